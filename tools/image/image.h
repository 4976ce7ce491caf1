#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace nepho {

// Row 0 at the top, channels interleaved.
template <typename T>
struct Pixels {
  int width = 0, height = 0, channels = 3;
  std::vector<T> values;

  Pixels() = default;
  Pixels(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        values(std::size_t(w) * std::size_t(h) * std::size_t(c)) {}
  std::size_t count() const { return std::size_t(width) * std::size_t(height); }
};
using FloatImage = Pixels<float>;
using ByteImage = Pixels<std::uint8_t>;

// Key and one-line value, such as nephoscope:scene.
using Metadata = std::map<std::string, std::string>;

// The two formats that need no library. Both are written in the order of this machine (little
// endian). PPM (P6, 8 bit) keeps metadata as comments of its header; PFM has none, so they follow
// the pixels, where readers stop looking. All throw Error; a failed write may leave a part behind.
void write_ppm(const std::filesystem::path& path, const ByteImage& image, const Metadata& metadata);
void write_pfm(const std::filesystem::path& path, const FloatImage& image,
               const Metadata& metadata);
ByteImage read_ppm(const std::filesystem::path& path, Metadata& metadata);
FloatImage read_pfm(const std::filesystem::path& path, Metadata& metadata);

// For formats that have no room for text: after their last pixel.
void append_trailer(const std::filesystem::path& path, const Metadata& metadata);
Metadata read_trailer(const std::filesystem::path& path);

}  // namespace nepho
