#include "forecast/conventions/vertical.h"

#include <array>

#include "core/error.h"
#include "forecast/conventions/hybrid_pressure.h"
#include "forecast/conventions/levels.h"

namespace nepho::forecast {

UnitOf unit_of(const FileVariable& variable, const Dimension& wanted) {
  const std::string text = variable.text("units");
  if (text == "millibars" || text == "millibar" || text == "mb")
    return {wanted == kPressure, 100, 0};
  if (text.empty()) return {};
  try {
    const Unit unit = parse_unit(text);
    return {unit.dimension == wanted, unit.factor, unit.offset};
  } catch (const Error&) {
    return {};
  }
}

Vertical find_vertical(const VerticalRequest& request) {
  static constexpr std::array<Way*, 11> kWays = {
      by_half_levels,     by_level_heights,  by_geopotential_height, by_geopotential,
      by_thickness,       by_hybrid_heights, by_hybrid_pressure,     by_pressure_thickness,
      by_pressure_levels, by_height_axis,    by_pressure_field};
  Vertical vertical;
  const DataFile& file = *request.reader->file;
  // Refused here whatever else there is: an axis out of order.
  const auto hybrid = hybrid_pressure(request, true);
  PressureField by_layers;
  if (!hybrid) by_layers = pressure_of_thickness(request).level_Pa;
  const PressureLevels levels =
      hybrid || by_layers ? PressureLevels{} : pressure_levels(file, request.z);
  for (Way* const way : kWays)
    if (way(request, vertical)) {
      vertical.level_pressure_Pa = levels.pressure_Pa;
      if (hybrid && !vertical.pressure_Pa) vertical.pressure_Pa = hybrid_field(request, *hybrid);
      if (!vertical.pressure_Pa) vertical.pressure_Pa = by_layers;
      if (!levels.pressure_Pa.empty() && levels.from_top != vertical.from_top)
        refuse_levels(file.path() + " [" + file.name(request.z) + "]",
                      "pressures in another order than the heights (" + vertical.how + ")");
      if (file.size(request.z) < 2 && !vertical.has_interfaces)
        throw Error(
            {"one level has no thickness", file.path(), "at least two levels",
             file.name(request.z) + " of size 1",
             "give the level bounds, half levels or a thickness, or keep a level beside it"});
      if (way == by_thickness && !levels.pressure_Pa.empty())
        vertical.assumptions.push_back("Pressures of the axis " + file.name(request.z) +
                                       " are taken for densities: they are a standard surface's.");
      vertical.facts.push_back("Heights: " + vertical.how + ".");
      return vertical;
    }
  const FileVariable* axis = file.find(file.name(request.z));
  const std::string unit = axis ? "\"" + axis->text("units") + "\"" : "no such variable";
  throw Error({"the levels are neither heights nor pressures",
               file.path() + " [" + file.name(request.z) + "]",
               "units of length or pressure, or a field of heights, geopotential or pressure on "
               "these levels",
               "units " + unit,
               "hybrid levels need their formula_terms with surface pressure or ground height, or "
               "their heights or pressures as a variable"});
}

}  // namespace nepho::forecast
