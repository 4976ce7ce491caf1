#include "forecast/conventions/dimension_roles.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "core/error.h"
#include "forecast/conventions/names.h"
#include "forecast/conventions/vertical.h"
#include "forecast/files/file_time.h"

namespace nepho::forecast {
namespace {

enum class Role { kUnknown, kTime, kLevel, kY, kX, kCells };

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool any_of(const std::string& text, const std::vector<std::string>& words) {
  return std::ranges::find(words, text) != words.end();
}

bool starts(const std::string& text, const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [&](const std::string& w) { return text.starts_with(w); });
}

bool is_north(const std::string& unit) {
  return any_of(unit,
                {"degrees_north", "degree_north", "degree_N", "degrees_N", "degreeN", "degreesN"});
}
bool is_east(const std::string& unit) {
  return any_of(unit,
                {"degrees_east", "degree_east", "degree_E", "degrees_E", "degreeE", "degreesE"});
}

Role of_coordinate(const FileVariable& axis) {
  const std::string unit = axis.text("units"), standard = axis.text("standard_name");
  const std::string letter = axis.text("axis");
  if (is_time_unit(unit) || letter == "T" || standard == "time") return Role::kTime;
  if (is_north(unit) || letter == "Y" ||
      any_of(standard, {"latitude", "grid_latitude", "projection_y_coordinate",
                        "projection_y_angular_coordinate"}))
    return Role::kY;
  if (is_east(unit) || letter == "X" ||
      any_of(standard, {"longitude", "grid_longitude", "projection_x_coordinate",
                        "projection_x_angular_coordinate"}))
    return Role::kX;
  if (letter == "Z" || !axis.text("positive").empty() || unit_of(axis, kPressure).fits ||
      any_of(standard, {"height", "altitude", "air_pressure", "model_level_number"}) ||
      standard.starts_with("atmosphere_"))
    return Role::kLevel;
  return Role::kUnknown;
}

Role of_letter(char axis) {
  return axis == 'T' ? Role::kTime : axis == 'Z' ? Role::kLevel : axis == 'Y' ? Role::kY : Role::kX;
}

Role of_name(const std::string& dimension) {
  const std::string name = lower(dimension);
  if (any_of(name, {"cell", "cells", "ncell", "ncells", "ncells_2", "ncol", "ncells_horizontal",
                    "nmesh2d_face", "values"}))
    return Role::kCells;
  if (any_of(name, {"time", "t", "times", "step", "valid_time", "forecast_time", "time_counter"}))
    return Role::kTime;
  if (any_of(name, {"lat", "latitude", "y", "yc", "rlat", "nj", "south_north", "nlat", "ygrid_0",
                    "grid_yt", "nlats", "yt", "yh"}))
    return Role::kY;
  if (any_of(name, {"lon", "longitude", "x", "xc", "rlon", "ni", "west_east", "nlon", "xgrid_0",
                    "grid_xt", "nlons", "xt", "xh"}))
    return Role::kX;
  if (any_of(name, {"z", "k", "nz", "zt", "zc", "pfull", "full_level", "nlev", "bottom_top", "nk",
                    "zh", "zu_3d"}) ||
      starts(name, {"lev", "plev", "isobaric", "height", "altitude", "alt", "pressure", "hybrid",
                    "model_level", "lv_", "mlev", "ilev"}))
    return Role::kLevel;
  return Role::kUnknown;
}

// Latitudes over two of the variable's dimensions.
const FileVariable* plane_of(const DataFile& file, Quantity names, const FileVariable& variable) {
  return find_named(file, names, [&](const FileVariable& v) {
    int planes = 0, long_planes = 0;
    for (const int d : v.dimensions) {
      const bool ours = std::ranges::find(variable.dimensions, d) != variable.dimensions.end();
      if (!ours) return false;
      const bool place = of_name(file.name(d)) != Role::kTime;
      planes += place;
      long_planes += place && file.size(d) > 1;
    }
    // A grid of one row or column has it, too.
    return v.numeric && (planes == 2 || long_planes == 2);
  });
}

// One-dimensional coordinates of cells that are no product of two axes.
bool unstructured(const DataFile& file, const FileVariable& variable, int dimension) {
  const auto along = [&](Quantity names) {
    return find_named(file, names, [&](const FileVariable& v) {
             return v.dimensions == std::vector<int>{dimension} && v.name != file.name(dimension);
           }) != nullptr;
  };
  bool says_so = false;
  for (const char* name : {"grid_type", "CDI_grid_type"})
    says_so |= variable.text(name) == "unstructured";
  return of_name(file.name(dimension)) == Role::kCells ||
         (says_so && dimension == variable.dimensions.back()) ||
         (along(names::kLatitude) && along(names::kLongitude));
}

}  // namespace

DimensionRoles dimension_roles(const DataFile& file, const FileVariable& variable) {
  DimensionRoles roles;
  const auto give = [&](Role role, int dimension) {
    int* place = role == Role::kTime    ? &roles.time
                 : role == Role::kLevel ? &roles.z
                 : role == Role::kY     ? &roles.y
                 : role == Role::kX     ? &roles.x
                                        : nullptr;
    if (!place || *place >= 0) return false;
    *place = dimension;
    return true;
  };
  std::vector<int> left;
  for (const int d : variable.dimensions) {
    if (const char axis = file.dimensions()[std::size_t(d)].axis) {
      give(of_letter(axis), d);
      continue;
    }
    if (roles.cells < 0 && unstructured(file, variable, d)) {
      roles.cells = roles.x = d;
      continue;
    }
    const FileVariable* axis = file.find(file.name(d));
    const bool coordinate = axis && axis->dimensions == std::vector<int>{d};
    if (!coordinate || !give(of_coordinate(*axis), d)) left.push_back(d);
  }
  roles.latitude = plane_of(file, names::kLatitude, variable);
  roles.longitude = plane_of(file, names::kLongitude, variable);
  if (roles.latitude && roles.longitude &&
      roles.latitude->dimensions == roles.longitude->dimensions) {
    std::vector<int> plane;
    for (const int d : roles.latitude->dimensions)
      if (d != roles.time && of_name(file.name(d)) != Role::kTime) plane.push_back(d);
    // Rows first, unless the axes say otherwise.
    if (plane.size() == 2 && roles.y < 0 && roles.x < 0) {
      roles.y = plane[0];
      roles.x = plane[1];
    }
  } else {
    roles.latitude = roles.longitude = nullptr;
  }
  for (const int d : left)
    if (d != roles.y && d != roles.x) give(of_name(file.name(d)), d);
  if (roles.y < 0 && roles.x < 0)
    throw Error(
        {"the cloud water has no horizontal grid", file.where(variable),
         "dimensions of latitude and longitude, or y and x", file.shape_text(variable),
         "profiles over time are no volume; other names of dimensions can be told in a file for "
         "--names: x_axis, y_axis, level_axis"});
  if (roles.z < 0 || (roles.y < 0 && roles.cells < 0) || roles.x < 0)
    throw Error({"the cloud water's dimensions are not understood", file.where(variable),
                 "level, y and x, by units, axis, standard_name or usual names",
                 file.shape_text(variable),
                 "set the attribute `axis` (Z, Y, X) of each coordinate, or name the dimensions in "
                 "a file for "
                 "--names: x_axis, y_axis, level_axis"});
  return roles;
}

}  // namespace nepho::forecast
