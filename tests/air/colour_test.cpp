// Three wavelengths as a display's three primaries, against spectra.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>

#include "accuracy_report.h"
#include "scene/scene.h"

namespace nepho::test {
namespace {

// Absorption cross-section of ozone at 233 K, m2, means of 10 nm from 360 nm: Gorshelev et al. 2014
// (doi:10.5194/amt-7-609-2014), as Bruneton 2017 lists them.
constexpr std::array kOzone_m2 = {
    1.18e-27,  2.182e-28, 2.818e-28, 6.636e-28, 1.527e-27, 2.763e-27, 5.52e-27,  8.451e-27,
    1.582e-26, 2.316e-26, 3.669e-26, 4.924e-26, 7.752e-26, 9.016e-26, 1.48e-25,  1.602e-25,
    2.139e-25, 2.755e-25, 3.091e-25, 3.5e-25,   4.266e-25, 4.672e-25, 4.398e-25, 4.701e-25,
    5.019e-25, 4.305e-25, 3.74e-25,  3.215e-25, 2.662e-25, 2.238e-25, 1.852e-25, 1.473e-25,
    1.209e-25, 9.423e-26, 7.455e-26, 6.566e-26, 5.105e-26, 4.15e-26,  4.228e-26, 3.237e-26};
constexpr double kPeak_per_m3 = 5.374e18;

double bell(double x, double height, double middle, double low, double high) {
  const double t = (x - middle) * (x < middle ? low : high);
  return height * std::exp(-0.5 * t * t);
}

// CIE 1931 as sums of bells (Wyman, Sloan and Shirley 2013), in Rec. 709 primaries.
glm::dvec3 primaries(double nm) {
  const double x = bell(nm, 0.362, 442.0, 0.0624, 0.0374) + bell(nm, 1.056, 599.8, 0.0264, 0.0323) +
                   bell(nm, -0.065, 501.1, 0.0490, 0.0382);
  const double y = bell(nm, 0.821, 568.8, 0.0213, 0.0247) + bell(nm, 0.286, 530.9, 0.0613, 0.0322);
  const double z = bell(nm, 1.217, 437.0, 0.0845, 0.0278) + bell(nm, 0.681, 459.0, 0.0385, 0.0725);
  return {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
          0.0557 * x - 0.2040 * y + 1.0570 * z};
}

// A spectrum's colour where an even one is white. (Of nm and ozone's absorption at its peak, 1/m.)
glm::dvec3 seen(const std::function<double(double, double)>& spectrum) {
  glm::dvec3 sum(0.0), white(0.0);
  for (std::size_t i = 0; i < kOzone_m2.size(); ++i) {
    const double nm = 360 + 10.0 * double(i);
    sum += spectrum(nm, kPeak_per_m3 * kOzone_m2[i]) * primaries(nm);
    white += primaries(nm);
  }
  return sum / white;
}

// The sky's colour in twilight: light that molecules scatter after a long way through air and
// ozone, of so many vertical depths.
TEST(Colour, OzoneTurnsTwilightAsBlueAsSpectraDo) {
  const Air air;
  double worst = 0, worst_plain = 0;
  for (const double air_mass : {1.0, 3.0, 6.0})
    for (const double ozone_mass : {0.0, 5.0, 10.0, 15.0}) {
      const auto light = [&](double rayleigh_per_m, double ozone_per_m) {
        return rayleigh_per_m * std::exp(-air_mass * air.rayleigh_scale_m * rayleigh_per_m -
                                         ozone_mass * 15e3 * ozone_per_m);
      };
      const auto rayleigh_per_m = [](double nm) { return 1.24062e-6 * std::pow(nm / 1000, -4); };
      const glm::dvec3 truth =
          seen([&](double nm, double ozone) { return light(rayleigh_per_m(nm), ozone); });
      glm::dvec3 got, plain;
      const glm::dvec3 at_wavelength(1.2027e-6, 1.8809e-6, 1.2446e-7);
      for (int c = 0; c < 3; ++c) {
        got[c] = light(air.rayleigh_per_m[c], air.ozone_per_m[c]);
        plain[c] = light(air.rayleigh_per_m[c], at_wavelength[c]);
      }
      for (int c = 0; c < 2; ++c) {  // against blue
        worst = std::max(worst, std::abs(got[c] / got.b / (truth[c] / truth.b) - 1));
        worst_plain =
            std::max(worst_plain, std::abs(plain[c] / plain.b / (truth[c] / truth.b) - 1));
      }
    }
  report_accuracy("clear air", "colour of twilight against spectra, red or green over blue", worst,
                  0.1, "relative");
  std::printf("measured: with ozone at single wavelengths: %.2f\n", worst_plain);
  EXPECT_LE(worst, 0.1);
  EXPECT_GT(worst_plain, 2 * worst);
}

}  // namespace
}  // namespace nepho::test
