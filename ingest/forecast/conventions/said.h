#pragma once

#include "forecast/conventions/model.h"
#include "forecast/water/condensate.h"

namespace nepho::forecast {

// What was assumed of a forecast, what was found in the water of its first time, and how that
// became extinction: added to what the model says, for `info` and `render`.
void say(const WaterStatistics& statistics, Model& model);

}  // namespace nepho::forecast
