#include "forecast/conventions/horizontal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "forecast/conventions/cell_bounds.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kOfStep = 0.01;            // exactness asked of a whole turn
constexpr double kMostTurned = 0.01;        // of all cells: grids with a fold have a row
constexpr double kLatitudeRounding = 1e-3;  // deg beyond a pole that is rounding

[[noreturn]] void refuse_axis(const std::string& where, const char* expected,
                              const std::string& found) {
  throw Error({"the coordinates of the grid are not usable", where, expected, found, ""});
}

void check_latitudes(std::vector<double>& latitude_deg, const std::string& where,
                     bool missing_too = false) {
  for (double& latitude : latitude_deg) {
    if (missing_too && std::isnan(latitude)) continue;
    if (!(std::abs(latitude) <= 90 + kLatitudeRounding))
      refuse_axis(where, "latitudes from -90 to 90 degrees", std::to_string(latitude));
    latitude = std::clamp(latitude, -90.0, 90.0);
  }
}

// The side that each four neighbouring centres turn to, seen from above: the same for all of a
// grid. More than a few that do not, or that lie on a line, and the coordinates are no grid.
void check_turn(int nx, int ny, const std::vector<glm::dvec3>& centre, const std::string& where) {
  std::size_t left = 0, right = 0, flat = 0;
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const auto at = [&](int a, int b) {
        return centre[std::size_t(j + b) * std::size_t(nx) + std::size_t(i + a)];
      };
      const double turn = glm::dot(glm::cross(at(1, 1) - at(0, 0), at(0, 1) - at(1, 0)), at(0, 0));
      if (std::isnan(turn)) continue;
      (turn > 0 ? left : turn < 0 ? right : flat) += 1;
    }
  const std::size_t wrong = std::min(left, right) + flat, all = left + right + flat;
  if (all == 0) refuse_axis(where, "places of cells", "missing values only");
  if (double(wrong) > kMostTurned * double(all))
    refuse_axis(where, "cells that all turn to one side",
                std::to_string(wrong) + " of " + std::to_string(all) +
                    " that turn to the other, or have no area");
}

double between(const std::vector<double>& edges, double at) {
  const double last = double(edges.size()) - 2;
  const double cell = std::clamp(std::floor(at), 0.0, last);
  const std::size_t i = std::size_t(cell);
  return edges[i] + (edges[i + 1] - edges[i]) * (at - cell);
}

bool strictly_monotone(const std::vector<double>& values) {
  if (values.size() < 2) return true;
  const bool rising = values[1] > values[0];
  for (std::size_t i = 1; i < values.size(); ++i)
    if (rising ? !(values[i] > values[i - 1]) : !(values[i] < values[i - 1])) return false;
  return true;
}

class AxesGrid : public HorizontalGrid {
 public:
  AxesGrid(std::vector<double> latitude_edges, std::vector<double> longitude_edges, bool around)
      : latitude_(std::move(latitude_edges)),
        longitude_(std::move(longitude_edges)),
        around_(around) {}
  int nx() const override { return int(longitude_.size()) - 1; }
  int ny() const override { return int(latitude_.size()) - 1; }
  bool around() const override { return around_; }
  glm::dvec2 lat_lon_deg(double x, double y) const override {
    return {between(latitude_, y), between(longitude_, x)};
  }

 private:
  std::vector<double> latitude_, longitude_;  // edges
  bool around_;
};

// Nodes that are centres of cells, or their corners.
class PointsGrid : public HorizontalGrid {
 public:
  PointsGrid(int nx, int ny, bool corners, const std::vector<double>& latitude,
             std::vector<double> longitude)
      : nx_(nx),
        ny_(ny),
        row_(corners ? nx + 1 : nx),
        rows_(corners ? ny + 1 : ny),
        first_(corners ? 0 : 0.5),
        longitude_(std::move(longitude)) {
    for (std::size_t n = 0; n < latitude.size(); ++n)
      direction_.emplace_back(std::cos(latitude[n] * kDegree) * std::cos(longitude_[n] * kDegree),
                              std::cos(latitude[n] * kDegree) * std::sin(longitude_[n] * kDegree),
                              std::sin(latitude[n] * kDegree));
  }
  int nx() const override { return nx_; }
  int ny() const override { return ny_; }
  bool around() const override { return false; }
  const std::vector<glm::dvec3>& directions() const { return direction_; }  // of nodes
  glm::dvec2 lat_lon_deg(double x, double y) const override {
    const glm::dvec3 d = mixed(direction_, x, y);
    const double longitude = std::atan2(d.y, d.x) / kDegree, near = mixed(longitude_, x, y);
    return {std::atan2(d.z, std::hypot(d.x, d.y)) / kDegree,
            longitude + 360 * std::round((near - longitude) / 360)};
  }
  glm::dvec3 direction(double x, double y) const override {
    return glm::normalize(mixed(direction_, x, y));
  }

 private:
  template <class Value>
  Value mixed(const std::vector<Value>& values, double x, double y) const {
    const double u = x - first_, v = y - first_;  // in nodes
    const double i = std::clamp(std::floor(u), 0.0, row_ - 2.0);
    const double j = std::clamp(std::floor(v), 0.0, rows_ - 2.0);
    const double fx = u - i, fy = v - j;  // beyond [0, 1] outside the outermost centres
    const std::size_t row = std::size_t(row_), at = std::size_t(j) * row + std::size_t(i);
    const Value low = values[at] * (1 - fx) + values[at + 1] * fx;
    const Value high = values[at + row] * (1 - fx) + values[at + row + 1] * fx;
    return low * (1 - fy) + high * fy;
  }

  int nx_, ny_, row_, rows_;  // cells; nodes
  double first_;              // node, in cells
  std::vector<glm::dvec3> direction_;
  std::vector<double> longitude_;  // continuous
};

std::unique_ptr<HorizontalGrid> nodes_grid(int nx, int ny, bool corners,
                                           std::vector<double> latitude_deg,
                                           std::vector<double> longitude_deg,
                                           const std::string& where) {
  check_latitudes(latitude_deg, where, true);
  // Along the row, and each row's first from the row before; across what is missing from the last.
  const std::size_t row = std::size_t(corners ? nx + 1 : nx);
  double before = 0, first = 0;
  for (std::size_t n = 0; n < longitude_deg.size(); ++n) {
    double& here = longitude_deg[n];
    if (n % row == 0) before = first;
    if (!std::isfinite(here) || std::isnan(latitude_deg[n])) {
      here = latitude_deg[n] = NAN;
      continue;
    }
    here -= 360 * std::round((here - before) / 360);
    before = here;
    if (n % row == 0) first = here;
  }
#ifdef NEPHO_MUTANT_LONGITUDE_180
  for (double& longitude : longitude_deg) longitude += 180;
#endif
  auto grid = std::make_unique<PointsGrid>(nx, ny, corners, latitude_deg, std::move(longitude_deg));
  check_turn(int(row), corners ? ny + 1 : ny, grid->directions(), where);
  return grid;
}

class MapGrid : public HorizontalGrid {
 public:
  MapGrid(std::vector<double> x_m, std::vector<double> y_m, const MapProjection& projection)
      : x_(std::move(x_m)), y_(std::move(y_m)), projection_(projection) {
    // Continuous about the middle, or about what is nearest to it of a disc.
    constexpr int kSteps = 8;
    for (int n = 0; n < kSteps * kSteps; ++n) {
      const glm::dvec2 part = {(n + kSteps / 2) % kSteps, (n / kSteps + kSteps / 2) % kSteps};
      const glm::dvec2 place = projection_.lat_lon_deg(
          {between(x_, part.x * nx() / kSteps), between(y_, part.y * ny() / kSteps)});
      if (!std::isfinite(place.y)) continue;
      centre_deg_ = place.y;
      break;
    }
  }
  int nx() const override { return int(x_.size()) - 1; }
  int ny() const override { return int(y_.size()) - 1; }
  bool around() const override { return false; }
  glm::dvec2 lat_lon_deg(double x, double y) const override {
    glm::dvec2 place = projection_.lat_lon_deg({between(x_, x), between(y_, y)});
    place.y += 360 * std::round((centre_deg_ - place.y) / 360);
    return place;
  }

 private:
  std::vector<double> x_, y_;  // edges
  MapProjection projection_;
  double centre_deg_ = 0;
};

}  // namespace

void unwrap_deg(std::vector<double>& longitude_deg) {
  for (std::size_t i = 1; i < longitude_deg.size(); ++i)
    longitude_deg[i] -= 360 * std::round((longitude_deg[i] - longitude_deg[i - 1]) / 360);
}

Turn turn_of(const std::vector<double>& longitude_deg) {
  const int n = int(longitude_deg.size());
  if (n < 3) return {n, false};
  const double span = std::abs(longitude_deg.back() - longitude_deg.front());
  const double step = span / (n - 1);
  if (std::abs(span + step - 360) < kOfStep * step) return {n, true};
  if (std::abs(span - 360) < kOfStep * step) return {n - 1, true};
  return {n, false};
}

std::unique_ptr<HorizontalGrid> axes_grid(std::vector<double> latitude_deg,
                                          std::vector<double> longitude_deg,
                                          const std::string& where, AxisEdges edges) {
  check_latitudes(latitude_deg, where);
  unwrap_deg(longitude_deg);
  for (const double longitude : longitude_deg)
    if (!std::isfinite(longitude)) refuse_axis(where, "longitudes", "a missing value");
  const Turn turn = turn_of(longitude_deg);
  longitude_deg.resize(std::size_t(turn.columns));
  if (!strictly_monotone(latitude_deg) || !strictly_monotone(longitude_deg))
    refuse_axis(where, "latitudes and longitudes that rise or fall", "axes that do neither");
  if (std::abs(longitude_deg.back() - longitude_deg.front()) > 360)
    refuse_axis(
        where, "longitudes within one turn",
        std::to_string(longitude_deg.front()) + " to " + std::to_string(longitude_deg.back()));
  auto& [latitude, longitude] = edges;
  if (latitude.empty()) latitude = edges_between(latitude_deg);
  if (longitude.empty()) longitude = edges_between(longitude_deg);
  longitude.resize(std::size_t(turn.columns) + 1);
#ifdef NEPHO_MUTANT_LONGITUDE_180
  for (double& edge : longitude) edge += 180;
#endif
#ifdef NEPHO_MUTANT_SWAPPED_LATITUDES
  std::ranges::reverse(latitude);
#endif
  for (double& edge : latitude) edge = std::clamp(edge, -90.0, 90.0);
  if (turn.around && latitude.size() > 2) {
    const double step = std::abs(latitude[2] - latitude[1]);
    for (double* end : {&latitude.front(), &latitude.back()})
      if (90 - std::abs(*end) < step) *end = std::copysign(90.0, *end);
  }
  return std::make_unique<AxesGrid>(std::move(latitude), std::move(longitude), turn.around);
}

std::unique_ptr<HorizontalGrid> points_grid(int nx, int ny, std::vector<double> latitude_deg,
                                            std::vector<double> longitude_deg,
                                            const std::string& where) {
  if (nx < 2 || ny < 2)
    refuse_axis(where, "at least 2 x 2 cells", std::to_string(nx) + " x " + std::to_string(ny));
  return nodes_grid(nx, ny, false, std::move(latitude_deg), std::move(longitude_deg), where);
}

std::unique_ptr<HorizontalGrid> corners_grid(int nx, int ny, std::vector<double> latitude_deg,
                                             std::vector<double> longitude_deg,
                                             const std::string& where) {
  return nodes_grid(nx, ny, true, std::move(latitude_deg), std::move(longitude_deg), where);
}

std::unique_ptr<HorizontalGrid> map_edges_grid(std::vector<double> x_m, std::vector<double> y_m,
                                               const MapProjection& projection) {
  return std::make_unique<MapGrid>(std::move(x_m), std::move(y_m), projection);
}

std::unique_ptr<HorizontalGrid> map_grid(const std::vector<double>& x_m,
                                         const std::vector<double>& y_m,
                                         const MapProjection& projection) {
  return map_edges_grid(edges_between(x_m), edges_between(y_m), projection);
}

std::unique_ptr<HorizontalGrid> plane_edges_grid(std::vector<double> x_m, std::vector<double> y_m) {
  MapSpec spec;
  spec.kind = MapKind::kTransverseMercator;
  spec.equatorial_m = constants::kWgs84Equatorial_m;
  spec.polar_m = constants::kWgs84Polar_m;
  return map_edges_grid(std::move(x_m), std::move(y_m), MapProjection(spec));
}

std::unique_ptr<HorizontalGrid> plane_grid(const std::vector<double>& x_m,
                                           const std::vector<double>& y_m) {
  return plane_edges_grid(edges_between(x_m), edges_between(y_m));
}

}  // namespace nepho::forecast
