#include "sources/grib/field_scan.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>

#include "core/error.h"

namespace nepho::grib {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::uint64_t kSearch_bytes = 1 << 16;        // of what stands between messages, at once
constexpr std::uint64_t kNoGribBefore_bytes = 1 << 20;  // of a file that is none
constexpr std::uint64_t kDataHeader1_bytes = 32;        // of edition 1's data, for its packing
constexpr std::uint64_t kEnd_bytes = 4;                 // "7777"
constexpr std::uint64_t kLengthUnit1 = 120;             // of long messages of edition 1

std::uint64_t number(const unsigned char* at, int bytes) {
  std::uint64_t value = 0;
  for (int n = 0; n < bytes; ++n) value = value << 8 | at[n];
  return value;
}

void put_number(Bytes& to, std::size_t at, int bytes, std::uint64_t value) {
  for (int n = bytes; n-- > 0; value >>= 8) to[at + std::size_t(n)] = (unsigned char)(value & 0xff);
}

[[noreturn]] void refuse(const std::string& path, std::size_t index, std::uint64_t offset,
                         const std::string& found) {
  throw Error(
      {"a GRIB message is cut short or damaged",
       path + ", message " + std::to_string(index + 1) + " at byte " + std::to_string(offset),
       "sections that end with 7777", found, "copy or download the file again"});
}

class File {
 public:
  explicit File(const std::string& path) : path_(path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw Error({"no such file", path, "", "", ""});
    if (!std::filesystem::is_regular_file(status))
      throw Error({"this is no file", path, "a GRIB file", "a folder or a device", ""});
    size_ = std::filesystem::file_size(path, error);
    if (size_ == 0)
      throw Error({"the file is empty", path, "a GRIB file", "0 bytes", "write or copy it again"});
    in_.open(path, std::ios::binary);
    if (!in_) throw Error({"cannot read the file", path, "", std::strerror(errno), ""});
  }
  std::uint64_t size() const { return size_; }
  // As many bytes as there are.
  Bytes read(std::uint64_t offset, std::uint64_t count) {
    Bytes bytes(std::size_t(std::min(count, offset < size_ ? size_ - offset : 0)));
    in_.clear();
    in_.seekg(std::streamoff(offset));
    in_.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    bytes.resize(std::size_t(in_.gcount()));
    return bytes;
  }
  void append(Bytes& to, const Section& section, std::uint64_t count) {
    const Bytes bytes = read(section.offset, count);
    if (bytes.size() != count)
      throw Error({"the file has become shorter while it was read", path_, "", "", ""});
    to.insert(to.end(), bytes.begin(), bytes.end());
  }

 private:
  std::string path_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
};

// The next "GRIB" from `from` on.
std::optional<std::uint64_t> next_message(File& file, std::uint64_t from) {
  for (std::uint64_t at = from; at + 4 <= file.size(); at += kSearch_bytes - 3) {
    const Bytes block = file.read(at, kSearch_bytes);
    static constexpr char kName[] = "GRIB";
    const auto found = std::search(block.begin(), block.end(), kName, kName + 4);
    if (found != block.end()) return at + std::uint64_t(found - block.begin());
    if (from == 0 && at > kNoGribBefore_bytes) break;
  }
  return {};
}

// One message after another: its end, and its fields.
class Scan {
 public:
  Scan(const std::string& path, int index) : path_(path), file_(path), index_(index) {}

  std::vector<FieldPlace> fields() {
    std::uint64_t at = 0;
    while (const auto start = next_message(file_, at)) {
      start_ = *start;
      const Bytes head = file_.read(start_, 16);
      if (head.size() < 8) refuse("the end of the file");
      if (head[7] == 2) {
        at = edition2(head);
      } else if (head[7] == 1) {
        at = edition1(head);
      } else if (messages_ == 0) {
        throw Error({"this is not a GRIB file of a known edition", path_, "edition 1 or 2",
                     "edition " + std::to_string(int(head[7])), ""});
      } else {
        refuse("edition " + std::to_string(int(head[7])));
      }
      ++messages_;
    }
    if (messages_ == 0)
      throw Error({"this is not a GRIB file", path_, "messages that begin with GRIB", "none", ""});
    return std::move(fields_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found) const {
    grib::refuse(path_, messages_, start_, found);
  }
  void check_end(std::uint64_t end) {
    if (end > file_.size())
      refuse("a length of " + std::to_string(end - start_) + " bytes with " +
             std::to_string(file_.size() - start_) + " left");
    const Bytes last = file_.read(end - kEnd_bytes, kEnd_bytes);
    if (Bytes{'7', '7', '7', '7'} != last) refuse("other bytes at its end");
  }
  std::uint64_t edition2(const Bytes& head);
  std::uint64_t edition1(const Bytes& head);

  std::string path_;
  File file_;
  int index_;
  std::uint64_t start_ = 0;
  std::size_t messages_ = 0;
  std::vector<FieldPlace> fields_;
};

std::uint64_t Scan::edition2(const Bytes& head) {
  if (head.size() < 16) refuse("the end of the file");
  const std::uint64_t length = number(&head[8], 8);
  if (length < 16 + kEnd_bytes || length > file_.size() - start_)
    refuse("a length of " + std::to_string(length) + " bytes with " +
           std::to_string(file_.size() - start_) + " left");
  const std::uint64_t end = start_ + length;
  check_end(end);
  FieldPlace place;
  place.file = index_;
  place.edition = 2;
  place.message = start_;
  place.section[0] = {start_, 16};
  Section bitmap;  // the last that was given
  std::size_t found = 0;
  for (std::uint64_t at = start_ + 16; at < end - kEnd_bytes;) {
    const Bytes header = file_.read(at, 6);
    const std::uint64_t bytes = header.size() < 5 ? 0 : number(header.data(), 4);
    const int name = header.size() < 5 ? 0 : header[4];
    if (bytes < 5 || name < 1 || name > 7 || bytes > end - kEnd_bytes - at)
      refuse("section " + std::to_string(name) + " of " + std::to_string(bytes) + " bytes");
    place.section[std::size_t(name)] = {at, bytes};
    if (name == 6) {
      // 254: the bit map of an earlier field of this message.
      if (header.size() < 6) refuse("a bit map without an indicator");
      if (header[5] == 254 && bitmap.bytes == 0) refuse("a bit map that was not given");
      if (header[5] == 254) place.section[6] = bitmap;
      if (header[5] == 0) bitmap = place.section[6];
    }
    if (name == 7) {
      for (const int needed : {1, 3, 4, 5, 6})
        if (place.section[std::size_t(needed)].bytes == 0)
          refuse("data without section " + std::to_string(needed));
      fields_.push_back(place);
      ++found;
    }
    at += bytes;
  }
  if (found == 0) refuse("no data");
  return end;
}

std::uint64_t Scan::edition1(const Bytes& head) {
  FieldPlace place;
  place.file = index_;
  place.edition = 1;
  place.message = start_;
  std::uint64_t length = number(&head[4], 3), at = start_ + 8;
  place.section[0] = {start_, 8};
  const auto section = [&](std::size_t name) {
    const Bytes header = file_.read(at, 8);
    const std::uint64_t bytes = header.size() < 8 ? 0 : number(header.data(), 3);
    if (bytes < 4 || at + bytes > file_.size())
      refuse("section " + std::to_string(name) + " of " + std::to_string(bytes) + " bytes");
    place.section[name] = {at, bytes};
    at += bytes;
    return header;
  };
  const unsigned char flags = section(1)[7];
  if (place.section[1].bytes < 28) refuse("a short section 1");
  if (flags & 0x80) section(2);
  if (flags & 0x40) section(3);
  const Bytes data = file_.read(at, 3);
  if (data.size() < 3) refuse("the end of the file");
  const std::uint64_t data_bytes = number(data.data(), 3);
  // Messages of 8 MiB and more count in units of 120 bytes; the rest stands as the data's length
  // (ECMWF's way, which all centres follow).
  if (length & 0x800000 && data_bytes < kLengthUnit1)
    length = (length & 0x7fffff) * kLengthUnit1 - data_bytes + 4;
  const std::uint64_t end = start_ + length;
  if (end <= at + kEnd_bytes) refuse("a length of " + std::to_string(length) + " bytes");
  check_end(end);
  place.section[4] = {at, end - kEnd_bytes - at};
  fields_.push_back(place);
  return end;
}

// Ends a message and writes its length.
Bytes finished(Bytes message, int edition) {
  message.insert(message.end(), kEnd_bytes, '7');
  if (edition == 2) put_number(message, 8, 8, message.size());
  return message;
}

}  // namespace

std::uint64_t FieldPlace::bytes() const {
  return std::accumulate(section.begin(), section.end(), kEnd_bytes,
                         [](std::uint64_t sum, const Section& s) { return sum + s.bytes; });
}

std::vector<FieldPlace> scan_fields(const std::string& path, int file) {
  return Scan(path, file).fields();
}

Bytes read_field(const std::string& path, const FieldPlace& place) {
  File file(path);
  Bytes message;
  message.reserve(std::size_t(place.bytes()));
  for (const Section& section : place.section) file.append(message, section, section.bytes);
  return finished(std::move(message), place.edition);
}

Bytes read_headers(const std::string& path, const FieldPlace& place) {
  File file(path);
  Bytes message;
  if (place.edition == 2) {
    for (std::size_t name = 0; name <= 5; ++name)
      file.append(message, place.section[name], place.section[name].bytes);
    for (const Bytes& short_section : {Bytes{0, 0, 0, 6, 6, 255}, Bytes{0, 0, 0, 5, 7}})
      message.insert(message.end(), short_section.begin(), short_section.end());
    return finished(std::move(message), 2);
  }
  for (std::size_t name = 0; name <= 2; ++name)
    file.append(message, place.section[name], place.section[name].bytes);
  message[8 + 7] &= 0xbf;  // no bit map
  const std::uint64_t data = std::min(place.section[4].bytes, kDataHeader1_bytes);
  const std::size_t at = message.size();
  file.append(message, place.section[4], data);
  put_number(message, at, 3, data);
  message = finished(std::move(message), 1);
  put_number(message, 4, 3, message.size());
  return message;
}

}  // namespace nepho::grib
