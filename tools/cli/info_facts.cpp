#include "cli/info_facts.h"

#include <algorithm>
#include <cmath>

#include "common/brick_columns.h"
#include "common/framing.h"
#include "common/open_scene.h"
#include "common/planet_scene.h"
#include "core/error.h"
#include "geo/place.h"
#include "gl/frame_data.h"
#include "scene/utc.h"
#include "tree/forest.h"

namespace nepho {
namespace {

constexpr std::uint64_t kMostValues = 40'000'000;  // that rows for all times may read

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

void put(Json& out, const char* key, double value) {
  if (std::isfinite(value)) out[key] = value;
}

void put(Json& out, const std::string& name, const std::string& unit,
         const DataFacts::Amount& amount) {
  put(out, (name + "_mean" + unit).c_str(), amount.mean);
  put(out, (name + "_max" + unit).c_str(), amount.max);
}

Json columns_json(const DataFacts& facts, bool from_data) {
  Json out{{"from", from_data ? "data" : "bricks"}, {"count", facts.columns}};
  put(out, "area_m2", facts.area_m2);
  put(out, "liquid_path", "_kg_per_m2", facts.liquid_kg_per_m2);
  put(out, "ice_path", "_kg_per_m2", facts.ice_kg_per_m2);
  put(out, "precipitation_path", "_kg_per_m2", facts.precipitation_kg_per_m2);
  if (from_data)
    put(out, "optical_depth_mean", facts.optical_depth.mean);
  else
    put(out, "optical_depth_mean_of_cloudy", facts.optical_depth.mean);
  put(out, "optical_depth_max", facts.optical_depth.max);
  put(out, "cover", facts.cover);
  put(out, "cloud_base_lowest_m", facts.lowest_base_m);
  put(out, "cloud_base_mean_m", facts.mean_base_m);
  put(out, "cloud_top_mean_m", facts.mean_top_m);
  put(out, "cloud_top_highest_m", facts.highest_top_m);
  put(out, "data_bottom_m", facts.data_bottom_m);
  put(out, "data_top_m", facts.data_top_m);
  put(out, "cut_at_top_share", facts.cut_share);
  return out;
}

Json variable_json(const DataVariable& v) {
  Json out{{"name", v.name}, {"meaning", v.meaning}, {"unit", v.unit}};
  put(out, "min", v.low);
  put(out, "max", v.high);
  out["values"] = v.values;
  out["missing"] = v.missing;
  out["negative"] = v.negative;
  return out;
}

bool all_missing(const DataFacts& facts) {
  return !facts.variables.empty() &&
         std::ranges::all_of(facts.variables, [](const auto& v) { return v.missing == v.values; });
}

std::string key_of(std::string what) {
  std::ranges::replace(what, ' ', '_');
  return what;
}

}  // namespace

Json volume_json(const BrickSource& source, const VolumeSpec& volume) {
  const VolumeInfo& info = source.info();
  Json out{{"name", info.name},
           {"source", volume.source},
           {"files", volume.files},
           {"chart", info.chart->kind() == ChartKind::kBox ? "box" : "shell"},
           {"roots", info.chart->roots()},
           {"levels", info.lattice.max_level() + 1},
           {"finest_cells", info.lattice.cells(info.lattice.max_level())},
           {"finest_cell_m", triple(finest_cell_m(info))},
           {"samples", info.finest == SampleKind::kPoint ? "point" : "hat"},
           {"bounds_q", {triple(info.bounds.low), triple(info.bounds.high)}},
           {"co_albedo", triple(info.co_albedo)},
           {"on_planet", info.on_planet},
           {"source_bytes", info.source_bytes}};
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
  if (info.on_planet) out["has_ground"] = info.surface != nullptr;
  out["assumptions"] = info.assumptions;
  out["facts"] = info.facts;
  return out;
}

Json times_json(const VolumeInfo& info, double shown_s) {
  const auto shown = std::ranges::find(info.times_s, shown_s) - info.times_s.begin();
  Json out{{"count", info.times_s.size()}, {"shown_index", shown}, {"shown_s", shown_s}};
  out["times_s"] = info.times_s;
  // A source whose data have no date counts from 1970.
  if (info.time_origin_ns == 0) return out;
  out["shown_utc"] = utc_text(utc_of(info, shown_s));
  out["origin_utc"] = utc_text(info.time_origin_ns);
  for (const double t : info.times_s) out["times_utc"].push_back(utc_text(utc_of(info, t)));
  return out;
}

void add_data(Json& out, const BrickSource& source, double time_s) {
  const VolumeInfo& info = source.info();
  DataFacts facts;
  const Status status = source.data_facts(time_s, facts);
  if (status != Status::kOk && status != Status::kUnsupported) {
    char text[512] = "";
    source.last_error(text, sizeof text);
    throw Error({to_string(status), "volume '" + info.name + "'", "", text, ""});
  }
  const bool from_data = status == Status::kOk;
  if (!from_data) facts = brick_facts(source, time_s);
  out["recognised"] = Json::object();
  for (const auto& [what, text] : facts.recognised) {
    Json& at = out["recognised"][key_of(what)];
    at = at.is_string() ? at.get<std::string>() + "; " + text : text;
  }
  out["variables"] = Json::array();
  for (const DataVariable& v : facts.variables) out["variables"].push_back(variable_json(v));
  out["columns"] = columns_json(facts, from_data);
  out["all_missing"] = all_missing(facts);
  const auto [low, high] = extinction_range(source, time_s);
  out["extinction_per_m"] = {{"min", low}, {"max", high}};
  if (!info.on_planet) return;
  const auto* shell = dynamic_cast<const ShellChart*>(info.chart.get());
  out["cloud"] = coordinates(source, time_s, shell ? shell->body() : Ellipsoid::wgs84());
}

Json states_json(const BrickSource& source, double time_s) {
  const VolumeInfo& info = source.info();
  DataFacts facts;
  if (info.times_s.size() < 2 || source.data_facts(time_s, facts) != Status::kOk) return nullptr;
  std::uint64_t values = 0;
  for (const DataVariable& v : facts.variables) values += v.values;
  if (values * info.times_s.size() > kMostValues) return nullptr;
  Json rows = Json::array();
  for (const double t : info.times_s) {
    if (source.data_facts(t, facts) != Status::kOk) return nullptr;  // told when it is drawn
    Json row{{"index", rows.size()}, {"time_s", t}};
    if (info.time_origin_ns != 0) row["utc"] = utc_text(utc_of(info, t));
    put(row, "optical_depth", "", facts.optical_depth);
    put(row, "cover", facts.cover);
    row["state"] = all_missing(facts) ? "missing" : facts.optical_depth.max > 0 ? "cloud" : "clear";
    rows.push_back(std::move(row));
  }
  return rows;
}

Json check_json(const BrickCheck& check, const DataError& error) {
  return {{"total_optical_depth_difference", check.total_difference},
          {"total_optical_depth_doubt", check.total_doubt},
          {"total_optical_depth_promised", BrickCheck::kTotal},
          {"column_rms_difference", check.column_rms},
          {"column_rms_least", check.column_rms_least},
          {"column_rms_promised", BrickCheck::kColumns},
          {"columns", check.columns},
          {"kept", check.kept()},
          {"rms_per_m", error.rms_per_m},
          {"relative_rms",
           error.field_rms_per_m > 0 ? Json(error.rms_per_m / error.field_rms_per_m) : Json()},
          {"largest_per_m", error.largest_per_m},
          {"field_rms_per_m", error.field_rms_per_m},
          {"points", error.points},
          {"nodes", error.nodes}};
}

Json picture_json(const OpenedScene& opened) {
  const Forest forest = build_forest(opened.request.volumes, gl::refinement_of(opened.request));
  std::size_t nodes = 0, bricks = 0;
  for (const VolumeTree& tree : forest.volumes) {
    nodes += tree.nodes.size();
    bricks += tree.bricks.size();
  }
  const RenderSettings& settings = opened.scene.render;
  return {{"width", settings.width},
          {"height", settings.height},
          {"nodes", nodes},
          {"bricks", bricks},
          {"gpu_bytes", forest.cost_bytes},
          {"budget_bound", forest.budget_bound}};
}

}  // namespace nepho
