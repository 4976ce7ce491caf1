#include "bench/fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace nepho::bench {

std::optional<OrderFit> convergence_order(std::span<const StepError> points, std::string& why) {
  std::vector<double> x, y;
  for (const StepError& p : points)
    if (p.step > 0 && p.error > 0) {
      x.push_back(std::log(p.step));
      y.push_back(std::log(p.error));
    }
  const std::size_t n = x.size();
  if (n < 3) {
    why = "a line through " + std::to_string(n) + " of the 3 points that a fit needs";
    return {};
  }
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < n; ++i) {
    mean_x += x[i] / double(n);
    mean_y += y[i] / double(n);
  }
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < n; ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(xx > 0)) {
    why = "all steps are the same";
    return {};
  }
  OrderFit fit{.order = xy / xx, .standard_error = 0, .points = int(n)};
  double residuals = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double off = y[i] - mean_y - fit.order * (x[i] - mean_x);
    residuals += off * off;
  }
  fit.standard_error = std::sqrt(residuals / double(n - 2) / xx);
  return fit;
}

Spread spread_of(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument("spread of nothing");
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const auto at = [&](double share) {
    const double place = share * double(sorted.size() - 1);
    const auto below = std::size_t(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - double(below)) * (sorted[above] - sorted[below]);
  };
  return {at(0.5), at(0.25), at(0.75), int(values.size())};
}

}  // namespace nepho::bench
