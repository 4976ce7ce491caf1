// The tables' multiple scattering against adding-doubling, where the planet is so large that its
// air is a slab: radiances are marched in double with the product's own tables and functions.
#include <gtest/gtest.h>

#include <cmath>

#include "accuracy_report.h"
#include "air/air_depth.h"
#include "air/air_lookup.h"
#include "air/air_path.h"
#include "air/gauss.h"
#include "physics/physics_cpp.h"
#include "rayleigh_slab.h"

namespace nepho::test {
namespace {

// Light that the air sends along a ray which leaves it at the far end.
class March {
 public:
  explicit March(const Air& air)
      : air_(air),
        tables_(make_air_tables(air, kSlabRadius_m, glm::dvec3{0.0})),
        lookup_(air, kSlabRadius_m, tables_),
        depth_(air, kSlabRadius_m),
        cuts_m_(air_cut_heights(air)) {}

  glm::dvec3 radiance(double height_m, const glm::dvec3& direction,
                      const glm::dvec3& to_sun) const {
    static const GaussRule rule(8);
    const AirPath path(kSlabRadius_m, height_m, direction.z);
    const double end_m = path.meets_ground() ? path.ground_m() : path.top_m(air_);
    const std::vector<double> cuts = path.cuts(path.start_m(), end_m, cuts_m_);
    const double cosine = glm::dot(direction, to_sun);
    const double phase = f64::rayleigh_phase(1 - cosine);
    glm::dvec3 sum{0.0};
    for (std::size_t p = 1; p < cuts.size(); ++p)
      for (std::size_t n = 0; n < rule.node.size(); ++n) {
        const double length_m = cuts[p] - cuts[p - 1], u_m = cuts[p - 1] + rule.node[n] * length_m;
        const double along_m = u_m - path.start_m(), h_m = path.height_m(u_m);
        const double r_m = kSlabRadius_m + h_m;
        const double mu_sun = ((kSlabRadius_m + height_m) * to_sun.z + along_m * cosine) / r_m;
        const glm::dvec3 seen =
            rule.weight[n] * length_m * glm::exp(-depth_(height_m, direction.z, along_m));
        const glm::dvec3 sun = glm::exp(-lookup_.depth(h_m, mu_sun));
        const AirLight light = lookup_.light(h_m, mu_sun);
        const glm::dvec3 rayleigh_per_m = air_density(air_, h_m).rayleigh_per_m;
        for (int c = 0; c < 3; ++c)
          sum[c] += seen[c] * f64::air_emission(rayleigh_per_m[c], 0, sun[c], phase, 0,
                                                light.multiple[c], light.multiple_p2[c], u_m / r_m);
      }
    return sum;
  }

 private:
  const Air air_;
  AirTables tables_;
  AirLookup lookup_;
  AirDepth depth_;
  std::vector<double> cuts_m_;
};

// Scattered once, exactly.
SlabRow once(const RayleighSlab& slab, const SlabRow& row) {
  const double mu = row.mu, mu0 = row.mu_sun;
  const double up = f64::rayleigh_phase(1 - glm::dot(row.from_above(), row.to_sun()));
  const double down = f64::rayleigh_phase(1 - glm::dot(row.from_below(), row.to_sun()));
  SlabRow single;
  for (int c = 0; c < 3; ++c) {
    const double tau = slab.depth[c];
    single.up[c] = up * mu0 / (mu + mu0) * -std::expm1(-tau * (1 / mu + 1 / mu0));
    single.down[c] = down * tau / mu * std::exp(-tau / mu0) * f64::exp_e0(tau * (1 / mu - 1 / mu0));
  }
  return single;
}

TEST(RayleighSlab, RadiancesAreThoseOfAddingDoubling) {
  const RayleighSlab slab(NEPHO_TRUTH_DIR "/slab_rayleigh.csv");
  ASSERT_EQ(slab.rows.size(), 57u);
  const March march(slab.air);
  SlabErrors up, down;
  double multiple = 0, missed = 0;
  for (const SlabRow& row : slab.rows) {
    const SlabRow single = once(slab, row);
    const glm::dvec3 got_up = march.radiance(slab.air.top_m, row.from_above(), row.to_sun());
    const glm::dvec3 got_down = march.radiance(0, row.from_below(), row.to_sun());
    up.add(got_up, row.up);
    down.add(got_down, row.down);
    // Means over azimuths of what goes as their cosine, or as that of twice them, are right.
    const double weight = row.mu == 1 || row.mu_sun == 1 ? 4 : row.azimuth_deg == 90 ? 2 : 1;
    for (int c = 0; c < 3; ++c) {
      multiple += weight * (row.up[c] - single.up[c] + row.down[c] - single.down[c]);
      missed += weight * (row.up[c] - got_up[c] + row.down[c] - got_down[c]);
    }
  }
  const char* section = "clear air against adding-doubling";
  report_accuracy(section, "Rayleigh slabs, tables in double, from above: worst", up.worst, 0.03,
                  "relative");
  report_accuracy(section, "Rayleigh slabs, tables in double, from below: worst", down.worst, 0.03,
                  "relative");
  report_accuracy(section, "Rayleigh slabs, tables in double: rms", std::max(up.rms(), down.rms()),
                  0.01, "relative");
  const double bias = std::abs(missed / multiple);
  report_accuracy(section, "Rayleigh slabs, sum of all multiple scattering", bias, 0.01,
                  "relative");
  EXPECT_LE(up.worst, 0.03);
  EXPECT_LE(down.worst, 0.03);
  EXPECT_LE(std::max(up.rms(), down.rms()), 0.01);
  EXPECT_LE(bias, 0.01);
}

}  // namespace
}  // namespace nepho::test
