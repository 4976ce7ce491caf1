#pragma once

#include <vector>

#include "forecast/forecast.h"

namespace nepho::test {

// Of each column of a model, [j * nx + i].
inline std::vector<double> optical_depths(const forecast::ForecastColumns& c) {
  std::vector<double> depths(std::size_t(c.nx) * std::size_t(c.ny), 0.0);
  const std::size_t nz = std::size_t(c.nz);
  for (std::size_t n = 0; n < depths.size(); ++n)
    for (std::size_t k = 0; k < nz; ++k)
      depths[n] += double(c.extinction_per_m[n * nz + k]) *
                   double(c.interface_m[n * (nz + 1) + k + 1] - c.interface_m[n * (nz + 1) + k]);
  return depths;
}

}  // namespace nepho::test
