#include "forecast/conventions/unstructured.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "forecast/conventions/cell_bounds.h"
#include "forecast/conventions/names.h"
#include "forecast/conventions/vertical.h"
#include "forecast/conventions/voronoi.h"
#include "geo/place.h"

namespace nepho::forecast {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLargestRadian = 6.3;  // values beyond are degrees

class PolygonGrid : public HorizontalGrid {
 public:
  PolygonGrid(std::vector<glm::dvec2> centre_deg, CellPolygons polygons)
      : centre_deg_(std::move(centre_deg)), polygons_(std::move(polygons)) {}
  int nx() const override { return int(centre_deg_.size()); }
  int ny() const override { return 1; }
  bool around() const override { return false; }
  glm::dvec2 lat_lon_deg(double x, double) const override {
    return centre_deg_[std::size_t(std::clamp(x, 0.0, double(nx()) - 1))];
  }
  const CellPolygons* polygons() const override { return &polygons_; }

 private:
  std::vector<glm::dvec2> centre_deg_;
  CellPolygons polygons_;
};

// Degrees; without a unit that says so, angles that fit into radians are radians, as MPAS has them.
std::vector<double> degrees(const DataFile& file, const FileVariable& variable) {
  std::vector<double> values = file.read_all(variable);
  const UnitOf unit = unit_of(variable, kAngle);
  double largest = 0;
  for (const double value : values)
    if (std::abs(value) > largest) largest = std::abs(value);
  const double factor = unit.fits                  ? unit.factor / kDegree
                        : largest < kLargestRadian ? 1 / kDegree
                                                   : 1;
  for (double& value : values) value *= factor;
  return values;
}

std::vector<glm::dvec2> paired(const std::vector<double>& lat, const std::vector<double>& lon) {
  std::vector<glm::dvec2> places(std::min(lat.size(), lon.size()));
  for (std::size_t n = 0; n < places.size(); ++n) places[n] = {lat[n], lon[n]};
  return places;
}

// Latitudes and longitudes along a dimension.
struct Centres {
  const FileVariable *latitude = nullptr, *longitude = nullptr;
  explicit operator bool() const { return latitude && longitude; }
};

Centres centres_along(const DataFile& file, std::size_t size) {
  const auto along = [&](const FileVariable& v) {
    return v.numeric && v.dimensions.size() == 1 && file.size(v.dimensions[0]) == size;
  };
  static const std::vector<std::string> kLat = {"clat", "latCell", "lat", "latitude", "lat_cell"};
  static const std::vector<std::string> kLon = {"clon", "lonCell", "lon", "longitude", "lon_cell"};
  Centres centres{find_named(file, kLat, along), find_named(file, kLon, along)};
  if (!centres)
    centres = {find_named(file, names::kLatitude, along),
               find_named(file, names::kLongitude, along)};
  return centres;
}

// Corners [cell][vertex], repeated or missing ones at the end left out.
CellPolygons polygons_of(const std::vector<double>& lat, const std::vector<double>& lon,
                         std::size_t cells) {
  CellPolygons polygons;
  polygons.first.push_back(0);
  const std::size_t most = lat.size() / cells;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::size_t begin = polygons.corner_deg.size();
    for (std::size_t at = cell * most; at < (cell + 1) * most; ++at) {
      const glm::dvec2 corner = {lat[at], lon[at]};
      if (std::isnan(corner.x + corner.y)) continue;
      if (polygons.corner_deg.size() > begin && polygons.corner_deg.back() == corner) continue;
      polygons.corner_deg.push_back(corner);
    }
    while (polygons.corner_deg.size() > begin + 1 &&
           polygons.corner_deg.back() == polygons.corner_deg[begin])
      polygons.corner_deg.pop_back();
    polygons.first.push_back(std::uint32_t(polygons.corner_deg.size()));
  }
  return polygons;
}

std::optional<CellPolygons> by_bounds(const DataFile& file, const Centres& centres) {
  const auto corners = [&](const FileVariable& of) -> const FileVariable* {
    for (const std::string& name :
         {of.text("bounds"), of.name + "_vertices", of.name + "_bnds", of.name + "_v"})
      if (const FileVariable* v = file.find(name); v && v->numeric && v->dimensions.size() == 2 &&
                                                   v->dimensions[0] == of.dimensions[0] &&
                                                   file.size(v->dimensions[1]) >= 3)
        return v;
    return nullptr;
  };
  const FileVariable *lat = corners(*centres.latitude), *lon = corners(*centres.longitude);
  if (!lat || !lon || file.values_in(*lat) != file.values_in(*lon)) return {};
  return polygons_of(degrees(file, *lat), degrees(file, *lon),
                     file.size(centres.latitude->dimensions[0]));
}

// Vertices by their numbers: MPAS, or a mesh topology of UGRID 1.0.
std::optional<CellPolygons> by_numbers(const DataFile& file, std::size_t cells) {
  const FileVariable *numbers = nullptr, *lat = nullptr, *lon = nullptr, *counts = nullptr;
  double start = 1;
  for (const FileVariable& mesh : file.variables()) {
    if (mesh.text("cf_role") != "mesh_topology") continue;
    numbers = file.find(mesh.text("face_node_connectivity"));
    std::istringstream names(mesh.text("node_coordinates"));
    for (std::string name; names >> name;)
      if (const FileVariable* v = file.find(name))
        (v->text("standard_name") == "latitude" || v->text("units").starts_with("degrees_n")
             ? lat
             : lon) = v;
    start = numbers ? numbers->number("start_index").value_or(0) : 0;
  }
  if (!numbers) {
    numbers = file.find("verticesOnCell");
    counts = file.find("nEdgesOnCell");
    lat = file.find("latVertex");
    lon = file.find("lonVertex");
  }
  if (!numbers || !lat || !lon || numbers->dimensions.size() != 2) return {};
  const bool cells_first = file.size(numbers->dimensions[0]) == cells;
  const std::size_t most = file.size(numbers->dimensions[cells_first ? 1 : 0]);
  if (most < 3 || file.values_in(*numbers) != most * cells) return {};
  const std::vector<double> number = file.read_all(*numbers), y = degrees(file, *lat),
                            x = degrees(file, *lon);
  const std::vector<double> count = counts ? file.read_all(*counts) : std::vector<double>{};
  std::vector<double> corner_y(number.size(), NAN), corner_x(number.size(), NAN);
  for (std::size_t cell = 0; cell < cells; ++cell)
    for (std::size_t v = 0; v < most; ++v) {
      const double at = number[cells_first ? cell * most + v : v * cells + cell] - start;
      const bool used = count.empty() || double(v) < count[cell];
      if (!used || !(at >= 0 && at < double(std::min(x.size(), y.size())))) continue;
      corner_y[cell * most + v] = y[std::size_t(at)];
      corner_x[cell * most + v] = x[std::size_t(at)];
    }
  return polygons_of(corner_y, corner_x, cells);
}

// The middle of each cell's corners.
std::vector<glm::dvec2> middles(const CellPolygons& polygons) {
  std::vector<glm::dvec2> centres;
  for (std::size_t cell = 0; cell + 1 < polygons.first.size(); ++cell) {
    glm::dvec3 sum(0.0);
    for (std::uint32_t at = polygons.first[cell]; at < polygons.first[cell + 1]; ++at)
      sum += unit_vector(polygons.corner_deg[at]);
    centres.push_back(lat_lon_deg_of(sum));
  }
  return centres;
}

// Stations, soundings and ways of aircraft (CF 1.11, chapter 9) are no cells, whatever is half way
// between them.
void refuse_points(const DataFile& file, const FileVariable& water, bool by_grid_file) {
#ifndef NEPHO_MUTANT_POINTS
  std::string kind = file.text("featureType");
  if (kind.empty()) kind = file.text("cdm_data_type");
  if (kind.empty() || kind == "Grid" || kind == "grid") return;
  throw Error({"the data are unconnected points", file.where(water), "cells of a grid",
               "featureType \"" + kind + "\"",
               by_grid_file
                   ? "a grid file with the corners of the cells (clat_vertices, "
                     "verticesOnCell, or a mesh_topology)"
                   : "--grid FILE with the corners of the cells, or interpolate the points "
                     "to a grid first"});
#endif
}

void check_polygons(const CellPolygons& polygons, const std::string& where) {
  std::size_t bad = 0;
  for (std::size_t cell = 0; cell + 1 < polygons.first.size(); ++cell)
    bad += polygons.first[cell + 1] - polygons.first[cell] < 3;
  for (const glm::dvec2& corner : polygons.corner_deg) bad += !(std::abs(corner.x) <= 90.001);
  if (bad > 0)
    throw Error({"the corners of the cells are not usable", where,
                 "three or more corners a cell, latitudes from -90 to 90 degrees",
                 std::to_string(bad) + " that are not", ""});
}

}  // namespace

std::unique_ptr<HorizontalGrid> unstructured_grid(const DataFile& file, const DataFile* grid_file,
                                                  const FileVariable& water, int dimension,
                                                  std::vector<std::string>& assumptions,
                                                  std::string& how) {
  const std::size_t cells = file.size(dimension);
  for (const DataFile* from : {grid_file, &file}) {
    if (!from) continue;
    const Centres centres = centres_along(*from, cells);
    std::optional<CellPolygons> polygons;
    if (centres) polygons = by_bounds(*from, centres);
    if (!polygons) polygons = by_numbers(*from, cells);
    if (!centres && !polygons) continue;
    std::vector<glm::dvec2> places =
        centres ? paired(degrees(*from, *centres.latitude), degrees(*from, *centres.longitude))
                : middles(*polygons);
    if (!polygons) refuse_points(file, water, from == grid_file);
    if (!polygons) {
      assumptions.push_back("The cells have no corners: each ends half way to its neighbours (" +
                            centres.latitude->name + ", " + centres.longitude->name + ").");
      polygons = voronoi_cells(places);
    }
    check_polygons(*polygons, from->path());
    how = "cells in a row";
    if (centres) how += ", " + centres.latitude->name + ", " + centres.longitude->name;
    if (from == grid_file) how += " of " + from->path();
    return std::make_unique<PolygonGrid>(std::move(places), std::move(*polygons));
  }
  const std::string size = std::to_string(cells) + " cells";
  throw Error({"the cells of the grid have no place", file.where(water),
               "centres along " + file.name(dimension) +
                   " (clat and clon, latCell and lonCell, or a mesh_topology), in the file or in "
                   "the one that --grid names",
               grid_file ? "a grid file without centres of " + size : size + " without centres",
               "--grid FILE with the model's own grid file, or interpolate the data, for example "
               "with cdo remapcon,r720x360"});
}

std::unique_ptr<HorizontalGrid> some_polygons(const HorizontalGrid& grid, int first,
                                              const std::vector<char>& inside) {
  const CellPolygons& all = *grid.polygons();
  std::vector<glm::dvec2> centres;
  CellPolygons some;
  some.first.push_back(0);
  for (std::size_t n = 0; n < inside.size(); ++n) {
    const std::size_t cell = std::size_t(first) + n;
    centres.push_back(grid.lat_lon_deg(double(cell) + 0.5, 0.5));
    for (std::uint32_t at = all.first[cell]; inside[n] && at < all.first[cell + 1]; ++at)
      some.corner_deg.push_back(all.corner_deg[at]);
    some.first.push_back(std::uint32_t(some.corner_deg.size()));
  }
  return std::make_unique<PolygonGrid>(std::move(centres), std::move(some));
}

}  // namespace nepho::forecast
