#include "bricks/quantise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nepho {
namespace {

constexpr double kEpsilon = std::numeric_limits<float>::epsilon();

// Conversions to float that never go below (above) the value.
float float_above(double value) {
  const float f = float(value);
  return double(f) >= value ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
}
float float_below(double value) {
  return -float_above(-value);
}

}  // namespace

Quantised quantise(std::span<const double> values, std::span<std::uint16_t> codes,
                   unsigned top_code, float fixed_scale) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const double value : values) {
    if (!(value >= 0) || !std::isfinite(value))
      throw std::domain_error("quantise: a value is negative or not finite");
    low = std::min(low, value);
    high = std::max(high, value);
  }
  Quantised q;
  if (values.empty()) return q;
  if (fixed_scale > 0) {
    q.scale = fixed_scale;
    if (high > fixed_scale * (double(top_code) + 0.5))
      throw std::domain_error("quantise: a value is above the volume's fixed scale");
  } else {
    q.offset = float_below(low);
    q.scale = float_above((high - double(q.offset)) / top_code);
  }
#ifdef NEPHO_MUTANT_ZERO_IS_NOT_EXACT
  q.offset += 0.25f * q.scale;  // within the error bound, but fog everywhere
#endif
  for (std::size_t at = 0; at < values.size(); ++at) {
    const double steps = q.scale > 0 ? (values[at] - double(q.offset)) / double(q.scale) : 0;
    codes[at] = std::uint16_t(std::min(std::round(steps), double(top_code)));
  }
  const double top = double(q.offset) + double(top_code) * double(q.scale);
  q.max_abs_error = 0.5 * double(q.scale) + 2 * kEpsilon * top;
  return q;
}

float decoded_bound(double most) {
  return float_above(most * (1 + 4 * kEpsilon));
}

}  // namespace nepho
