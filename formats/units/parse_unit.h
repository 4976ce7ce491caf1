#pragma once

#include <string>
#include <string_view>

namespace nepho {

// Powers of the base units that data come in. An angle has a dimension, so that degrees cannot be
// taken for a ratio; a solid angle is rad2.
struct Dimension {
  int m = 0, kg = 0, s = 0, K = 0, rad = 0;
  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};
inline constexpr Dimension kDimensionless{};
inline constexpr Dimension kLength{.m = 1};
inline constexpr Dimension kExtinction{.m = -1};
inline constexpr Dimension kAngle{.rad = 1};
inline constexpr Dimension kTime{.s = 1};
inline constexpr Dimension kTemperature{.K = 1};
inline constexpr Dimension kPressure{.m = -1, .kg = 1, .s = -2};
inline constexpr Dimension kDensity{.m = -3, .kg = 1};

// "kg m-3"; "1" where there is none.
std::string to_string(const Dimension& dimension);

// value in SI = value * factor + offset. Factors that are powers of ten are correctly rounded.
struct Unit {
  double factor = 1, offset = 0;
  Dimension dimension;
  double to_si(double value) const { return value * factor + offset; }
  double from_si(double value) const { return (value - offset) / factor; }
};

// A unit as files and people write it: "g m-3", "kg kg**-1", "g/kg", "W/(m2 sr)", "hPa", "1/m",
// "degrees_north", "um", "\u00b5m", "m s\u207b\u00b9", "%", "1", "100 Pa".
//   unit     factor { [. * or blank] factor } { ("/" or "per") factor }
//   factor   (name, number, or unit in brackets) [integer power: 2 -2 ^2 **-2, superscripts]
// A product after a division ("W/m2 sr") has two readings and is refused. degC (also degF) has its
// offset when it stands alone, and is an interval within a product ("K km-1" = "degC km-1").
// Throws Error for all else, empty text and time axes ("hours since 1970-01-01") included.
Unit parse_unit(std::string_view text);

// The value in SI; throws Error with both dimensions where the unit is not of the `wanted` one.
double to_si(double value, std::string_view unit, const Dimension& wanted);

}  // namespace nepho
