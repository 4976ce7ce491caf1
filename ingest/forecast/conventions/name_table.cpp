// Names of models as data. Sources: CF standard names 85; WRF Users' Guide; CM1's netcdf writer;
// SAM's write_fields3D and com3D2nc; UCLA-LES's ncio; DALES's modfielddump; PALM's list of output
// quantities; ICON's and COSMO's GRIB tables; ECMWF's parameter database.
#include "forecast/conventions/name_table.h"

#include <algorithm>
#include <array>

#include "forecast/conventions/names.h"

namespace nepho::forecast {
namespace {

using enum Quantity;
constexpr auto kReal = Evidence::kReal, kMade = Evidence::kMade;
#ifdef NEPHO_MUTANT_MARKED
constexpr auto kNone = Evidence::kMade;
#else
constexpr auto kNone = Evidence::kNone;
#endif
constexpr auto kDry = Basis::kDryAir, kMoist = Basis::kMoistAir, kVolume = Basis::kVolume;
constexpr const char* kAny = kAnyModel;

constexpr NameRow part_of(NameRow row) {
  row.part = true;
  return row;
}
constexpr NameRow only_there(NameRow row) {
  row.only_there = true;
  return row;
}
constexpr NameRow both_phases(NameRow row, double all_ice_K, double all_liquid_K) {
  row.all_ice_K = all_ice_K;
  row.all_liquid_K = all_liquid_K;
  return row;
}

// Khairoutdinov & Randall (2003), doi:10.1175/1520-0469(2003)060<0607:CRMOTA>2.0.CO;2: cloud and
// precipitation of SAM with one moment.
constexpr double kSamIce_K = 253.16, kSamWater_K = 273.16, kSamSnow_K = 268.16, kSamRain_K = 283.16;
constexpr double kIce_K = kWholeCondensateFreezes_K;

constexpr NameRow kTable[] = {
    // Cloud water
    {kCloudWater, kAny, "", "mass_fraction_of_cloud_liquid_water_in_air", kMade},
    {kCloudWater, kAny, "", "mass_fraction_of_stratiform_cloud_liquid_water_in_air"},
    {kCloudWater, kAny, "", "cloud_liquid_water_mixing_ratio", kNone, kDry},
    {kCloudWater, kAny, "", "cloud_water_mixing_ratio", kNone, kDry},
    {kCloudWater, kAny, "", "mass_concentration_of_cloud_liquid_water_in_air", kMade, kVolume},
    {kCloudWater, "WRF", "qcloud", "", kReal, kDry},
    both_phases({kCloudWater, "GFS", "clwmr", "", kReal, kDry}, kIce_K, kIce_K),
    {kCloudWater, "ICON", "clw", "", kReal},
    {kCloudWater, "IFS", "clwc", "", kMade},
    {kCloudWater, "AROME", "specific_cloud_liquid_water_content", ""},
    {kCloudWater, "CM1", "qc", "", kMade, kDry},
    {kCloudWater, "SAM", "qc", "", kMade},
    {kCloudWater, "PALM", "qc", "", kMade},
    {kCloudWater, "COSMO", "qc", "", kMade},
    {kCloudWater, kAny, "qc", "", kMade},
    {kCloudWater, "CAM", "cldliq", ""},
    part_of({kCloudWater, "UM", "mr_lsliq", "", kReal}),
    part_of({kCloudWater, "UM", "mr_ccliq", "", kReal}),
    {kCloudWater, kAny, "cloud_water_mixing_ratio", "", kNone, kDry},
    {kCloudWater, kAny, "cloud_water", ""},
    both_phases(only_there({kCloudWater, "SAM", "qn", "", kMade}), kSamIce_K, kSamWater_K),
    only_there({kCloudWater, "UCLA-LES", "l", "", kMade}),
    // Its netCDF files hold kg/kg under the unit of its binary ones, 1e-5kg/kg.
    {kCloudWater, "DALES", "ql", "", kMade, kMoist, "kg kg-1"},
    {kCloudWater, "PALM", "ql", "", kMade},
    {kCloudWater, "MicroHH", "ql", "", kMade},
    {kCloudWater, kAny, "ql", "", kMade},
    {kCloudWater, kAny, "lwc", "", kMade, kVolume},
    both_phases({kCloudWater, "AROME", "", "mass_fraction_of_cloud_condensed_water_in_air", kMade},
                kIce_K, kIce_K),
    // Cloud ice
    {kCloudIce, kAny, "", "mass_fraction_of_cloud_ice_in_air", kMade},
    {kCloudIce, kAny, "", "mass_fraction_of_stratiform_cloud_ice_in_air"},
    {kCloudIce, kAny, "", "cloud_ice_mixing_ratio", kNone, kDry},
    {kCloudIce, kAny, "", "mass_concentration_of_cloud_ice_in_air", kNone, kVolume},
    {kCloudIce, "WRF", "qice", "", kMade, kDry},
    {kCloudIce, "GFS", "icmr", "", kMade, kDry},
    {kCloudIce, "ICON", "cli", "", kReal},
    {kCloudIce, "IFS", "ciwc", "", kMade},
    {kCloudIce, "AROME", "specific_cloud_ice_water_content", ""},
    {kCloudIce, "CM1", "qi", "", kMade, kDry},
    {kCloudIce, "SAM", "qi", "", kMade},
    {kCloudIce, "PALM", "qi", ""},
    {kCloudIce, "COSMO", "qi", "", kMade},
    {kCloudIce, "MicroHH", "qi", ""},
    {kCloudIce, kAny, "qi", "", kMade},
    {kCloudIce, "CAM", "cldice", ""},
    part_of({kCloudIce, "UM", "mr_lsice", "", kReal}),
    part_of({kCloudIce, "UM", "mr_ccice", "", kReal}),
    only_there({kCloudIce, "UCLA-LES", "i", ""}),
    {kCloudIce, kAny, "iwc", "", kNone, kVolume},
    // Rain
    {kRain, kAny, "", "mass_fraction_of_rain_in_air", kMade},
    {kRain, "WRF", "qrain", "", kReal, kDry},
    {kRain, "GFS", "rwmr", "", kMade, kDry},
    {kRain, "IFS", "crwc", "", kMade},
    {kRain, "ICON", "qr", "", kReal},
    {kRain, "CM1", "qr", "", kMade, kDry},
    {kRain, "SAM", "qr", ""},
    {kRain, "PALM", "qr", "", kMade},
    {kRain, "DALES", "qr", "", kMade, kMoist, "kg kg-1"},
    {kRain, "MicroHH", "qr", "", kMade},
    {kRain, "COSMO", "qr", "", kMade},
    {kRain, kAny, "qr", "", kMade},
    both_phases(only_there({kRain, "SAM", "qp", "", kMade}), kSamSnow_K, kSamRain_K),
    only_there({kRain, "UCLA-LES", "r", "", kMade}),
    // Snow
    {kSnow, kAny, "", "mass_fraction_of_snow_in_air", kMade},
    {kSnow, "WRF", "qsnow", "", kMade, kDry},
    {kSnow, "GFS", "snmr", "", kMade, kDry},
    {kSnow, "IFS", "cswc", "", kMade},
    {kSnow, "ICON", "qs", "", kReal},
    {kSnow, "CM1", "qs", "", kMade, kDry},
    {kSnow, "SAM", "qs", ""},
    {kSnow, "COSMO", "qs", "", kMade},
    {kSnow, "MicroHH", "qs", ""},
    {kSnow, kAny, "qs", "", kMade},
    only_there({kSnow, "UCLA-LES", "s", ""}),
    // Graupel
    {kGraupel, kAny, "", "mass_fraction_of_graupel_in_air", kMade},
    {kGraupel, "WRF", "qgraup", "", kMade, kDry},
    {kGraupel, "GFS", "grle", "", kMade, kDry},
    {kGraupel, "CM1", "qg", "", kMade, kDry},
    {kGraupel, "SAM", "qg", ""},
    {kGraupel, "COSMO", "qg", "", kMade},
    {kGraupel, "MicroHH", "qg", ""},
    {kGraupel, kAny, "qg", "", kMade},
    only_there({kGraupel, "UCLA-LES", "rgrp", ""}),
    // Cloud fraction
    {kCloudFraction, kAny, "", "cloud_area_fraction_in_atmosphere_layer", kMade},
    {kCloudFraction, "WRF", "cldfra", ""},
    {kCloudFraction, "IFS", "cc", "", kMade},
    {kCloudFraction, "ICON", "clc", "", kReal},
    {kCloudFraction, "CMIP", "cl", ""},
    {kCloudFraction, "UM", "tca", "", kReal},
    {kCloudFraction, kAny, "cloud_fraction", ""},
    {kCloudFraction, kAny, "ccov", ""},
    {kCloudFraction, kAny, "clct", ""},
    // Sizes
    {kDropletNumber, kAny, "", "number_concentration_of_cloud_liquid_water_particles_in_air",
     kMade},
    {kDropletNumber, "ICON", "qnc", "", kReal},
    {kDropletNumber, "WRF", "qncloud", "", kMade},
    {kDropletNumber, "WRF", "qndrop", ""},
    {kDropletNumber, kAny, "nc", "", kMade},
    {kDropletRadius, kAny, "", "effective_radius_of_cloud_liquid_water_particles", kMade},
    {kDropletRadius, kAny, "", "effective_radius_of_stratiform_cloud_liquid_water_particles"},
    {kDropletRadius, kAny, "", "effective_radius_of_cloud_liquid_water_particle"},
    {kDropletRadius, kAny, "", "effective_radius_of_stratiform_cloud_liquid_water_particle"},
    {kDropletRadius, "WRF", "re_cloud", "", kMade},
    {kDropletRadius, "SAM", "rel", "", kMade},
    {kDropletRadius, "ICON", "reff_qc", ""},
    {kDropletRadius, "CM1", "effc", ""},
    {kIceRadius, kAny, "", "effective_radius_of_cloud_ice_particles", kMade},
    {kIceRadius, kAny, "", "effective_radius_of_stratiform_cloud_ice_particles"},
    {kIceRadius, "WRF", "re_ice", "", kMade},
    {kIceRadius, "SAM", "rei", "", kMade},
    {kIceRadius, "ICON", "reff_qi", ""},
    {kIceRadius, "CM1", "effi", ""},
    // Names that mean something else
    only_there({kOther, "UCLA-LES", "q", "", kMade}),  // all water, vapour and liquid
    only_there({kOther, "UCLA-LES", "n", "", kMade}),  // number of raindrops
    only_there({kOther, "PALM", "p", "", kMade}),      // deviation from the base state
    only_there({kOther, "PALM", "q", "", kMade}),      // all water
    // Temperature
    only_there({kLiquidPotentialTemperature, "UCLA-LES", "t", "", kMade}),
    {kTemperature, kAny, "", "air_temperature", kMade},
    {kTemperature, kAny, "", "air_temperature_at_full_level_center", kReal},
    {kTemperature, kAny, "t", "", kReal},
    {kTemperature, kAny, "ta", "", kReal},
    {kTemperature, kAny, "temp", ""},
    {kTemperature, kAny, "temperature", ""},
    {kTemperature, "UM", "t_abs", "", kReal},
    {kTemperature, kAny, "tk", ""},
    {kTemperature, "SAM", "tabs", "", kMade},
    {kTemperature, "GFS", "tmp", "", kMade},
    {kPotentialTemperature, kAny, "", "air_potential_temperature", kMade},
    {kPotentialTemperature, "CM1", "th", "", kMade},
    {kPotentialTemperature, "PALM", "theta", "", kMade},
    {kPotentialTemperature, "PALM", "pt", ""},
    {kPotentialTemperature, kAny, "theta", "", kMade},
    {kPotentialTemperature, kAny, "th0", ""},
    {kPotentialTemperature, kAny, "theta0", "", kMade},
    {kLiquidPotentialTemperature, "DALES", "thl", "", kMade},
    {kLiquidPotentialTemperature, "MicroHH", "thl", "", kMade},
    {kLiquidPotentialTemperature, "PALM", "thetal", ""},
    {kLiquidPotentialTemperature, kAny, "thl", "", kMade},
    // Pressure and density: fields, or one number per level
    {kPressure, kAny, "", "air_pressure", kMade},
    {kPressure, kAny, "", "air_pressure_at_full_level_center", kReal},
    {kPressure, kAny, "pres", "", kReal},
    {kPressure, "UM", "pfull", "", kReal},
    {kPressure, "SAM", "p", "", kMade},
    {kPressure, "UCLA-LES", "p", "", kMade},
    {kPressure, kAny, "p", "", kMade},
    {kPressure, kAny, "pressure", ""},
    {kPressure, kAny, "pa", ""},
    {kPressure, "CM1", "prs", "", kMade},
    {kPressure, "DALES", "presh", ""},
    {kPressure, kAny, "p0", "", kMade},
    {kDensity, kAny, "", "air_density", kMade},
    {kDensity, "UCLA-LES", "dn0", "", kMade},
    {kDensity, "DALES", "rhof", ""},
    {kDensity, "DALES", "rhobf", ""},
    {kDensity, "MicroHH", "rhoref", "", kMade},
    {kDensity, "PALM", "rho_air", "", kMade},
    {kDensity, "CM1", "rho", ""},
    {kDensity, kAny, "rho", ""},
    {kDensity, kAny, "rho0", ""},
    {kSurfacePressure, kAny, "", "surface_air_pressure", kMade},
    {kSurfacePressure, kAny, "ps", "", kReal},
    {kSurfacePressure, kAny, "psfc", "", kReal},
    {kSurfacePressure, kAny, "sp", ""},
    {kSurfacePressure, kAny, "pressfc", ""},
    {kSurfacePressure, kAny, "surface_pressure", ""},
    {kSurfacePressure, kAny, "psurf", ""},
    {kLogSurfacePressure, kAny, "", "logarithm_of_surface_pressure"},
    {kLogSurfacePressure, kAny, "", "logarithm_of_surface_air_pressure"},
    {kLogSurfacePressure, kAny, "lnsp", ""},
    {kLogSurfacePressure, kAny, "lsp", ""},
    {kLogSurfacePressure, kAny, "lnps", ""},
    // Vapour
    {kSpecificHumidity, kAny, "", "specific_humidity", kMade},
    {kSpecificHumidity, kAny, "", "specific_humidity_at_full_level_center", kReal},
    {kSpecificHumidity, kAny, "q", "", kMade},
    {kSpecificHumidity, kAny, "hus", "", kReal},
    {kSpecificHumidity, kAny, "spfh", ""},
    {kSpecificHumidity, kAny, "huss", ""},
    {kSpecificHumidity, kAny, "shum", ""},
    only_there({kVapourMixingRatio, "CM1", "qv", "", kMade}),
    {kSpecificHumidity, kAny, "qv", "", kReal},
    {kVapourMixingRatio, kAny, "", "humidity_mixing_ratio"},
    {kVapourMixingRatio, "WRF", "qvapor", "", kReal},
    {kVapourMixingRatio, kAny, "mixr", ""},
    {kVapourMixingRatio, kAny, "rv", ""},
    {kRelativeHumidity, kAny, "", "relative_humidity"},
    {kRelativeHumidity, kAny, "r", "", kReal},
    {kRelativeHumidity, kAny, "rh", "", kReal},
    {kRelativeHumidity, kAny, "hur", ""},
    {kRelativeHumidity, kAny, "relhum", ""},
    // Ground
    {kTerrain, kAny, "", "surface_altitude", kMade},
    {kTerrain, kAny, "", "surface_height", kReal},
    {kTerrain, kAny, "", "height_above_sea_level"},
    {kTerrain, "WRF", "hgt", "", kReal},
    {kTerrain, "GFS", "hgtsfc", ""},
    {kTerrain, kAny, "orog", ""},
    {kTerrain, "UM", "orography", "", kReal},
    {kTerrain, "ICON", "topography_c", "", kReal},
    {kTerrain, "COSMO", "hsurf", ""},
    {kTerrain, "CM1", "zs", ""},
    {kTerrain, kAny, "terrain", ""},
    {kTerrain, kAny, "topo", ""},
    {kTerrain, kAny, "topography", ""},
    {kTerrain, kAny, "phis_height", ""},
    {kSurfaceGeopotential, kAny, "", "surface_geopotential"},
    {kSurfaceGeopotential, kAny, "phis", ""},
    {kSurfaceGeopotential, kAny, "fis", ""},
    {kSurfaceGeopotential, "IFS", "z", ""},
    {kSurfaceGeopotential, kAny, "z_surf", ""},
    {kSurfaceGeopotential, kAny, "geosp", ""},
    {kLandFraction, kAny, "", "land_area_fraction", kReal},
    {kLandFraction, kAny, "", "land_binary_mask"},
    {kLandFraction, "UM", "landmask", "", kReal},
    {kLandFraction, kAny, "lsm", "", kMade},
    {kLandFraction, "ICON", "fr_land", "", kReal},
    {kLandFraction, kAny, "land", ""},
    {kLandFraction, "CMIP", "sftlf", ""},
    {kLandFraction, "CAM", "landfrac", ""},
    // Heights
    {kHalfLevelHeight, kAny, "", "geometric_height_at_half_level_center", kReal},
    {kHalfLevelHeight, kAny, "", "geometric_height_at_half_level"},
    {kHalfLevelHeight, "ICON", "z_ifc", "", kReal},
    {kHalfLevelHeight, "COSMO", "hhl", "", kMade},
    {kHalfLevelHeight, kAny, "zhalf", ""},
    {kHalfLevelHeight, kAny, "z_w", ""},
    {kHalfLevelHeight, kAny, "height_interface", ""},
    {kFullLevelHeight, kAny, "", "altitude", kMade},
    {kFullLevelHeight, kAny, "", "geometric_height_at_full_level_center", kReal},
    {kFullLevelHeight, kAny, "", "height_above_mean_sea_level"},
    {kFullLevelHeight, kAny, "", "height_above_geopotential_datum"},
    {kFullLevelHeight, kAny, "", "height"},
    {kFullLevelHeight, "ICON", "z_mc", "", kReal},
    {kFullLevelHeight, "UM", "height", "", kReal},
    {kFullLevelHeight, kAny, "zfull", ""},
    {kFullLevelHeight, kAny, "altitude", ""},
    {kFullLevelHeight, kAny, "zg_geometric", ""},
    {kFullLevelHeight, "COSMO", "hfl", ""},
    {kFullLevelHeight, kAny, "z3d", ""},
    {kFullLevelHeight, kAny, "height_full", ""},
    {kGeopotentialHeight, kAny, "", "geopotential_height"},
    {kGeopotentialHeight, kAny, "gh", "", kReal},
    {kGeopotentialHeight, "CMIP", "zg", ""},
    {kGeopotentialHeight, "CAM", "z3", ""},
    {kGeopotentialHeight, "GFS", "hgt", ""},
    {kGeopotentialHeight, kAny, "geopotential_height", ""},
    {kGeopotential, kAny, "", "geopotential"},
    {kGeopotential, "IFS", "z", ""},
    {kGeopotential, kAny, "phi", ""},
    {kGeopotential, kAny, "geopotential", ""},
    {kGeopotential, "COSMO", "fi", ""},
    // Places
    {kLatitude, kAny, "", "latitude", kReal},
    {kLatitude, kAny, "lat", "", kReal},
    {kLatitude, kAny, "latitude", "", kReal},
    {kLatitude, "WRF", "xlat", "", kReal},
    {kLatitude, kAny, "nav_lat", ""},
    {kLatitude, kAny, "tlat", ""},
    {kLatitude, "ICON", "clat", "", kReal},
    {kLatitude, kAny, "lats", ""},
    {kLongitude, kAny, "", "longitude", kReal},
    {kLongitude, kAny, "lon", "", kReal},
    {kLongitude, kAny, "longitude", "", kReal},
    {kLongitude, "WRF", "xlong", "", kReal},
    {kLongitude, kAny, "nav_lon", ""},
    {kLongitude, kAny, "tlon", ""},
    {kLongitude, "ICON", "clon", "", kReal},
    {kLongitude, kAny, "lons", ""}};

constexpr std::array<const char*, kQuantities> kWords = {"cloud_water",
                                                         "rain",
                                                         "cloud_ice",
                                                         "snow",
                                                         "graupel",
                                                         "cloud_fraction",
                                                         "droplet_number",
                                                         "droplet_radius",
                                                         "ice_radius",
                                                         "temperature",
                                                         "potential_temperature",
                                                         "liquid_potential_temperature",
                                                         "pressure",
                                                         "density",
                                                         "surface_pressure",
                                                         "log_surface_pressure",
                                                         "specific_humidity",
                                                         "vapour_mixing_ratio",
                                                         "relative_humidity",
                                                         "terrain",
                                                         "surface_geopotential",
                                                         "land_fraction",
                                                         "half_level_height",
                                                         "level_height",
                                                         "geopotential_height",
                                                         "geopotential",
                                                         "latitude",
                                                         "longitude",
                                                         "other"};

// One way to know a model by: a word in any of the file's usual attributes of origin, or variables
// and dimensions that no other has together.
struct Mark {
  const char* model;
  const char* word;
  std::array<const char*, 3> holds = {};  // variables or dimensions, all of them
};
constexpr Mark kMarks[] = {{"WRF", "WRF"},
                           {"WRF", nullptr, {"PHB", "bottom_top_stag"}},
                           {"PALM", "PALM"},
                           {"PALM", nullptr, {"zu_3d"}},
                           {"MicroHH", "MicroHH"},
                           {"UCLA-LES", "UCLA"},
                           {"UCLA-LES", nullptr, {"dn0", "zt", "xt"}},
                           {"DALES", "DALES"},
                           {"DALES", nullptr, {"thl", "zt", "xt"}},
                           {"DALES", nullptr, {"ql", "zt", "xt"}},
                           {"SAM", nullptr, {"TABS"}},
                           {"CM1", "CM1"},
                           {"CM1", nullptr, {"prs", "th", "zh"}},
                           {"UM", "Unified Model"},
                           {"UM", nullptr, {"mr_lsliq"}},
                           {"ICON", "ICON"},
                           {"ICON", nullptr, {"z_ifc", "z_mc"}},
                           {"AROME", "AROME"},
                           {"AROME", "HARMONIE"},
                           {"COSMO", "COSMO"},
                           {"GFS", "GFS"},
                           {"IFS", "ECMWF"},
                           {"IFS", "Integrated Forecast"}};

bool holds(const DataFile& file, const std::string& name) {
  return file.find(name) || std::ranges::find(file.dimensions(), name, &FileDimension::name) !=
                                file.dimensions().end();
}

}  // namespace

std::span<const NameRow> name_table() {
  return kTable;
}

const char* word_of(Quantity quantity) {
  return kWords[std::size_t(quantity)];
}

std::string model_of_file(const DataFile& file) {
  std::string origin;
  for (const char* attribute : {"TITLE", "title", "source", "model", "Model", "institution"})
    origin += file.text(attribute) + "\n";
  if (!file.text("CM1 version").empty()) return "CM1";
  for (const Mark& mark : kMarks) {
    if (mark.word ? origin.find(mark.word) != std::string::npos
                  : std::ranges::all_of(
                        mark.holds, [&](const char* name) { return !name || holds(file, name); }))
      return mark.model;
  }
  return "";
}

}  // namespace nepho::forecast
