#include "vdb_container.h"

#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"

namespace nepho::vdb {
namespace {

constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldest = 220, kNodeMask = 222, kNewest = 224;  // 1.0, 2.0, 10.0

class Cursor {
 public:
  Cursor(const std::string& file, std::int64_t size)
      : file_(file), size_(size), stream_(file, std::ios::binary) {
    if (!stream_) throw Error({"cannot read the file", file, "a readable file", "no access", ""});
  }

  template <class T>
  T number(const char* what) {
    T value{};
    need(sizeof value, what);
    stream_.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  void skip(std::int64_t bytes, const char* what) {
    need(bytes, what);
    stream_.seekg(bytes, std::ios::cur);
  }
  void skip_text(const char* what) { skip(number<std::uint32_t>(what), what); }
  std::string text(const char* what) {
    const std::uint32_t length = number<std::uint32_t>(what);
    need(length, what);
    std::string result(length, '\0');
    stream_.read(result.data(), length);
    return result;
  }
  void seek(std::int64_t position) { stream_.seekg(position); }
  std::int64_t position() { return stream_.tellg(); }
  std::int64_t size() const { return size_; }

  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw Error(
        {"the VDB file is truncated or damaged", file_, expected, found, "write or copy it again"});
  }

 private:
  void need(std::int64_t bytes, const char* what) {
    if (bytes > size_ - position())
      refuse(std::to_string(bytes) + " bytes of " + what + " at byte " + std::to_string(position()),
             "a file of " + std::to_string(size_) + " bytes");
  }
  std::string file_;
  std::int64_t size_;
  std::ifstream stream_;
};

std::int64_t checked_size(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw Error({"no such file", file, "a .vdb file", "nothing", ""});
  if (fs::is_directory(status))
    throw Error({"cannot read a folder as a VDB file", file, "a .vdb file", "a folder",
                 "a sequence is written as folder/name.####.vdb"});
  if (!fs::is_regular_file(status))
    throw Error({"cannot read this as a VDB file", file, "a .vdb file", "a device or pipe", ""});
  const auto size = fs::file_size(file, error);
  if (error) throw Error({"cannot read the file", file, "a readable file", error.message(), ""});
  if (size == 0) throw Error({"the file is empty", file, "a .vdb file", "0 bytes", ""});
  return std::int64_t(size);
}

[[noreturn]] void refuse_nano(const std::string& file) {
  throw Error({"NanoVDB is not read", file, "an OpenVDB file (.vdb)", "a NanoVDB file",
               "convert it with nanovdb_convert to .vdb"});
}

void check_magic(const std::string& file, Cursor& in) {
  char first[8] = {};
  for (char& c : first) c = in.number<char>("magic number");
  if (std::memcmp(first, "NanoVDB", 7) == 0) refuse_nano(file);
  if (std::memcmp(first, &kMagic, 8) != 0)
    throw Error(
        {"not a VDB file", file, "the magic number 20 42 44 56", "another kind of file", ""});
}

void skip_metadata(Cursor& in) {
  const auto count = in.number<std::uint32_t>("metadata count");
  for (std::uint32_t at = 0; at < count; ++at)
    for (const char* what : {"metadata name", "metadata type", "metadata"}) in.skip_text(what);
}

void check_grid(Cursor& in, std::uint32_t version) {
  const std::string name = in.text("grid name");
  in.skip_text("grid type");
  in.skip_text("grid parent");
  const auto grid = in.number<std::int64_t>("grid offset");
  const auto block = in.number<std::int64_t>("grid offset");
  const auto end = in.number<std::int64_t>("grid offset");
  if (end > in.size())
    in.refuse("grid " + name + " to end at byte " + std::to_string(end),
              "a file of " + std::to_string(in.size()) + " bytes");
  if (grid < in.position() || block < grid || end < block)
    in.refuse("ascending offsets of grid " + name,
              std::to_string(grid) + ", " + std::to_string(block) + ", " + std::to_string(end));
  in.seek(grid);
  if (version >= kNodeMask) in.skip(4, "compression flags");
  skip_metadata(in);
  in.skip_text("transform type");
  in.seek(end);
}

}  // namespace

void check_container(const std::string& file) {
  const std::int64_t size = checked_size(file);
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".nvdb") refuse_nano(file);
  Cursor in(file, size);
  check_magic(file, in);
  const auto version = in.number<std::uint32_t>("file version");
  if (version < kOldest || version > kNewest)
    throw Error({"unknown version of the VDB format", file,
                 std::to_string(kOldest) + " to " + std::to_string(kNewest),
                 std::to_string(version), "read and write it with a current OpenVDB"});
  in.skip(8, "library version");
  if (in.number<char>("offset flag") == 0)
    throw Error({"the VDB file is a stream without grid offsets", file, "a file with offsets",
                 "none", "write it with openvdb::io::File"});
  if (version < kNodeMask) in.skip(1, "compression flag");
  in.skip(36, "identifier");
  skip_metadata(in);
  const auto grids = in.number<std::int32_t>("grid count");
  if (grids < 0) in.refuse("a count of grids", std::to_string(grids));
  for (std::int32_t at = 0; at < grids; ++at) check_grid(in, version);
}

}  // namespace nepho::vdb
