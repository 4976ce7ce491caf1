#include "forecast/rasters/quantity.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/error.h"

namespace nepho::forecast {
namespace {

using enum CloudQuantity;
constexpr Dimension kPath{.m = -2, .kg = 1};

// Optical depths of models reach some hundreds; 50 kg/m2 is twice what a hailstorm holds.
constexpr std::array<QuantityKind, 10> kKinds = {{
    {kOpticalDepth, "optical_depth", kDimensionless, "1", 0, 1000},
    {kLiquidPath, "liquid_path", kPath, "g m-2", 0, 50},
    {kIcePath, "ice_path", kPath, "g m-2", 0, 50},
    {kWaterPath, "water_path", kPath, "g m-2", 0, 50},
    {kCover, "cover", kDimensionless, "1 or %", 0, 1.001},
    {kTopHeight, "top_height", kLength, "m", -500, 30000},
    {kTopPressure, "top_pressure", kPressure, "hPa", 500, 110000},
    {kTopTemperature, "top_temperature", kTemperature, "K", 150, 330},
    {kBaseHeight, "base_height", kLength, "m", -500, 30000},
    {kEffectiveRadius, "effective_radius", kLength, "um", 0, 300e-6},
}};

struct Name {
  CloudQuantity quantity;
  const char* name;
};

// CF standard names (table 85), then short names of products: CM SAF, CERES, MODIS, VIIRS, ABI,
// SEVIRI, models' column fields.
// Water in kg/kg on levels has the same names (cloud_water): the unit tells them apart.
constexpr std::array kNames = std::to_array<Name>(
    {{kOpticalDepth, "atmosphere_optical_thickness_due_to_cloud"},
     {kOpticalDepth, "cloud_optical_depth"},
     {kOpticalDepth, "cloud_optical_thickness"},
     {kOpticalDepth, "optical_thickness"},
     {kOpticalDepth, "cot"},
     {kOpticalDepth, "cod"},
     {kOpticalDepth, "tau"},
     {kLiquidPath, "atmosphere_mass_content_of_cloud_liquid_water"},
     {kLiquidPath, "cloud_liquid_water_path"},
     {kLiquidPath, "liquid_water_path"},
     {kLiquidPath, "total_column_cloud_liquid_water"},
     {kLiquidPath, "lwp"},
     {kLiquidPath, "clwp"},
     {kLiquidPath, "tclw"},
     {kLiquidPath, "tqc"},
     {kIcePath, "atmosphere_mass_content_of_cloud_ice"},
     {kIcePath, "cloud_ice_water_path"},
     {kIcePath, "ice_water_path"},
     {kIcePath, "total_column_cloud_ice_water"},
     {kIcePath, "iwp"},
     {kIcePath, "ciwp"},
     {kIcePath, "tciw"},
     {kIcePath, "tqi"},
     {kIcePath, "clivi"},
     {kWaterPath, "atmosphere_mass_content_of_cloud_condensed_water"},
     {kWaterPath, "atmosphere_cloud_condensed_water_content"},
     {kWaterPath, "cloud_water_path"},
     {kWaterPath, "cloud_water"},
     {kWaterPath, "cwp"},
     {kWaterPath, "clwvi"},
     {kCover, "cloud_area_fraction"},
     {kCover, "cloud_fraction"},
     {kCover, "cloud_cover"},
     {kCover, "total_cloud_cover"},
     {kCover, "clt"},
     {kCover, "tcc"},
     {kCover, "cfc"},
     {kTopHeight, "cloud_top_altitude"},
     {kTopHeight, "height_at_cloud_top"},
     {kTopHeight, "geopotential_height_at_cloud_top"},
     {kTopHeight, "cloud_top_height"},
     {kTopHeight, "cth"},
     {kTopPressure, "air_pressure_at_cloud_top"},
     {kTopPressure, "cloud_top_pressure"},
     {kTopPressure, "ctp"},
     {kTopTemperature, "air_temperature_at_cloud_top"},
     {kTopTemperature, "cloud_top_temperature"},
     {kTopTemperature, "ctt"},
     {kBaseHeight, "cloud_base_altitude"},
     {kBaseHeight, "cloud_base_height"},
     {kBaseHeight, "cbh"},
     {kEffectiveRadius, "effective_radius_of_cloud_condensed_water_particles_at_cloud_top"},
     {kEffectiveRadius,
      "effective_radius_of_cloud_liquid_water_particle_at_liquid_water_cloud_top"},
     {kEffectiveRadius, "cloud_effective_radius"},
     {kEffectiveRadius, "cloud_particle_effective_radius"},
     {kEffectiveRadius, "cer"},
     {kEffectiveRadius, "reff"}});

std::string folded(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool word = std::isalnum(static_cast<unsigned char>(c));
    if (word)
      text += char(std::tolower(static_cast<unsigned char>(c)));
    else if (!text.empty() && text.back() != '_')
      text += '_';
  }
  while (text.ends_with('_')) text.pop_back();
  return text;
}

}  // namespace

const QuantityKind& kind_of(CloudQuantity quantity) {
  return *std::ranges::find(kKinds, quantity, &QuantityKind::quantity);
}

std::optional<CloudQuantity> quantity_named(const std::string& name) {
  const std::string wanted = folded(name);
  for (const QuantityKind& kind : kKinds)
    if (wanted == kind.word) return kind.quantity;
  for (const Name& known : kNames)
    if (wanted == known.name) return known.quantity;
  return std::nullopt;
}

std::string quantity_words() {
  std::string text;
  for (const QuantityKind& kind : kKinds)
    text += (text.empty() ? "" : ", ") + std::string(kind.word);
  return text;
}

Unit unit_for(CloudQuantity quantity, const std::string& unit, const std::string& where,
              const std::string& cure) {
  const QuantityKind& kind = kind_of(quantity);
  const std::string expected = std::string(kind.word) + " in a unit such as " + kind.usual_unit;
  if (unit.empty()) {
    if (quantity == kOpticalDepth) return Unit{};
    throw Error({"the raster's values have no unit", where, expected, "none", cure});
  }
  Unit parsed;
  try {
    parsed = parse_unit(unit);
  } catch (const Error&) {
    throw Error({"the raster's unit is not known", where, expected, "\"" + unit + "\"", cure});
  }
  if (parsed.dimension != kind.dimension)
    throw Error(
        {"the raster's unit is of another quantity", where, expected, "\"" + unit + "\"", cure});
#ifdef NEPHO_MUTANT_RASTER_UNITS
  parsed.factor *= parsed.dimension == kPath ? 1000 : 1;
#endif
  return parsed;
}

}  // namespace nepho::forecast
