#include <cmath>
#include <cstdio>

#include "cli/commands.h"
#include "cli/scene_input.h"
#include "common/metrics.h"
#include "host/source_host.h"

namespace nepho {
namespace {

double from_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// In linear light. Pictures without a channel of optical depth count whole.
HdrImage load(const std::string& name, const PictureFiles& pictures, bool& has_depth) {
  input_kind(name);  // says so where there is no such file
  Metadata metadata;
  const FloatImage image = pictures.read(name, metadata);
  const bool linear = is_linear(picture_format(name));
  HdrImage out;
  out.width = image.width;
  out.height = image.height;
  has_depth = linear && image.channels == 4;
  const auto channels = std::size_t(image.channels);
  for (std::size_t p = 0; p < image.count(); ++p) {
    const float* in = image.values.data() + p * channels;
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = in[channels >= 3 ? c : 0];
      out.rgb.push_back(linear ? value : float(from_srgb(double(value))));
    }
    out.optical_depth.push_back(has_depth ? in[3] : 1.0f);
  }
  return out;
}

}  // namespace

void compare_command(const CompareOptions& options) {
  const PictureFiles pictures(default_module_folders());
  bool picture_depth = false, truth_depth = false;
  const HdrImage picture = load(options.a, pictures, picture_depth);
  const HdrImage truth = load(options.b, pictures, truth_depth);
  const PictureDifference d = difference(picture, truth);
  const char* where = truth_depth ? "where the truth shows cloud" : "over all pixels";
  if (d.relative_rms >= 0)
    std::printf("rms of luminance, relative: %.6g %% (%s)\n", 100 * d.relative_rms, where);
  std::printf("relative MSE: %.6g\n", d.relative_mse);
  std::printf("bias of luminance: %+.6g %%\n", 100 * d.bias);
  std::printf("largest difference of a channel: %.6g\n", d.largest);
  std::printf("%s\n", d.same_bits ? "same pixels, bit for bit" : "not the same pixels");
}

}  // namespace nepho
