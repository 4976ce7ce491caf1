#pragma once

#include <span>
#include <vector>

#include "bricks/quantise.h"

namespace nepho::test {

// What quantise() made of some values, with its codes.
struct Codes {
  Quantised q;
  std::vector<std::uint16_t> code;
  float decode(std::size_t at) const { return nepho::decode(code[at], q.scale, q.offset); }
};

inline Codes code_values(std::span<const double> values, unsigned top_code = kTopCode16,
                         float fixed_scale = 0) {
  Codes codes{{}, std::vector<std::uint16_t>(values.size())};
  codes.q = quantise(values, codes.code, top_code, fixed_scale);
  return codes;
}
inline Codes code_values(std::initializer_list<double> values, unsigned top_code = kTopCode16,
                         float fixed_scale = 0) {
  return code_values(std::span(values.begin(), values.size()), top_code, fixed_scale);
}

}  // namespace nepho::test
