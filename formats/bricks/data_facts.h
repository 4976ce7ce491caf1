#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace nepho {

// What the data behind a source hold at one time, worked out from them without bricks: what
// `nephoscope info` tells, and what it checks bricks against. NaN: not known.

struct DataVariable {
  std::string name, meaning, unit;                        // "QCLOUD", "cloud water", "kg kg-1"
  double low = std::numeric_limits<double>::quiet_NaN();  // of values that are there, in `unit`
  double high = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t values = 0, missing = 0, negative = 0;
};

struct DataFacts {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  // A layer is cloud from this extinction on, and a column cloudy from this optical depth on.
  static constexpr double kCloud_per_m = 1e-5, kCloudyDepth = 0.1;

  struct Recognised {
    std::string what, text;  // "grid", "144 x 73 cells, axes lat, lon"
  };
  struct Amount {
    double mean = kUnknown, max = kUnknown;  // of columns, the mean by area
  };

  std::vector<Recognised> recognised;
  std::vector<DataVariable> variables;  // water, in the order in which it is added up
  std::uint64_t columns = 0;
  double area_m2 = kUnknown;  // of all columns, on the ellipsoid
  Amount liquid_kg_per_m2, ice_kg_per_m2, precipitation_kg_per_m2, optical_depth;
  double cover = kUnknown;                                    // cloudy columns' share of the area
  double lowest_base_m = kUnknown, highest_top_m = kUnknown;  // of cloud in any column
  double mean_base_m = kUnknown, mean_top_m = kUnknown;       // of cloudy columns
  double data_bottom_m = kUnknown, data_top_m = kUnknown;     // where the layers end
  double cut_share = kUnknown;  // of cloudy columns: their topmost layer is cloud
  // Sum of extinction times volume, as bricks should have it.
  double extinction_m2 = kUnknown;
};

}  // namespace nepho
