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

namespace {

// Of the columns of all domains together.
class Facts {
 public:
  void add(const ForecastColumns& columns, const std::vector<double>& area_m2,
           double extend_below_m);
  DataFacts facts() const;

 private:
  void add_ranges(const std::vector<DataVariable>& variables);
  void add_cloud(const ColumnSums& sums, double area_m2);

  std::vector<DataVariable> variables_;
  std::uint64_t columns_ = 0;
  Averaged liquid_, ice_, precipitation_, depth_, base_, top_, cut_;
  double total_m2_ = 0, cloudy_m2_ = 0, extinction_m2_ = 0;
  double lowest_m_ = std::numeric_limits<double>::infinity(), highest_m_ = -lowest_m_;
  double bottom_m_ = lowest_m_, end_m_ = highest_m_;
};

// Variables of one name and unit are one.
void Facts::add_ranges(const std::vector<DataVariable>& variables) {
  for (const DataVariable& v : variables) {
    const auto known = std::ranges::find_if(variables_, [&](const DataVariable& other) {
      return other.name == v.name && other.unit == v.unit;
    });
    if (known == variables_.end()) {
      variables_.push_back(v);
      continue;
    }
    known->low = std::fmin(known->low, v.low), known->high = std::fmax(known->high, v.high);
    known->values += v.values, known->missing += v.missing, known->negative += v.negative;
  }
}

void Facts::add_cloud(const ColumnSums& sums, double area_m2) {
  if (sums.depth < DataFacts::kCloudyDepth || !(sums.top_m > sums.base_m)) return;
  cloudy_m2_ += area_m2;
  base_.add(sums.base_m, area_m2);
  top_.add(sums.top_m, area_m2);
  cut_.add(sums.cut, area_m2);
}

void Facts::add(const ForecastColumns& columns, const std::vector<double>& area_m2,
                double extend_below_m) {
  add_ranges(columns.variables);
  columns_ += area_m2.size();
  const std::size_t nz = std::size_t(columns.nz);
  for (std::size_t cell = 0; cell < area_m2.size(); ++cell) {
    const double area = area_m2[cell];
    if (!(area > 0)) continue;
    const ColumnSums sums = sums_of(columns, cell, extend_below_m);
    total_m2_ += area;
    extinction_m2_ += sums.extended_m3_per_m2 * area;
    depth_.add(sums.depth, area);
    const auto add_path = [&](Averaged& to, const std::vector<float>& path) {
      if (!path.empty()) to.add(double(path[cell]), area);
    };
    add_path(liquid_, columns.liquid_kg_per_m2);
    add_path(ice_, columns.ice_kg_per_m2);
    add_path(precipitation_, columns.precipitation_kg_per_m2);
    lowest_m_ = std::min(lowest_m_, sums.base_m);
    highest_m_ = std::max(highest_m_, sums.top_m);
    bottom_m_ = std::min(bottom_m_, double(columns.interface_m[cell * (nz + 1)]));
    end_m_ = std::max(end_m_, double(columns.interface_m[cell * (nz + 1) + nz]));
    add_cloud(sums, area);
  }
}

DataFacts Facts::facts() const {
  DataFacts facts;
  facts.variables = variables_;
  facts.columns = columns_;
  facts.liquid_kg_per_m2 = liquid_.amount();
  facts.ice_kg_per_m2 = ice_.amount();
  facts.precipitation_kg_per_m2 = precipitation_.amount();
  if (!(total_m2_ > 0)) return facts;
  facts.area_m2 = total_m2_;
  facts.optical_depth = depth_.amount();
  facts.cover = cloudy_m2_ / total_m2_;
  facts.extinction_m2 = extinction_m2_;
  facts.data_bottom_m = bottom_m_, facts.data_top_m = end_m_;
  facts.mean_base_m = base_.amount().mean, facts.mean_top_m = top_.amount().mean;
  facts.cut_share = cut_.amount().mean;
  if (highest_m_ > lowest_m_) facts.lowest_base_m = lowest_m_, facts.highest_top_m = highest_m_;
  return facts;
}

// Places spread evenly over a cell: n x n, of a polygon towards each of its corners.
std::vector<glm::dvec2> places_in(const HorizontalGrid& grid, std::size_t cell, int n) {
  std::vector<glm::dvec2> places;
  if (const CellPolygons* polygons = grid.polygons()) {
    glm::dvec3 middle(0.0);
    for (std::uint32_t c = polygons->first[cell]; c < polygons->first[cell + 1]; ++c)
      middle += unit_vector(polygons->corner_deg[c]);
    middle = glm::normalize(middle);
    for (std::uint32_t c = polygons->first[cell]; c < polygons->first[cell + 1]; ++c)
      for (int i = 0; i < n; ++i)
        places.push_back(lat_lon_deg_of(
            glm::mix(middle, unit_vector(polygons->corner_deg[c]), std::sqrt((i + 0.5) / n))));
    return places;
  }
  const auto nx = std::size_t(grid.nx());
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      places.push_back(
          grid.lat_lon_deg(double(cell % nx) + (i + 0.5) / n, double(cell / nx) + (j + 0.5) / n));
  return places;
}

// Of a cell of domains[coarse]: the part that no finer domain covers.
double share_left(const std::vector<DomainState>& domains, std::size_t coarse, std::size_t cell) {
  const auto share = [&](int n) {
    const std::vector<glm::dvec2> places = places_in(domains[coarse].search.grid(), cell, n);
    const auto is_left = [&](const glm::dvec2& deg) {
      return std::none_of(domains.begin(), domains.begin() + std::ptrdiff_t(coarse),
                          [&](const DomainState& finer) { return finer.cell_at(deg).has_value(); });
    };
    return double(std::ranges::count_if(places, is_left)) / double(places.size());
  };
  const double rough = share(3);
  return rough == 0 || rough == 1 ? rough : share(8);
}

}  // namespace

DataFacts column_facts(const ForecastColumns& columns, const HorizontalGrid& grid,
                       double extend_below_m) {
  Facts facts;
  facts.add(columns, cell_areas_m2(grid), extend_below_m);
  return facts.facts();
}

DataFacts column_facts(const std::vector<DomainState>& domains, double extend_below_m) {
  Facts facts;
  for (std::size_t n = 0; n < domains.size(); ++n) {
    std::vector<double> area_m2 = cell_areas_m2(domains[n].search.grid());
    if (n > 0)
      for (std::size_t cell = 0; cell < area_m2.size(); ++cell)
        if (area_m2[cell] > 0) area_m2[cell] *= share_left(domains, n, cell);
    const std::vector<char>& hole = domains[n].columns.without_data;
    for (std::size_t cell = 0; cell < hole.size() && domains.size() > 1; ++cell)
      if (hole[cell]) area_m2[cell] = 0;  // of a coarser domain
    facts.add(domains[n].columns, area_m2, extend_below_m);
  }
  return facts.facts();
}

}  // namespace nepho::forecast
