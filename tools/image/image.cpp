#include "image/image.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.h"

namespace nepho {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr int kLargestSide = 1 << 16;
constexpr const char* kTrailerMark = "\n#nephoscope-metadata\n";
constexpr std::streamoff kLargestTrailer = 4 << 20;

std::ofstream open_output(const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  if (!out) throw Error({"cannot write", path.string(), "", std::strerror(errno), ""});
  return out;
}

void close_output(std::ofstream& out, const std::filesystem::path& path) {
  out.close();
  if (!out) throw Error({"cannot write", path.string(), "", std::strerror(errno), ""});
}

std::ifstream open_input(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error({"cannot read", path.string(), "", std::strerror(errno), ""});
  return in;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const char* format) {
  throw Error({"not a picture", path.string(), format, "", ""});
}

// A word of a PNM header; comments "# key value" go to the metadata.
std::string next_word(std::istream& in, Metadata* metadata) {
  std::string word, line;
  for (;;) {
    in >> std::ws;
    if (in.peek() != '#') break;
    std::getline(in, line);
    std::istringstream comment(line.substr(1));
    std::string key, value;
    comment >> key >> std::ws;
    std::getline(comment, value);
    if (metadata && !key.empty()) (*metadata)[key] = value;
  }
  in >> word;
  return word;
}

int next_side(std::istream& in, Metadata* metadata, const std::filesystem::path& path,
              const char* format) {
  const std::string word = next_word(in, metadata);
  const bool digits =
      !word.empty() && word.size() < 7 && word.find_first_not_of("0123456789") == std::string::npos;
  const int side = digits ? std::stoi(word) : 0;
  if (side < 1 || side > kLargestSide) refuse(path, format);
  return side;
}

void read_values(std::istream& in, void* to, std::size_t bytes, const std::filesystem::path& path,
                 const char* format) {
  in.read(static_cast<char*>(to), std::streamsize(bytes));
  if (std::size_t(in.gcount()) != bytes) refuse(path, format);
}

// Nothing is allocated on a header's word: the file must be as long as it says.
void check_length(const std::filesystem::path& path, std::size_t bytes, const char* format) {
  std::error_code failure;
  if (std::filesystem::file_size(path, failure) < bytes || failure) refuse(path, format);
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

}  // namespace

void write_ppm(const std::filesystem::path& path, const ByteImage& image,
               const Metadata& metadata) {
  std::ofstream out = open_output(path);
  out << "P6\n";
  for (const auto& [key, value] : metadata) out << "# " << key << ' ' << one_line(value) << '\n';
  out << image.width << ' ' << image.height << "\n255\n";
  out.write(reinterpret_cast<const char*>(image.values.data()),
            std::streamsize(image.values.size()));
  close_output(out, path);
}

ByteImage read_ppm(const std::filesystem::path& path, Metadata& metadata) {
  constexpr const char* format = "PPM, 8 bit (P6)";
  std::ifstream in = open_input(path);
  if (next_word(in, nullptr) != "P6") refuse(path, format);
  const int width = next_side(in, &metadata, path, format);
  const int height = next_side(in, &metadata, path, format);
  if (next_word(in, &metadata) != "255") refuse(path, format);
  in.get();
  check_length(path, std::size_t(width) * std::size_t(height) * 3, format);
  ByteImage image(width, height, 3);
  read_values(in, image.values.data(), image.values.size(), path, format);
  return image;
}

void write_pfm(const std::filesystem::path& path, const FloatImage& image,
               const Metadata& metadata) {
  std::ofstream out = open_output(path);
  // A negative scale means little endian; rows run from the bottom to the top.
  out << (image.channels == 1 ? "Pf\n" : "PF\n") << image.width << ' ' << image.height
      << "\n-1.0\n";
  const std::size_t row = std::size_t(image.width) * std::size_t(image.channels);
  for (int y = image.height - 1; y >= 0; --y)
    out.write(reinterpret_cast<const char*>(image.values.data() + std::size_t(y) * row),
              std::streamsize(row * sizeof(float)));
  close_output(out, path);
  append_trailer(path, metadata);
}

FloatImage read_pfm(const std::filesystem::path& path, Metadata& metadata) {
  constexpr const char* format = "PFM, little endian";
  std::ifstream in = open_input(path);
  const std::string magic = next_word(in, nullptr);
  if (magic != "PF" && magic != "Pf") refuse(path, format);
  const int width = next_side(in, nullptr, path, format);
  const int height = next_side(in, nullptr, path, format);
  if (!next_word(in, nullptr).starts_with('-')) refuse(path, format);
  in.get();
  const int channels = magic == "PF" ? 3 : 1;
  const std::size_t row = std::size_t(width) * std::size_t(channels);
  check_length(path, row * std::size_t(height) * sizeof(float), format);
  FloatImage image(width, height, channels);
  for (int y = height - 1; y >= 0; --y)
    read_values(in, image.values.data() + std::size_t(y) * row, row * sizeof(float), path, format);
  metadata = read_trailer(path);
  return image;
}

void append_trailer(const std::filesystem::path& path, const Metadata& metadata) {
  if (metadata.empty()) return;
  std::ofstream out(path, std::ios::binary | std::ios::app);
  out << kTrailerMark;
  for (const auto& [key, value] : metadata) out << key << ' ' << one_line(value) << '\n';
  close_output(out, path);
}

Metadata read_trailer(const std::filesystem::path& path) {
  Metadata metadata;
  std::ifstream in = open_input(path);
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  const std::streamoff start = std::max<std::streamoff>(0, size - kLargestTrailer);
  in.seekg(start);
  std::string tail(std::size_t(size - start), '\0');
  in.read(tail.data(), std::streamsize(tail.size()));
  const std::size_t mark = tail.rfind(kTrailerMark);
  if (mark == std::string::npos) return metadata;
  std::istringstream lines(tail.substr(mark + std::strlen(kTrailerMark)));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t blank = std::min(line.find(' '), line.size());
    if (blank > 0) metadata[line.substr(0, blank)] = line.substr(std::min(blank + 1, line.size()));
  }
  return metadata;
}

}  // namespace nepho
