#include "forecast/bricks/column_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bricks/shell_chart.h"

namespace nepho::forecast {
namespace {

glm::dvec3 ecef_m(const glm::dvec2& lat_lon_deg) {
  return geodetic_to_ecef_m(Ellipsoid::wgs84(), glm::radians(lat_lon_deg.x),
                            glm::radians(lat_lon_deg.y), 0);
}

double positive(double area) {
  return area > 0 ? area : 0;  // NaN too
}

// Triangles about the first corner.
double polygon_m2(const CellPolygons& cells, std::size_t cell) {
  glm::dvec3 sum(0.0);
  const std::size_t first = cells.first[cell], end = cells.first[cell + 1];
  if (end < first + 3) return 0;
  const glm::dvec3 about = ecef_m(cells.corner_deg[first]);
  for (std::size_t c = first + 1; c + 1 < end; ++c)
    sum += 0.5 *
           glm::cross(ecef_m(cells.corner_deg[c]) - about, ecef_m(cells.corner_deg[c + 1]) - about);
  return positive(glm::length(sum));
}

// What one column holds.
struct ColumnSums {
  double depth = 0, extended_m3_per_m2 = 0;  // the latter with the ground's fog, at its radius
  double base_m = std::numeric_limits<double>::infinity(), top_m = -base_m;
  bool cut = false;
};

ColumnSums sums_of(const ForecastColumns& columns, std::size_t cell, double extend_below_m) {
  const std::size_t nz = std::size_t(columns.nz);
  const float* z = &columns.interface_m[cell * (nz + 1)];
  const float* extinction = &columns.extinction_per_m[cell * nz];
  const double radius_m = Ellipsoid::wgs84().equatorial_m;
  ColumnSums sums;
  for (std::size_t k = 0; k < nz; ++k) {
    const double per_m = double(extinction[k]);
    const double low_m = double(z[k]), high_m = double(z[k + 1]);
    const double from_m = low_m - (k == 0 ? extend_below_m : 0);
    const double wider = 1 + 0.5 * (from_m + high_m) / radius_m;  // columns widen with height
    sums.depth += per_m * (high_m - low_m);
    sums.extended_m3_per_m2 += per_m * (high_m - from_m) * wider * wider;
    if (per_m < DataFacts::kCloud_per_m) continue;
    sums.base_m = std::min(sums.base_m, low_m);
    sums.top_m = std::max(sums.top_m, high_m);
    sums.cut = k + 1 == nz;
  }
  return sums;
}

// Mean by area and largest of a number of each column.
class Averaged {
 public:
  void add(double value, double area_m2) {
    sum_ += value * area_m2;
    area_m2_ += area_m2;
    most_ = std::max(most_, value);
  }
  DataFacts::Amount amount() const {
    return area_m2_ > 0 ? DataFacts::Amount{sum_ / area_m2_, most_} : DataFacts::Amount{};
  }

 private:
  double sum_ = 0, area_m2_ = 0, most_ = -std::numeric_limits<double>::infinity();
};

DataFacts::Amount amount_of(const std::vector<float>& values, const std::vector<double>& area_m2) {
  Averaged sum;
  for (std::size_t cell = 0; cell < values.size(); ++cell)
    if (area_m2[cell] > 0) sum.add(double(values[cell]), area_m2[cell]);
  return sum.amount();
}

}  // namespace

std::vector<double> cell_areas_m2(const HorizontalGrid& grid) {
  std::vector<double> areas;
  if (const CellPolygons* polygons = grid.polygons()) {
    for (std::size_t cell = 0; cell + 1 < polygons->first.size(); ++cell)
      areas.push_back(polygon_m2(*polygons, cell));
    return areas;
  }
  const auto at = [&](double x, double y) { return ecef_m(grid.lat_lon_deg(x, y)); };
  for (int j = 0; j < grid.ny(); ++j)
    for (int i = 0; i < grid.nx(); ++i)
      areas.push_back(positive(glm::length(
          glm::cross(at(i + 1, j + 0.5) - at(i, j + 0.5), at(i + 0.5, j + 1) - at(i + 0.5, j)))));
  return areas;
}

DataFacts column_facts(const ForecastColumns& columns, const HorizontalGrid& grid,
                       double extend_below_m) {
  const std::vector<double> area_m2 = cell_areas_m2(grid);
  DataFacts facts;
  facts.variables = columns.variables;
  facts.columns = area_m2.size();
  facts.liquid_kg_per_m2 = amount_of(columns.liquid_kg_per_m2, area_m2);
  facts.ice_kg_per_m2 = amount_of(columns.ice_kg_per_m2, area_m2);
  facts.precipitation_kg_per_m2 = amount_of(columns.precipitation_kg_per_m2, area_m2);
  Averaged depth, base, top, cut;
  double total_m2 = 0, cloudy_m2 = 0, extinction_m2 = 0;
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  double bottom_m = lowest_m, end_m = highest_m;
  const std::size_t nz = std::size_t(columns.nz);
  for (std::size_t cell = 0; cell < area_m2.size(); ++cell) {
    if (!(area_m2[cell] > 0)) continue;
    const ColumnSums sums = sums_of(columns, cell, extend_below_m);
    total_m2 += area_m2[cell];
    extinction_m2 += sums.extended_m3_per_m2 * area_m2[cell];
    depth.add(sums.depth, area_m2[cell]);
    lowest_m = std::min(lowest_m, sums.base_m);
    highest_m = std::max(highest_m, sums.top_m);
    bottom_m = std::min(bottom_m, double(columns.interface_m[cell * (nz + 1)]));
    end_m = std::max(end_m, double(columns.interface_m[cell * (nz + 1) + nz]));
    if (sums.depth < DataFacts::kCloudyDepth || !(sums.top_m > sums.base_m)) continue;
    cloudy_m2 += area_m2[cell];
    base.add(sums.base_m, area_m2[cell]);
    top.add(sums.top_m, area_m2[cell]);
    cut.add(sums.cut, area_m2[cell]);
  }
  if (!(total_m2 > 0)) return facts;
  facts.area_m2 = total_m2;
  facts.optical_depth = depth.amount();
  facts.cover = cloudy_m2 / total_m2;
  facts.extinction_m2 = extinction_m2;
  facts.data_bottom_m = bottom_m, facts.data_top_m = end_m;
  facts.mean_base_m = base.amount().mean, facts.mean_top_m = top.amount().mean;
  facts.cut_share = cut.amount().mean;
  if (highest_m > lowest_m) facts.lowest_base_m = lowest_m, facts.highest_top_m = highest_m;
  return facts;
}

}  // namespace nepho::forecast
