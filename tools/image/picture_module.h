#pragma once

#include <cstddef>
#include <cstdint>

namespace nepho {

// The C entry of the run-time modules that know PNG, EXR and HDR: nothing but plain pointers
// crosses, nothing throws. The program opens one only when such a picture is written or read.

inline constexpr std::uint32_t kPictureModuleVersion = 1;

enum class PixelType : std::int32_t { kByte, kFloat };

struct PictureView {
  int width, height, channels;
  PixelType type;
  const void* pixels;                // interleaved, row 0 at the top
  const char* const* channel_names;  // one per channel
  const char* const* keys;           // metadata
  const char* const* values;
  std::size_t metadata_count;
};

// Filled piece by piece, so that the module owns no memory of the program's.
struct PictureSink {
  void* context;
  // Returns where the floats go, or null to refuse; only asked for where pixels are wanted.
  float* (*size)(void* context, int width, int height, int channels);
  void (*metadata)(void* context, const char* key, const char* value);
};

struct PictureModule {
  std::uint32_t version;
  // Zero on success; else a text in `error`.
  int (*write)(const char* path, const char* format, const PictureView* picture, char* error,
               std::size_t error_size);
  int (*read)(const char* path, int want_pixels, const PictureSink* sink, char* error,
              std::size_t error_size);
};

}  // namespace nepho

// What the module exports: const nepho::PictureModule* nepho_picture_module();
extern "C" {
using nepho_picture_module_fn = const nepho::PictureModule*();
}
