#include "landscape.h"

#include "hash_noise.h"

namespace nepho::samples {
namespace {

constexpr std::uint64_t kSeed = 4100;

double bump(double at, double centre, double width) {
  const double d = (at - centre) / width;
  return std::exp(-d * d);
}

// Ridged multifractal (Musgrave in Ebert et al., Texturing and Modeling, 2003): sharp crests, and
// detail where the ground is high already. About 0..1.
double ridges(glm::dvec3 p, int octaves) {
  double sum = 0, weight = 1, amplitude = 0.62;
  for (int octave = 0; octave < octaves; ++octave) {
    const double crest =
        1 - std::min(1.0, 1.7 * std::abs(gradient_noise(p, kSeed + 40 + std::uint64_t(octave))));
    const double value = crest * crest * weight;
    sum += amplitude * value;
    weight = std::clamp(1.8 * value, 0.0, 1.0);
    amplitude *= 0.55;
    p = glm::dvec3(0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y, 0) * 2.07;
  }
  return sum;
}

}  // namespace

Landscape landscape(double x_m, double y_m) {
  const glm::dvec3 p = {x_m, y_m, 0};
  const double bays_m = 16e3 * fractal_noise(p / 58e3, 3, kSeed);
  const double inland_m = x_m + 38e3 - 0.12 * y_m + bays_m;
  if (inland_m <= 0) return {inland_m, 0, 0};
  // what the ranges follow is the coast's smooth part
  const double s_m = x_m + 38e3 - 0.12 * y_m + 11e3 * gradient_noise(p / 75e3, kSeed + 9);
  const double shore = smooth_step(0, 9e3, inland_m);
  const double hills_m = 620 * bump(s_m, 21e3, 11e3);
  const double range_m = 1950 * bump(s_m, 93e3, 24e3);
  const double plateau_m = 900 * smooth_step(62e3, 118e3, s_m);
  const glm::dvec3 warp = {3e3 * gradient_noise(p / 17e3, kSeed + 20),
                           3e3 * gradient_noise(p / 17e3, kSeed + 21), 0};
  const double ridge = ridges((p + warp) / glm::dvec3(23e3, 31e3, 1), 4);
  const double envelope_m = shore * (60 + 0.45 * (hills_m + range_m) + plateau_m);
  const double rough_m = (hills_m + range_m + 0.3 * plateau_m) * (ridge - 0.28);
  const double height_m = shore * (55 + 0.45 * (hills_m + range_m) + plateau_m + 1.05 * rough_m);
  return {inland_m, std::max(2.0 + 10 * shore, height_m), envelope_m};
}

}  // namespace nepho::samples
