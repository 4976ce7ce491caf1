#include "sources/grib/grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "sources/grib/grid_maps.h"

namespace nepho::grib {
namespace {

constexpr double kRounding_deg = 0.6e-3;  // of edition 1's numbers, and of what was made of them
constexpr double kSamePlace = 1e-3;       // of a step
constexpr double kMostCells = 4e8;

// Degrees from `first` to `last` in `count` steps that go the way of `sign`; whole turns are found
// by the increment. Positions by first and last: increments are rounded.
std::vector<double> degrees(const Message& message, const char* first_key, const char* last_key,
                            const char* step_key, std::size_t count, double sign, bool turns) {
  const double first = message.need_number(first_key);
  const auto last = message.number(last_key), step = message.number(step_key);
  const double steps = double(count - 1);
  double span = 0;
  if (count > 1) {
    if (!last && !step)
      refuse_grid(message, std::string("neither ") + last_key + " nor " + step_key);
    span = last ? (*last - first) * sign : *step * steps;
    if (turns && last && span < 0) span += 360;
    if (last && step && *step > 0) {
      const double by_step = *step * steps, allowed = 0.5 * *step + kRounding_deg * steps;
      if (turns && std::abs(span + 360 - by_step) <= allowed) span += 360;
      if (std::abs(span - by_step) > allowed)
        refuse_grid(message, short_number(first) + " to " + short_number(*last) + " in " +
                                 std::to_string(count - 1) + " steps of " + short_number(*step));
    }
    if (!(span > 0)) refuse_grid(message, short_number(first) + " twice");
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
    refuse_grid(message, std::to_string(grid.ny) + " Gaussian latitudes from " +
                             short_number(first) + " on, N = " + message.text("N"));
  return {nearest, nearest + std::ptrdiff_t(grid.ny)};
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

// In all, where the headers say it: edition 1 counts the data.
std::optional<long> told_points(const Message& message) {
  if (message.need_integer("editionNumber") == 1) return {};
  return message.integer("numberOfDataPoints");
}

// Rows of their own numbers of points, as rows of the longest.
void reduced(const Message& message, Grid& grid) {
  const std::vector<double> points = message.numbers("pl");
  grid.row_points.assign(points.begin(), points.end());
  grid.ny = points.size();
  const auto total = std::accumulate(points.begin(), points.end(), 0.0);
  const bool whole_rows = !points.empty() && *std::ranges::min_element(points) > 0 &&
                          total == double(told_points(message).value_or(long(total)));
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
  const auto same = [](const forecast::FileAttribute& a, const forecast::FileAttribute& b) {
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
  const long points = told_points(message).value_or(nx * ny);
  if (!is_reduced &&
      (nx < 1 || ny < 1 || double(nx) * double(ny) > kMostCells || nx * ny != points))
    refuse_grid(message, std::to_string(points) + " points in all, " + std::to_string(nx) + " x " +
                             std::to_string(ny) + " points");
  if (message.integer("scanningMode").value_or(0) & 0x0f) {
    grid.why = "its rows are shifted by half a step";
    return grid;
  }
  find_axes(message, grid, whole);
#ifndef NEPHO_MUTANT_UNREVERSED
  if (grid.kind == Grid::Kind::kLatLon || grid.kind == Grid::Kind::kRotated ||
      grid.kind == Grid::Kind::kMap) {
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
