#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"

namespace nepho {

enum class PictureFormat { kPng, kExr, kHdr, kPfm, kPpm };

// By the ending of the name, upper or lower case; throws Error that lists the endings.
PictureFormat picture_format(const std::filesystem::path& path);
bool is_picture_name(const std::filesystem::path& path);
inline bool is_linear(PictureFormat format) {
  return format != PictureFormat::kPng && format != PictureFormat::kPpm;
}

// Reads and writes pictures. PNG, EXR and HDR go through the module nepho_image_oiio, looked for in
// `module_folders` and opened only then; without it, Error names the missing package.
class PictureFiles {
 public:
  explicit PictureFiles(std::vector<std::filesystem::path> module_folders)
      : folders_(std::move(module_folders)) {}

  // Throws where `path` could not be written later for a reason that is known now.
  void check_format(const std::filesystem::path& path) const;
  // 8-bit formats take `shown`; EXR takes `linear` with every channel, HDR and PFM its first 3.
  void write(const std::filesystem::path& path, PictureFormat format, const ByteImage& shown,
             const FloatImage& linear, const Metadata& metadata) const;
  Metadata read_metadata(const std::filesystem::path& path) const;
  // Values as stored (8 bit: 0 to 1, still sRGB).
  FloatImage read(const std::filesystem::path& path, Metadata& metadata) const;

  // Whether some picture needed the module so far in this process.
  static bool module_loaded();

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace nepho
