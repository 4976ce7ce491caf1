#pragma once

#include <gtest/gtest.h>

#include "remapped.h"

namespace nepho::test {

// Domains that are drawn together, and truth for them by points that are looked up in their grids.

// What file_total() needs of a forecast.
struct CutColumns {
  forecast::ForecastColumns columns;
  std::shared_ptr<const HorizontalGrid> grid;
  struct {
    double extend_below_m;
  } layout;
};

// The hats of all domains on the nest's lattice.
struct Together {
  std::shared_ptr<const forecast::Forecast> nest;
  std::vector<forecast::DomainTime> domains;
  forecast::Layout layout;
  std::vector<std::shared_ptr<const HorizontalGrid>> grids;
  std::vector<forecast::ForecastColumns> columns;
  int points = 12;                   // an axis of a cell, for what is left of it
  std::unique_ptr<Remapped> finest;  // lends its sums to the hats of all

  using Change = std::function<void(std::vector<forecast::ForecastColumns>&)>;
  explicit Together(std::shared_ptr<const forecast::Forecast> n, std::size_t time = 0,
                    const Change& change = {})
      : nest(std::move(n)), domains(nest->domains(time)) {
    finest = std::make_unique<Remapped>(nest);
    layout = finest->layout;
    for (const auto& [domain, at] : domains) {
      grids.push_back(domain->grid(at));
      columns.push_back(domain->columns(at));
    }
    if (change) change(columns);
    std::vector<forecast::HatDomain> cells;
    for (std::size_t d = 0; d < grids.size(); ++d) cells.push_back({*grids[d], columns[d]});
    finest->remap = std::make_unique<HatRemap>(
        layout.chart, layout.lattice, cells,
        forecast::RemapOptions{layout.extend_below_m, 0, forecast::Layers::kSmooth});
  }
  const Remapped& all() const { return *finest; }

  // Farthest from one even layer of all columns whose hat lies in the coarsest domain.
  double worst_seam(double value_per_m) const {
    const ShellChart& chart = *layout.chart;
    const Index3 n = all().cells();
    const double q = (2000 - chart.bottom_m()) / chart.thickness_m();
    const auto k = std::uint32_t(std::lround(q * n[2]));
    const GridSearch search(grids.back());
    double worst = 0;
    std::size_t checked = 0;
    for (const Column& column : all().columns_with_cloud()) {
      const GeodeticPoint p = geodetic_point(
          chart.body(),
          chart.ecef_m({column.root, {double(column.i) / n[0], double(column.j) / n[1], q}}));
      const auto found = search.find({p.latitude_deg, p.longitude_deg});
      const glm::dvec2 size(grids.back()->nx(), grids.back()->ny());
      if (found.off_cells > 0 || glm::any(glm::lessThan(found.at, glm::dvec2(0.5))) ||
          glm::any(glm::greaterThan(found.at, size - 0.5)))
        continue;
      ++checked;
      worst = std::max(worst, std::abs(all().sample(column, k) / value_per_m - 1));
    }
    EXPECT_GT(checked, 1000u);
    return worst;
  }

  // Part of a cell that no finer domain covers, by points looked up in their grids.
  double left(std::size_t domain, int i, int j, const std::vector<GridSearch>& searches) const {
    int free = 0;
    for (int b = 0; b < points; ++b)
      for (int a = 0; a < points; ++a) {
        const glm::dvec2 place =
            grids[domain]->lat_lon_deg(i + (a + 0.5) / points, j + (b + 0.5) / points);
        bool covered = false;
        for (std::size_t d = 0; d < domain && !covered; ++d) {
          const auto found = searches[d].find(place);
          const auto& missing = columns[d].without_data;
          covered =
              found.off_cells == 0 &&
              (missing.empty() || !missing[std::size_t(found.at.y) * std::size_t(columns[d].nx) +
                                           std::size_t(found.at.x)]);
        }
        free += !covered;
      }
    return double(free) / (points * points);
  }

  // sum beta V over the files' cells, each as far as it is left.
  double files_total() const {
    std::vector<GridSearch> searches;
    for (const auto& grid : grids) searches.emplace_back(grid);
    double sum = 0;
    for (std::size_t d = 0; d < grids.size(); ++d) {
      CutColumns own{columns[d], grids[d], {layout.extend_below_m}};
      const auto nz = std::size_t(own.columns.nz);
      for (int j = 0; j < own.columns.ny; ++j)
        for (int i = 0; i < own.columns.nx; ++i) {
          const auto cell = std::size_t(j) * std::size_t(own.columns.nx) + std::size_t(i);
          const auto part = float(left(d, i, j, searches));
          for (std::size_t k = 0; k < nz; ++k) own.columns.extinction_per_m[cell * nz + k] *= part;
        }
      sum += file_total(own);
    }
    return sum;
  }
};

}  // namespace nepho::test
