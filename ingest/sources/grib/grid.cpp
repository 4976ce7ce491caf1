#include "sources/grib/grid.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>

#include "core/error.h"
#include "geo/map_projection.h"

namespace nepho::grib {
namespace {

using forecast::FileAttribute;

constexpr double kRounding_deg = 0.6e-3;  // of edition 1's numbers, and of what was made of them
constexpr double kSamePlace = 1e-3;       // of a step
constexpr double kMostCells = 4e8;

// Shape of the Earth: GRIB2 table 3.2; edition 1 has a bit for two of them.
struct Earth {
  double equatorial_m = 6371229, polar_m = 6371229;
};

Earth earth_of(const Message& message) {
  if (message.need_integer("editionNumber") == 1)
    return message.integer("earthIsOblate").value_or(0) == 1 ? Earth{6378160, 6356775}
                                                             : Earth{6367470, 6367470};
  const auto given = [&](const char* value, const char* power, double unit) {
    const double scaled = double(message.integer(value).value_or(0));
    return unit * scaled * std::pow(10.0, -double(message.integer(power).value_or(0)));
  };
  const auto axes = [&](double unit) {
    return Earth{given("scaledValueOfEarthMajorAxis", "scaleFactorOfEarthMajorAxis", unit),
                 given("scaledValueOfEarthMinorAxis", "scaleFactorOfEarthMinorAxis", unit)};
  };
  Earth earth;
  switch (message.integer("shapeOfTheEarth").value_or(6)) {
    case 0:
      earth = {6367470, 6367470};
      break;
    case 1:
      earth.equatorial_m = earth.polar_m =
          given("scaledValueOfRadiusOfSphericalEarth", "scaleFactorOfRadiusOfSphericalEarth", 1);
      break;
    case 2:
      earth = {6378160, 6356775};
      break;
    case 3:
      earth = axes(1000);
      break;
    case 4:
      earth = {6378137, 6356752.314140};
      break;
    case 5:
      earth = {6378137, 6356752.314245};
      break;
    case 7:
      earth = axes(1);
      break;
    case 8:
      earth = {6371200, 6371200};
      break;
    case 9:
      earth = {6377563.396, 6356256.909};
      break;
    default:
      break;
  }
  if (!(earth.equatorial_m > 1e5 && earth.polar_m > 1e5 && earth.polar_m <= earth.equatorial_m))
    throw Error({"a GRIB message's shape of the Earth is not usable", message.where(),
                 "a radius, or axes of an ellipsoid, in m",
                 std::to_string(earth.equatorial_m) + " and " + std::to_string(earth.polar_m), ""});
  return earth;
}

void put(Grid& grid, const char* name, double value) {
  grid.mapping.push_back({name, "", {value}});
}
void put_name(Grid& grid, const char* value, const Earth& earth) {
  grid.mapping.push_back({"grid_mapping_name", value, {}});
  if (earth.equatorial_m == earth.polar_m) return put(grid, "earth_radius", earth.equatorial_m);
  put(grid, "semi_major_axis", earth.equatorial_m);
  put(grid, "semi_minor_axis", earth.polar_m);
}

[[noreturn]] void refuse(const Message& message, const std::string& found) {
  throw Error({"a GRIB message's grid contradicts itself", message.where(),
               "first and last points, increments and numbers of points that agree", found, ""});
}

std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Degrees from `first` to `last` in `count` steps that go the way of `sign`; whole turns are found
// by the increment. Positions by first and last: increments are rounded.
std::vector<double> degrees(const Message& message, const char* first_key, const char* last_key,
                            const char* step_key, std::size_t count, double sign, bool turns) {
  const double first = message.need_number(first_key);
  const auto last = message.number(last_key), step = message.number(step_key);
  const double steps = double(count - 1);
  double span = 0;
  if (count > 1) {
    if (!last && !step) refuse(message, std::string("neither ") + last_key + " nor " + step_key);
    span = last ? (*last - first) * sign : *step * steps;
    if (turns && last && span < 0) span += 360;
    if (last && step && *step > 0) {
      const double by_step = *step * steps, allowed = 0.5 * *step + kRounding_deg * steps;
      if (turns && std::abs(span + 360 - by_step) <= allowed) span += 360;
      if (std::abs(span - by_step) > allowed)
        refuse(message, short_number(first) + " to " + short_number(*last) + " in " +
                            std::to_string(count - 1) + " steps of " + short_number(*step));
    }
    if (!(span > 0)) refuse(message, short_number(first) + " twice");
  }
  std::vector<double> values(count);
  for (std::size_t n = 0; n < count; ++n)
    values[n] = first + (count > 1 ? sign * span * (double(n) / steps) : 0);
  return values;
}

std::vector<double> longitudes(const Message& message, const Grid& grid) {
  return degrees(message, "longitudeOfFirstGridPointInDegrees", "longitudeOfLastGridPointInDegrees",
                 "iDirectionIncrementInDegrees", grid.nx, grid.x_falls ? -1 : 1, true);
}

// By their own numbers: some write the flag of the other direction.
std::vector<double> latitudes(const Message& message, Grid& grid) {
  const auto last = message.number("latitudeOfLastGridPointInDegrees");
  if (last && grid.ny > 1)
    grid.y_falls = *last < message.need_number("latitudeOfFirstGridPointInDegrees");
  return degrees(message, "latitudeOfFirstGridPointInDegrees", "latitudeOfLastGridPointInDegrees",
                 "jDirectionIncrementInDegrees", grid.ny, grid.y_falls ? -1 : 1, false);
}

// The Gaussian latitudes from the first row on.
std::vector<double> parallels(const Message& message, Grid& grid) {
  std::vector<double> all = gaussian_latitudes_deg(message.need_integer("N"));
  const double first = message.need_number("latitudeOfFirstGridPointInDegrees");
  const double last = message.number("latitudeOfLastGridPointInDegrees").value_or(-first);
  grid.y_falls = first > last;
  if (!grid.y_falls) std::ranges::reverse(all);
  const auto nearest = std::ranges::min_element(
      all, {}, [&](double latitude) { return std::abs(latitude - first); });
  if (std::size_t(all.end() - nearest) < grid.ny || std::abs(*nearest - first) > 0.5)
    refuse(message, std::to_string(grid.ny) + " Gaussian latitudes from " + short_number(first) +
                        " on, N = " + message.text("N"));
  return {nearest, nearest + std::ptrdiff_t(grid.ny)};
}

void rotate(const Message& message, Grid& grid) {
  grid.kind = Grid::Kind::kRotated;
  put_name(grid, "rotated_latitude_longitude", earth_of(message));
  const double south = message.need_number("longitudeOfSouthernPoleInDegrees");
  put(grid, "grid_north_pole_latitude", -message.need_number("latitudeOfSouthernPoleInDegrees"));
  put(grid, "grid_north_pole_longitude", std::remainder(south + 180, 360));
  const double turn = message.number("angleOfRotationInDegrees").value_or(0);
  put(grid, "north_pole_grid_longitude", 0);
  if (turn != 0) {
    grid.kind = Grid::Kind::kUnknown;
    grid.why = "its rotated pole is turned by " + short_number(turn) + " degrees as well";
  }
}

// Axes in m from the first point on.
void map_axes(const Message& message, Grid& grid, const MapSpec& spec, const char* dx,
              const char* dy) {
  grid.kind = Grid::Kind::kMap;
  const glm::dvec2 first =
      MapProjection(spec).map_m({message.need_number("latitudeOfFirstGridPointInDegrees"),
                                 message.need_number("longitudeOfFirstGridPointInDegrees")});
  const double step_x = message.need_number(dx) * (grid.x_falls ? -1 : 1);
  const double step_y = message.need_number(dy) * (grid.y_falls ? -1 : 1);
  if (step_x == 0 || step_y == 0) refuse(message, "steps of 0 m");
  for (std::size_t i = 0; i < grid.nx; ++i) grid.x.push_back(first.x + step_x * double(i));
  for (std::size_t j = 0; j < grid.ny; ++j) grid.y.push_back(first.y + step_y * double(j));
}

MapSpec spec_of(const Message& message, MapKind kind) {
  const Earth earth = earth_of(message);
  MapSpec spec;
  spec.kind = kind;
  spec.equatorial_m = earth.equatorial_m;
  spec.polar_m = earth.polar_m;
  return spec;
}

void lambert(const Message& message, Grid& grid) {
  MapSpec spec = spec_of(message, MapKind::kLambertConformal);
  spec.true_latitude1_deg = message.need_number("Latin1InDegrees");
  spec.true_latitude2_deg = message.need_number("Latin2InDegrees");
  spec.central_longitude_deg = message.need_number("LoVInDegrees");
  spec.origin_latitude_deg = message.number("LaDInDegrees").value_or(spec.true_latitude1_deg);
  put_name(grid, "lambert_conformal_conic", {spec.equatorial_m, spec.polar_m});
  grid.mapping.push_back(
      {"standard_parallel", "", {spec.true_latitude1_deg, spec.true_latitude2_deg}});
  put(grid, "longitude_of_central_meridian", spec.central_longitude_deg);
  put(grid, "latitude_of_projection_origin", spec.origin_latitude_deg);
  map_axes(message, grid, spec, "DxInMetres", "DyInMetres");
}

void mercator(const Message& message, Grid& grid) {
  MapSpec spec = spec_of(message, MapKind::kMercator);
  spec.true_latitude1_deg = message.need_number("LaDInDegrees");
  spec.central_longitude_deg = message.need_number("longitudeOfFirstGridPointInDegrees");
  put_name(grid, "mercator", {spec.equatorial_m, spec.polar_m});
  put(grid, "standard_parallel", spec.true_latitude1_deg);
  put(grid, "longitude_of_projection_origin", spec.central_longitude_deg);
  map_axes(message, grid, spec, "DiInMetres", "DjInMetres");
  if (message.number("orientationOfTheGridInDegrees").value_or(0) != 0) {
    grid.kind = Grid::Kind::kUnknown;
    grid.why = "its rows do not run east";
  }
}

void polar_stereographic(const Message& message, Grid& grid) {
  MapSpec spec = spec_of(message, MapKind::kPolarStereographic);
  const bool south = message.integer("projectionCentreFlag").value_or(0) & 0x80;
  const double true_latitude = std::abs(message.number("LaDInDegrees").value_or(60));
  if (!(true_latitude > 0 && true_latitude <= 90))
    refuse(message, "steps at latitude " + short_number(true_latitude));
  spec.true_latitude1_deg = south ? -true_latitude : true_latitude;
  spec.central_longitude_deg = message.need_number("orientationOfTheGridInDegrees");
  put_name(grid, "polar_stereographic", {spec.equatorial_m, spec.polar_m});
  put(grid, "latitude_of_projection_origin", south ? -90 : 90);
  put(grid, "standard_parallel", spec.true_latitude1_deg);
  put(grid, "straight_vertical_longitude_from_pole", spec.central_longitude_deg);
  map_axes(message, grid, spec, "DxInMetres", "DyInMetres");
}

// Template 3.90: angles from the line of sight to the subsatellite point; Nr is the distance from
// the Earth's centre in its radii, dx and dy its diameter in points.
void space_view(const Message& message, Grid& grid) {
  const Earth earth = earth_of(message);
  const double distance = message.need_number("NrInRadiusOfEarth");
  if (!(distance > 1)) refuse(message, "a camera in the Earth");
  grid.kind = Grid::Kind::kAngles;
  put_name(grid, "geostationary", earth);
  put(grid, "perspective_point_height", (distance - 1) * earth.equatorial_m);
  put(grid, "longitude_of_projection_origin",
      message.need_number("longitudeOfSubSatellitePointInDegrees"));
  put(grid, "latitude_of_projection_origin", 0);
  grid.mapping.push_back({"sweep_angle_axis", "y", {}});
  const double diameter_rad = 2 * std::asin(1 / distance);
  const auto axis = [&](std::size_t count, const char* size, const char* centre, const char* origin,
                        bool falls) {
    const double step = diameter_rad / message.need_number(size);
    const double first = message.number(origin).value_or(0) - message.need_number(centre);
    std::vector<double> angles;
    for (std::size_t n = 0; n < count; ++n)
      angles.push_back((falls ? -1 : 1) * step * (first + double(n)));
    return angles;
  };
  grid.x = axis(grid.nx, "dx", "XpInGridLengths", "Xo", grid.x_falls);
  grid.y = axis(grid.ny, "dy", "YpInGridLengths", "Yo", grid.y_falls);
}

void scanning(const Message& message, Grid& grid) {
  grid.x_falls = message.integer("iScansNegatively").value_or(0) == 1;
  grid.y_falls = message.integer("jScansPositively").value_or(0) == 0;
  grid.columns_first = message.integer("jPointsAreConsecutive").value_or(0) == 1;
  grid.alternating = message.integer("alternativeRowScanning").value_or(0) == 1;
#ifdef NEPHO_MUTANT_FLIPPED_SCAN
  grid.alternating = false;
  grid.columns_first = false;
#endif
}

// Rows of their own numbers of points, as rows of the longest.
void reduced(const Message& message, Grid& grid) {
  const std::vector<double> points = message.numbers("pl");
  grid.row_points.assign(points.begin(), points.end());
  grid.ny = points.size();
  const auto total = std::accumulate(points.begin(), points.end(), 0.0);
  const bool whole_rows = !points.empty() && *std::ranges::min_element(points) > 0 &&
                          total == double(message.integer("numberOfPoints").value_or(long(total)));
  if (!whole_rows || total > kMostCells) {
    grid.why = "its rows do not go around the planet";
    return;
  }
  grid.nx = std::size_t(*std::ranges::max_element(points));
  const double first = message.number("longitudeOfFirstGridPointInDegrees").value_or(0);
  for (std::size_t i = 0; i < grid.nx; ++i)
    grid.x.push_back(first + 360 * double(i) / double(grid.nx));
  grid.kind = Grid::Kind::kLatLon;
}

// What ecCodes itself can place: cell by cell.
void by_places(Grid& grid, const std::function<Message*()>& whole) {
  // ecCodes 2.28 puts rows that run south, and columns, where rows that run north belong.
  if (grid.x_falls || grid.y_falls || grid.columns_first || grid.alternating) {
    grid.why = "its rows do not run north, and its places are known for those only";
    return;
  }
  Message::Places places;
  if (Message* const message = whole()) places = message->places();
  if (places.latitude_deg.size() != grid.nx * grid.ny || grid.nx < 2 || grid.ny < 2) {
    grid.why = "its places are not known";
    return;
  }
  grid.kind = Grid::Kind::kPlaces;
  grid.latitude_deg = std::move(places.latitude_deg);
  grid.longitude_deg = std::move(places.longitude_deg);
}

void find_axes(const Message& message, Grid& grid, const std::function<Message*()>& whole) {
  const std::string& type = grid.type;
  if (type == "regular_ll" || type == "rotated_ll") {
    grid.x = longitudes(message, grid);
    grid.y = latitudes(message, grid);
    grid.kind = Grid::Kind::kLatLon;
  } else if (type == "regular_gg" || type == "rotated_gg") {
    grid.x = longitudes(message, grid);
    grid.y = parallels(message, grid);
    grid.kind = Grid::Kind::kLatLon;
  } else if (type == "reduced_gg" || type == "reduced_rotated_gg") {
    reduced(message, grid);
    if (grid.kind == Grid::Kind::kLatLon) grid.y = parallels(message, grid);
  } else if (type == "reduced_ll") {
    reduced(message, grid);
    if (grid.kind == Grid::Kind::kLatLon) grid.y = latitudes(message, grid);
  } else if (type == "lambert") {
    lambert(message, grid);
  } else if (type == "mercator") {
    mercator(message, grid);
  } else if (type == "polar_stereographic") {
    polar_stereographic(message, grid);
  } else if (type == "space_view") {
    space_view(message, grid);
  } else {
    by_places(grid, whole);
  }
  if (grid.kind == Grid::Kind::kLatLon && type.find("rotated") != std::string::npos)
    rotate(message, grid);
}

std::vector<float> spread_rows(const Grid& grid, const std::vector<double>& values) {
  std::vector<float> result(grid.nx * grid.ny);
  const double width = 1 / double(grid.nx);  // of a target's cell, in turns
  std::size_t first = 0;
  for (std::size_t j = 0; j < grid.ny; ++j) {
    const std::size_t points = std::size_t(grid.row_points[j]);
    for (std::size_t i = 0; i < grid.nx; ++i) {
      // Cells are centred at n / points of the turn; in units of the row's cells, from the west
      // edge of its first.
      const double west = ((double(i) - 0.5) * width) * double(points) + 0.5;
      const double east = west + width * double(points);
      double sum = 0, weight = 0;
      for (double cell = std::floor(west); cell < east; ++cell) {
        const double overlap = std::min(east, cell + 1) - std::max(west, cell);
        const std::size_t n = std::size_t(cell + double(points)) % points;
        if (overlap > 0 && !std::isnan(values[first + n])) {
          sum += overlap * values[first + n];
          weight += overlap;
        }
      }
      result[j * grid.nx + i] = weight > 0.5 * (east - west) ? float(sum / weight) : NAN;
    }
    first += points;
  }
  return result;
}

}  // namespace

std::string Grid::text() const {
  std::string text = type;
  if (ny > 0) text += ", " + std::to_string(nx) + " x " + std::to_string(ny);
  if (!x.empty() && !y.empty())
    text += " from " + short_number(x.front()) + ", " + short_number(y.front()) + " to " +
            short_number(x.back()) + ", " + short_number(y.back());
  return text;
}

bool Grid::same_places(const Grid& other) const {
  if (kind != other.kind || type != other.type || nx != other.nx || ny != other.ny ||
      row_points != other.row_points)
    return false;
  const auto near = [](const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) return false;
    const double step = a.size() > 1 ? std::abs(a[1] - a[0]) : 1;
    for (std::size_t n = 0; n < a.size(); ++n)
      if (std::abs(a[n] - b[n]) > kSamePlace * step) return false;
    return true;
  };
  const auto same = [](const FileAttribute& a, const FileAttribute& b) {
    return a.name == b.name && a.text == b.text && a.numbers == b.numbers;
  };
  return near(x, other.x) && near(y, other.y) && near(latitude_deg, other.latitude_deg) &&
         near(longitude_deg, other.longitude_deg) &&
         std::ranges::equal(mapping, other.mapping, same);
}

Grid grid_of(const Message& message, const std::function<Message*()>& whole) {
  Grid grid;
  grid.type = message.text("gridType");
  if (grid.type == "unstructured_grid") {
    grid.kind = Grid::Kind::kCells;
    grid.nx = std::size_t(std::max(0l, message.need_integer("numberOfDataPoints")));
    return grid;
  }
  if (grid.type == "sh" || grid.type.find("_sh") != std::string::npos || grid.type.empty()) {
    grid.why = grid.type.empty() ? "its kind is not known" : "it is in spherical harmonics";
    return grid;
  }
  scanning(message, grid);
  const long nx = message.integer("Ni").value_or(0), ny = message.integer("Nj").value_or(0);
  grid.nx = std::size_t(std::max(0l, nx));
  grid.ny = std::size_t(std::max(0l, ny));
  const bool is_reduced = grid.type.starts_with("reduced");
  if (!is_reduced && (nx < 1 || ny < 1 || double(nx) * double(ny) > kMostCells))
    refuse(message, std::to_string(nx) + " x " + std::to_string(ny) + " points");
  if (message.integer("scanningMode").value_or(0) & 0x0f) {
    grid.why = "its rows are shifted by half a step";
    return grid;
  }
  find_axes(message, grid, whole);
#ifndef NEPHO_MUTANT_UNREVERSED
  if (grid.kind == Grid::Kind::kLatLon || grid.kind == Grid::Kind::kRotated ||
      grid.kind == Grid::Kind::kMap || grid.kind == Grid::Kind::kAngles) {
    if (grid.x_falls) std::ranges::reverse(grid.x);
    if (grid.y_falls) std::ranges::reverse(grid.y);
  }
#endif
#ifdef NEPHO_MUTANT_SHIFTED_LONGITUDE
  for (double& x : grid.x) x += grid.nx > 1 ? grid.x[1] - grid.x[0] : 1;
#endif
  return grid;
}

std::vector<float> arranged(const Grid& grid, const std::vector<double>& values,
                            const std::string& where) {
  const std::size_t expected =
      grid.kind == Grid::Kind::kCells ? grid.nx
      : grid.row_points.empty()
          ? grid.nx * grid.ny
          : std::size_t(std::accumulate(grid.row_points.begin(), grid.row_points.end(), 0l));
  if (values.size() != expected)
    throw Error({"a GRIB field has another number of values than its grid", where,
                 std::to_string(expected), std::to_string(values.size()),
                 "the file is damaged: copy or download it again"});
  if (grid.kind == Grid::Kind::kCells) return {values.begin(), values.end()};
  std::vector<float> spread;
  if (!grid.row_points.empty()) spread = spread_rows(grid, values);
  const auto value = [&](std::size_t n) { return spread.empty() ? float(values[n]) : spread[n]; };
  const std::size_t nx = grid.nx, ny = grid.ny;
  std::vector<float> result(nx * ny);
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i) {
      // In steps of the scan.
      std::size_t from = 0;
      if (grid.columns_first)
        from = i * ny + (grid.alternating && i % 2 ? ny - 1 - j : j);
      else
        from = j * nx + (grid.alternating && j % 2 ? nx - 1 - i : i);
      const std::size_t to_i = grid.x_falls ? nx - 1 - i : i;
      const std::size_t to_j = grid.y_falls ? ny - 1 - j : j;
      result[to_j * nx + to_i] = value(from);
    }
  return result;
}

}  // namespace nepho::grib
