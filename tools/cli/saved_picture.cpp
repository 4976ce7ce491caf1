#include "cli/saved_picture.h"

#include "common/planet_scene.h"
#include "image/tone.h"
#include "scene/scene_file.h"

namespace nepho {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

}  // namespace

FloatImage linear_image(const HdrImage& picture) {
  FloatImage out(picture.width, picture.height, 4);
  for (std::size_t p = 0; p < out.count(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) out.values[4 * p + c] = picture.rgb[3 * p + c];
    out.values[4 * p + 3] = picture.optical_depth[p];
  }
  return out;
}

double find_exposure(const OpenedScene& opened, const FloatImage& linear,
                     const std::vector<float>& optical_depth) {
  return opened.scene.planet ? exposure_on_planet(linear, optical_depth, white_in_the_sun(opened))
                             : exposure_from(linear, optical_depth);
}

std::uintmax_t largest_size(const RenderSettings& settings, PictureFormat format) {
  const auto pixels = std::uintmax_t(settings.width) * std::uintmax_t(settings.height);
  return pixels * (format == PictureFormat::kExr ? 17 : is_linear(format) ? 13 : 4) + (64u << 10);
}

Metadata metadata_of(const OpenedScene& opened, const std::filesystem::path& output,
                     const std::string& error) {
  return {{"nephoscope:scene",
           write_scene(opened.scene, std::filesystem::absolute(output).parent_path())},
          {"nephoscope:error", error},
          {"nephoscope:assumptions", joined(opened.assumptions)},
          {"nephoscope:version", NEPHO_VERSION}};
}

void write_picture(const PictureFiles& pictures, const std::filesystem::path& temporary,
                   PictureFormat format, const OpenedScene& opened, const FloatImage& linear,
                   const Metadata& metadata) {
  const ByteImage shown = is_linear(format)
                              ? ByteImage()
                              : to_display(linear, *opened.scene.exposure_ev, opened.scene.tone_map,
                                           opened.scene.dither, display_white(opened.scene));
  pictures.write(temporary, format, shown, linear, metadata);
}

}  // namespace nepho
