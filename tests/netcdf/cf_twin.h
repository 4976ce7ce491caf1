#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "nc_writer.h"
#include "twin_weather.h"

namespace nepho::forecast::test {

// A small CF forecast whose every value is a formula of its place, written in any of the ways that
// models have: what is read must not depend on them.
struct CfTwin : nepho::test::TwinWeather {
  std::vector<double> latitude = {-30, -10, 10, 30, 50};
  std::vector<double> longitude = {100, 120, 140, 160, 180, 200};
  std::vector<double> pressure_hPa = {1000, 900, 700, 500};
  std::vector<double> hours = {0, 6};
  std::string order = "tzyx", water_units = "kg kg-1", level_units = "hPa";
  std::string water_name = "clw", time_units = "hours since 2020-03-01 00:00:00";
  double water_scale = 1, level_scale = 1;  // written = SI times this (levels: hPa times this)
  int type = NC_FLOAT, format = NC_NETCDF4;
  bool packed = false, with_time = true;
  // Groups ("model/") of the dimensions, of the coordinate variables, of the fields.
  std::string dimensions_in, axes_in, fields_in;
  // What else to write into the file, before its variables.
  std::function<void(NcWriter&)> more = [](NcWriter&) {};
  double fill = NAN;  // water where the column is at index 0 of both axes

  template <class Value>
  std::vector<double> field(Value value) const {
    const std::string o = with_time ? order : std::string(order).erase(order.find('t'), 1);
    const auto size = [&](char axis) {
      return axis == 't'   ? hours.size()
             : axis == 'z' ? pressure_hPa.size()
             : axis == 'y' ? latitude.size()
                           : longitude.size();
    };
    std::vector<double> values;
    std::vector<std::size_t> at(o.size(), 0);
    const auto index = [&](char axis) {
      const auto found = o.find(axis);
      return found == std::string::npos ? std::size_t{0} : at[found];
    };
    std::size_t total = 1;
    for (const char axis : o) total *= size(axis);
    for (std::size_t n = 0; n < total; ++n) {
      std::size_t rest = n;
      for (std::size_t d = o.size(); d-- > 0; rest /= size(o[d])) at[d] = rest % size(o[d]);
      values.push_back(value(index('t'), index('z'), index('y'), index('x')));
    }
    return values;
  }

  std::string write(const std::string& name) const {
    const std::string path = folder() / (name + ".nc");
    NcWriter nc(path, format);
    const std::string time = dimensions_in + "time", level = dimensions_in + "level",
                      lat = dimensions_in + "lat", lon = dimensions_in + "lon";
    nc.dimension(time, hours.size());
    nc.dimension(level, pressure_hPa.size());
    nc.dimension(lat, latitude.size());
    nc.dimension(lon, longitude.size());
    more(nc);
    if (with_time) nc.variable(axes_in + "time", NC_DOUBLE, {time}, hours, {{"units", time_units}});
    std::vector<double> levels = pressure_hPa;
    for (double& p : levels) p *= level_scale;
    nc.variable(axes_in + "level", NC_DOUBLE, {level}, levels, {{"units", level_units}});
    nc.variable(axes_in + "lat", NC_DOUBLE, {lat}, latitude, {{"units", "degrees_north"}});
    nc.variable(axes_in + "lon", NC_DOUBLE, {lon}, longitude, {{"units", "degrees_east"}});
    std::vector<std::string> dimensions;
    for (const char axis : order)
      if (axis != 't' || with_time)
        dimensions.push_back(axis == 't' ? time : axis == 'z' ? level : axis == 'y' ? lat : lon);
    const auto put = [&](const char* variable, const char* units, auto value) {
      nc.variable(fields_in + variable, NC_FLOAT, dimensions, field(value),
                  {{"units", std::string(units)}});
    };
    put("t", "K", [&](auto, auto z, auto, auto) { return temperature_K(pressure_hPa[z]); });
    put("gh", "gpm",
        [&](auto, auto z, auto, auto) { return geopotential_height_m(pressure_hPa[z]); });
    std::vector<double> water_values = field([&](auto t, auto z, auto y, auto x) {
      if (!std::isnan(fill) && y == 0 && x == 0) return fill;
      return water_scale * water(latitude[y], longitude[x], pressure_hPa[z], hours[t]);
    });
    Attributes attributes;
    if (!water_units.empty()) attributes["units"] = water_units;
    if (packed) {  // as grib_to_netcdf: zero lands near, not on, zero
      const double scale = 1.2e-8, offset = 3.7e-4 + 1e-19;
      attributes["scale_factor"] = scale;
      attributes["add_offset"] = offset;
      attributes["_FillValue"] = -32767.0;
      for (double& v : water_values) v = std::round((v - offset) / scale);
    } else if (!std::isnan(fill)) {
      attributes["_FillValue"] = fill;
    }
    nc.variable(fields_in + water_name, packed ? NC_SHORT : type, dimensions, water_values,
                attributes);
    return path;
  }
};

}  // namespace nepho::forecast::test
