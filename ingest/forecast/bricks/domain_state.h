#pragma once

#include <optional>
#include <vector>

#include "bricks/brick_source.h"
#include "bricks/shell_chart.h"
#include "forecast/bricks/grid_search.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// The cells of one domain at one of its times.
struct DomainState {
  GridSearch search;
  ForecastColumns columns;

  // The cell that holds a place: none where the domain has no cell there, or one without data.
  // `nearby` is where a place near it was found, and becomes where this one is.
  std::optional<std::size_t> cell_at(glm::dvec2 lat_lon_deg,
                                     std::optional<glm::dvec2>* nearby = nullptr) const;
  double extinction_per_m(std::size_t cell, double height_m, double extend_below_m) const;
  // With the fog below the cell's ground, as bricks have it.
  OwnColumn column(std::size_t cell, double extend_below_m) const;
};

// What is drawn at a time, finest first.
std::vector<DomainState> states_of(const Forecast& forecast, std::size_t time);

}  // namespace nepho::forecast
