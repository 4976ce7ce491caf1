#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/module_support.h"
#include "forecast/rasters/quantity.h"

namespace nepho::forecast {

// How a column's optical depth lies between base and top, and how thick a cloud is where nobody
// says:
//   uniform    the same extinction all the way. Thickness is water path over water content
//              (Hutchison 2002, Int. J. Remote Sensing 23, 5249)
//   adiabatic  droplets of one number, their water rising with height over the base, so that
//              extinction goes as its power 2/3 (Brenguier et al. 2000,
//              doi:10.1175/1520-0469(2000)057<0803:RPOBLC>2.0.CO;2); thickness is that of the
//              column's optical depth. Liquid only: ice stays uniform
enum class Profile { kUniform, kAdiabatic };

enum class RasterPhase { kByTemperature, kLiquid, kIce };

// What a user may state of a raster of clouds. Parameters, all optional:
//   bands                    "optical_depth,top_height km,-": what each band of the files in a row
//                            is, with its unit; - is left out, and so are the rest
//   cloud_base_m, cloud_top_m, cloud_thickness_m   over the sea; in place of what a raster says
//   cloud_optical_depth      of all cloudy columns, where no band holds one
//   cloud_profile            uniform | adiabatic
//   cloud_phase              by_temperature (ice where tops are below -28 degC) | liquid | ice
//   liquid_radius_m, ice_radius_m                         effective radii (10 and 30 um)
//   liquid_content_kg_per_m3, ice_content_kg_per_m3       water in a cloud (0.3 and 0.05 g/m3)
//   droplets_per_m3          of an adiabatic cloud (1e8)
struct RasterOptions {
  struct Band {
    std::optional<CloudQuantity> quantity;  // empty: left out
    std::string unit;
  };
  std::vector<Band> bands;  // empty: what the files say
  std::optional<double> base_m, top_m, thickness_m, optical_depth;
  Profile profile = Profile::kUniform;
  RasterPhase phase = RasterPhase::kByTemperature;
  double liquid_radius_m = 10e-6, ice_radius_m = 30e-6;
  double liquid_content_kg_per_m3 = 0.3e-3, ice_content_kg_per_m3 = 0.05e-3;
  double droplets_per_m3 = 1e8;
  bool stated = false;  // bands, heights or a depth: of no use to clouds on levels
};

// Throws Error on what is no quantity, and on base, top and thickness together.
RasterOptions raster_options(Parameters& parameters);

}  // namespace nepho::forecast
