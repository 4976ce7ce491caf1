#pragma once

#include "bricks/data_facts.h"
#include "forecast/bricks/domain_state.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// Area of each cell (m2, on the ellipsoid), [j * nx + i]; 0 for cells without a place. By their
// middle lines: a cell of 2.5 degrees is 8e-5 too small, one of 10 degrees 1.3e-3.
std::vector<double> cell_areas_m2(const HorizontalGrid& grid);

// Of the columns of one time: everything but `recognised`. The lowest layer goes on
// `extend_below_m` below the ground in `extinction_m2` alone, as in bricks.
DataFacts column_facts(const ForecastColumns& columns, const HorizontalGrid& grid,
                       double extend_below_m);
// Of several domains, finest first: coarser cells count with the part that no finer one covers, by
// 64 points of each cell on a border.
DataFacts column_facts(const std::vector<DomainState>& domains, double extend_below_m);

}  // namespace nepho::forecast
