#include "forecast/conventions/off_planet.h"

#include <algorithm>
#include <cmath>

namespace nepho::forecast {

void clear_off_planet(const HorizontalGrid& grid, ForecastColumns& columns) {
  const std::size_t nz = std::size_t(columns.nz), nx = std::size_t(columns.nx);
  const auto clear = [&](std::size_t cell) {
    for (std::vector<float>* values : {&columns.extinction_per_m, &columns.ice_extinction_per_m})
      if (!values->empty()) std::fill_n(values->begin() + std::ptrdiff_t(cell * nz), nz, 0.0f);
  };
  if (const CellPolygons* polygons = grid.polygons()) {
    for (std::size_t cell = 0; cell < nx; ++cell)
      if (polygons->first[cell + 1] == polygons->first[cell]) clear(cell);
    return;
  }
  // Each corner once.
  const auto missing_at = [&](int y) {
    std::vector<char> row;
    for (std::size_t x = 0; x <= nx; ++x)
      row.push_back(std::isnan(grid.lat_lon_deg(double(x), y).x));
    return row;
  };
  std::vector<char> low = missing_at(0);
  for (int y = 0; y < columns.ny; ++y) {
    std::vector<char> high = missing_at(y + 1);
    for (std::size_t x = 0; x < nx; ++x)
      if (low[x] || low[x + 1] || high[x] || high[x + 1]) clear(std::size_t(y) * nx + x);
    low = std::move(high);
  }
}

}  // namespace nepho::forecast
