#include "sources/grib/parameter_table.h"

#include <algorithm>

namespace nepho::grib {
namespace {

using Evidence = forecast::Evidence;
constexpr auto kReal = Evidence::kReal, kMade = Evidence::kMade, kNone = Evidence::kNone;
constexpr const char* kAny = forecast::kAnyModel;
constexpr const char* kLayerFraction = "cloud_area_fraction_in_atmosphere_layer";

// GRIB2 tables 4.2: specific contents are per mass of moist air, mixing ratios per dry air.
constexpr ParameterRow kGrib2[] = {
    {0, 0, 0, "t", "air_temperature", "K", false, kAny, kReal},
    {0, 1, 0, "q", "specific_humidity", "kg kg-1", false, kAny, kMade},
    {0, 1, 1, "r", "relative_humidity", "%", false, kAny, kReal},
    {0, 1, 2, "mixr", "humidity_mixing_ratio", "kg kg-1", false, kAny, kMade},
    {0, 1, 22, "clwmr", "", "kg kg-1", true, "GFS", kReal},
    {0, 1, 23, "icmr", "", "kg kg-1", true, "GFS", kMade},
    {0, 1, 24, "rwmr", "", "kg kg-1", true, "GFS", kMade},
    {0, 1, 25, "snmr", "", "kg kg-1", true, "GFS", kMade},
    {0, 1, 32, "grle", "", "kg kg-1", true, "GFS", kMade},
    {0, 1, 82, "icmr", "", "kg kg-1", true, "GFS", kMade},
    {0, 1, 83, "clwc", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1", true, "IFS", kMade},
    {0, 1, 84, "ciwc", "mass_fraction_of_cloud_ice_in_air", "kg kg-1", true, "IFS", kMade},
    {0, 1, 85, "crwc", "mass_fraction_of_rain_in_air", "kg kg-1", true, "IFS", kMade},
    {0, 1, 86, "cswc", "mass_fraction_of_snow_in_air", "kg kg-1", true, "IFS", kMade},
    {0, 6, 1, "tcc", kLayerFraction, "%", false, kAny, kReal},
    {0, 6, 22, "clc", kLayerFraction, "%", false, "COSMO", kMade},
    {0, 6, 23, "icmr", "", "kg kg-1", true, "GFS", kMade},
    {0, 6, 28, "qndrop", "", "kg-1", false, kAny, kMade},
    {0, 6, 30, "qndrop", "number_concentration_of_cloud_liquid_water_particles_in_air", "m-3",
     false, kAny, kMade},
    {0, 6, 32, "cc", kLayerFraction, "1", false, "IFS", kMade},
    {0, 6, 38, "lwc", "mass_concentration_of_cloud_liquid_water_in_air", "kg m-3", true, kAny,
     kMade},
    {0, 6, 39, "iwc", "mass_concentration_of_cloud_ice_in_air", "kg m-3", true, kAny, kMade},
    {0, 3, 0, "pres", "air_pressure", "Pa", false, kAny, kReal},
    {0, 3, 4, "z", "geopotential", "m2 s-2", false, kAny, kMade},
    {0, 3, 5, "gh", "geopotential_height", "gpm", false, kAny, kReal},
    {0, 3, 6, "altitude", "altitude", "m", false, kAny, kMade},
    {0, 3, 25, "lnsp", "", "1", false, kAny, kMade},
    {2, 0, 0, "lsm", "", "1", false, kAny, kReal},
    {0, 191, 1, "clat", "", "degrees_north", false, "ICON", kMade},
    {0, 191, 2, "clon", "", "degrees_east", false, "ICON", kMade},
};

// DWD's names of the same numbers: contents per moist air (COSMO documentation part II; ICON).
constexpr ParameterRow kGrib2Dwd[] = {{0, 1, 22, "qc", "", "kg kg-1", true, "COSMO", kMade},
                                      {0, 1, 82, "qi", "", "kg kg-1", true, "COSMO", kMade},
                                      {0, 1, 24, "qr", "", "kg kg-1", true, "COSMO", kMade},
                                      {0, 1, 25, "qs", "", "kg kg-1", true, "COSMO", kMade},
                                      {0, 1, 32, "qg", "", "kg kg-1", true, "COSMO", kMade}};

// Tables of centres first, the WMO's table (numbers below 128) last.
constexpr ParameterRow kGrib1[] = {
    // ECMWF, table 128
    {98, 128, 54, "pres", "air_pressure", "Pa", false, "IFS", kMade},
    {98, 128, 75, "crwc", "mass_fraction_of_rain_in_air", "kg kg-1", true, "IFS", kMade},
    {98, 128, 76, "cswc", "mass_fraction_of_snow_in_air", "kg kg-1", true, "IFS", kMade},
    {98, 128, 129, "z", "geopotential", "m2 s-2", false, "IFS", kMade},
    {98, 128, 130, "t", "air_temperature", "K", false, "IFS", kMade},
    {98, 128, 133, "q", "specific_humidity", "kg kg-1", false, "IFS", kMade},
    {98, 128, 134, "pres", "air_pressure", "Pa", false, "IFS", kNone},
    {98, 128, 152, "lnsp", "", "1", false, "IFS", kMade},
    {98, 128, 156, "gh", "geopotential_height", "gpm", false, "IFS", kMade},
    {98, 128, 157, "r", "relative_humidity", "%", false, "IFS", kMade},
    {98, 128, 172, "lsm", "", "1", false, "IFS", kMade},
    {98, 128, 246, "clwc", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1", true, "IFS",
     kMade},
    {98, 128, 247, "ciwc", "mass_fraction_of_cloud_ice_in_air", "kg kg-1", true, "IFS", kMade},
    {98, 128, 248, "cc", kLayerFraction, "1", false, "IFS", kMade},
    // NCEP, table 2 (Office Note 388)
    {7, 2, 153, "clwmr", "", "kg kg-1", true, "GFS", kMade},
    {7, 2, 170, "rwmr", "", "kg kg-1", true, "GFS", kMade},
    {7, 2, 171, "snmr", "", "kg kg-1", true, "GFS", kMade},
    {7, 2, 178, "icmr", "", "kg kg-1", true, "GFS", kMade},
    {7, 2, 179, "grle", "", "kg kg-1", true, "GFS", kMade},
    // COSMO, table 201
    {-1, 201, 29, "clc", kLayerFraction, "%", false, "COSMO", kMade},
    {-1, 201, 31, "qc", "", "kg kg-1", true, "COSMO", kMade},
    {-1, 201, 33, "qi", "", "kg kg-1", true, "COSMO", kMade},
    {-1, 201, 35, "qr", "", "kg kg-1", true, "COSMO", kMade},
    {-1, 201, 36, "qs", "", "kg kg-1", true, "COSMO", kMade},
    {-1, 201, 39, "qg", "", "kg kg-1", true, "COSMO", kMade},
    // HIRLAM and HARMONIE, table 253: contents, where they are on levels
    {-1, 253, 58, "ciwc", "mass_fraction_of_cloud_ice_in_air", "kg kg-1", true, "HARMONIE", kMade},
    {-1, 253, 76, "clwc", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1", true, "HARMONIE",
     kMade},
    {-1, 253, 181, "crwc", "mass_fraction_of_rain_in_air", "kg kg-1", true, "HARMONIE", kMade},
    {-1, 253, 184, "cswc", "mass_fraction_of_snow_in_air", "kg kg-1", true, "HARMONIE", kMade},
    {-1, 253, 201, "grle", "mass_fraction_of_graupel_in_air", "kg kg-1", true, "HARMONIE", kMade},
    // All: the numbers that every table shares
    {-1, -1, 1, "pres", "air_pressure", "Pa", false, kAny, kMade},
    {-1, -1, 6, "z", "geopotential", "m2 s-2", false, kAny, kMade},
    {-1, -1, 7, "gh", "geopotential_height", "gpm", false, kAny, kMade},
    {-1, -1, 8, "altitude", "altitude", "m", false, kAny, kMade},
    {-1, -1, 11, "t", "air_temperature", "K", false, kAny, kMade},
    {-1, -1, 51, "q", "specific_humidity", "kg kg-1", false, kAny, kMade},
    {-1, -1, 52, "r", "relative_humidity", "%", false, kAny, kMade},
    {-1, -1, 53, "mixr", "humidity_mixing_ratio", "kg kg-1", false, kAny, kMade},
    {-1, -1, 81, "lsm", "", "1", false, kAny, kMade},
};

const ParameterRow* find(std::span<const ParameterRow> rows, long a, long b, long c) {
  const auto fits = [](int wanted, long is) { return wanted < 0 || wanted == is; };
  const auto at = std::ranges::find_if(
      rows, [&](const ParameterRow& r) { return fits(r.a, a) && fits(r.b, b) && r.c == c; });
  return at == rows.end() ? nullptr : &*at;
}

bool uses_dwd_names(long centre) {
  return centre == 78 || centre == 215 || centre == 250;  // DWD, MeteoSwiss, the COSMO consortium
}

}  // namespace

std::span<const ParameterRow> parameter_table(int edition) {
  return edition == 2 ? std::span<const ParameterRow>(kGrib2)
                      : std::span<const ParameterRow>(kGrib1);
}
std::span<const ParameterRow> parameter_table_of_dwd() {
  return kGrib2Dwd;
}

const ParameterRow* parameter_row(const Codes& codes) {
  if (codes.edition == 2) {
    if (uses_dwd_names(codes.centre))
      if (const ParameterRow* row = find(kGrib2Dwd, codes.a, codes.b, codes.c)) return row;
    return find(kGrib2, codes.a, codes.b, codes.c);
  }
  // Below 128 tables of version 128 and more are a centre's own, but for those that keep the WMO's.
  const bool shared = codes.b < 128 || codes.b == 253;
  const ParameterRow* row = find(kGrib1, codes.a, codes.b, codes.c);
  return row && row->b < 0 && !shared ? nullptr : row;
}

std::string text_of(const ParameterRow& row) {
  return std::string(row.name) + " by the number " + std::to_string(row.a) + "/" +
         std::to_string(row.b) + "/" + std::to_string(row.c) + " of " + row.model;
}

}  // namespace nepho::grib
