#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "bricks/volume_info.h"
#include "optics/hg_draine.h"
#include "reference/path/random.h"

namespace nepho {

// A turn from one direction of travel to the next, as what keeps its digits: 1 - cos(theta) and
// sin(theta).
struct Turn {
  double one_minus_cos = 0, sine = 0;
};

// Henyey & Greenstein (1941) for u in [0, 1], without the division by g and the cancellation of the
// usual form: at |g| = 0.9999 its sine is good to 1e-12 in double, and g = 0 needs no branch.
Turn sample_hg(double g, double u);

// Draine (2003, doi:10.1086/379118), HG (1 + alpha mu^2) normalised: HG, and then rejection.
// Bounded: of any two trials one is taken, or more.
Turn sample_draine(double g, double alpha, Random& random);

// (1 + mu^2) 3 / (16 pi), by rejection.
Turn sample_rayleigh(Random& random);

// The direction after a turn, all azimuths alike; unit length to 1e-15.
glm::dvec3 turned(const glm::dvec3& direction, const Turn& turn, Random& random);

// 1 - cos of the angle between unit vectors.
inline double one_minus_cos(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 apart = a - b;
  return 0.5 * glm::dot(apart, apart);
}

// A volume's phase function, by the table that the renderer looks it up in (phase_table.h), or by
// its formula for Henyey-Greenstein and HG + Draine. Samples are exactly of the density that
// value() tells: the table's curve is its own envelope, texel by texel, and what is above the curve
// is rejected.
class PhaseSampler {
 public:
  // Throws Error as phase_table() does.
  explicit PhaseSampler(const Phase& phase);
  // Of air: molecules, and aerosol (Cornette and Shanks 1992).
  static PhaseSampler rayleigh() { return PhaseSampler(Kind::kRayleigh, 0); }
  static PhaseSampler cornette_shanks(double asymmetry) {
    return PhaseSampler(Kind::kCornetteShanks, asymmetry);
  }

  // Same at all three wavelengths.
  bool grey() const { return kind_ != Kind::kTable; }
  // 1/sr at wavelength 0, 1 or 2 (650, 550, 450 nm).
  double value(int wavelength, double one_minus_cos) const;
  glm::dvec3 values(double one_minus_cos) const;
  Turn sample(int wavelength, Random& random) const;

  // The forward peak alone, to draw directions near a light. A table's is its curve within
  // kPeak_rad, over what it holds; of HG + Draine it is the first of the two; Henyey-Greenstein's,
  // from an asymmetry of kLeastPeak on, is all of it.
  static constexpr double kPeak_rad = 0.17, kLeastPeak = 0.5;
  bool has_peak() const {
    return kind_ == Kind::kTable || kind_ == Kind::kHgDraine ||
           (kind_ == Kind::kHenyeyGreenstein && asymmetry_ > kLeastPeak);
  }
  glm::dvec3 peak_values(double one_minus_cos) const;  // densities, 1/sr
  Turn sample_peak(int wavelength, Random& random) const;

 private:
  enum class Kind : std::uint8_t {
    kTable,
    kHenyeyGreenstein,
    kHgDraine,
    kRayleigh,
    kCornetteShanks
  };
  static Kind kind_of(PhaseKind kind);
  PhaseSampler(Kind kind, double asymmetry) : kind_(kind), asymmetry_(asymmetry) {}
  struct Table {
    std::vector<double> log_values;          // by texel; divided by their integral
    std::vector<double> envelope, log_most;  // by interval: sums of mass, and the larger end
    std::vector<double> from_forward;        // 1 - cos of each texel
    std::size_t peak_end = 0;                // texel
    double peak_part = 0;                    // of the light, before that
  };
  Turn sample_table(const Table& table, int wavelength, double mass, Random& random) const;
  static Table make_table(const std::vector<float>& log_values, int wavelength);

  Kind kind_;
  double asymmetry_ = 0;
  HgDraine fit_;
  std::array<Table, 3> tables_;
};

}  // namespace nepho
