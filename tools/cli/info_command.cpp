#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/scene_input.h"
#include "common/data_error.h"
#include "common/framing.h"
#include "common/open_scene.h"
#include "common/planet_scene.h"
#include "core/error.h"
#include "geo/place.h"
#include "scene/scene_file.h"
#include "scene/utc.h"

namespace nepho {
namespace {

using Json = nlohmann::ordered_json;

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

Json triple(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

// Lengths of one finest cell's edges at the middle of the first root.
glm::dvec3 finest_cell_m(const VolumeInfo& info) {
  const Index3& cells = info.lattice.cells(info.lattice.max_level());
  const glm::dvec3 middle = info.chart->ecef_m({0, glm::dvec3(0.5)});
  glm::dvec3 lengths;
  for (int a = 0; a < 3; ++a) {
    glm::dvec3 q(0.5);
    q[a] += 1.0 / cells[std::size_t(a)];
    lengths[a] = glm::length(info.chart->ecef_m({0, q}) - middle);
  }
  return lengths;
}

std::string split_name(SplitMask mask) {
  std::string name;
  for (int a = 0; a < 3; ++a)
    if (splits(mask, a)) name += "xyz"[a];
  return name;
}

// The extremes over the whole volume: those of the roots.
std::pair<float, float> extinction_range(const BrickSource& source, double time_s) {
  float low = 0, high = 0;
  for (int root = 0; root < source.info().chart->roots(); ++root) {
    const NodeSummary summary = summary_of(source, {root, 0, 0u, 0u, 0u}, time_s);
    low = root ? std::min(low, summary.min_extinction_per_m) : summary.min_extinction_per_m;
    high = std::max(high, summary.max_extinction_per_m);
  }
  return {low, high};
}

// Where the clouds of a planet's weather are: the box of their nodes, from summaries alone.
Json coordinates(const BrickSource& source, double time_s, const Ellipsoid& body) {
  double low_lat = 90, high_lat = -90, low_m = 1e300, high_m = -1e300;
  std::vector<double> longitudes;
  for (const glm::dvec3& p : occupied_points(source, time_s)) {
    const GeodeticPoint g = geodetic_point(body, p);
    low_lat = std::min(low_lat, g.latitude_deg);
    high_lat = std::max(high_lat, g.latitude_deg);
    low_m = std::min(low_m, g.height_m);
    high_m = std::max(high_m, g.height_m);
    longitudes.push_back(g.longitude_deg);
  }
  if (longitudes.empty()) return nullptr;
  // The box begins behind the widest gap, which may hold the date line.
  std::ranges::sort(longitudes);
  double gap = 360 - longitudes.back() + longitudes.front(), west = longitudes.front();
  for (std::size_t i = 1; i < longitudes.size(); ++i)
    if (longitudes[i] - longitudes[i - 1] > gap)
      gap = longitudes[i] - longitudes[i - 1], west = longitudes[i];
  return {{"lat_deg", {low_lat, high_lat}},
          {"lon_deg", {west, west + 360 - gap}},
          {"height_m", {low_m, high_m}}};
}

Json check_of(const BrickSource& source, double time_s) {
  const DataError error = data_error(source, time_s);
  return {{"rms_per_m", error.rms_per_m},
          {"relative_rms",
           error.field_rms_per_m > 0 ? Json(error.rms_per_m / error.field_rms_per_m) : Json()},
          {"largest_per_m", error.largest_per_m},
          {"field_rms_per_m", error.field_rms_per_m},
          {"points", error.points},
          {"nodes", error.nodes}};
}

double chosen_time(const BrickSource& source, const VolumeSpec& volume) {
  const VolumeInfo& info = source.info();
  if (volume.utc_ns) return time_at(info, *volume.utc_ns, "volume '" + info.name + "'");
  return volume.time_s ? time_of(volume, info) : first_time_with_cloud(source);
}

Json describe(const BrickSource& source, const VolumeSpec& volume, bool check) {
  const VolumeInfo& info = source.info();
  const Index3& cells = info.lattice.cells(info.lattice.max_level());
  const double time_s = chosen_time(source, volume);
  const auto [low, high] = extinction_range(source, time_s);
  Json out{{"name", info.name},
           {"chart", info.chart->kind() == ChartKind::kBox ? "box" : "shell"},
           {"roots", info.chart->roots()},
           {"levels", info.lattice.max_level() + 1},
           {"finest_cells", cells},
           {"finest_cell_m", triple(finest_cell_m(info))},
           {"samples", info.finest == SampleKind::kPoint ? "point" : "hat"},
           {"bounds_q", {triple(info.bounds.low), triple(info.bounds.high)}},
           {"extinction_per_m", {{"time_s", time_s}, {"min", low}, {"max", high}}},
           {"co_albedo", triple(info.co_albedo)},
           {"time_origin", utc_text(info.time_origin_ns)},
           {"times_s", info.times_s},
           {"source_bytes", info.source_bytes},
           {"files", volume.files},
           {"assumptions", info.assumptions},
           {"facts", info.facts}};
  // A source whose data have no date counts from 1970.
  if (info.time_origin_ns != 0)
    for (const double t : info.times_s) out["times_utc"].push_back(utc_text(utc_of(info, t)));
  out["on_planet"] = info.on_planet;
  if (info.on_planet) {
    const auto* shell = dynamic_cast<const ShellChart*>(info.chart.get());
    const Ellipsoid body = shell ? shell->body() : Ellipsoid::wgs84();
    out["cloud"] = coordinates(source, time_s, body);
    out["has_ground"] = info.surface != nullptr;
  }
  if (check) out["data_error"] = check_of(source, time_s);
  for (int level = 0; level < info.lattice.max_level(); ++level)
    out["split_axes"].push_back(split_name(info.lattice.split_axes(level)));
  for (const ChannelInfo& channel : info.channels)
    out["channels"].push_back({{"name", channel.name},
                               {"unit", channel.unit},
                               {"code_bits", channel.code_bits},
                               {"max_abs_error", channel.max_abs_error}});
  const bool mie = info.phase.kind == PhaseKind::kMie;
  out["phase"] = mie ? Json{{"kind", "mie"}, {"effective_radius_m", info.phase.effective_radius_m}}
                     : Json{{"kind", "henyey_greenstein"}, {"asymmetry", info.phase.asymmetry}};
  return out;
}

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

void print_list(const char* title, const Json& lines) {
  for (const Json& line : lines) std::printf("  %s: %s\n", title, line.get<std::string>().c_str());
}

void print_check(const Json& e) {
  const bool relative = e["relative_rms"].is_number();
  std::printf("  data error: rms %.3g 1/m%s, largest %.3g 1/m (%d points in %d finest nodes)\n",
              e["rms_per_m"].get<double>(),
              relative ? (", " + number_text(100 * e["relative_rms"].get<double>()) +
                          " % of the field's rms")
                             .c_str()
                       : "",
              e["largest_per_m"].get<double>(), e["points"].get<int>(), e["nodes"].get<int>());
}

void print_times(const Json& times) {
  constexpr std::size_t kMost = 12;
  std::printf("  valid");
  for (std::size_t i = 0; i < std::min(times.size(), kMost); ++i)
    std::printf("%s %s", i ? "," : "", times[i].get<std::string>().c_str());
  if (times.size() > kMost) std::printf(", ... %s", times.back().get<std::string>().c_str());
  std::printf("\n");
}

void print_volume(const Json& v) {
  const auto cells = v["finest_cells"], size = v["finest_cell_m"];
  std::printf("%s\n", v["name"].get<std::string>().c_str());
  std::printf("  %s, %d root(s), %d levels, %u x %u x %u cells of %.6g x %.6g x %.6g m\n",
              v["chart"].get<std::string>().c_str(), v["roots"].get<int>(), v["levels"].get<int>(),
              cells[0].get<unsigned>(), cells[1].get<unsigned>(), cells[2].get<unsigned>(),
              size[0].get<double>(), size[1].get<double>(), size[2].get<double>());
  std::printf(
      "  extinction %.6g to %.6g 1/m (at %.6g s)\n", v["extinction_per_m"]["min"].get<double>(),
      v["extinction_per_m"]["max"].get<double>(), v["extinction_per_m"]["time_s"].get<double>());
  for (const Json& channel : v["channels"])
    std::printf("  channel %s [%s], %d bit, error to %.3g\n",
                channel["name"].get<std::string>().c_str(),
                channel["unit"].get<std::string>().c_str(), channel["code_bits"].get<int>(),
                channel["max_abs_error"].get<double>());
  std::printf("  phase %s; samples: %s\n", v["phase"]["kind"].get<std::string>().c_str(),
              v["samples"].get<std::string>().c_str());
  if (v["on_planet"].get<bool>() && v["cloud"].is_object()) {
    const Json &lat = v["cloud"]["lat_deg"], &lon = v["cloud"]["lon_deg"],
               &height = v["cloud"]["height_m"];
    std::printf("  cloud within %.4g to %.4g N, %.4g to %.4g E, %.0f to %.0f m\n",
                lat[0].get<double>(), lat[1].get<double>(), lon[0].get<double>(),
                lon[1].get<double>(), height[0].get<double>(), height[1].get<double>());
  }
  if (v.contains("data_error")) print_check(v["data_error"]);
  if (v.contains("times_utc")) print_times(v["times_utc"]);
  std::printf("  %zu time(s), from %s; source holds %.2f MiB\n", v["times_s"].size(),
              v["time_origin"].get<std::string>().c_str(),
              v["source_bytes"].get<double>() / (1 << 20));
  print_list("fact", v["facts"]);
  print_list("assumed", v["assumptions"]);
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
  set_force(scene, options.force);
  set_region(scene, options.region);
  return scene;
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
    for (const VolumeSpec& volume : scene.volumes)
      out["volumes"].push_back(describe(*open_volume(host, volume), volume, options.check));
  }
  if (options.json) {
    std::printf("%s\n", out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return;
  }
  if (out.contains("volumes"))
    for (const Json& volume : out["volumes"]) print_volume(volume);
  if (out.contains("metadata"))
    for (const auto& [key, value] : out["metadata"].items())
      std::printf("%s: %s\n", key.c_str(), text_of(value).c_str());
}

}  // namespace nepho
