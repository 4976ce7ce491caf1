#include "forecast/conventions/names.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "units/parse_unit.h"

namespace nepho::forecast {
namespace names {

const VariableNames kTemperature = {{"air_temperature", "air_temperature_at_full_level_center"},
                                    {"t", "ta", "temp", "temperature", "T_abs", "tk", "TABS", "tmp"}};
const VariableNames kPressure = {{"air_pressure", "air_pressure_at_full_level_center"},
                                 {"pres", "p", "pfull", "pressure", "pa"}};
const VariableNames kSurfacePressure = {
    {"surface_air_pressure"}, {"ps", "psfc", "sp", "pressfc", "surface_pressure", "psurf"}};
const VariableNames kLogSurfacePressure = {
    {"logarithm_of_surface_pressure", "logarithm_of_surface_air_pressure"},
    {"lnsp", "lsp", "lnps"}};
const VariableNames kSpecificHumidity = {
    {"specific_humidity", "specific_humidity_at_full_level_center"},
    {"q", "qv", "hus", "spfh", "huss", "shum"}};
const VariableNames kVapourMixingRatio = {{"humidity_mixing_ratio"}, {"qvapor", "mixr", "rv"}};
const VariableNames kRelativeHumidity = {{"relative_humidity"}, {"r", "rh", "hur", "relhum"}};
const VariableNames kCloudFraction = {
    {"cloud_area_fraction_in_atmosphere_layer", "clc"},
    {"cldfra", "cc", "clc", "cl", "tca", "cloud_fraction", "ccov", "clct"}};
const VariableNames kDropletNumber = {
    {"number_concentration_of_cloud_liquid_water_particles_in_air", "qnc"},
    {"qnc", "qncloud", "qndrop", "nc"}};
const VariableNames kTerrain = {{"surface_altitude", "surface_height", "height_above_sea_level"},
                                {"hgt", "hgtsfc", "orog", "orography", "topography_c", "hsurf", "zs",
                                 "terrain", "topo", "topography", "phis_height"}};
const VariableNames kSurfaceGeopotential = {{"surface_geopotential"},
                                            {"phis", "fis", "z", "z_surf", "geosp"}};
const VariableNames kLandFraction = {{"land_area_fraction", "land_binary_mask"},
                                     {"landmask", "lsm", "fr_land", "land", "sftlf", "landfrac"}};
const VariableNames kHalfLevelHeight = {
    {"geometric_height_at_half_level_center", "geometric_height_at_half_level"},
    {"z_ifc", "hhl", "zhalf", "z_w", "height_interface"}};
const VariableNames kFullLevelHeight = {
    {"altitude", "geometric_height_at_full_level_center", "height_above_mean_sea_level",
     "height_above_geopotential_datum", "height"},
    {"z_mc", "height", "zfull", "altitude", "zg_geometric", "hfl", "z3d", "height_full"}};
const VariableNames kGeopotentialHeight = {{"geopotential_height"},
                                           {"gh", "zg", "z3", "hgt", "geopotential_height"}};
const VariableNames kGeopotential = {{"geopotential"}, {"z", "phi", "geopotential", "fi"}};
const VariableNames kLatitude = {{"latitude"},
                                 {"lat", "latitude", "xlat", "nav_lat", "tlat", "clat", "lats"}};
const VariableNames kLongitude = {{"longitude"},
                                  {"lon", "longitude", "xlong", "nav_lon", "tlon", "clon", "lons"}};

}  // namespace names

namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// One way in which a kind of water is written. Rows of a kind are tried in order; within a row, all
// variables of `names` add up (large-scale and convective parts).
struct WaterNames {
  Species species;
  std::vector<std::string> standard_names, names;
  Basis basis;  // of a ratio; contents per volume tell themselves by their unit
};

const std::vector<WaterNames>& water_table() {
  using enum Species;
  static const std::vector<WaterNames> table = {
      {kCloudWater,
       {"mass_fraction_of_cloud_liquid_water_in_air",
        "mass_fraction_of_stratiform_cloud_liquid_water_in_air"},
       {},
       Basis::kMoistAir},
      {kCloudWater,
       {"cloud_liquid_water_mixing_ratio", "cloud_water_mixing_ratio"},
       {},
       Basis::kDryAir},
      {kCloudWater, {"mass_concentration_of_cloud_liquid_water_in_air"}, {}, Basis::kVolume},
      {kCloudWater, {}, {"qcloud"}, Basis::kDryAir},
      {kCloudWater, {}, {"clwmr"}, Basis::kDryAir},
      {kCloudWater, {}, {"clw"}, Basis::kMoistAir},
      {kCloudWater, {}, {"clwc"}, Basis::kMoistAir},
      {kCloudWater, {}, {"specific_cloud_liquid_water_content"}, Basis::kMoistAir},
      {kCloudWater, {}, {"qc"}, Basis::kMoistAir},
      {kCloudWater, {}, {"cldliq"}, Basis::kMoistAir},
      {kCloudWater, {}, {"mr_lsliq", "mr_ccliq"}, Basis::kMoistAir},
      {kCloudWater, {}, {"cloud_water_mixing_ratio"}, Basis::kDryAir},
      {kCloudWater, {}, {"cloud_water"}, Basis::kMoistAir},
      {kCloudWater, {}, {"ql"}, Basis::kMoistAir},
      {kCloudWater, {}, {"lwc"}, Basis::kVolume},
      {kCloudWater, {"mass_fraction_of_cloud_condensed_water_in_air"}, {}, Basis::kMoistAir},
      {kCloudIce,
       {"mass_fraction_of_cloud_ice_in_air", "mass_fraction_of_stratiform_cloud_ice_in_air"},
       {},
       Basis::kMoistAir},
      {kCloudIce, {"cloud_ice_mixing_ratio"}, {}, Basis::kDryAir},
      {kCloudIce, {"mass_concentration_of_cloud_ice_in_air"}, {}, Basis::kVolume},
      {kCloudIce, {}, {"qice"}, Basis::kDryAir},
      {kCloudIce, {}, {"icmr"}, Basis::kDryAir},
      {kCloudIce, {}, {"cli"}, Basis::kMoistAir},
      {kCloudIce, {}, {"ciwc"}, Basis::kMoistAir},
      {kCloudIce, {}, {"specific_cloud_ice_water_content"}, Basis::kMoistAir},
      {kCloudIce, {}, {"qi"}, Basis::kMoistAir},
      {kCloudIce, {}, {"cldice"}, Basis::kMoistAir},
      {kCloudIce, {}, {"mr_lsice", "mr_ccice"}, Basis::kMoistAir},
      {kCloudIce, {}, {"iwc"}, Basis::kVolume},
      {kRain, {"mass_fraction_of_rain_in_air"}, {}, Basis::kMoistAir},
      {kRain, {}, {"qrain"}, Basis::kDryAir},
      {kRain, {}, {"rwmr"}, Basis::kDryAir},
      {kRain, {}, {"crwc"}, Basis::kMoistAir},
      {kRain, {}, {"qr"}, Basis::kMoistAir},
      {kSnow, {"mass_fraction_of_snow_in_air"}, {}, Basis::kMoistAir},
      {kSnow, {}, {"qsnow"}, Basis::kDryAir},
      {kSnow, {}, {"snmr"}, Basis::kDryAir},
      {kSnow, {}, {"cswc"}, Basis::kMoistAir},
      {kSnow, {}, {"qs"}, Basis::kMoistAir},
      {kGraupel, {"mass_fraction_of_graupel_in_air"}, {}, Basis::kMoistAir},
      {kGraupel, {}, {"qgraup"}, Basis::kDryAir},
      {kGraupel, {}, {"grle"}, Basis::kDryAir},
      {kGraupel, {}, {"qg"}, Basis::kMoistAir}};
  return table;
}

bool answers(const FileVariable& variable, const std::vector<std::string>& standard_names,
             const std::vector<std::string>& names) {
  const std::string standard = lower(variable.text("standard_name")), name = lower(variable.name);
  return std::ranges::find(standard_names, standard) != standard_names.end() ||
         std::ranges::find(names, name, lower) != names.end();
}

// The factor to kg/kg, or to kg/m3 with Basis::kVolume.
WaterVariable water_variable(const DataFile& file, const FileVariable& variable,
                             const WaterNames& row) {
  const std::string unit = variable.text("units");
  const auto refuse = [&](const char* what, const std::string& found) {
    throw Error({what, file.where(variable), "units such as kg kg-1, g/kg or g m-3", found,
                 "set the attribute `units`, for example with ncatted -a units," + variable.name +
                     ",o,c,\"kg kg-1\""});
  };
  if (unit.empty()) refuse("the variable has no units", "no attribute `units`");
  Unit parsed;
  try {
    parsed = parse_unit(unit);
  } catch (const Error&) {
    refuse("the variable's units are not known", "\"" + unit + "\"");
  }
  WaterVariable result{row.species, &variable, row.basis, parsed.factor, 0};
#ifdef NEPHO_MUTANT_UNITS_1000
  result.to_si = 1;
#endif
  if (parsed.dimension == kDensity) {
    result.basis = Basis::kVolume;
  } else if (parsed.dimension != kDimensionless) {
    refuse("the variable's units are no water content", "\"" + unit + "\"");
  } else if (result.basis == Basis::kVolume) {
    result.basis = Basis::kMoistAir;
  }
  return result;
}

// A vertical sum (kg m-2), whatever it is called, is no field of water.
bool is_column(const FileVariable& variable) {
  try {
    return parse_unit(variable.text("units")).dimension == Dimension{.m = -2, .kg = 1};
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

const FileVariable* find_named(const DataFile& file, const VariableNames& wanted,
                               const std::function<bool(const FileVariable&)>& accept) {
  for (const std::string& standard : wanted.standard_names)
    for (const FileVariable& variable : file.variables())
      if (variable.text("standard_name") == standard && accept(variable)) return &variable;
  for (const std::string& name : wanted.names)
    for (const FileVariable& variable : file.variables())
      if (lower(variable.name) == lower(name) && accept(variable)) return &variable;
  return nullptr;
}

std::vector<WaterVariable> find_water(const DataFile& file,
                                      const std::function<bool(const FileVariable&)>& accept) {
  std::vector<WaterVariable> found;
  for (const WaterNames& row : water_table()) {
    const bool known = std::ranges::any_of(
        found, [&](const WaterVariable& w) { return w.species == row.species; });
    if (known) continue;
    for (const FileVariable& variable : file.variables())
      if (variable.numeric && answers(variable, row.standard_names, row.names) &&
          accept(variable) && !is_column(variable)) {
        found.push_back(water_variable(file, variable, row));
        if (row.names.empty()) break;  // one of a standard name's variants
      }
  }
  return found;
}

namespace {

// Short enough for one message: standard names are told by their pattern.
std::string known_water_names() {
  std::string text;
  for (const WaterNames& row : water_table()) {
    if (row.species != Species::kCloudWater && row.species != Species::kCloudIce) continue;
    for (const std::string& name : row.names) text += (text.empty() ? "" : ", ") + name;
  }
  return text + ", or a standard_name mass_fraction_of_cloud_liquid_water_in_air or its like";
}

constexpr std::size_t kMostNames = 12;  // of a file with hundreds of variables

}  // namespace

bool is_whole_condensate(const WaterVariable& water) {
  return lower(water.variable->name) == "clwmr" ||
         water.variable->text("standard_name") == "mass_fraction_of_cloud_condensed_water_in_air";
}

void require_water(const DataFile& file, const std::vector<WaterVariable>& water) {
  if (!water.empty()) return;
  std::string found;
  std::size_t count = 0;
  for (const FileVariable& variable : file.variables())
    if (variable.numeric && variable.dimensions.size() >= 3 && ++count <= kMostNames)
      found += (found.empty() ? "" : ", ") + file.shape_text(variable);
  if (count > kMostNames) found += " and " + std::to_string(count - kMostNames) + " more";
  throw Error({"there is no cloud water on levels in this file", file.path(),
               "one of " + known_water_names(),
               found.empty() ? "no variable of three dimensions" : found,
               "vertical sums (kg m-2) and satellite pictures are no forecast"});
}

}  // namespace nepho::forecast
