#include "cli/compare_input.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/scene_input.h"
#include "cli/values.h"
#include "core/error.h"
#include "image/colour.h"
#include "image/tone.h"
#include "scene/scene_file.h"

namespace nepho {
namespace {

constexpr const char* kSceneKey = "nephoscope:scene";

struct Loaded {
  std::string name;
  FloatImage image;  // as stored
  Metadata metadata;
  std::optional<Scene> scene;  // that it was drawn from
  bool linear = false;
};

std::string size_text(const FloatImage& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

// Grey pictures have one channel, or two with opacity.
float channel(const FloatImage& image, std::size_t pixel, std::size_t c) {
  return image.values[pixel * std::size_t(image.channels) + (image.channels >= 3 ? c : 0)];
}

std::string pixel_text(const FloatImage& image, std::size_t pixel) {
  const auto width = std::size_t(image.width);
  return "inf or NaN at column " + std::to_string(pixel % width) + ", row " +
         std::to_string(pixel / width);
}

Loaded load(const std::string& name, const PictureFiles& pictures) {
  input_kind(name);  // says so where there is no such file
  Loaded out{name, {}, {}, {}, is_linear(picture_format(name))};
  out.image = pictures.read(name, out.metadata);
  for (std::size_t i = 0; i < 3 * out.image.count(); ++i)
    if (!std::isfinite(channel(out.image, i / 3, i % 3)))
      throw Error({"not finite", name, "finite values", pixel_text(out.image, i / 3), ""});
  const auto scene = out.metadata.find(kSceneKey);
  if (scene != out.metadata.end())
    out.scene = parse_scene(scene->second, name + " (" + kSceneKey + ")", ".");
  return out;
}

// Four channels are optical depth in our own pictures; elsewhere the fourth is opacity. Over a
// planet there is no nothing: every pixel counts, as in the error line.
bool has_depth(const Loaded& loaded) {
  return loaded.linear && loaded.image.channels == 4 && loaded.scene && !loaded.scene->planet;
}

HdrImage light_of(const Loaded& loaded) {
  HdrImage out{loaded.image.width, loaded.image.height, {}, {}};
  const bool depth = has_depth(loaded);
  for (std::size_t p = 0; p < loaded.image.count(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = channel(loaded.image, p, c);
      out.rgb.push_back(loaded.linear ? value : float(srgb_decode(double(value))));
    }
    // Pictures without a channel of optical depth count whole.
    out.optical_depth.push_back(depth ? loaded.image.values[4 * p + 3] : 1.0f);
  }
  return out;
}

HdrImage light_of(const ByteImage& shown) {
  HdrImage out{shown.width, shown.height, {}, std::vector<float>(shown.count(), 1.0f)};
  for (const std::uint8_t value : shown.values)
    out.rgb.push_back(float(srgb_decode(double(value) / 255)));
  return out;
}

ByteImage bytes_of(const Loaded& loaded) {
  ByteImage out(loaded.image.width, loaded.image.height, 3);
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = std::uint8_t(
        std::lround(255 * std::clamp(channel(loaded.image, i / 3, i % 3), 0.0f, 1.0f)));
  return out;
}

ByteImage shown_by(const Display& display, const HdrImage& light) {
  FloatImage radiance(light.width, light.height, 3);
  radiance.values = light.rgb;
  return to_display(radiance, display.exposure_ev, display.tone_map, display.dither, display.white);
}

// What the picture's own scene says; nothing where it has none.
std::optional<Display> display_in(const Loaded& loaded, const char* from) {
  if (!loaded.scene || !loaded.scene->exposure_ev) return {};
  const Scene& scene = *loaded.scene;
  return Display{*scene.exposure_ev, scene.tone_map, display_white(scene), scene.dither, from};
}

void lay_options_over(Display& display, const CompareOptions& options) {
  if (options.exposure_ev)
    display.exposure_ev = number_value("--exposure", *options.exposure_ev, "scene", "exposure_ev");
  if (options.tone_map) display.tone_map = tone_map_value(*options.tone_map);
  if (options.exposure_ev || options.tone_map) display.from += ", and the options";
}

Display display_of_linear(const Loaded& a, const Loaded& b, const HdrImage& truth,
                          const CompareOptions& options) {
  std::optional<Display> display = display_in(b, "B's scene");
  if (!display) display = display_in(a, "A's scene");
  if (!display) {
    display = Display{0, ToneMap::kAces, glm::dvec3(1), false, "found for B"};
    FloatImage radiance(truth.width, truth.height, 3);
    radiance.values = truth.rgb;
    if (!options.exposure_ev) display->exposure_ev = exposure_from(radiance, truth.optical_depth);
  }
  display->dither = false;  // a pattern that hides the difference of smooth pictures
  lay_options_over(*display, options);
  return *display;
}

Display display_of_mixed(const Loaded& shown, const Loaded& linear, const CompareOptions& options) {
  std::optional<Display> display = display_in(shown, "the 8-bit picture's scene");
  if (!display && !(options.exposure_ev && options.tone_map))
    throw Error({"pictures differ in colour meaning", shown.name,
                 "linear light as in " + linear.name + ", or a scene that says how it was shown",
                 "8 bit, without one", "say it with --exposure EV and --tone-map NAME"});
  if (!display) display = Display{};
  lay_options_over(*display, options);
  return *display;
}

std::string other_exposure(const Loaded& a, const Loaded& b) {
  const std::optional<Display> first = display_in(a, ""), second = display_in(b, "");
  if (!first || !second) return "";
  if (first->exposure_ev == second->exposure_ev && first->tone_map == second->tone_map) return "";
  char text[120];
  std::snprintf(text, sizeof text, "A and B were shown differently: %+.2f EV, %s, and %+.2f EV, %s",
                first->exposure_ev, tone_map_name(first->tone_map), second->exposure_ev,
                tone_map_name(second->tone_map));
  return text;
}

}  // namespace

ComparedPair read_pair(const CompareOptions& options, const PictureFiles& pictures) {
  const Loaded a = load(options.a, pictures), b = load(options.b, pictures);
  if (a.image.width != b.image.width || a.image.height != b.image.height)
    throw Error({"pictures differ in size", a.name, size_text(b.image) + " as in " + b.name,
                 size_text(a.image), ""});
  ComparedPair out;
  out.linear = a.linear && b.linear;
  out.has_depth = out.linear && has_depth(b);
  if (!a.linear && !b.linear) {
    for (const auto& [option, value] : {std::pair{"--exposure", &options.exposure_ev},
                                        std::pair{"--tone-map", &options.tone_map}})
      if (*value) throw Error({"nothing to apply it to", option, "a linear picture", "none", ""});
    out.note = other_exposure(a, b);
  } else {
    out.display = out.linear ? display_of_linear(a, b, light_of(b), options)
                  : a.linear ? display_of_mixed(b, a, options)
                             : display_of_mixed(a, b, options);
  }
  out.picture_shown = a.linear ? shown_by(*out.display, light_of(a)) : bytes_of(a);
  out.truth_shown = b.linear ? shown_by(*out.display, light_of(b)) : bytes_of(b);
  const bool mixed = a.linear != b.linear;
  out.picture = mixed ? light_of(out.picture_shown) : light_of(a);
  out.truth = mixed ? light_of(out.truth_shown) : light_of(b);
  return out;
}

}  // namespace nepho
