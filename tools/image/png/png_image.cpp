// PNG (ISO/IEC 15948:2003) of 8-bit pictures through zlib, behind the plain C entry of
// picture_module.h. Writes only.

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "image/picture_module.h"

namespace nepho {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kCompression = 6, kMemory = 8;  // zlib's own
constexpr std::size_t kLongestKey = 79;

int fail(char* error, std::size_t size, const std::string& text) {
  std::snprintf(error, size, "%s", text.c_str());
  return 1;
}

void put_u32(Bytes& to, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) to.push_back(std::uint8_t(value >> shift));
}

void put_chunk(Bytes& to, std::string_view type, const Bytes& data) {
  put_u32(to, std::uint32_t(data.size()));
  const std::size_t checked = to.size();
  to.insert(to.end(), type.begin(), type.end());
  to.insert(to.end(), data.begin(), data.end());
  put_u32(to, std::uint32_t(crc32(0, to.data() + checked, uInt(to.size() - checked))));
}

std::uint8_t paeth(int left, int above, int corner) {
  const int estimate = left + above - corner;
  const int to_left = std::abs(estimate - left), to_above = std::abs(estimate - above);
  const int to_corner = std::abs(estimate - corner);
  if (to_left <= to_above && to_left <= to_corner) return std::uint8_t(left);
  return std::uint8_t(to_above <= to_corner ? above : corner);
}

// The row by each of the five filters (chapter 9); that with the least sum of absolute values, as
// signed bytes, is likely to deflate best (12.8).
class RowFilter {
 public:
  RowFilter(std::size_t row_bytes, std::size_t pixel_bytes) : pixel_(pixel_bytes) {
    for (Bytes& row : rows_) row.resize(row_bytes);
    blank_.resize(row_bytes);
  }

  void put(const std::uint8_t* row, const std::uint8_t* above, Bytes& to) {
    if (!above) above = blank_.data();
    std::array<std::uint64_t, 5> sums{};
    for (std::size_t i = 0; i < blank_.size(); ++i) {
      const int left = i < pixel_ ? 0 : row[i - pixel_],
                corner = i < pixel_ ? 0 : above[i - pixel_];
      const std::array<int, 5> predicted = {0, left, above[i], (left + above[i]) / 2,
                                            paeth(left, above[i], corner)};
      for (std::size_t f = 0; f < 5; ++f) {
        const auto value = std::uint8_t(row[i] - predicted[f]);
        rows_[f][i] = value;
        sums[f] += std::uint64_t(value < 128 ? value : 256 - value);
      }
    }
    const auto best = std::size_t(std::ranges::min_element(sums) - sums.begin());
    to.push_back(std::uint8_t(best));
    to.insert(to.end(), rows_[best].begin(), rows_[best].end());
  }

 private:
  std::size_t pixel_;
  std::array<Bytes, 5> rows_;
  Bytes blank_;
};

// Runs only: filtered rows of a photograph repeat little else, and the search for it takes seven
// times as long for a file that is a tenth smaller.
Bytes deflated(Bytes& rows) {
  z_stream stream{};
  if (deflateInit2(&stream, kCompression, Z_DEFLATED, MAX_WBITS, kMemory, Z_RLE) != Z_OK)
    throw std::bad_alloc();
  Bytes packed(deflateBound(&stream, uLong(rows.size())));
  stream.next_in = rows.data();
  stream.next_out = packed.data();
  constexpr std::size_t kPiece = 1u << 30;  // zlib counts by 32 bits
  int status = Z_OK;
  for (std::size_t left = rows.size(); status == Z_OK;) {
    const std::size_t piece = std::min(left, kPiece);
    stream.avail_in = uInt(piece);
    stream.avail_out = uInt(std::min(packed.size() - stream.total_out, kPiece));
    status = deflate(&stream, piece == left ? Z_FINISH : Z_NO_FLUSH);
    left -= piece - stream.avail_in;
  }
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::bad_alloc();
  return packed;
}

Bytes deflated_rows(const PictureView& picture) {
  const auto row_bytes = std::size_t(picture.width) * std::size_t(picture.channels);
  const auto height = std::size_t(picture.height);
  const auto* pixels = static_cast<const std::uint8_t*>(picture.pixels);
  RowFilter filter(row_bytes, std::size_t(picture.channels));
  Bytes rows;
  rows.reserve(height * (row_bytes + 1));
  for (std::size_t y = 0; y < height; ++y)
    filter.put(pixels + y * row_bytes, y > 0 ? pixels + (y - 1) * row_bytes : nullptr, rows);
  return deflated(rows);
}

Bytes header(const PictureView& picture) {
  Bytes data;
  put_u32(data, std::uint32_t(picture.width));
  put_u32(data, std::uint32_t(picture.height));
  const std::uint8_t colour = picture.channels == 3 ? 2 : 0;
  data.insert(data.end(), {8, colour, 0, 0, 0});
  return data;
}

Bytes text(std::string_view key, std::string_view value) {
  Bytes data(key.begin(), key.begin() + std::ptrdiff_t(std::min(key.size(), kLongestKey)));
  data.push_back(0);
  data.insert(data.end(), value.begin(), value.end());
  return data;
}

int save(const char* path, const Bytes& file, char* error, std::size_t error_size) {
  std::FILE* out = std::fopen(path, "wb");
  if (!out) return fail(error, error_size, std::strerror(errno));
  const bool written = std::fwrite(file.data(), 1, file.size(), out) == file.size();
  const int why = errno;
  if (std::fclose(out) == 0 && written) return 0;
  return fail(error, error_size, std::strerror(written ? errno : why));
}

int write(const char* path, const char* format, const PictureView* picture, char* error,
          std::size_t error_size) {
  try {
    if (std::string_view(format) != "png" || picture->type != PixelType::kByte ||
        (picture->channels != 3 && picture->channels != 1))
      return fail(error, error_size, "only 8-bit PNG pictures of one or three channels");
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    put_chunk(file, "IHDR", header(*picture));
    put_chunk(file, "sRGB", {0});  // perceptual
    for (std::size_t i = 0; i < picture->metadata_count; ++i)
      put_chunk(file, "tEXt", text(picture->keys[i], picture->values[i]));
    put_chunk(file, "IDAT", deflated_rows(*picture));
    put_chunk(file, "IEND", {});
    return save(path, file, error, error_size);
  } catch (const std::exception& e) {
    return fail(error, error_size, e.what());
  }
}

int read(const char*, int, const PictureSink*, char* error, std::size_t error_size) {
  return fail(error, error_size, "this module writes only");
}

constexpr PictureModule kModule{kPictureModuleVersion, write, read};

}  // namespace
}  // namespace nepho

extern "C" __attribute__((visibility("default"))) const nepho::PictureModule*
nepho_picture_module() {
  return &nepho::kModule;
}
