#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "nc_writer.h"

namespace nepho::forecast::test {

// A WRF file on its Mercator map (true latitude 0, sphere of 6370 km), with a nest that moves by
// some cells a time.
struct WrfTwin {
  int nx = 6, ny = 5, nz = 4, nt = 2;
  double dx_m = 10000, west_m = 0, south_m = 2500000;  // of the first centre, from 90 W 0 N
  int moves = 1, first_h = 12, step_h = 3;
  bool flat = false;
  bool with_xlat = true, with_ice = true;
  bool with_kinds = false, with_number = false, with_radii = false;  // all water; its sizes
  int scheme = 8;
  double shift_deg = 0;  // of XLONG against the map
  double cloud = 5e-4;   // QCLOUD of cell (2, 1), layer 1, time 0; twice that at time 1
  std::function<double(int t, int k, int j, int i)> water;  // QCLOUD instead, where there is one

  static constexpr double kRadius_m = 6370000, kDegree = 0.017453292519943295;
  double latitude(int t, double j) const {  // j in centres
    const double y = (j + t * moves) * dx_m + south_m;
    return (2 * std::atan(std::exp(y / kRadius_m)) - M_PI / 2) / kDegree;
  }
  double longitude(double i) const { return -90 + (i * dx_m + west_m) / kRadius_m / kDegree; }
  double terrain_m(int i, int j) const { return flat ? 0 : 100.0 * i + 10 * j; }
  // Geopotential of interface k, base and perturbation in one.
  double phi(int k, int i, int j) const {
    return 9.81 * (terrain_m(i, j) + 300.0 * k + 50.0 * k * k);
  }

  std::string write(const std::string& name) const {
    const std::string path = folder() / (name + ".nc");
    NcWriter nc(path);
    const auto n = [](int size) { return std::size_t(size); };
    nc.dimension("Time", n(nt));
    nc.dimension("DateStrLen", 19);
    nc.dimension("west_east", n(nx));
    nc.dimension("south_north", n(ny));
    nc.dimension("bottom_top", n(nz));
    nc.dimension("bottom_top_stag", n(nz) + 1);
    nc.global("TITLE", std::string(" OUTPUT FROM WRF V4.2 MODEL"));
    for (const auto& [key, value] :
         std::map<std::string, double>{{"MAP_PROJ", 3},
                                       {"TRUELAT1", 0},
                                       {"TRUELAT2", 0},
                                       {"STAND_LON", -90},
                                       {"DX", dx_m},
                                       {"DY", dx_m},
                                       {"MP_PHYSICS", scheme},
                                       {"CEN_LAT", latitude(0, 0.5 * (ny - 1))},
                                       {"CEN_LON", longitude(0.5 * (nx - 1))}})
      nc.global(key, value);
    std::string times;
    for (int t = 0; t < nt; ++t)
      times += "2005-08-28_" + std::to_string(first_h + step_h * t) + ":00:00";
    nc.text("Times", {"Time", "DateStrLen"}, times);
    const auto put = [&](const char* variable, int levels, const char* units, auto value) {
      std::vector<double> values;
      for (int t = 0; t < nt; ++t)
        for (int k = 0; k < std::max(levels, 1); ++k)
          for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) values.push_back(value(t, k, j, i));
      std::vector<std::string> dimensions = {"Time", "south_north", "west_east"};
      if (levels > 0)
        dimensions.insert(dimensions.begin() + 1, levels == nz ? "bottom_top" : "bottom_top_stag");
      nc.variable(variable, NC_FLOAT, dimensions, values, {{"units", std::string(units)}});
    };
    if (with_xlat) {
      put("XLAT", 0, "degree_north", [&](int t, int, int j, int) { return latitude(t, j); });
      put("XLONG", 0, "degree_east",
          [&](int, int, int, int i) { return longitude(i) + shift_deg; });
    }
    put("HGT", 0, "m", [&](int, int, int j, int i) { return terrain_m(i, j); });
    put("LANDMASK", 0, "", [&](int, int, int, int i) { return i < 3 ? 1.0 : 0.0; });
    put("PHB", nz + 1, "m2 s-2", [&](int, int k, int j, int i) { return phi(k, i, j) - 7; });
    put("PH", nz + 1, "m2 s-2", [&](int, int, int, int) { return 7.0; });
    put("PB", nz, "Pa", [&](int, int k, int, int) { return 95000.0 - 5000 * k; });
    put("P", nz, "Pa", [&](int, int, int, int) { return 100.0; });
    put("T", nz, "K", [&](int, int k, int, int) { return -5.0 + k; });
    put("QVAPOR", nz, "kg kg-1", [&](int, int, int, int) { return 0.008; });
    put("QCLOUD", nz, "kg kg-1", [&](int t, int k, int j, int i) {
      if (water) return water(t, k, j, i);
      return k == 1 && j == 1 && i == 2 ? cloud * (t + 1) : -7.9e-14;
    });
    if (with_ice)
      put("QICE", nz, "kg kg-1",
          [&](int, int k, int j, int i) { return k == 3 && j == 3 && i == 4 ? 1e-5 : 0; });
    const auto in = [](int cell) {
      return [cell](int, int k, int j, int i) { return k == 1 && j == 2 && i == cell ? 1e-4 : 0; };
    };
    const auto same = [](double value) { return [value](int, int, int, int) { return value; }; };
    if (with_kinds) {
      put("QRAIN", nz, "kg kg-1", in(1));
      put("QSNOW", nz, "kg kg-1", in(2));
      put("QGRAUP", nz, "kg kg-1", in(3));
    }
    if (with_number) put("QNCLOUD", nz, "  kg(-1)", same(2e8));
    if (with_radii) {
      put("RE_CLOUD", nz, "m", same(12e-6));
      put("RE_ICE", nz, "m", same(55e-6));
    }
    return path;
  }
};

}  // namespace nepho::forecast::test
