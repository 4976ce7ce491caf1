#pragma once

#include <memory>
#include <optional>

#include "grib_writer.h"
#include "twin_weather.h"

namespace nepho::grib::test {

// A small forecast on latitudes and longitudes whose every value is a formula of its place, written
// in any of the ways that centres have: what is read must not depend on them.
struct GribTwin : nepho::test::TwinWeather {
  int edition = 2;
  std::vector<double> latitude = {-30, -10, 10, 30, 50};
  std::vector<double> longitude = {100, 120, 140, 160, 180, 200};
  std::vector<double> pressure_hPa = {1000, 900, 700, 500};
  std::vector<long> hours = {0, 6};
  // Flags of the scan.
  bool west = false, north = false, columns = false, alternating = false;
  std::string packing = "grid_simple";
  long bits = 24;
  std::optional<double> missing_hPa;  // a level without water
  double missing_at = NAN;            // a latitude without values

  // Points of the file's order, by the flags' own meaning (WMO flag table 3.4).
  template <class Value>
  std::vector<double> scanned(Value value) const {
    const std::size_t nx = longitude.size(), ny = latitude.size();
    std::vector<double> values(nx * ny);
    for (std::size_t n = 0; n < values.size(); ++n) {
      std::size_t slow = n / (columns ? ny : nx), fast = n % (columns ? ny : nx);
      if (alternating && slow % 2 == 1) fast = (columns ? ny : nx) - 1 - fast;
      const std::size_t i = columns ? slow : fast, j = columns ? fast : slow;
      values[n] = value(latitude[north ? j : ny - 1 - j], longitude[west ? nx - 1 - i : i]);
    }
    return values;
  }

  Keys grid() const {
    const auto lat = std::pair(latitude.front(), latitude.back());
    const auto lon = std::pair(longitude.front(), longitude.back());
    const auto turn = [](double degrees) { return std::fmod(degrees + 360, 360); };
    Keys keys = {{"gridType", "regular_ll"},
                 {"Ni", long(longitude.size())},
                 {"Nj", long(latitude.size())},
                 {"latitudeOfFirstGridPointInDegrees", north ? lat.first : lat.second},
                 {"latitudeOfLastGridPointInDegrees", north ? lat.second : lat.first},
                 {"longitudeOfFirstGridPointInDegrees", turn(west ? lon.second : lon.first)},
                 {"longitudeOfLastGridPointInDegrees", turn(west ? lon.first : lon.second)},
                 {"iDirectionIncrementInDegrees", longitude[1] - longitude[0]},
                 {"jDirectionIncrementInDegrees", latitude[1] - latitude[0]},
                 {"iScansNegatively", int(west)},
                 {"jScansPositively", int(north)},
                 {"jPointsAreConsecutive", int(columns)}};
    if (edition == 2) {
      keys.insert(keys.begin() + 3,
                  Key("numberOfDataPoints", long(longitude.size() * latitude.size())));
      keys.emplace_back("alternativeRowScanning", int(alternating));
    }
    return keys;
  }

  template <class Value>
  std::string message(const char* name, double hPa, long hour, Value value) const {
    Made made(edition, grid());
    made.set(parameter(edition, name)).set(isobaric(edition, hPa)).set(at_hour(edition, hour));
    made.set({{"bitsPerValue", bits}});
    if (packing != "grid_simple") made.set({{"packingType", packing.c_str()}});
    made.values(scanned(value));
    return made.bytes();
  }

  std::string all(long hour) const {
    std::string bytes;
    for (const double hPa : pressure_hPa) {
      bytes += message("t", hPa, hour, [&](double, double) { return temperature_K(hPa); });
      bytes += message("gh", hPa, hour, [&](double, double) { return geopotential_height_m(hPa); });
      if (missing_hPa == hPa) continue;
      bytes += message("clwmr", hPa, hour, [&](double lat, double lon) {
        return lat == missing_at ? NAN : water(lat, lon, hPa, double(hour));
      });
    }
    return bytes;
  }

  std::string write(const std::string& name) const {
    std::string bytes;
    for (const long hour : hours) bytes += all(hour);
    return write_bytes(name, bytes);
  }
};

// A variable of a file, all of it.
inline std::vector<double> all_of(const GribFile& file, const std::string& name) {
  const forecast::FileVariable* variable = file.find(name);
  if (!variable) throw std::runtime_error("no variable " + name);
  return file.read_all(*variable);
}

}  // namespace nepho::grib::test
