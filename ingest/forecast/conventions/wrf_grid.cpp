#include "forecast/conventions/wrf_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/conventions/line_grid.h"

namespace nepho::forecast {
namespace {

constexpr double kSphere_m = 6370000;  // WRF's own (share/module_model_constants.F)
constexpr double kMapAgreement_deg = 1e-3;

// MAP_PROJ of runs without a place.
constexpr int kIdealised = 0;

bool is_one_place(const std::vector<double>& latitude, const std::vector<double>& longitude) {
  const auto same = [](const std::vector<double>& values) {
    return std::ranges::all_of(values, [&](double value) { return value == values.front(); });
  };
  return same(latitude) && same(longitude);
}

std::optional<MapProjection> projection_of(const DataFile& file) {
  const auto kind = file.number("MAP_PROJ"), lat1 = file.number("TRUELAT1");
  const auto lon = file.number("STAND_LON");
  if (!kind || !lat1 || !lon) return {};
  MapSpec spec;
  spec.equatorial_m = spec.polar_m = kSphere_m;
  spec.true_latitude1_deg = *lat1;
  spec.true_latitude2_deg = file.number("TRUELAT2").value_or(*lat1);
  spec.central_longitude_deg = *lon;
  if (*kind == 1) {
    // A second true latitude out of range stands for a tangent cone.
    if (!(std::abs(spec.true_latitude2_deg) < 90)) spec.true_latitude2_deg = *lat1;
    spec.kind = MapKind::kLambertConformal;
  } else if (*kind == 2) {
    spec.kind = MapKind::kPolarStereographic;
  } else if (*kind == 3) {
    spec.kind = MapKind::kMercator;
  } else {
    return {};  // 0: idealised, without a place; 6: latitudes and longitudes, maybe rotated
  }
  try {
    return MapProjection(spec);
  } catch (const Error&) {
    return {};
  }
}

// Centres of cells on a map, in steps about its middle.
std::vector<double> steps(int count, double step_m, double middle_m) {
  std::vector<double> centres;
  for (int n = 0; n < count; ++n) centres.push_back(middle_m + step_m * (n + 0.5 - 0.5 * count));
  return centres;
}

// One row, column or cell of a domain: on its map from the first place on, as CEN_LAT is the whole
// domain's. None: no such file, or without a map.
std::optional<WrfGrid> line_of_cells(const FieldReader& whole, const std::vector<double>& lat,
                                     const std::vector<double>& lon) {
  const auto dx = whole.file->number("DX"), dy = whole.file->number("DY");
  const auto map = projection_of(*whole.file);
  if ((whole.nx > 1 && whole.ny > 1) || !map || !dx || !dy || !(*dx > 0 && *dy > 0)) return {};
  const glm::dvec2 first = map->map_m({lat.front(), lon.front()});
  const auto axis = [](int count, double step, double from) {
    std::vector<double> edges;
    for (int n = 0; n <= count; ++n) edges.push_back(from + step * (n - 0.5));
    return edges;
  };
  return WrfGrid{map_edges_grid(axis(whole.nx, *dx, first.x), axis(whole.ny, *dy, first.y), *map)};
}

}  // namespace

WrfGrid wrf_grid(const FieldReader& whole, std::size_t time) {
  const DataFile& file = *whole.file;
  const FileVariable *latitude = file.find("XLAT"), *longitude = file.find("XLONG");
  if (latitude && longitude) {
    const auto doubles = [&](const FileVariable& variable) {
      const std::vector<float> values = whole.surface(variable, time);
      return std::vector<double>(values.begin(), values.end());
    };
    const std::vector<double> lat = doubles(*latitude), lon = doubles(*longitude);
    if (const auto row = line_of_cells(whole, lat, lon)) return *row;
    const std::string where = file.path() + " [XLAT, XLONG]";
    if (!is_one_place(lat, lon) && (whole.nx == 1 || whole.ny == 1)) {
      WrfGrid row;
      row.cells = line_grid(whole.nx, whole.ny, lat, lon, where, row.assumptions);
      return row;
    }
    if (!is_one_place(lat, lon)) return {points_grid(whole.nx, whole.ny, lat, lon, where)};
  }
  const auto map = projection_of(file);
  const auto lat = file.number("CEN_LAT"), lon = file.number("CEN_LON");
  const auto dx = file.number("DX"), dy = file.number("DY");
  const bool has_size = dx && dy && *dx > 0 && *dy > 0;
  if (map && lat && lon && has_size) {
    const glm::dvec2 centre = map->map_m({*lat, *lon});
    return {map_grid(steps(whole.nx, *dx, centre.x), steps(whole.ny, *dy, centre.y), *map)};
  }
  if (has_size && file.number("MAP_PROJ") == kIdealised)
    return {plane_grid(steps(whole.nx, *dx, 0), steps(whole.ny, *dy, 0)), false};
  throw Error({"the WRF file does not say where its cells lie", file.path(),
               "XLAT and XLONG, or MAP_PROJ with its attributes", "neither", ""});
}

std::string compare_with_map(const DataFile& file, const HorizontalGrid& grid) {
  const auto map = projection_of(file);
  const auto dx = file.number("DX"), dy = file.number("DY");
  if (!map || !dx || !dy || !file.find("XLAT")) return "";
  const glm::dvec2 first = map->map_m(grid.lat_lon_deg(0.5, 0.5));
  double worst = 0;
  for (int j = 0; j < grid.ny(); ++j)
    for (int i = 0; i < grid.nx(); ++i) {
      const glm::dvec2 here = grid.lat_lon_deg(i + 0.5, j + 0.5);
      const glm::dvec2 ours = map->lat_lon_deg(first + glm::dvec2(i * *dx, j * *dy));
      const double turn = std::remainder(here.y - ours.y, 360.0);
      worst = std::max({worst, std::abs(here.x - ours.x),
                        std::abs(turn) * std::cos(here.x * 0.017453292519943295)});
    }
  char text[200];
  std::snprintf(text, sizeof text, "XLAT and XLONG %s the map of the attributes: %.1e deg.",
                worst <= kMapAgreement_deg ? "agree with" : "DIFFER from", worst);
  return text;
}

}  // namespace nepho::forecast
