#pragma once

#include <cmath>

namespace nepho::test {

// The closed-form weather that made files hold, whatever their format.
struct TwinWeather {
  // kg/kg; zero in half of the columns.
  static double water(double lat, double lon, double hPa, double hour) {
    const double turn = std::fmod(lon + 720, 360);
    if (std::fmod(turn / 20, 2) >= 1) return 0;
    return 2e-4 * (1 + lat / 100) * (1 + turn / 1000) * (hPa / 1000) * (1 + hour / 100);
  }
  static double temperature_K(double hPa) { return 288 - 60 * (1 - hPa / 1000); }
  static double geopotential_height_m(double hPa) { return 7500 * std::log(1013.25 / hPa); }
};

}  // namespace nepho::test
