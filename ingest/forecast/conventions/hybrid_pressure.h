#pragma once

#include <optional>
#include <string>
#include <vector>

#include "forecast/conventions/vertical.h"

namespace nepho::forecast {

// Levels whose pressure is a + b ps: hybrid and sigma coordinates, logarithms of pressure, and
// pressures themselves (b = 0). From the ground up.
struct HybridPressure {
  std::vector<double> a_Pa, b;                      // of levels
  std::vector<double> interface_a_Pa, interface_b;  // nz + 1; empty: half way in height
  const FileVariable* surface = nullptr;            // ps, or its logarithm
  double surface_factor = 1;
  bool surface_is_log = false;
  bool from_top = false;
  std::string how;

  double surface_Pa(double value) const;
};

// By formula_terms (atmosphere_hybrid_sigma_pressure_coordinate, atmosphere_sigma_coordinate,
// atmosphere_ln_pressure_coordinate: CF 1.11, appendix D), or by coefficients under the names of
// ECMWF's and NCAR's models (hyam, hybm; hyai, hybi), of which a level axis of numbers may choose
// some, or FV3's (ak, bk). Levels without coefficients of their own are at the mean pressure of
// their interfaces (Simmons & Burridge 1981). None: no such levels; throws Error where they are,
// but ps is missing, unless `optional`.
std::optional<HybridPressure> hybrid_pressure(const VerticalRequest& request, bool optional);

// Its pressures as Vertical::pressure_Pa gives them.
std::function<std::vector<float>(std::size_t time)> hybrid_field(const VerticalRequest& request,
                                                                 HybridPressure hybrid);

}  // namespace nepho::forecast
