#pragma once

#include <optional>
#include <string>
#include <vector>

#include "units/parse_unit.h"

namespace nepho::forecast {

// What a raster of clouds can hold: one number per column, never a level.
enum class CloudQuantity {
  kOpticalDepth,  // of the cloudy part of the cell, in visible light
  kLiquidPath,    // means over the cell
  kIcePath,
  kWaterPath,  // liquid and ice
  kCover,
  kTopHeight,  // over the sea
  kTopPressure,
  kTopTemperature,
  kBaseHeight,
  kEffectiveRadius
};

struct QuantityKind {
  CloudQuantity quantity;
  const char* word;  // in `bands`, and in messages
  Dimension dimension;
  const char* usual_unit;  // for hints
  double low, high;        // in SI; outside, no cloud is like that
};
const QuantityKind& kind_of(CloudQuantity quantity);

// By a CF standard name, by a `bands` word, or by a name that products give their variables; case,
// blanks, dashes and dots do not count. Empty: none of those.
std::optional<CloudQuantity> quantity_named(const std::string& name);
// "optical_depth, liquid_path, ..."
std::string quantity_words();

// The unit a file or a user names for a quantity. "" is a ratio's only where the quantity has no
// other unit (optical depth). Throws Error, naming `where` and `cure`, on a unit that is missing,
// unknown, or of another dimension.
Unit unit_for(CloudQuantity quantity, const std::string& unit, const std::string& where,
              const std::string& cure);

}  // namespace nepho::forecast
