#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace nepho {

// Gauss-Legendre nodes and weights on (0, 1).
struct GaussRule {
  std::vector<double> node, weight;

  explicit GaussRule(int n) {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0;
      for (int round = 0; round < 20; ++round) {
        double p0 = 1, p1 = x;
        for (int k = 2; k <= n; ++k) {
          const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
          p0 = p1;
          p1 = p2;
        }
        slope = n * (x * p1 - p0) / ((x - 1) * (x + 1));
        const double step = p1 / slope;
        x -= step;
        if (std::abs(step) < 1e-15) break;
      }
      node.push_back(0.5 * (1 - x));
      weight.push_back(1 / ((1 - x) * (1 + x) * slope * slope));
    }
  }
};

}  // namespace nepho
