#include "forecast/water/condensate.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "forecast/water/air.h"
#include "forecast/water/water.h"

namespace nepho::forecast {
namespace {

// Grid mean to in-cloud water, for radii only; the smallest fraction that is believed.
constexpr double kSmallestFraction = 1e-3;
// Effective radii that a file may say: of haze to drizzle, and of ice crystals.
constexpr double kSmallestRadius_m = 1e-6, kLargestDroplet_m = 100e-6, kLargestCrystal_m = 500e-6;

Species frozen(Species species) {
  return species == Species::kRain ? Species::kSnow : Species::kCloudIce;
}

struct Place {
  std::size_t n, at;  // cell, and index [k][j][i]
  double temperature_K, density_kg_per_m3;
};

// The file's own radius; nothing where it has none that is believed.
std::optional<double> radius_there(const std::vector<float>& radius_m, std::size_t at,
                                   double largest_m, WaterStatistics& statistics) {
  if (radius_m.empty()) return {};
  ++statistics.sized;
  const double radius = double(radius_m[at]);
  if (radius >= kSmallestRadius_m && radius <= largest_m) return radius;
  ++statistics.without_size;
  return {};
}

double droplet_radius(double content, const CloudSetting& setting, const Place& place,
                      WaterStatistics& statistics) {
  if (const auto radius =
          radius_there(setting.droplet_radius_m, place.at, kLargestDroplet_m, statistics))
    return *radius;
  const double sea = setting.water.empty() ? 1.0 : double(setting.water[place.n]);
  Droplets droplets = droplets_over(std::isfinite(sea) ? 1 - sea : 0);
  if (!setting.number.empty()) {
    const double per_m3 =
        double(setting.number[place.at]) * (setting.number_per_kg ? place.density_kg_per_m3 : 1);
    ++statistics.sized;
    if (per_m3 > 0)
      droplets.number_per_m3 = per_m3;
    else
      ++statistics.without_size;
  }
  return droplet_radius_m(content, droplets);
}

double in_cloud(double content, const CloudSetting& setting, std::size_t at) {
  if (setting.fraction.empty()) return content;
  const double fraction = double(setting.fraction[at]);
  return fraction > 0 ? content / std::clamp(fraction, kSmallestFraction, 1.0) : content;
}

double extinction(Species species, double content, const CloudSetting& setting, const Place& place,
                  WaterStatistics& statistics) {
  if (species == Species::kCloudWater) {
    const double radius =
        droplet_radius(in_cloud(content, setting, place.at), setting, place, statistics);
    const double result = content * droplet_extinction_m2_per_kg(radius);
    statistics.droplet_extinction += result;
    statistics.droplet_radius_sum_m += result * radius;
    return result;
  }
  if (species == Species::kCloudIce) {
    const auto radius = radius_there(setting.ice_radius_m, place.at, kLargestCrystal_m, statistics);
    return content *
           ice_extinction_m2_per_kg(radius ? *radius
                                           : ice_radius_m(in_cloud(content, setting, place.at),
                                                          place.temperature_K,
                                                          double(setting.latitude_deg[place.n])));
  }
  return content * precipitation_extinction_m2_per_kg(species, content, place.temperature_K);
}

// The part of a variable of both phases that is liquid.
double liquid_part(const WaterVariable& water, double temperature_K) {
  if (water.freezes_below_K == 0) return 1;
  if (temperature_K < water.freezes_below_K) return 0;
#ifdef NEPHO_MUTANT_ONE_PHASE
  return 1;
#endif
  const double range_K = water.liquid_above_K - water.freezes_below_K;
  return range_K > 0 ? std::min(1.0, (temperature_K - water.freezes_below_K) / range_K) : 1;
}

}  // namespace

double WaterStatistics::radius_m() const {
  return droplet_extinction > 0 ? droplet_radius_sum_m / droplet_extinction : 10e-6;
}

void add_water(const WaterVariable& water, std::span<const float> values, const Air& air,
               const CloudSetting& setting, ForecastColumns& columns,
               std::vector<float>& path_kg_per_m2, WaterStatistics& statistics) {
  const std::size_t cells = std::size_t(columns.nx) * std::size_t(columns.ny);
  const std::size_t nz = std::size_t(columns.nz);
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t n = 0; n < cells; ++n) {
      const std::size_t at = k * cells + n;
      const double amount = double(values[at]) * water.to_si;
      ++statistics.values;
      if (!std::isfinite(amount)) {
        ++statistics.missing;
        continue;
      }
      if (amount < 0) {
        ++statistics.negative;
        statistics.lowest = std::min(statistics.lowest, amount);
      }
      if (amount <= 0) continue;
      const Air::State state = air.at(k, n, cells);
      double content = amount;
      if (water.basis == Basis::kDryAir) content *= state.dry_density_kg_per_m3;
      if (water.basis == Basis::kMoistAir) content *= state.density_kg_per_m3;
      // NaN is neither.
      statistics.coldest_K = std::min(statistics.coldest_K, state.temperature_K);
      statistics.warmest_K = std::max(statistics.warmest_K, state.temperature_K);
      if (!std::isfinite(content) || content < 0 || !std::isfinite(state.temperature_K)) {
        ++statistics.without_air;
        continue;
      }
      const std::size_t out = n * nz + k;
      const float* interface_m = &columns.interface_m[n * (nz + 1) + k];
      const double liquid = liquid_part(water, state.temperature_K);
      for (const auto& [species, part] :
           {std::pair{water.species, liquid}, {frozen(water.species), 1 - liquid}}) {
        if (part == 0) continue;
        const double per_m =
            extinction(species, content * part, setting,
                       {n, at, state.temperature_K, state.density_kg_per_m3}, statistics);
        columns.extinction_per_m[out] += float(per_m);
        if (is_ice(species)) columns.ice_extinction_per_m[out] += float(per_m);
        path_kg_per_m2[n] +=
            float(content * part * (double(interface_m[1]) - double(interface_m[0])));
      }
      if (content > statistics.highest_content_kg_per_m3) {
        statistics.highest_content_kg_per_m3 = content;
        statistics.highest_variable = water.variable->name;
      }
      statistics.highest_extinction_per_m =
          std::max(statistics.highest_extinction_per_m, double(columns.extinction_per_m[out]));
    }
}

}  // namespace nepho::forecast
