#include "reference/path/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "optics/phase_table.h"
#include "physics/physics_cpp.h"

namespace nepho {

Turn sample_hg(double g, double u) {
  // From the inverse of its distribution, with q = 1 - u; both 1 - cos and 1 + cos are products.
  const double q = 1 - u, d = (1 - g) * q + (1 + g) * u;
#if defined(NEPHO_MUTANT_CLASSIC_HG)
  const float gf = float(g), root = (1 - gf * gf) / (1 - gf + 2 * gf * float(u));
  const float cosine = (1 + gf * gf - root * root) / (2 * gf);
  return {double(1 - cosine), double(std::sqrt(std::max(0.0f, 1 - cosine * cosine)))};
#endif
  const double down = 2 * (1 - g) * (1 - g) * q * (1 + g * u) / (d * d);
  const double sine =
      2 * (1 - g) * (1 + g) / (d * d) * std::sqrt(u * q * (1 + g * u) * (1 - g * q));
  return {down, sine};
}

Turn sample_draine(double g, double alpha, Random& random) {
  while (true) {
    const Turn turn = sample_hg(g, random.uniform());
    const double mu = 1 - turn.one_minus_cos;
    if (random.uniform() * (1 + alpha) < 1 + alpha * mu * mu) return turn;
  }
}

Turn sample_rayleigh(Random& random) {
  while (true) {
    const double down = 2 * random.uniform(), mu = 1 - down;
    if (2 * random.uniform() < 1 + mu * mu) return {down, std::sqrt(down * (2 - down))};
  }
}

glm::dvec3 turned(const glm::dvec3& direction, const Turn& turn, Random& random) {
  // Duff et al. 2017 (JCGT 6(1)): an orthonormal basis without a branch at the poles.
  const double sign = std::copysign(1.0, direction.z), a = -1 / (sign + direction.z);
  const double b = direction.x * direction.y * a;
  const glm::dvec3 first{1 + sign * direction.x * direction.x * a, sign * b, -sign * direction.x};
  const glm::dvec3 second{b, sign + direction.y * direction.y * a, -direction.y};
  const double azimuth = 2 * std::numbers::pi * random.uniform();
  return glm::normalize((1 - turn.one_minus_cos) * direction +
                        turn.sine * (std::cos(azimuth) * first + std::sin(azimuth) * second));
}

PhaseSampler::Kind PhaseSampler::kind_of(PhaseKind kind) {
  if (kind == PhaseKind::kMie) return Kind::kTable;
  return kind == PhaseKind::kHgDraine ? Kind::kHgDraine : Kind::kHenyeyGreenstein;
}

PhaseSampler::PhaseSampler(const Phase& phase)
    : kind_(kind_of(phase.kind)), asymmetry_(phase.asymmetry) {
  if (kind_ == Kind::kHgDraine) fit_ = hg_draine_fit(phase.effective_radius_m);
  const std::vector<float> log_values = phase_table(phase);  // refuses what is out of range
  if (kind_ != Kind::kTable) return;
  for (int c = 0; c < 3; ++c) tables_[std::size_t(c)] = make_table(log_values, c);
}

PhaseSampler::Table PhaseSampler::make_table(const std::vector<float>& log_values, int wavelength) {
  Table table;
  const double norm = std::log(phase_table_moments(log_values, wavelength).integral);
  for (int i = 0; i < kPhaseTexels; ++i) {
    const double half_sine = std::sin(0.5 * phase_texel_angle_rad(i));
    table.from_forward.push_back(2 * half_sine * half_sine);
    table.log_values.push_back(double(log_values[std::size_t(3 * i + wavelength)]) - norm);
  }
  double sum = 0;
  for (std::size_t i = 0; i + 1 < std::size_t(kPhaseTexels); ++i) {
    const double most = std::max(table.log_values[i], table.log_values[i + 1]);
    sum += std::exp(most) * (table.from_forward[i + 1] - table.from_forward[i]);
    table.log_most.push_back(most);
    table.envelope.push_back(sum);
  }
  while (phase_texel_angle_rad(int(table.peak_end)) < kPeak_rad) ++table.peak_end;
  table.peak_part =
      phase_table_moments(log_values, wavelength, int(table.peak_end)).integral / std::exp(norm);
  return table;
}

double PhaseSampler::value(int wavelength, double one_minus_cos) const {
  if (kind_ == Kind::kHenyeyGreenstein) return f64::hg_phase(one_minus_cos, asymmetry_);
  if (kind_ == Kind::kHgDraine) return fit_.value(one_minus_cos);
  if (kind_ == Kind::kRayleigh) return f64::rayleigh_phase(one_minus_cos);
  if (kind_ == Kind::kCornetteShanks) return f64::cornette_shanks_phase(one_minus_cos, asymmetry_);
  const Table& table = tables_[std::size_t(wavelength)];
  const double u = f64::phase_table_coordinate(one_minus_cos) * (kPhaseTexels - 1);
  const auto i = std::size_t(std::clamp(u, 0.0, double(kPhaseTexels - 2)));
  const double f = u - double(i);
  return std::exp(table.log_values[i] + f * (table.log_values[i + 1] - table.log_values[i]));
}

glm::dvec3 PhaseSampler::values(double one_minus_cos) const {
  const double first = value(0, one_minus_cos);
  if (grey()) return glm::dvec3{first};
  return {first, value(1, one_minus_cos), value(2, one_minus_cos)};
}

Turn PhaseSampler::sample(int wavelength, Random& random) const {
  if (kind_ == Kind::kHenyeyGreenstein) return sample_hg(asymmetry_, random.uniform());
  if (kind_ == Kind::kHgDraine) {
    if (random.uniform() < fit_.draine_part)
      return sample_draine(fit_.draine_asymmetry, fit_.alpha, random);
    return sample_hg(fit_.peak_asymmetry, random.uniform());
  }
  if (kind_ == Kind::kRayleigh) return sample_rayleigh(random);
  if (kind_ == Kind::kCornetteShanks) return sample_draine(asymmetry_, 1, random);
  const Table& table = tables_[std::size_t(wavelength)];
  return sample_table(table, wavelength, table.envelope.back(), random);
}

Turn PhaseSampler::sample_table(const Table& table, int wavelength, double mass,
                                Random& random) const {
  while (true) {
    const double below = random.uniform() * mass;
    const auto i =
        std::size_t(std::ranges::upper_bound(table.envelope, below) - table.envelope.begin());
    const double low = table.from_forward[i], high = table.from_forward[i + 1];
    const double down = low + random.uniform() * (high - low);
    if (random.uniform() * std::exp(table.log_most[i]) < value(wavelength, down))
      return {down, std::sqrt(std::max(0.0, down * (2 - down)))};
  }
}

glm::dvec3 PhaseSampler::peak_values(double one_minus_cos) const {
  if (kind_ == Kind::kHgDraine)
    return glm::dvec3{f64::hg_phase(one_minus_cos, fit_.peak_asymmetry)};
  if (kind_ == Kind::kHenyeyGreenstein) return values(one_minus_cos);
  glm::dvec3 densities{0.0};
  for (int c = 0; c < 3; ++c) {
    const Table& table = tables_[std::size_t(c)];
    if (one_minus_cos < table.from_forward[table.peak_end])
      densities[c] = value(c, one_minus_cos) / table.peak_part;
  }
  return densities;
}

Turn PhaseSampler::sample_peak(int wavelength, Random& random) const {
  if (kind_ == Kind::kHgDraine) return sample_hg(fit_.peak_asymmetry, random.uniform());
  if (kind_ == Kind::kHenyeyGreenstein) return sample(wavelength, random);
  const Table& table = tables_[std::size_t(wavelength)];
  return sample_table(table, wavelength, table.envelope[table.peak_end - 1], random);
}

}  // namespace nepho
