#include "air/air_lookup.h"

#include "physics/physics_cpp.h"

namespace nepho {
namespace {

// Four texels around a place, and their weights.
struct Corners {
  std::array<std::size_t, 4> at;
  std::array<double, 4> weight;
};

// Part of the way from texel `low` of n to the next.
double along(double u, int n, std::size_t& low) {
  const double place = std::clamp(u, 0.0, 1.0) * (n - 1);
  low = std::size_t(std::min(int(place), n - 2));
  return place - double(low);
}

Corners corners_of(const AirTable& table, double x, double y) {
  std::size_t i = 0, j = 0;
  const double f = along(x, table.width, i), g = along(y, table.height, j);
  const std::size_t row = std::size_t(table.width), first = 3 * (j * row + i);
  return {{first, first + 3, first + 3 * row, first + 3 * row + 3},
          {(1 - f) * (1 - g), f * (1 - g), (1 - f) * g, f * g}};
}

glm::dvec3 mixed(const AirTable& table, const Corners& corners) {
  glm::dvec3 sum{0.0};
  for (std::size_t c = 0; c < 4; ++c) {
    const float* texel = &table.rgb[corners.at[c]];
    sum += corners.weight[c] * glm::dvec3{texel[0], texel[1], texel[2]};
  }
  return sum;
}

}  // namespace

AirDensity air_density(const Air& air, double height_m) {
  AirDensity density;
  if (height_m > air.top_m) return density;
  density.rayleigh_per_m =
      air.rayleigh_per_m * f64::air_exponential(height_m, air.rayleigh_scale_m);
#if defined(NEPHO_MUTANT_HALF_AIR)
  density.rayleigh_per_m *= 0.5;
#endif
  const glm::dvec3 aerosol =
      air.aerosol_extinction_per_m * f64::air_exponential(height_m, air.aerosol_scale_m);
  density.aerosol_per_m = air.aerosol_albedo * aerosol;
  density.extinction_per_m = density.rayleigh_per_m + aerosol +
                             air.ozone_per_m * f64::air_ozone(height_m, air.ozone_low_m,
                                                              air.ozone_peak_m, air.ozone_high_m);
  return density;
}

AirLightRow::AirLightRow(const AirTables& tables, double top_m, double height_m)
    : top_m_(top_m), height_m_(height_m) {
  double x = 0, y = 0;
  f64::air_light_coordinates(top_m, height_m, 0, x, y);
  std::size_t row = 0;
  const double part = along(y, tables.multiple.height, row);
  const auto width = std::size_t(tables.multiple.width);
  texels_.reserve(width);
  const auto mixed = [&](const AirTable& table, std::size_t texel) {
    const float *low = &table.rgb[3 * (row * width + texel)], *high = low + 3 * width;
    return (1 - part) * glm::dvec3{low[0], low[1], low[2]} +
           part * glm::dvec3{high[0], high[1], high[2]};
  };
  for (std::size_t i = 0; i < width; ++i)
    texels_.push_back({mixed(tables.multiple, i), mixed(tables.multiple_p2, i)});
}

AirLight AirLightRow::operator()(double mu_sun) const {
  double x = 0, y = 0;
  f64::air_light_coordinates(top_m_, height_m_, mu_sun, x, y);
  std::size_t i = 0;
  const double part = along(x, int(texels_.size()), i);
  const AirLight &low = texels_[i], &high = texels_[i + 1];
  return {low.multiple + part * (high.multiple - low.multiple),
          low.multiple_p2 + part * (high.multiple_p2 - low.multiple_p2)};
}

glm::dvec3 AirLookup::depth(double height_m, double mu) const {
  double x = 0, y = 0;
  f64::air_depth_coordinates(radius_m_, air_.top_m, height_m, mu, x, y);
  return mixed(tables_.depth, corners_of(tables_.depth, x, y));
}

AirLight AirLookup::light(double height_m, double mu_sun) const {
  double x = 0, y = 0;
  f64::air_light_coordinates(air_.top_m, height_m, mu_sun, x, y);
  const Corners corners = corners_of(tables_.multiple, x, y);
  return {mixed(tables_.multiple, corners), mixed(tables_.multiple_p2, corners)};
}

SkyLight AirLookup::sky(double height_m, double mu_sun) const {
  double x = 0, y = 0;
  f64::air_light_coordinates(air_.top_m, height_m, mu_sun, x, y);
  const Corners corners = corners_of(tables_.sky_up, x, y);
  return {mixed(tables_.sky_up, corners), mixed(tables_.sky_side, corners),
          mixed(tables_.sky_down, corners), mixed(tables_.sky_low, corners)};
}

}  // namespace nepho
