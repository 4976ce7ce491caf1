#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>

#include "bricks/coarsen.h"
#include "forecast/bricks/grid_search.h"
#include "forecast/bricks/hat_remap.h"
#include "forecast/bricks/layout.h"
#include "geo/place.h"
#include "pyramid/level_filter.h"
#include "synthetic_forecast.h"

namespace nepho::test {

// A forecast's hats without the source around them, and truth for them by quadratures that share no
// code with the remap: points of the chart looked up in the model's grid, and the model's cells on
// the ellipsoid.

using forecast::GridSearch;
using forecast::HatRemap;
using forecast::HorizontalGrid;
using Part = HatRemap::Part;

struct Remapped {
  std::shared_ptr<const forecast::Forecast> forecast;
  forecast::Layout layout;
  forecast::ForecastColumns columns;
  std::shared_ptr<const HorizontalGrid> grid;
  std::unique_ptr<HatRemap> remap;

  explicit Remapped(std::shared_ptr<const forecast::Forecast> f,
                    forecast::LayoutOptions options = {}, double clear_below_per_m = 0,
                    std::size_t time = 0, forecast::Layers layers = forecast::Layers::kSmooth)
      : forecast(std::move(f)),
        layout(choose_layout(*forecast, options)),
        columns(forecast->columns(time)),
        grid(forecast->grid(time)) {
    remap = std::make_unique<HatRemap>(
        layout.chart, layout.lattice, *grid, columns,
        forecast::RemapOptions{layout.extend_below_m, clear_below_per_m, layers});
  }
  const ShellChart& chart() const { return *layout.chart; }
  int level() const { return layout.lattice.max_level(); }
  const Index3& cells() const { return layout.lattice.cells(level()); }

  // sum c V over all finest bricks (m2: extinction times volume).
  double total(Part part = Part::kTotal) const {
    double sum = 0;
    BrickSamples samples;
    for (const NodeKey key : remap->nodes(part)) {
      const HatWeights hats = owned_hats(chart(), layout.lattice, key);
      remap->samples(key, part, samples.data());
      for (std::size_t at = 0; at < samples.size(); ++at)
        sum += samples[at] * hats.horizontal[at % 81] * hats.vertical[at / 81];
    }
    return sum;
  }
  // One sample, and all samples of a column.
  double sample(Column column, std::uint32_t k) const {
    const auto node = [](std::uint32_t g, std::uint32_t n) {
      return std::min(g / kBrickCells, n / kBrickCells - 1);
    };
    const NodeKey key(column.root, level(), node(column.i, cells()[0]), node(column.j, cells()[1]),
                      node(k, cells()[2]));
    BrickSamples samples;
    remap->samples(key, Part::kTotal, samples.data());
    return samples[brick_offset(column.i - 8 * key.i(), column.j - 8 * key.j(), k - 8 * key.k())];
  }
  // int c r^2 dr / a^2 of a column's interpolant: its optical depth (1).
  double column_depth(Column column) const {
    const double a = chart().body().equatorial_m, b = chart().body().polar_m;
    double sum = 0;
    BrickSamples samples;
    const std::uint32_t i = std::min(column.i / 8, cells()[0] / 8 - 1),
                        j = std::min(column.j / 8, cells()[1] / 8 - 1);
    for (std::uint32_t k = 0; k < cells()[2] / 8; ++k) {
      remap->samples(NodeKey(column.root, level(), i, j, k), Part::kTotal, samples.data());
      for (std::uint32_t s = 0; s < (k + 1 == cells()[2] / 8 ? 9u : 8u); ++s)
        sum += samples[brick_offset(column.i - 8 * i, column.j - 8 * j, s)] *
               chart().hat_vertical(8 * k + s, cells());
    }
    return sum / (a * b);
  }
  // Owners of all columns that hold something.
  std::vector<Column> columns_with_cloud() const {
    std::map<Column, bool> seen;
    BrickSamples samples;
    for (const NodeKey key : remap->nodes(Part::kTotal)) {
      remap->samples(key, Part::kTotal, samples.data());
      for (std::uint32_t j = 0; j < 9; ++j)
        for (std::uint32_t i = 0; i < 9; ++i)
          for (std::uint32_t k = 0; k < 9; ++k)
            if (samples[brick_offset(i, j, k)] > 0)
              seen[chart().names({key.root(), 8 * key.i() + i, 8 * key.j() + j}, cells()).owner()] =
                  true;
    }
    std::vector<Column> list;
    for (const auto& [column, _] : seen) list.push_back(column);
    return list;
  }
};

// Volume under each m2 of a cell's height range, on the ellipsoid: 3 x 3 Gauss points a cell.
inline double cell_volume_m3(const HorizontalGrid& grid, int i, int j, double low_m,
                             double high_m) {
  constexpr double node[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
  constexpr double weight[3] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
  const Ellipsoid body = Ellipsoid::wgs84();
  const auto at = [&](double x, double y, double h) {
    const glm::dvec2 p = grid.lat_lon_deg(x, y);
    return geodetic_to_ecef_m(body, p.x * kDegree, p.y * kDegree, h);
  };
  constexpr double e = 1e-4;
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int c = 0; c < 3; ++c) {
        const double x = i + node[a], y = j + node[b], h = low_m + node[c] * (high_m - low_m);
        const glm::dvec3 dx = (at(x + e, y, h) - at(x - e, y, h)) / (2 * e);
        const glm::dvec3 dy = (at(x, y + e, h) - at(x, y - e, h)) / (2 * e);
        const glm::dvec3 dh = at(x, y, h + 1) - at(x, y, h);
        sum += weight[a] * weight[b] * weight[c] * std::abs(glm::dot(glm::cross(dx, dy), dh));
      }
  return sum * (high_m - low_m);
}

// sum beta V over the model's cells, the extension below the ground included.
template <class Cells>
double file_total(const Cells& r, bool ice = false) {
  const auto& c = r.columns;
  const std::vector<float>& beta = ice ? c.ice_extinction_per_m : c.extinction_per_m;
  double sum = 0;
  for (int j = 0; j < c.ny; ++j)
    for (int i = 0; i < c.nx; ++i) {
      const auto cell = std::size_t(j) * std::size_t(c.nx) + std::size_t(i);
      const auto nz = std::size_t(c.nz);
      const double area = cell_volume_m3(*r.grid, i, j, 0, 1);
      const double area_up = cell_volume_m3(*r.grid, i, j, 10000, 10001);
      for (std::size_t k = 0; k < nz; ++k) {
        double low = double(c.interface_m[cell * (nz + 1) + k]);
        const double high = double(c.interface_m[cell * (nz + 1) + k + 1]);
        if (k == 0) low -= r.layout.extend_below_m;
        const double middle = area + (area_up - area) * (low + high) / 2e4;
        sum += double(beta[cell * nz + k]) * middle * (high - low);
      }
    }
  return sum;
}

// Points of the chart under one column's hat, looked up in the model's grid.
inline double looked_up_depth(const Remapped& r, const GridSearch& search,
                              const std::vector<double>& depth_of_cell, double height_m,
                              Column column) {
  constexpr int kPoints = 40;  // a side of a square
  const Index3& n = r.cells();
  const double reference_q = (height_m - r.chart().bottom_m()) / r.chart().thickness_m();
  double sum = 0, total = 0;
  GridSearch::Found found;
  for (const Column& name : r.chart().names(column, n))
    for (int b = -kPoints; b < kPoints; ++b)
      for (int a = -kPoints; a < kPoints; ++a) {
        const double u = (a + 0.5) / kPoints, v = (b + 0.5) / kPoints;
        const glm::dvec3 q = {(name.i + u) / n[0], (name.j + v) / n[1], reference_q};
        if (q.x < 0 || q.x > 1 || q.y < 0 || q.y > 1) continue;
        const double x = std::tan(std::numbers::pi / 4 * (2 * q.x - 1)),
                     y = std::tan(std::numbers::pi / 4 * (2 * q.y - 1));
        const double weight = (1 - std::abs(u)) * (1 - std::abs(v)) * (1 + x * x) * (1 + y * y) /
                              std::pow(1 + x * x + y * y, 1.5);
        total += weight;
        const GeodeticPoint p = geodetic_point(r.chart().body(), r.chart().ecef_m({name.root, q}));
        found = search.find({p.latitude_deg, p.longitude_deg}, found.at);
        if (found.off_cells > 0) continue;
        const int i = std::min(int(found.at.x), r.columns.nx - 1),
                  j = std::min(int(found.at.y), r.columns.ny - 1);
        sum += weight * depth_of_cell[std::size_t(j) * std::size_t(r.columns.nx) + std::size_t(i)];
      }
  return sum / total;
}

// Column optical depths against the field under the same hats: rms of the difference over that of
// the depth, over some columns; edges and corners of the cube first, where there are any.
inline double column_rms(const Remapped& r, std::size_t most = 60) {
  const GridSearch search(r.grid);
  const double a = r.chart().body().equatorial_m;
  std::vector<double> depth;
  double middle_m = 0, weight = 0;  // where the clouds are: columns lean against the chart's
  const auto nz = std::size_t(r.columns.nz);
  for (std::size_t cell = 0; cell < r.columns.interface_m.size() / (nz + 1); ++cell) {
    const double lat_deg =
        r.grid->lat_lon_deg(int(cell) % r.columns.nx + 0.5, int(cell) / r.columns.nx + 0.5).x;
    const auto cube = [&](double h) {
      const double up = 1 + forecast::chart_height_m(r.chart().body(), lat_deg, h) / a;
      return up * up * up / 3;
    };
    double sum = 0;
    for (std::size_t k = 0; k < nz; ++k) {
      const float* h = &r.columns.interface_m[cell * (nz + 1) + k];
      const double low = double(h[0]) - (k == 0 ? r.layout.extend_below_m : 0);
      const double part =
          double(r.columns.extinction_per_m[cell * nz + k]) * a * (cube(double(h[1])) - cube(low));
      sum += part;
      middle_m += part * (low + double(h[1])) / 2;
      weight += part;
    }
    depth.push_back(sum);
  }
  std::vector<Column> list = r.columns_with_cloud();
  std::mt19937 random(7);
  std::ranges::shuffle(list, random);
  std::ranges::stable_partition(list,
                                [&](Column c) { return r.chart().names(c, r.cells()).size() > 1; });
  double gap = 0, square = 0;
  list.resize(std::min(list.size(), most));
  for (std::size_t n = 0; n < list.size(); ++n) {
    const double truth = looked_up_depth(r, search, depth, middle_m / weight, list[n]);
    const double off = r.column_depth(list[n]) - truth;
    gap += off * off;
    square += truth * truth;
  }
  return std::sqrt(gap / square);
}

}  // namespace nepho::test
