#pragma once

#include <cmath>
#include <random>

#include <glm/glm.hpp>

namespace nepho::test {

class Random {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 d = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      if (const double l = length(d); l > 1e-3 && l < 1) return 1 / l * d;
    }
  }

 private:
  std::mt19937_64 engine_{5};
};

}  // namespace nepho::test
