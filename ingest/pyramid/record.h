#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "bricks/brick_source.h"
#include "bricks/quantise.h"

namespace nepho {

// What a stored node knows besides its samples; of the node and all below where not said otherwise.
struct Record {
  double least = 0, most = 0;
  double error = 0;     // sup |own trilinear - finest|
  double variance = 0;  // mean, this level
  std::uint8_t children = 0;
  bool empty = true;  // this level
};

inline float decoded_floor(double least) {
  const double low = least * (1 - 4 * double(std::numeric_limits<float>::epsilon()));
  const auto f = float(low);
  return double(f) <= low ? f : std::nextafter(f, 0.0f);
}

// Mean over the node of the interpolant of its samples: half weight on faces.
inline double node_mean(const float* samples) {
  constexpr auto weight = [](std::size_t s) { return s == 0 || s == kBrickCells ? 0.5 : 1.0; };
  double sum = 0;
  for (std::size_t k = 0, at = 0; k < kBrickSamples; ++k)
    for (std::size_t j = 0; j < kBrickSamples; ++j)
      for (std::size_t i = 0; i < kBrickSamples; ++i, ++at)
        sum += weight(i) * weight(j) * weight(k) * double(samples[at]);
  return sum / (kBrickCells * kBrickCells * kBrickCells);
}

inline bool all_zero(const double* samples) {
  return std::all_of(samples, samples + kBrickVolume, [](double c) { return c == 0; });
}

inline NodeSummary to_summary(const Record& record) {
  NodeSummary summary;
  summary.min_extinction_per_m = decoded_floor(record.least);
  summary.max_extinction_per_m = decoded_bound(record.most);
  summary.constant = record.least == record.most;
  summary.constant_extinction_per_m = summary.constant ? float(record.most) : 0;
  summary.unresolved_variance_per_m2 = record.variance;
  summary.error_bound_per_m = record.error;
  summary.children = record.children;
  summary.empty = record.empty;
  return summary;
}

}  // namespace nepho
