#pragma once

#include <span>
#include <string>
#include <vector>

#include "forecast/conventions/model.h"

namespace nepho::forecast {

// What is counted while a time's water becomes extinction.
struct WaterStatistics {
  std::size_t values = 0, missing = 0, negative = 0, without_air = 0;
  double lowest = 0;                     // of the negative ones, kg/kg or kg/m3
  double highest_content_kg_per_m3 = 0;  // all kinds together are not counted: the largest kind
  std::string highest_variable;
  double highest_extinction_per_m = 0;
  double coldest_K = 1e30, warmest_K = -1e30;  // of air with water
  // Cloud water or ice whose own radius or number is missing or no cloud's: the formula's is taken.
  std::size_t sized = 0, without_size = 0;
  // Of columns; cloud apart from precipitation.
  double highest_cloud_kg_per_m2 = 0, mean_cloud_kg_per_m2 = 0;
  double highest_precipitation_kg_per_m2 = 0;
  double droplet_extinction = 0, droplet_radius_sum_m = 0;  // radius weighted by extinction
  double radius_m() const;                                  // 10 um where there are no droplets
};

// Beside the water itself.
struct CloudSetting {
  std::vector<float> fraction;  // [k][j][i]; empty: overcast
  std::vector<float> number;    // droplets, [k][j][i]; empty: Martin et al.
  bool number_per_kg = true;    // of moist air, rather than per m3
  // Effective radii, [k][j][i]; they come before numbers. Empty: by number, by Sun & Rikus.
  std::vector<float> droplet_radius_m, ice_radius_m;
  std::vector<float> water;         // 1 sea .. 0 land, [j][i]; empty: sea
  std::vector<float> latitude_deg;  // [j][i]
};

// Adds one variable's water to the columns' extinction and `path_kg_per_m2` [j][i].
void add_water(const WaterVariable& water, std::span<const float> values, const Air& air,
               const CloudSetting& setting, ForecastColumns& columns,
               std::vector<float>& path_kg_per_m2, WaterStatistics& statistics);

}  // namespace nepho::forecast
