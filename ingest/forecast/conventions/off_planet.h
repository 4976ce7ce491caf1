#pragma once

#include "forecast/forecast.h"

namespace nepho::forecast {

// Cells with a corner off a satellite's disc, or without corners, hold nothing.
void clear_off_planet(const HorizontalGrid& grid, ForecastColumns& columns);

}  // namespace nepho::forecast
