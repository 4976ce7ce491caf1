#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "truth_table.h"

namespace nepho::test {

// Molecules alone around a planet so large that its air is a slab: tests/data/truth/
// slab_rayleigh.csv, in which the sun's irradiance is 1 and the ground is black.

inline constexpr double kSlabRadius_m = 1e9;
inline constexpr std::size_t kColours = 3;  // 650, 550, 450 nm, as in Air

struct SlabRow {
  double mu_sun = 0, mu = 0, azimuth_deg = 0;  // between the ways of sun's and seen photons
  glm::dvec3 up{0.0}, down{0.0};               // radiance at the top; diffuse at the base

  double sine() const { return std::sqrt((1 - mu) * (1 + mu)); }
  // Unit vectors; z up, the sun's photons go towards +x.
  glm::dvec3 to_sun() const { return {-std::sqrt((1 - mu_sun) * (1 + mu_sun)), 0, mu_sun}; }
  // Of the view ray, against its photons: from above (looks down), from below (looks up).
  glm::dvec3 from_above() const { return {-sine() * cosine(), -sine() * azimuth_sine(), -mu}; }
  glm::dvec3 from_below() const { return {-sine() * cosine(), -sine() * azimuth_sine(), mu}; }

 private:
  static constexpr double kRad = 0.017453292519943295;
  double cosine() const { return std::cos(kRad * azimuth_deg); }
  double azimuth_sine() const { return std::sin(kRad * azimuth_deg); }
};

struct RayleighSlab {
  Air air;
  glm::dvec3 depth{0.0};  // optical
  std::vector<SlabRow> rows;

  explicit RayleighSlab(const std::string& path) {
    const TruthTable truth(path);
    air.aerosol_extinction_per_m = air.ozone_per_m = glm::dvec3{0.0};
    const double column_m = -air.rayleigh_scale_m * std::expm1(-air.top_m / air.rayleigh_scale_m);
    const std::size_t n = truth.rows() / kColours;
    rows.resize(n);
    for (std::size_t r = 0; r < truth.rows(); ++r) {
      // One colour after the other, the shortest wave first.
      const int c = 2 - int(r / n);
      SlabRow& row = rows[r % n];
      if (truth.at(r, "lambda_nm") != 650 - 100 * c) throw std::runtime_error("order of " + path);
      row.mu_sun = truth.at(r, "mu0");
      row.mu = truth.at(r, "mu_view");
      row.azimuth_deg = truth.at(r, "dphi_deg");
      row.up[c] = truth.at(r, "I_up_top");
      row.down[c] = truth.at(r, "I_down_bottom_diffuse");
      depth[c] = truth.at(r, "tau");
      air.rayleigh_per_m[c] = depth[c] / column_m;
    }
  }
};

// Signed errors, relative to truth.
struct SlabErrors {
  double worst = 0, sum = 0, squares = 0;
  int count = 0;
  void add(const glm::dvec3& got, const glm::dvec3& truth) {
    for (int c = 0; c < 3; ++c) {
      const double off = got[c] / truth[c] - 1;
      worst = std::max(worst, std::abs(off));
      sum += off;
      squares += off * off;
      ++count;
    }
  }
  double mean() const { return sum / count; }
  double rms() const { return std::sqrt(squares / count); }
};

}  // namespace nepho::test
