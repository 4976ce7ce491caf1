#include <algorithm>
#include <cstdio>

#include "cli/commands.h"
#include "cli/info_facts.h"
#include "cli/scene_input.h"
#include "common/open_scene.h"
#include "common/planet_scene.h"
#include "core/error.h"
#include "scene/scene_file.h"

namespace nepho {
namespace {

// A scene that is no JSON is shown as it stands: `render` says what is wrong with it.
Json metadata_value(const std::string& key, const std::string& value) {
  if (key != "nephoscope:scene") return value;
  Json scene = Json::parse(value, nullptr, false);
  return scene.is_discarded() ? Json(value) : scene;
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>()
                           : value.dump(2, ' ', false, Json::error_handler_t::replace);
}

Scene scene_of(const InfoOptions& options, const PictureFiles& pictures) {
  const InputKind kind = input_kind(options.input);
  if (kind == InputKind::kScene) return read_scene_file(options.input);
  if (kind == InputKind::kPicture) return scene_in_picture(options.input, pictures);
  Scene scene;
  scene.volumes.push_back(data_volume(options.input));
  set_parameter(scene, "grid", "--grid", options.grid);
  set_parameter(scene, "names", "--names", options.names);
  set_parameter(scene, "up", "--up", options.up);
  set_parameter(scene, "metres_per_unit", "--metres-per-unit", options.metres_per_unit);
  set_parameter(scene, "density_scale", "--density-scale", options.density_scale);
  set_parameter(scene, "frame", "--frame", options.frame);
  set_raster(scene, options.raster);
  set_force(scene, options.force);
  set_region(scene, options.region);
  return scene;
}

// A volume and the time that is told of it: a picture's, where one can be drawn.
struct Shown {
  const BrickSource* source = nullptr;
  double time_s = 0;
};

std::string why_shown(const VolumeSpec& volume, bool of_picture) {
  if (volume.utc_ns || volume.time_s || !volume.time_choice.empty()) return "as asked for";
  return of_picture ? "the first with cloud, by day where there is one" : "the first with cloud";
}

Json describe(const Shown& shown, const VolumeSpec& volume, bool of_picture, bool check) {
  const BrickSource& source = *shown.source;
  Json out = volume_json(source, volume);
  out["time"] = times_json(source.info(), shown.time_s);
  out["time"]["shown_because"] = why_shown(volume, of_picture);
  add_data(out, source, shown.time_s);
  if (Json rows = states_json(source, shown.time_s); rows.is_array()) out["states"] = rows;
  if (check)
    out["check"] = check_json(check_bricks(source, shown.time_s), data_error(source, shown.time_s));
  return out;
}

// As `render` opens it, so that times and bricks are those of its picture. What cannot be drawn (an
// eye below the ground) is told all the same, without a picture.
Json volumes_and_picture(const SourceHost& host, const Scene& scene, bool check) {
  Json out;
  std::optional<OpenedScene> opened;
  std::vector<std::unique_ptr<BrickSource>> sources;
  try {
    opened = open_scene(host, scene);
  } catch (const Error& error) {
    for (const VolumeSpec& volume : scene.volumes) sources.push_back(open_volume(host, volume));
    out["no_picture"] = error.what();
  }
  for (std::size_t v = 0; v < scene.volumes.size(); ++v) {
    Shown shown{opened ? opened->sources[v].get() : sources[v].get()};
    const auto named_s = opened ? std::nullopt : named_time(scene.volumes[v], *shown.source);
    shown.time_s = opened    ? opened->request.volumes[v].time_s
                   : named_s ? *named_s
                             : first_time_with_cloud(*shown.source);
    out["volumes"].push_back(describe(shown, scene.volumes[v], opened.has_value(), check));
  }
  // Procedural clouds are worked out as they are read: the tree would take as long as the picture.
  const bool procedural = opened && std::ranges::any_of(opened->sources, [](const auto& source) {
                            return source->info().refine_by_variance;
                          });
  if (procedural) out["no_picture"] = "procedural clouds are worked out as they are drawn";
  if (opened && !procedural) out["picture"] = picture_json(*opened);
  return out;
}

// After all has been told, as one error: the exit status is for programs that check.
void refuse_broken_promises(const Json& out) {
  std::fflush(stdout);
  for (const Json& volume : out["volumes"]) {
    if (volume["check"]["kept"].get<bool>()) continue;
    const auto percent = [&](const char* key) {
      char text[32];
      std::snprintf(text, sizeof text, "%.3g %%", 100 * volume["check"][key].get<double>());
      return std::string(text);
    };
    throw Error(
        {"the bricks are not what the source holds",
         "volume '" + volume["name"].get<std::string>() + "'",
         "total optical depth within " + percent("total_optical_depth_promised") +
             ", columns within " + percent("column_rms_promised") + " rms",
         percent("total_optical_depth_difference") + " and " + percent("column_rms_difference"),
         "finer bricks hold more: max_level, or a finer resolution of the volume"});
  }
}

}  // namespace

void info_command(const InfoOptions& options) {
  const PictureFiles pictures(default_module_folders());
  Json out;
  if (is_picture_name(options.input)) {
    input_kind(options.input);  // says so where there is no such file
    for (const auto& [key, value] : pictures.read_metadata(options.input))
      out["metadata"][key] = metadata_value(key, value);
  } else {
    const SourceHost host(default_module_folders());
    Scene scene = scene_of(options, pictures);
    set_time(scene, options.time);
    out = volumes_and_picture(host, scene, options.check);
  }
  if (options.json) {
    std::printf("%s\n", out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    if (out.contains("volumes"))
      for (const Json& volume : out["volumes"]) print_volume(volume);
    if (out.contains("picture")) print_picture(out["picture"]);
    if (out.contains("no_picture"))
      std::printf("no picture: %s\n", out["no_picture"].get<std::string>().c_str());
    if (out.contains("metadata"))
      for (const auto& [key, value] : out["metadata"].items())
        std::printf("%s: %s\n", key.c_str(), text_of(value).c_str());
  }
  if (options.check && out.contains("volumes")) refuse_broken_promises(out);
}

}  // namespace nepho
