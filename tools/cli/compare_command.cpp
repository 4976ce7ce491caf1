#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/compare_input.h"
#include "cli/values.h"
#include "common/metrics.h"
#include "common/output_file.h"
#include "core/error.h"
#include "host/source_host.h"
#include "image/difference.h"
#include "image/flip.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Comparison {
  PictureDifference light;
  ByteDifference shown;
  FloatImage flip;  // a value for each pixel
  double pixels_per_degree = kPixelsPerDegree;
};

struct DifferenceMap {
  std::string of;  // what its values are
  FloatImage values;
  ByteImage colours;
  std::string scale;  // of the colours, in words
};
struct MapOptions {
  bool luminance = false;
  std::optional<double> scale;
};

double value_between(const char* name, const std::string& text, double low, double high) {
  const double value = number_value(name, text);
  if (value >= low && value <= high) return value;
  char range[60];
  std::snprintf(range, sizeof range, "a number from %g to %g", low, high);
  throw Error({"bad value", name, range, "'" + text + "'", ""});
}

FloatImage signed_map(const ComparedPair& pair) {
  FloatImage map(pair.truth.width, pair.truth.height, 1);
  const std::vector<double> values = relative_luminance_differences(pair.picture, pair.truth);
  for (std::size_t p = 0; p < values.size(); ++p) map.values[p] = float(values[p]);
  return map;
}

// FLIP on its whole scale, so that maps can be held side by side; luminance on one that fits.
DifferenceMap difference_map(const ComparedPair& pair, const Comparison& found,
                             const MapOptions& options) {
  char text[160];
  if (!options.luminance) {
    const double full = options.scale.value_or(1);
    std::snprintf(text, sizeof text,
                  "FLIP from 0 (black) over violet, red and orange to %g (pale yellow)", full);
    return {"FLIP", found.flip, error_colours(found.flip, full), text};
  }
  const FloatImage map = signed_map(pair);
  const double full = options.scale.value_or(round_scale(map));
  std::snprintf(
      text, sizeof text,
      "relative difference of luminance from -%g %% (blue) over 0 (white) to +%g %% (red)",
      100 * full, 100 * full);
  return {"relative difference of luminance", map, signed_colours(map, full), text};
}

// The colours in 8 bit; the numbers where the format is linear.
void write_map(const DifferenceMap& map, const fs::path& path, const PictureFiles& pictures,
               OutputFile& file) {
  FloatImage values(map.values.width, map.values.height, 3);
  for (std::size_t i = 0; i < values.values.size(); ++i)
    values.values[i] = map.values.values[i / 3];
  pictures.write(file.temporary(), picture_format(path), map.colours, values,
                 {{"nephoscope:difference", map.scale}, {"nephoscope:version", NEPHO_VERSION}});
  file.commit();
}

void print_light(const PictureDifference& d, const ComparedPair& pair) {
  const char* where = pair.has_depth ? "where the truth shows cloud" : "over all pixels";
  if (!pair.linear) std::printf("light: that of a display, as 8-bit pictures hold no other\n");
  if (d.relative_rms >= 0)
    std::printf("rms of luminance, relative: %.6g %% (%s)\n", 100 * d.relative_rms, where);
  std::printf("relative MSE: %.6g\n", d.relative_mse);
  std::printf("relative MSE of luminance: %.6g, red %.6g, green %.6g, blue %.6g\n",
              d.relative_mse_luminance, d.relative_mse_rgb[0], d.relative_mse_rgb[1],
              d.relative_mse_rgb[2]);
  std::printf("bias of luminance: %+.6g %%\n", 100 * d.bias);
  std::printf("bias of red %+.6g %%, green %+.6g %%, blue %+.6g %%\n", 100 * d.bias_rgb[0],
              100 * d.bias_rgb[1], 100 * d.bias_rgb[2]);
  std::printf("largest difference of a channel: %.6g\n", d.largest);
}

void print_shown(const Comparison& found, const ComparedPair& pair) {
  if (pair.display)
    std::printf("shown at %+.2f EV, tone map %s%s (%s)\n", pair.display->exposure_ev,
                tone_map_name(pair.display->tone_map), pair.display->dither ? ", dithered" : "",
                pair.display->from.c_str());
  std::printf("RMSE of 8-bit RGB: %.6g\n", found.shown.rmse);
  std::printf("PSNR of 8-bit RGB: %.6g dB\n", found.shown.psnr_db);
  std::printf("FLIP: mean %.6g, largest %.6g (%.4g pixels per degree)\n", mean_of(found.flip),
              largest_of(found.flip), found.pixels_per_degree);
}

// Ratios are ratios here, not percent; what is not finite is null.
void print_json(const CompareOptions& options, const ComparedPair& pair, const Comparison& found,
                const DifferenceMap* map) {
  const PictureDifference& d = found.light;
  Json out;
  out["a"] = options.a;
  out["b"] = options.b;
  out["width"] = pair.truth.width;
  out["height"] = pair.truth.height;
  out["light"] = pair.linear ? "linear" : "display";
  out["same_bits"] = d.same_bits;
  if (d.relative_rms >= 0)
    out["relative_rms"] = {{"value", d.relative_rms}, {"pixels", pair.has_depth ? "cloud" : "all"}};
  out["relative_mse"] = {{"all", d.relative_mse},
                         {"luminance", d.relative_mse_luminance},
                         {"rgb", d.relative_mse_rgb}};
  out["bias"] = {{"luminance", d.bias}, {"rgb", d.bias_rgb}};
  out["largest_difference"] = d.largest;
  if (pair.display)
    out["display"] = {{"exposure_ev", pair.display->exposure_ev},
                      {"tone_map", tone_map_name(pair.display->tone_map)},
                      {"dither", pair.display->dither},
                      {"from", pair.display->from}};
  if (!pair.note.empty()) out["note"] = pair.note;
  out["rmse_8bit"] = found.shown.rmse;
  out["psnr_db"] = found.shown.psnr_db;
  out["flip"] = {{"mean", mean_of(found.flip)},
                 {"largest", largest_of(found.flip)},
                 {"pixels_per_degree", found.pixels_per_degree}};
  if (map) out["map"] = {{"file", *options.diff}, {"of", map->of}, {"scale", map->scale}};
  std::printf("%s\n", out.dump(2).c_str());
}

// Known before the work: what cannot be written, and what would be lost.
// Known before the work: what cannot be written, and what would be lost.
MapOptions map_options(const CompareOptions& options, const PictureFiles& pictures) {
  for (const auto& [option, value] :
       {std::pair{"--diff-of", &options.diff_of}, std::pair{"--diff-scale", &options.diff_scale}})
    if (*value && !options.diff)
      throw Error({"nothing to apply it to", option, "--diff FILE", "none", ""});
  MapOptions out;
  if (!options.diff) return out;
  out.luminance = options.diff_of == "luminance";
  if (options.diff_of && !out.luminance && options.diff_of != "flip")
    throw Error({"bad value", "--diff-of", "flip or luminance", "'" + *options.diff_of + "'", ""});
  if (options.diff_scale) out.scale = value_between("--diff-scale", *options.diff_scale, 1e-9, 1e9);
  std::error_code ignored;
  for (const std::string& input : {options.a, options.b})
    if (fs::equivalent(*options.diff, input, ignored))
      throw Error({"would replace a picture that is compared", "--diff", "another name",
                   "'" + *options.diff + "'", ""});
  pictures.check_format(*options.diff);
  return out;
}

const char* sameness(const ComparedPair& pair, const Comparison& found) {
  if (!found.light.same_bits) return "not the same pixels";
  // A linear picture holds more than its 8 bits.
  return !pair.linear && pair.display ? "same pixels as shown in 8 bits"
                                      : "same pixels, bit for bit";
}

}  // namespace

void compare_command(const CompareOptions& options) {
  const PictureFiles pictures(default_module_folders());
  const MapOptions map_is = map_options(options, pictures);
  const double pixels_per_degree =
      options.pixels_per_degree
          ? value_between("--pixels-per-degree", *options.pixels_per_degree, 1, 1000)
          : kPixelsPerDegree;
  const ComparedPair pair = read_pair(options, pictures);
  std::optional<OutputFile> file;
  if (options.diff) file.emplace(*options.diff, 5 * pair.truth.rgb.size() + (64u << 10));
  const Comparison found{
      difference(pair.picture, pair.truth), byte_difference(pair.picture_shown, pair.truth_shown),
      flip_map(pair.picture_shown, pair.truth_shown, pixels_per_degree), pixels_per_degree};
  std::optional<DifferenceMap> map;
  if (options.diff) {
    map = difference_map(pair, found, map_is);
    write_map(*map, *options.diff, pictures, *file);
  }
  if (options.json) return print_json(options, pair, found, map ? &*map : nullptr);
  if (!pair.note.empty()) std::printf("note: %s\n", pair.note.c_str());
  print_light(found.light, pair);
  print_shown(found, pair);
  if (map)
    std::printf("%s: %s\n", options.diff->c_str(),
                is_linear(picture_format(*options.diff)) ? map->of.c_str() : map->scale.c_str());
  std::printf("%s\n", sameness(pair, found));
}

}  // namespace nepho
