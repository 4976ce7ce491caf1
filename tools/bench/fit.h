#pragma once

#include <optional>
#include <span>
#include <string>

namespace nepho::bench {

// The order of convergence: the slope of log error against log step, by least squares.
struct OrderFit {
  double order = 0, standard_error = 0;  // of the slope, from the residuals
  int points = 0;
};
struct StepError {
  double step, error;
};
// Absent with `why` filled in: fewer than three points with step and error above 0, or steps that
// are all the same.
std::optional<OrderFit> convergence_order(std::span<const StepError> points, std::string& why);

// Median and quartiles, by linear interpolation between the sorted values (type 7 of Hyndman and
// Fan 1996). Throws std::invalid_argument without a value.
struct Spread {
  double median = 0, low = 0, high = 0;
  int runs = 0;
};
Spread spread_of(std::span<const double> values);

}  // namespace nepho::bench
