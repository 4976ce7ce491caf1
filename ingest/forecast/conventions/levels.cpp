#include "forecast/conventions/levels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "forecast/water/air.h"
#include "forecast/water/level_heights.h"

namespace nepho::forecast {
namespace {

// Of all interfaces: more that must be lifted, and the levels are no levels.
constexpr double kMostLifted = 0.01;
constexpr double kMissingLevelStep_m = 100;

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (std::size_t n = 0; n < values.size() && n < 6; ++n) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%g", n ? ", " : "", values[n]);
    text += number;
  }
  return text + (values.size() > 6 ? ", ..." : "");
}

}  // namespace

void refuse_levels(const std::string& where, const std::string& found) {
  throw Error({"the levels neither rise nor fall", where, "heights or pressures in order", found,
               "write the file again with its levels in order"});
}

int direction(const std::vector<double>& values, const std::string& where) {
  int sign = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const int step = values[k] > values[k - 1] ? 1 : values[k] < values[k - 1] ? -1 : 0;
    if (step == 0 || (sign && step != sign)) refuse_levels(where, numbers(values));
    sign = step;
  }
  if (values.size() == 1 && !std::isfinite(values[0])) refuse_levels(where, "a missing value");
  return sign ? sign : 1;
}

bool fill_levels(std::vector<double>& level_m) {
  const auto valid = [](double z) { return std::isfinite(z); };
  const auto first = std::ranges::find_if(level_m, valid);
  if (first == level_m.end()) {
    for (std::size_t k = 0; k < level_m.size(); ++k) level_m[k] = kMissingLevelStep_m * double(k);
    return false;
  }
  for (auto at = first; at != level_m.begin(); --at) *(at - 1) = *at - kMissingLevelStep_m;
  for (std::size_t k = 1; k < level_m.size(); ++k) {
    if (valid(level_m[k])) continue;
    std::size_t next = k;
    while (next < level_m.size() && !valid(level_m[next])) ++next;
    const double step = next < level_m.size()
                            ? (level_m[next] - level_m[k - 1]) / double(next - k + 1)
                            : kMissingLevelStep_m;
    level_m[k] = level_m[k - 1] + step;
  }
  return true;
}

double Levels::height_m(double value) const {
  const double height = value * factor + offset;
  return geopotential ? height_of_geopotential_height_m(height) : height;
}

std::vector<double> Levels::terrain_m(std::size_t time) const {
  if (!request.terrain_m) return std::vector<double>(cells(), NAN);
  const std::vector<float> heights = request.terrain_m(time);
  return {heights.begin(), heights.end()};
}

std::vector<float> rising_interfaces(std::vector<float> interface_m, std::size_t count,
                                     const std::string& where) {
  const std::size_t lifted = make_rising(interface_m, count);
  if (double(lifted) > kMostLifted * double(interface_m.size()))
    refuse_levels(where, std::to_string(lifted) + " of " + std::to_string(interface_m.size()) +
                             " heights below the one beneath, or missing");
#ifdef NEPHO_MUTANT_FLIPPED_LEVELS
  for (std::size_t at = 0; at < interface_m.size(); at += count) {
    float* column = &interface_m[at];
    const float low = column[0], high = column[count - 1];
    std::reverse(column, column + count);
    for (std::size_t k = 0; k < count; ++k) column[k] = low + high - column[k];
  }
#endif
  return interface_m;
}

std::vector<float> Levels::checked(std::vector<float> interface_m) const {
  return rising_interfaces(std::move(interface_m), std::size_t(nz()) + 1, file().where(*variable));
}

std::vector<float> Levels::of_levels(const std::vector<float>& field, std::size_t time) const {
  const std::size_t count = std::size_t(nz());
  const std::vector<double> ground = terrain_m(time);
  std::vector<float> result(cells() * (count + 1));
  std::vector<double> level(count);
  bool any = false;
  for (std::size_t n = 0; n < cells(); ++n) {
    for (std::size_t k = 0; k < count; ++k)
      level[k] = height_m(double(field[k * cells() + n])) + base_m(ground[n]);
    any |= fill_levels(level);
    interfaces_of_levels_m(level, ground[n], {&result[n * (count + 1)], count + 1});
  }
  if (!any) refuse_levels(file().where(*variable), "missing values only");
  return checked(std::move(result));
}

bool falls(const FieldReader& reader, const FileVariable& variable, int z) {
  const int last_level = int(reader.file->size(z)) - 1;
  const std::vector<float> first = reader.levels(variable, z, false, 0, 0, 1),
                           last = reader.levels(variable, z, false, 0, last_level, 1);
  std::size_t falling = 0, rising = 0;
  for (std::size_t n = 0; n < first.size(); ++n) {
    falling += first[n] > last[n];
    rising += first[n] < last[n];
  }
  return falling > rising;
}

bool varies(const FileVariable& variable, int dimension) {
  return std::ranges::find(variable.dimensions, dimension) != variable.dimensions.end();
}

UnitOf height_unit(const FileVariable& variable) {
  const std::string unit = variable.text("units");
  if (unit == "gpm" || unit == "geopotential meter" || unit == "geopotential metre")
    return {true, 1, 0};
  return unit_of(variable, kLength);
}

std::shared_ptr<Levels> levels_of(const VerticalRequest& request, const FileVariable& variable,
                                  int z) {
  auto levels = std::make_shared<Levels>();
  levels->request = request;
  levels->variable = &variable;
  levels->z = z;
  return levels;
}

}  // namespace nepho::forecast
