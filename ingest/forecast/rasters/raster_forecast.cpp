#include "forecast/rasters/raster_forecast.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "forecast/conventions/off_planet.h"
#include "forecast/rasters/cloud_column.h"

namespace nepho::forecast {
namespace {

constexpr int kAdiabaticLayers = 8;
constexpr double kClearAbove_m = 100;  // the layer over the highest top
constexpr double kLargestExtinction_per_m = 1;

std::string text(const char* format, auto... values) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

class RasterForecast : public Forecast {
 public:
  RasterForecast(Raster raster, const RasterOptions& options, bool force)
      : raster_(std::move(raster)), options_(options) {
    if (!force) check_values(raster_);
    for (const auto& [quantity, field] : raster_.fields) fields_[std::size_t(quantity)] = &field;
    require_meaning();
    measure(force);
    state();
  }

  std::int64_t time_origin_ns() const override { return raster_.utc_ns; }
  const std::vector<double>& times_s() const override { return times_s_; }
  bool has_ice() const override { return has_ice_; }
  std::shared_ptr<const HorizontalGrid> grid(std::size_t) const override { return raster_.grid; }
  ForecastColumns columns(std::size_t time) const override;
  ForecastGround ground(std::size_t) const override { return {}; }
  glm::dvec2 height_range_m() const override { return {floor_m_, ceiling_m_}; }
  double thinnest_layer_m() const override { return thinnest_m_; }
  double liquid_radius_m() const override { return radius_m_; }
  std::vector<std::string> assumptions() const override { return raster_.assumptions; }
  std::vector<std::string> facts() const override { return raster_.facts; }

 private:
  std::size_t cells() const {
    return std::size_t(raster_.grid->nx()) * std::size_t(raster_.grid->ny());
  }
  bool given(CloudQuantity quantity) const { return fields_[std::size_t(quantity)] != nullptr; }
  Lacks column(std::size_t cell, CloudColumn& column) const;
  void require_meaning() const;
  void measure(bool force);
  void state();
  void state_depth();
  void state_heights();

  Raster raster_;
  RasterOptions options_;
  const std::vector<float>* fields_[std::size_t(CloudQuantity::kEffectiveRadius) + 1] = {};
  std::vector<double> times_s_{0.0};
  bool has_ice_ = false;
  double floor_m_ = 0, ceiling_m_ = 0, thinnest_m_ = 0, radius_m_ = 10e-6;
  double deepest_ = 0, mean_depth_ = 0;
  std::size_t cloudy_ = 0, without_top_ = 0;
};

Lacks RasterForecast::column(std::size_t cell, CloudColumn& column) const {
  const auto value = [&](CloudQuantity quantity) {
    const std::vector<float>* field = fields_[std::size_t(quantity)];
    return field ? double((*field)[cell]) : double(NAN);
  };
  using enum CloudQuantity;
  ColumnValues v{value(kOpticalDepth),   value(kLiquidPath),     value(kIcePath),
                 value(kWaterPath),      value(kCover),          value(kTopHeight),
                 value(kTopPressure),    value(kTopTemperature), value(kBaseHeight),
                 value(kEffectiveRadius)};
  // A stated depth is that of columns of which something is known.
  const bool known = given(kCover) || !std::isnan(v.top_m) || !std::isnan(v.top_Pa) ||
                     !std::isnan(v.top_K) || !std::isnan(v.base_m);
  const bool depth_given =
      given(kOpticalDepth) || given(kLiquidPath) || given(kIcePath) || given(kWaterPath);
  if (!depth_given && !known) v.cover = 0;
  if (given(kCover) && std::isnan(v.cover)) v.cover = 0;
  if (given(kOpticalDepth) && std::isnan(v.optical_depth)) v.optical_depth = 0;
  return cloud_column(v, options_, column);
}

// What must be stated, in one message.
void RasterForecast::require_meaning() const {
  using enum CloudQuantity;
  std::string found;
  for (const auto& [quantity, field] : raster_.fields)
    found += (found.empty() ? "" : ", ") + std::string(kind_of(quantity).word);
  if (found.empty()) found = "nothing of a cloud";
  if (!given(kOpticalDepth) && !given(kLiquidPath) && !given(kIcePath) && !given(kWaterPath) &&
      !options_.optical_depth)
    throw Error({"the raster does not say how thick its clouds are", raster_.path,
                 "optical_depth, or a water path", found,
                 "add a file that does, or state one depth: --optical-depth 10"});
  const bool heights = given(kTopHeight) || given(kTopPressure) || given(kTopTemperature) ||
                       given(kBaseHeight) || options_.base_m || options_.top_m;
  if (!heights)
    throw Error({"the raster does not say how high its clouds are", raster_.path,
                 "top_height, top_pressure, top_temperature or base_height", found,
                 "add a file that does, or state it: --cloud-top 2000, or --cloud-base 800 (m)"});
}

void RasterForecast::measure(bool force) {
  double low = 0, high = 100, sum = 0, radius_weight = 0, radius_sum = 0;
  double thinnest = 1e9, thick_sum = 0;
  CloudColumn cloud;
  for (std::size_t cell = 0; cell < cells(); ++cell) {
    if (column(cell, cloud) == Lacks::kTop) {
      ++without_top_;
      continue;
    }
    if (!(cloud.optical_depth > 0)) continue;
    ++cloudy_;
    low = std::min(low, cloud.base_m - 1);
    high = std::max(high, cloud.top_m);
    sum += cloud.optical_depth;
    deepest_ = std::max(deepest_, cloud.optical_depth);
    has_ice_ |= cloud.ice_share > 0;
    const double liquid = cloud.optical_depth * (1 - cloud.ice_share);
    radius_sum += liquid * cloud.radius_m;
    radius_weight += liquid;
    const double thick_m = cloud.top_m - cloud.base_m;
    thinnest = std::min(thinnest, thick_m);
    thick_sum += cloud.optical_depth / thick_m;
    if (!force && cloud.optical_depth / thick_m > kLargestExtinction_per_m)
      throw Error({"extinction is higher than any cloud's", raster_.path, "at most 1 /m",
                   text("optical depth %.4g in %.0f m", cloud.optical_depth, thick_m),
                   "state a thicker cloud; --force draws it as it is"});
  }
  if (cloudy_ == 0 && without_top_ > 0)
    throw Error({"no cloud of the raster has a height", raster_.path,
                 "a height where there is optical depth",
                 std::to_string(without_top_) + " cloudy columns without one",
                 "state one: --cloud-top 2000 (m)"});
  if (radius_weight > 0) radius_m_ = radius_sum / radius_weight;
  mean_depth_ = sum / double(std::max<std::size_t>(cells(), 1));
  floor_m_ = low;
  ceiling_m_ = high + kClearAbove_m;
  // Harmonic mean, weighted by depth: two voxels for the clouds that are seen.
  thinnest_m_ = thick_sum > 0 ? std::max(sum / thick_sum, thinnest) / 2 : 100;
}

ForecastColumns RasterForecast::columns(std::size_t) const {
  const int layers = options_.profile == Profile::kUniform ? 1 : kAdiabaticLayers;
  ForecastColumns columns;
  columns.nx = raster_.grid->nx();
  columns.ny = raster_.grid->ny();
  columns.nz = layers + 2;
  const std::size_t nz = std::size_t(columns.nz);
  columns.interface_m.resize(cells() * (nz + 1));
  columns.extinction_per_m.assign(cells() * nz, 0.0f);
  if (has_ice_) columns.ice_extinction_per_m = columns.extinction_per_m;
  CloudColumn cloud;
  for (std::size_t cell = 0; cell < cells(); ++cell) {
    float* z = &columns.interface_m[cell * (nz + 1)];
    const bool cloudy = column(cell, cloud) == Lacks::kNothing && cloud.optical_depth > 0;
    const double base_m = cloudy ? cloud.base_m : floor_m_ + (ceiling_m_ - floor_m_) / 3;
    const double top_m = cloudy ? cloud.top_m : floor_m_ + (ceiling_m_ - floor_m_) / 1.5;
    z[0] = float(floor_m_ - 1);
    for (int k = 0; k <= layers; ++k) z[k + 1] = float(base_m + (top_m - base_m) * k / layers);
    z[nz] = float(ceiling_m_);
    if (!cloudy) continue;
    const Profile profile = cloud.ice_share > 0.5 ? Profile::kUniform : options_.profile;
    for (int k = 0; k < layers; ++k) {
      const double share =
          depth_below(profile, double(k + 1) / layers) - depth_below(profile, double(k) / layers);
      const double thick_m = double(z[k + 2]) - double(z[k + 1]);
      double per_m = cloud.optical_depth * share / thick_m;
#ifdef NEPHO_MUTANT_RASTER_DEPTH
      per_m /= 2;
#endif
      columns.extinction_per_m[cell * nz + std::size_t(k) + 1] = float(per_m);
      if (has_ice_)
        columns.ice_extinction_per_m[cell * nz + std::size_t(k) + 1] =
            float(per_m * cloud.ice_share);
    }
  }
  clear_off_planet(*raster_.grid, columns);
  return columns;
}

void RasterForecast::state_depth() {
  using enum CloudQuantity;
  auto& said = raster_.assumptions;
  const bool paths = given(kLiquidPath) || given(kIcePath) || given(kWaterPath);
  if (!given(kOpticalDepth) && paths)
    said.push_back(
        text("Optical depths follow from water paths by extinction per mass: droplets "
             "of %.3g um, ice of %.3g um%s.",
             options_.liquid_radius_m * 1e6, options_.ice_radius_m * 1e6,
             given(kEffectiveRadius) ? ", or the raster's effective radius" : ""));
  if (!given(kOpticalDepth) && !paths)
    said.push_back(
        text("Each cloudy column has the stated optical depth of %.4g.", *options_.optical_depth));
  if (given(kCover) && (given(kOpticalDepth) || !paths))
    said.push_back(
        "Optical depths are those of the cloudy part of a cell: its mean is depth times "
        "cover.");
  if (options_.phase == RasterPhase::kByTemperature && !(given(kLiquidPath) || given(kIcePath)))
    said.push_back(text("Clouds are ice where their tops are below %.0f degC (%s), else liquid.",
                        kIceBelow_K - 273.15,
                        given(kTopTemperature) ? "the raster's temperatures"
                                               : "the standard atmosphere's at their height"));
}

void RasterForecast::state_heights() {
  using enum CloudQuantity;
  auto& said = raster_.assumptions;
  if (options_.top_m)
    said.push_back(text("All clouds end at the stated top, %.0f m.", *options_.top_m));
  else if (!given(kTopHeight) && given(kTopPressure))
    said.push_back("Tops lie where the standard atmosphere has their pressure.");
  else if (!given(kTopHeight) && given(kTopTemperature))
    said.push_back(
        "Tops lie where the standard atmosphere has their temperature, at most at 11 km.");
  else if (!given(kTopHeight))
    said.push_back("Tops are those of the bases and the clouds' thickness.");
  if (options_.base_m)
    said.push_back(text("All clouds begin at the stated base, %.0f m.", *options_.base_m));
  else if (options_.thickness_m)
    said.push_back(text("All clouds are %.0f m thick, as stated.", *options_.thickness_m));
  else if (!given(kBaseHeight) && options_.profile == Profile::kAdiabatic)
    said.push_back(
        text("Bases follow from the optical depth of adiabatic clouds of %.3g droplets "
             "per cm3 (Brenguier et al. 2000).",
             options_.droplets_per_m3 / 1e6));
  else if (!given(kBaseHeight))
    said.push_back(
        text("Bases follow from water path over water content, %.3g g/m3 of liquid and "
             "%.3g of ice (Hutchison 2002).",
             options_.liquid_content_kg_per_m3 * 1e3, options_.ice_content_kg_per_m3 * 1e3));
  said.push_back(options_.profile == Profile::kUniform
                     ? "Extinction is the same from base to top."
                     : "Extinction goes as the height over the base to the power 2/3.");
  said.push_back(
      "Heights above sea level are taken as above the ellipsoid: the geoid lies 107 m below to 86 "
      "m "
      "above it.");
}

void RasterForecast::state() {
  state_depth();
  state_heights();
  auto& facts = raster_.facts;
  std::string names;
  for (const auto& [quantity, field] : raster_.fields) {
    const auto missing =
        std::ranges::count_if(field, [](float value) { return std::isnan(value); });
    names += (names.empty() ? "" : ", ") + std::string(kind_of(quantity).word);
    if (missing > 0)
      names += text(" (%.3g %% missing)", 100 * double(missing) / double(field.size()));
  }
  facts.push_back("Raster: " + names + ".");
  facts.push_back(
      text("Optical depth of a column: up to %.4g, mean %.4g; cloud in %.3g %% of the "
           "cells.",
           deepest_, mean_depth_, 100 * double(cloudy_) / double(cells())));
  if (without_top_ > 0)
    facts.push_back(std::to_string(without_top_) +
                    " columns have optical depth and no height: no cloud there.");
}

}  // namespace

void check_values(const Raster& raster) {
  for (const auto& [quantity, field] : raster.fields) {
    const QuantityKind& kind = kind_of(quantity);
    // Packing and interpolation leave traces below zero, which count as none.
    const double slack = 0.02 * (kind.high - kind.low);
    for (const float value : field)
      if (double(value) < kind.low - slack || double(value) > kind.high)
        throw Error({"no cloud has such a value", raster.path,
                     text("%s from %.4g to %.4g in SI", kind.word, kind.low, kind.high),
                     text("%.5g", double(value)),
                     "the unit may be wrong, or a value that means nothing is not declared as "
                     "nodata; --force draws it as it is"});
  }
}

std::unique_ptr<Forecast> make_raster_forecast(Raster raster, const RasterOptions& options,
                                               bool force) {
  return std::make_unique<RasterForecast>(std::move(raster), options, force);
}

}  // namespace nepho::forecast
