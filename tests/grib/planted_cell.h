#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grib_twin.h"

namespace nepho::grib::test {

// One cell with cloud on a grid of GRIB.
struct Case {
  std::string name;
  int edition;
  std::size_t points;
  Keys grid;
  double cell_deg;                      // size of a cell
  bool any_scan = true, placed = true;  // by ecCodes, too
};

inline constexpr int kNx = 12, kNy = 9;

inline Keys lat_lon(const char* type, double step, double lat, double lon) {
  return {{"gridType", type},
          {"Ni", kNx},
          {"Nj", kNy},
          {"iDirectionIncrementInDegrees", step},
          {"jDirectionIncrementInDegrees", step},
          {"latitudeOfFirstGridPointInDegrees", lat},
          {"longitudeOfFirstGridPointInDegrees", lon},
          {"latitudeOfLastGridPointInDegrees", lat - step * (kNy - 1)},
          {"longitudeOfLastGridPointInDegrees", std::fmod(lon + step * (kNx - 1), 360)}};
}

inline Keys with(Keys keys, const Keys& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

inline Keys map(const char* type, double lat, double lon, const Keys& more) {
  return with({{"gridType", type},
               {"Nx", kNx},
               {"Ny", kNy},
               {"latitudeOfFirstGridPointInDegrees", lat},
               {"longitudeOfFirstGridPointInDegrees", lon}},
              more);
}

// Water in one point of the message, on three levels.
struct Planted {
  std::string path;
  Made::Place place;
};
inline Planted plant(const Case& c, std::size_t at, const Keys& scan) {
  Planted planted;
  std::string bytes;
  for (const double hPa : {900.0, 800.0, 700.0})
    for (const char* name : {"clwmr", "t", "gh"}) {
      Made made(c.edition, c.grid);
      if (c.edition == 2) made.set({{"numberOfDataPoints", long(c.points)}});
      made.set(scan);
      made.set(parameter(c.edition, name)).set(isobaric(c.edition, hPa)).set(at_hour(c.edition, 0));
      made.set({{"bitsPerValue", 16}});
      std::vector<double> values(c.points, name[0] == 't'   ? GribTwin::temperature_K(hPa)
                                           : name[0] == 'g' ? GribTwin::geopotential_height_m(hPa)
                                                            : 0);
      if (name[0] == 'c') {
        values[at] = 1e-3;
        made.values(values);
        for (const Made::Place& p : c.placed ? made.places() : std::vector<Made::Place>{})
          if (p.value > 5e-4) planted.place = p;
      } else {
        made.values(values);
      }
      bytes += made.bytes();
    }
  planted.path = write_bytes(c.name + ".grib", bytes);
  return planted;
}

inline double distance_deg(double lat1, double lon1, double lat2, double lon2) {
  const double d = std::numbers::pi / 180;
  const double a = std::sin(0.5 * (lat1 - lat2) * d), b = std::sin(0.5 * (lon1 - lon2) * d);
  return 2 / d * std::asin(std::sqrt(a * a + std::cos(lat1 * d) * std::cos(lat2 * d) * b * b));
}

// Where the one column with cloud stands.
inline glm::dvec2 column_place(const forecast::Forecast& forecast) {
  const forecast::ForecastColumns c = forecast.columns(0);
  int found = -1, count = 0;
  for (int n = 0; n < c.nx * c.ny; ++n) {
    double sum = 0;
    for (int k = 0; k < c.nz; ++k) sum += double(c.extinction_per_m[std::size_t(n * c.nz + k)]);
    if (sum > 1e-4) {
      found = n;
      ++count;
    }
  }
  EXPECT_EQ(count, 1);
  return forecast.grid(0)->lat_lon_deg(found % c.nx + 0.5, found / c.nx + 0.5);
}

}  // namespace nepho::grib::test
