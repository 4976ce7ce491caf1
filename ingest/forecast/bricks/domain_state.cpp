#include "forecast/bricks/domain_state.h"

#include <algorithm>
#include <cmath>

namespace nepho::forecast {

std::optional<std::size_t> DomainState::cell_at(glm::dvec2 lat_lon_deg,
                                                std::optional<glm::dvec2>* nearby) const {
  GridSearch::Found found =
      nearby && *nearby ? search.find(lat_lon_deg, **nearby) : search.find(lat_lon_deg);
  // A place without coordinates is no start.
  if (std::isnan(found.off_cells)) found = search.find(lat_lon_deg);
  const auto [at, off_cells] = found;
  if (nearby) *nearby = off_cells == 0 ? std::optional(at) : std::nullopt;
  if (!(off_cells <= 0)) return {};
  const auto index = [](double x, int n) { return std::size_t(std::min(int(x), n - 1)); };
  const std::size_t cell =
      index(at.y, columns.ny) * std::size_t(columns.nx) + index(at.x, columns.nx);
  if (!columns.without_data.empty() && columns.without_data[cell]) return {};
  return cell;
}

double DomainState::extinction_per_m(std::size_t cell, double height_m,
                                     double extend_below_m) const {
  const std::size_t nz = std::size_t(columns.nz);
  const float* interface_m = &columns.interface_m[cell * (nz + 1)];
  if (height_m < double(interface_m[0]) - extend_below_m) return 0;
  const float* above = std::upper_bound(interface_m + 1, interface_m + nz + 1, float(height_m));
  if (above == interface_m + nz + 1) return 0;
  return double(columns.extinction_per_m[cell * nz + std::size_t(above - interface_m - 1)]);
}

OwnColumn DomainState::column(std::size_t cell, double extend_below_m) const {
  OwnColumn column;
  const std::size_t nz = std::size_t(columns.nz);
  const float* z = &columns.interface_m[cell * (nz + 1)];
  for (std::size_t k = 0; k < nz; ++k) {
    const double low_m = double(z[k]) - (k == 0 ? extend_below_m : 0);
    const double depth =
        double(columns.extinction_per_m[cell * nz + k]) * (double(z[k + 1]) - low_m);
    column.optical_depth += depth;
    column.mean_height_m += depth * 0.5 * (low_m + double(z[k + 1]));
  }
  if (column.optical_depth > 0) column.mean_height_m /= column.optical_depth;
  return column;
}

std::vector<DomainState> states_of(const Forecast& forecast, std::size_t time) {
  std::vector<DomainState> states;
  for (const DomainTime& d : forecast.domains(time))
    states.push_back({GridSearch(d.domain->grid(d.time)), d.domain->columns(d.time)});
  return states;
}

}  // namespace nepho::forecast
