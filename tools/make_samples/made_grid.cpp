#include "made_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "lambert.h"
#include "made_cells.h"
#include "made_maps.h"

namespace nepho::samples {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::size_t kNx = 24, kNy = 20, kI = 6, kJ = 13;  // cells, and the cloud's middle one
constexpr double kSphere_m = 6371000;

std::vector<double> steps(double first, double step, std::size_t count) {
  std::vector<double> all;
  for (std::size_t n = 0; n < count; ++n) all.push_back(first + step * double(n));
  return all;
}

// Rows and columns whose places a function gives; the cloud fills 3 x 3 cells.
MadeGrid of_rows(const std::string& name, std::vector<std::string> axes,
                 std::function<glm::dvec2(double, double)> place, std::size_t nx = kNx,
                 std::size_t ny = kNy) {
  MadeGrid grid;
  grid.name = name;
  grid.axes = std::move(axes);
  grid.nx = nx, grid.ny = ny;
  grid.place = std::move(place);
  for (std::size_t j = kJ - 1; j <= kJ + 1; ++j)
    for (std::size_t i = kI - 1; i <= kI + 1; ++i) grid.cloudy.push_back(j * nx + i);
  grid.cell = [place = grid.place, nx](std::size_t n) {
    const double x = double(n % nx), y = double(n / nx);
    MadeCell cell{place(x + 0.5, y + 0.5), {}};
    constexpr int kSide = 8;
    constexpr std::array<glm::dvec2, 5> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
    for (std::size_t side = 0; side < 4; ++side)
      for (int part = 0; part < kSide; ++part) {
        const glm::dvec2 at = glm::mix(kCorner[side], kCorner[side + 1], double(part) / kSide);
        cell.outline_deg.push_back(place(x + at.x, y + at.y));
      }
    return cell;
  };
  return grid;
}

void add_axis(TinyFile& file, const char* name, std::vector<double> values,
              std::vector<NcNote> notes) {
  file.layout.axes.push_back({name, values.size()});
  file.add({name, NcValue::kDouble, {name}, std::move(notes)}, std::move(values));
}

// A map: cell (x, y) is at first + step * (x + 0.5) of it, in `unit`s of `to_unit` m or rad.
struct MapAxes {
  glm::dvec2 first, step;
  const char* unit = "m";
  double to_unit = 1;
  const char *x = "x", *y = "y", *x_standard = "projection_x_coordinate",
             *y_standard = "projection_y_coordinate";
};

MadeGrid of_map(const std::string& name, const MapAxes& axes, std::vector<NcNote> mapping,
                const std::function<glm::dvec2(glm::dvec2)>& inverse) {
  MadeGrid grid = of_rows(name, {axes.y, axes.x}, [=](double x, double y) {
    return inverse(axes.first + axes.step * glm::dvec2(x, y));
  });
  grid.notes = {text_note("grid_mapping", "crs")};
  grid.write = [=](TinyFile& file) {
    const auto centres = [&](int a, std::size_t n) {
      return steps((axes.first[a] + 0.5 * axes.step[a]) / axes.to_unit, axes.step[a] / axes.to_unit,
                   n);
    };
    add_axis(file, axes.y, centres(1, kNy),
             {text_note("standard_name", axes.y_standard), text_note("units", axes.unit)});
    add_axis(file, axes.x, centres(0, kNx),
             {text_note("standard_name", axes.x_standard), text_note("units", axes.unit)});
    file.add({"crs", NcValue::kInt, {}, mapping}, {0});
  };
  return grid;
}

// About `lower`, the corner of the grid, in steps of 20 km.
MapAxes in_metres(glm::dvec2 lower, double step_m = 20e3) {
  return {lower, glm::dvec2(step_m)};
}

MadeGrid of_axes(const std::string& name, std::vector<double> lat_edge, double west_deg,
                 double step_deg, std::size_t columns, double written_turn_deg) {
  const std::size_t rows = lat_edge.size() - 1;
  MadeGrid grid = of_rows(
      name, {"lat", "lon"},
      [=](double x, double y) {
        const auto row = std::size_t(std::clamp(std::floor(y), 0.0, double(rows) - 1));
        return glm::dvec2(lat_edge[row] + (lat_edge[row + 1] - lat_edge[row]) * (y - double(row)),
                          west_deg + step_deg * x);
      },
      columns, rows);
  grid.write = [=](TinyFile& file) {
    std::vector<double> lat, lon = steps(west_deg + step_deg / 2, step_deg, columns);
    for (std::size_t j = 0; j < rows; ++j) lat.push_back((lat_edge[j] + lat_edge[j + 1]) / 2);
    for (double& value : lon)
      if (value < written_turn_deg) value += 360;
    for (double& value : lon)
      if (value >= written_turn_deg + 360) value -= 360;
    add_axis(file, "lat", lat, {text_note("units", "degrees_north")});
    add_axis(file, "lon", lon, {text_note("units", "degrees_east")});
  };
  return grid;
}

// Latitudes of Gauss-Legendre nodes; rows end half way. Legendre's polynomials by recurrence.
MadeGrid gaussian() {
  constexpr int kRows = 64;
  std::vector<double> node;
  for (int k = 0; k < kRows; ++k) {
    double x = -std::cos(180 * kDegree * (k + 0.75) / (kRows + 0.5));
    for (int turn = 0; turn < 30; ++turn) {
      double p0 = 1, p1 = x;
      for (int n = 2; n <= kRows; ++n) {
        const double p2 = ((2 * n - 1) * x * p1 - (n - 1) * p0) / n;
        p0 = p1, p1 = p2;
      }
      x -= p1 * (x * x - 1) / (kRows * (x * p1 - p0));
    }
    node.push_back(std::asin(x) / kDegree);
  }
  std::vector<double> edge = {-90};
  for (int k = 1; k < kRows; ++k)
    edge.push_back((node[std::size_t(k) - 1] + node[std::size_t(k)]) / 2);
  edge.push_back(90);
  MadeGrid grid = of_axes("gaussian", edge, -1.40625, 2.8125, 128, 0);
  const auto write = grid.write;
  grid.write = [=](TinyFile& file) {
    write(file);
    file.values.at("lat") = node;  // no middles of their rows
  };
  return grid;
}

// Fields of latitude and longitude of any grid, in place of its axes; corners on demand.
MadeGrid of_fields(const std::string& name, const std::function<glm::dvec2(double, double)>& place,
                   bool corners) {
  MadeGrid grid = of_rows(name, {"nj", "ni"}, place);
  grid.notes = {text_note("coordinates", "lat lon")};
  grid.write = [=](TinyFile& file) {
    file.layout.axes.insert(file.layout.axes.end(), {{"nj", kNy}, {"ni", kNx}, {"nv", 4}});
    std::vector<double> centre[2], corner[2];
    for (std::size_t j = 0; j < kNy; ++j)
      for (std::size_t i = 0; i < kNx; ++i)
        for (int a = 0; a < 2; ++a) {
          const double x = double(i), y = double(j);
          centre[a].push_back(place(x + 0.5, y + 0.5)[a]);
          for (const glm::dvec2& v :
               {glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1), glm::dvec2(0, 0)})
            corner[a].push_back(place(x + v.x, y + v.y)[a]);
        }
    const char* const names[2] = {"lat", "lon"};
    const char* const units[2] = {"degrees_north", "degrees_east"};
    for (int a = 0; a < 2; ++a) {
      const std::string bounds = std::string(names[a]) + "_bnds";
      std::vector<NcNote> notes = {text_note("units", units[a])};
      if (corners) notes.push_back(text_note("bounds", bounds));
      file.add({names[a], NcValue::kDouble, {"nj", "ni"}, notes}, centre[a]);
      if (corners) file.add({bounds, NcValue::kDouble, {"nj", "ni", "nv"}, {}}, corner[a]);
    }
  };
  return grid;
}

std::vector<NcNote> on_sphere(const char* name, std::vector<NcNote> more) {
  more.insert(more.begin(),
              {text_note("grid_mapping_name", name), real_note("earth_radius", {kSphere_m})});
  return more;
}

MadeGrid lambert(const std::string& name, double parallel1, double parallel2) {
  const Lambert map(parallel1, parallel2, 39, -97);
  std::vector<double> parallels = {parallel1};
  if (parallel2 != parallel1) parallels.push_back(parallel2);
  MapAxes axes = in_metres({-700e3, 300e3});
  axes.unit = "km", axes.to_unit = 1000;
  return of_map(
      name, axes,
      {text_note("grid_mapping_name", "lambert_conformal_conic"),
       real_note("earth_radius", {Lambert::kSphere_m}), real_note("standard_parallel", parallels),
       real_note("latitude_of_projection_origin", {39}),
       real_note("longitude_of_central_meridian", {-97})},
      [=](glm::dvec2 m) { return map.lat_lon_deg(m.x, m.y); });
}

MadeGrid geostationary(const std::string& name, bool sweep_x) {
  constexpr double kHeight_m = 35786023;
  MapAxes axes{{0.1402, 0.012}, glm::dvec2(560e-6)};
  axes.unit = sweep_x ? "rad" : "microradian", axes.to_unit = sweep_x ? 1 : 1e-6;
  if (!sweep_x) axes.first = {-0.03, 0.09};
  return of_map(
      name, axes,
      {text_note("grid_mapping_name", "geostationary"),
       real_note("perspective_point_height", {kHeight_m}), real_note("semi_major_axis", {6378137}),
       real_note("semi_minor_axis", {6356752.31414}),
       real_note("longitude_of_projection_origin", {-75}),
       text_note("sweep_angle_axis", sweep_x ? "x" : "y")},
      [=](glm::dvec2 angle) { return from_view(-75, kHeight_m, sweep_x, angle); });
}

constexpr const char* kWkt =
    "PROJCRS[\"ours\",BASEGEOGCRS[\"sphere\",DATUM[\"sphere\",ELLIPSOID[\"sphere\",6371000,0]]],"
    "CONVERSION[\"laea\",METHOD[\"Lambert Azimuthal Equal Area\",ID[\"EPSG\",9820]],"
    "PARAMETER[\"Latitude of natural origin\",52,ANGLEUNIT[\"degree\",0.0174532925199433]],"
    "PARAMETER[\"Longitude of natural origin\",10,ANGLEUNIT[\"degree\",0.0174532925199433]],"
    "PARAMETER[\"False easting\",0,LENGTHUNIT[\"metre\",1]],"
    "PARAMETER[\"False northing\",0,LENGTHUNIT[\"metre\",1]]],CS[Cartesian,2],"
    "AXIS[\"(E)\",east],AXIS[\"(N)\",north],LENGTHUNIT[\"metre\",1]]";

struct Entry {
  const char* name;
  std::function<MadeGrid(const std::string& name)> make;
};

std::vector<Entry> maps() {
  return {
      {"rotated",
       [](const std::string& name) {
         MapAxes axes{{-2.4, 5}, glm::dvec2(0.2), "degrees",        1,
                      "rlon",    "rlat",          "grid_longitude", "grid_latitude"};
         return of_map(name, axes,
                       {text_note("grid_mapping_name", "rotated_latitude_longitude"),
                        real_note("grid_north_pole_latitude", {39.25}),
                        real_note("grid_north_pole_longitude", {-162}),
                        real_note("north_pole_grid_longitude", {20})},
                       [](glm::dvec2 d) {
                         return from_rotated({39.25, -162}, 20, d);
                       });
       }},
      {"lambert1", [](const std::string& name) { return lambert(name, 39, 39); }},
      {"lambert2", [](const std::string& name) { return lambert(name, 30, 60); }},
      {"mercator",
       [](const std::string& name) {
         return of_map(name, in_metres({-200e3, 1500e3}),
                       on_sphere("mercator", {real_note("standard_parallel", {20}),
                                              real_note("false_easting", {50e3}),
                                              real_note("longitude_of_projection_origin", {179})}),
                       [](glm::dvec2 m) {
                         return from_mercator({kSphere_m, 0, 179}, 20, {m.x - 50e3, m.y});
                       });
       }},
      {"polar_north",
       [](const std::string& name) {
         return of_map(name, in_metres({-300e3, -250e3}),
                       {text_note("grid_mapping_name", "polar_stereographic"),
                        real_note("semi_major_axis", {6378137}),
                        real_note("inverse_flattening", {298.257223563}),
                        real_note("latitude_of_projection_origin", {90}),
                        real_note("straight_vertical_longitude_from_pole", {-45}),
                        real_note("standard_parallel", {70})},
                       [](glm::dvec2 m) {
                         return from_polar({6378137, 1 / 298.257223563, -45, 70, 0, false}, m);
                       });
       }},
      {"polar_south",
       [](const std::string& name) {
         return of_map(name, in_metres({-900e3, 1200e3}),
                       on_sphere("polar_stereographic",
                                 {real_note("latitude_of_projection_origin", {-90}),
                                  real_note("straight_vertical_longitude_from_pole", {30}),
                                  real_note("scale_factor_at_projection_origin", {0.97})}),
                       [](glm::dvec2 m) {
                         return from_polar({kSphere_m, 0, 30, 0, 0.97, true}, m);
                       });
       }},
      {"equal_area",
       [](const std::string& name) {
         return of_map(name, in_metres({200e3, -700e3}),
                       on_sphere("lambert_azimuthal_equal_area",
                                 {real_note("latitude_of_projection_origin", {52}),
                                  real_note("longitude_of_projection_origin", {10})}),
                       [](glm::dvec2 m) {
                         return from_equal_area({kSphere_m, 52, 10}, m);
                       });
       }},
      {"wkt",
       [](const std::string& name) {
         return of_map(name, in_metres({200e3, -700e3}), {text_note("crs_wkt", kWkt)},
                       [](glm::dvec2 m) {
                         return from_equal_area({kSphere_m, 52, 10}, m);
                       });
       }},
      {"stereographic",
       [](const std::string& name) {
         return of_map(
             name, in_metres({-500e3, 100e3}),
             on_sphere("stereographic", {real_note("latitude_of_projection_origin", {47}),
                                         real_note("longitude_of_projection_origin", {8}),
                                         real_note("scale_factor_at_projection_origin", {0.99})}),
             [](glm::dvec2 m) {
               return from_stereographic({kSphere_m, 47, 8}, 0.99, m);
             });
       }},
      {"transverse",
       [](const std::string& name) {
         return of_map(name, in_metres({-300e3, 400e3}),
                       on_sphere("transverse_mercator",
                                 {real_note("latitude_of_projection_origin", {40}),
                                  real_note("longitude_of_central_meridian", {9}),
                                  real_note("scale_factor_at_central_meridian", {0.9996})}),
                       [](glm::dvec2 m) {
                         return from_transverse({kSphere_m, 40, 9}, 0.9996, m);
                       });
       }},
      {"goes", [](const std::string& name) { return geostationary(name, true); }},
      {"meteosat", [](const std::string& name) { return geostationary(name, false); }}};
}

std::vector<Entry> entries() {
  std::vector<Entry> all = {
      {"lonlat",
       [](const std::string& name) {
         return of_axes(name, steps(40, 0.2, kNy + 1), 5, 0.25, kNx, -180);
       }},
      {"lonlat360",  // across Greenwich, where longitudes jump from 360 to 0
       [](const std::string& name) {
         return of_axes(name, steps(-31, 0.2, kNy + 1), -1.6, 0.25, kNx, 0);
       }},
      {"gaussian", [](const std::string&) { return gaussian(); }},
      {"curvilinear",  // across the date line
       [](const std::string& name) {
         return of_fields(
             name,
             [](double x, double y) {
               return from_rotated({60, -1}, 0, {0.2 * x - 1.3, 0.2 * y - 2});
             },
             false);
       }},
      {"curvilinear_corners",  // over the pole
       [](const std::string& name) {
         return of_fields(
             name,
             [](double x, double y) {
               return from_rotated({0.3, 70}, 0, {0.2 * x - 2.4, 0.2 * y - 2});
             },
             true);
       }}};
  for (Entry& entry : maps()) all.push_back(std::move(entry));
  all.push_back({"icon", [](const std::string&) { return made_icon(); }});
  all.push_back({"mpas", [](const std::string& name) { return made_numbers(name, false); }});
  all.push_back({"ugrid", [](const std::string& name) { return made_numbers(name, true); }});
  all.push_back({"centres", [](const std::string&) { return made_hexagons(); }});
  return all;
}

}  // namespace

const std::vector<std::string>& made_grid_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Entry& entry : entries()) list.emplace_back(entry.name);
    return list;
  }();
  return names;
}

MadeGrid made_grid(const std::string& name) {
  for (const Entry& entry : entries())
    if (name == entry.name) return entry.make(name);
  std::string known;
  for (const std::string& one : made_grid_names()) known += (known.empty() ? "" : ", ") + one;
  throw Error({"no such grid", "--grid", known, name, ""});
}

}  // namespace nepho::samples
