#include "forecast/conventions/cell_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nepho::forecast {
namespace {

constexpr double kOfStep = 0.01;    // of a cell that neighbours' bounds may part
constexpr double kMostTorn = 0.01;  // of all cells: a fold, or a seam

double nearest_turn(double value, double to) {
  return value - 360 * std::round((value - to) / 360);
}

}  // namespace

const FileVariable* bounds_of(const DataFile& file, const FileVariable& variable) {
  const FileVariable* bounds = file.find(variable.text("bounds"));
  return bounds && bounds->numeric ? bounds : nullptr;
}

std::vector<double> edges_between(const std::vector<double>& centres) {
  const std::size_t n = centres.size();
  std::vector<double> edges(n + 1);
  for (std::size_t i = 1; i < n; ++i) edges[i] = 0.5 * (centres[i - 1] + centres[i]);
  edges[0] = n > 1 ? centres[0] - 0.5 * (centres[1] - centres[0]) : centres[0] - 0.5;
  edges[n] = n > 1 ? centres[n - 1] + 0.5 * (centres[n - 1] - centres[n - 2]) : centres[0] + 0.5;
  return edges;
}

std::optional<std::vector<double>> axis_bounds(const DataFile& file, const FileVariable& axis,
                                               const std::vector<double>& centres, double factor,
                                               bool turns) {
  const std::size_t n = centres.size();
  const FileVariable* bounds = bounds_of(file, axis);
  if (!bounds || bounds->dimensions.size() != 2 || bounds->dimensions[0] != axis.dimensions[0] ||
      file.size(bounds->dimensions[1]) != 2)
    return {};
  std::vector<double> value = file.read_all(*bounds);
  if (value.size() < 2 * n) return {};
  for (std::size_t at = 0; at < 2 * n; ++at) {
    value[at] *= factor;
    if (turns) value[at] = nearest_turn(value[at], centres[at / 2]);
  }
  // Each cell's two in the direction of the axis.
  const bool rising = n < 2 || centres[1] > centres[0];
  std::vector<double> edges(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto [low, high] = std::minmax(value[2 * i], value[2 * i + 1]);
    const double step = high - low;
    if (!(low < centres[i] && centres[i] < high)) return {};
    const double first = rising ? low : high;
    if (i > 0 && !(std::abs(edges[i] - first) < kOfStep * step)) return {};
    edges[i] = first;
    edges[i + 1] = rising ? high : low;
  }
  return edges;
}

AxisWalls axis_walls(const DataFile& file, const FileVariable& axis,
                     const std::vector<double>& centres, double factor, bool turns) {
  if (auto edges = axis_bounds(file, axis, centres, factor, turns))
    return {std::move(*edges), true};
  return {edges_between(centres), centres.size() > 1};
}

std::optional<CellCorners> cell_corners(const DataFile& file, const FileVariable& latitude,
                                        const FileVariable& longitude, int nx, int ny,
                                        double factor) {
  const FileVariable *lat = bounds_of(file, latitude), *lon = bounds_of(file, longitude);
  const auto columns = std::size_t(nx), rows = std::size_t(ny);
  const auto fits = [&](const FileVariable* b, const FileVariable& of) {
    return b && b->dimensions.size() == 3 && of.dimensions.size() == 2 &&
           std::equal(of.dimensions.begin(), of.dimensions.end(), b->dimensions.begin()) &&
           file.size(b->dimensions[0]) == rows && file.size(b->dimensions[1]) == columns &&
           file.size(b->dimensions[2]) == 4;
  };
  if (!fits(lat, latitude) || !fits(lon, longitude)) return {};
  const std::vector<double> y = file.read_all(*lat), x = file.read_all(*lon);
  // Which of a cell's corners is at (0, 0), (1, 0), (1, 1), (0, 1): the way round in which
  // neighbours meet.
  const auto torn = [&](const std::array<std::size_t, 4>& order) {
    std::size_t count = 0;
    const auto apart = [&](std::size_t a, std::size_t b, std::size_t size) {
      const double step = std::abs(y[4 * size] - y[4 * size + 2]) + 1e-9;
      return !(std::abs(y[a] - y[b]) < kOfStep * step &&
               std::abs(std::remainder((x[a] - x[b]) * factor, 360.0)) <
                   std::max(1e-9, 10 * kOfStep * step * factor));
    };
    for (std::size_t cell = 0; cell < rows * columns; ++cell) {
      const bool east = cell % columns + 1 < columns, north = cell / columns + 1 < rows;
      count += (east && apart(4 * cell + order[1], 4 * (cell + 1) + order[0], cell)) ||
               (north && apart(4 * cell + order[3], 4 * (cell + columns) + order[0], cell));
    }
    return count;
  };
  for (std::size_t first = 0; first < 4; ++first)
    for (const std::size_t step : {std::size_t{1}, std::size_t{3}}) {
      const std::array<std::size_t, 4> order = {first, (first + step) % 4, (first + 2 * step) % 4,
                                                (first + 3 * step) % 4};
      if (double(torn(order)) > kMostTorn * double(rows * columns)) continue;
      CellCorners corners;
      for (std::size_t j = 0; j <= rows; ++j)
        for (std::size_t i = 0; i <= columns; ++i) {
          const std::size_t cell = std::min(j, rows - 1) * columns + std::min(i, columns - 1);
          const std::size_t which = j < rows ? (i < columns ? 0 : 1) : (i < columns ? 3 : 2);
          corners.latitude.push_back(y[4 * cell + order[which]] * factor);
          corners.longitude.push_back(x[4 * cell + order[which]] * factor);
        }
      return corners;
    }
  return {};
}

}  // namespace nepho::forecast
