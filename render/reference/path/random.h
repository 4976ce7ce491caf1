#pragma once

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>

namespace nepho {

// Counter-based random numbers (Philox 4x32-10; Salmon et al. 2011, doi:10.1145/2063384.2063405):
// a stream is named by seed, item and sample, so that no result depends on the number of threads.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t item, std::uint32_t sample)
      : key_{{std::uint32_t(seed), std::uint32_t(seed >> 32)}},
        counter_{{0, sample, std::uint32_t(item), std::uint32_t(item >> 32)}} {}

  // Uniform in [0, 1), 53 bits.
  double uniform() {
    const std::uint64_t high = word() >> 5, low = word() >> 6;
    return double(high << 26 | low) * 0x1p-53;
  }
  // Exponential of mean 1. 1 - u is exact and never 0; its least value 2^-53 is a depth of 36.7.
  double depth() { return -std::log(1 - uniform()); }

 private:
  std::uint32_t word() {
    if (used_ == 4) {
      block_ = r123::Philox4x32()(counter_, key_);
      ++counter_.v[0];
      used_ = 0;
    }
    return block_.v[used_++];
  }

  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_, block_{};
  int used_ = 4;
};

// Trials of a Poisson process along a ray, piece by piece, each with its own bound of the rate:
// what is left of a free path carries over from one piece to the next.
class Trials {
 public:
  explicit Trials(Random& random) : random_(random), left_(random.depth()) {}

  // Moves t_m to the next trial; false where there is none before end_m.
  bool next(double& t_m, double end_m, double most_per_m) {
    const double step_m = left_ / most_per_m;
    if (step_m >= end_m - t_m) {
      left_ -= most_per_m * (end_m - t_m);
      return false;
    }
    t_m += step_m;
    left_ = random_.depth();
    return true;
  }

 private:
  Random& random_;
  double left_;  // optical depth of the bound
};

}  // namespace nepho
