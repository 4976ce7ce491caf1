#pragma once

#include <cstdint>
#include <span>

namespace nepho {

inline constexpr unsigned kTopCode16 = 65535, kTopCode8 = 255;

// How one channel of one brick was coded: value = offset + (scale * 65535) * (code / 65535).
struct Quantised {
  float scale = 0, offset = 0;
  double max_abs_error = 0;  // of any decoded sample against the double it was made from
};

// The expression of the GPU (R16 UNORM texel, then one multiply and one add), to 1.2 float epsilon.
inline float decode(std::uint16_t code, float scale, float offset) {
  return offset + (scale * 65535.0f) * (float(code) / 65535.0f);
}

// The one quantiser: values (finite, not negative) to codes of the same count. An offset only where
// there is no zero, so that zero decodes to exactly zero. max_abs_error is half a step plus what
// decoding in float adds: 2 epsilon of the top value. `fixed_scale` > 0 is a scale that the whole
// volume shares (u8 volumes; the offset is then 0).
// Throws std::domain_error on a negative or non-finite value, or one above a fixed scale's range.
Quantised quantise(std::span<const double> values, std::span<std::uint16_t> codes,
                   unsigned top_code = kTopCode16, float fixed_scale = 0);

// Bound on what decodes from bricks whose samples are all <= `most`: a top code decodes to the
// brick's maximum, so quantisation adds roundings only, not half a step.
float decoded_bound(double most);

}  // namespace nepho
