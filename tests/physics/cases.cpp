// Radiometric cases. The geometric ones: geometry_rows.cpp.
#include "cases.h"

#include <algorithm>
#include <numbers>

#include "case_rows.h"

namespace nepho::test {
namespace {

using std::numbers::pi;
constexpr Real kPi = std::numbers::pi_v<Real>;
constexpr int kRows = 20000;

void expect(Row& row, std::size_t output, Real truth, Real scale) {
  row.truth[output] = double(truth);
  row.scale[output] = double(scale);
}

std::vector<Row> rows_of_e0() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.x[0] = rounded(random.log_uniform(1e-8, 1e8));
    const Real x = row.x[0], truth = -expm1l(-x) / x;
    expect(row, 0, truth, truth);
    return true;
  });
}

Real w1(Real x) {
  if (x > 0.5L) return (1 - (1 + x) * expl(-x)) / (x * x);
  Real term = 0.5L, sum = 0;
  for (int n = 0; n < 30; ++n) {
    sum += term;
    term *= -x * Real(n + 2) / (Real(n + 1) * Real(n + 3));
  }
  return sum;
}

std::vector<Row> rows_of_w1() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.x[0] = rounded(random.log_uniform(1e-8, 1e8));
    expect(row, 0, w1(row.x[0]), w1(row.x[0]));
    return true;
  });
}

std::vector<Row> rows_of_simpson() {
  return random_rows(kRows, [](Random& random, Row& row) {
    for (std::size_t i = 0; i < 4; ++i) row.x[i] = rounded(random.log_uniform(1e-6, 1e4));
    const Real truth = Real(row.x[3]) * (row.x[0] + 4 * Real(row.x[1]) + row.x[2]) / 6;
    expect(row, 0, truth, truth);
    return true;
  });
}

std::vector<Row> rows_of_steps() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.x[0] = rounded(random.log_uniform(1e-4, 1));
    row.x[1] = rounded(random.log_uniform(1e-4, 1));
    row.x[2] = rounded(random.log_uniform(1e-8, 1e4));
    // Integral of (s0 + (s1 - s0) y / tau) e^-y over y = 0 .. tau.
    const Real s0 = row.x[0], s1 = row.x[1], tau = row.x[2], first = tau * tau * w1(tau);
    const Real truth = s0 * -expm1l(-tau) + (s1 - s0) / tau * first;
    expect(row, 0, truth, truth);
    return true;
  });
}

// Angles from the forward peak to the backward direction, asymmetries up to 0.999 of both signs.
void draw_scattering(Random& random, Row& row) {
  const double angle = random.integer(0, 1) ? random.log_uniform(1e-6, pi) : random.uniform(0, pi);
  const double sine = std::sin(angle / 2);
  const double below_one = random.log_uniform(1e-3, 1);
  row.x[0] = rounded(2 * sine * sine);
  row.x[1] = rounded(random.integer(0, 1) ? 1 - below_one : below_one - 1);
}

Real hg(Real one_minus_cos, Real g) {
  const Real k = 1 + g * g - 2 * g * (1 - one_minus_cos);
  return (1 - g * g) / (4 * kPi * k * sqrtl(k));
}

std::vector<Row> rows_of_hg() {
  return random_rows(kRows, [](Random& random, Row& row) {
    draw_scattering(random, row);
    expect(row, 0, hg(row.x[0], row.x[1]), hg(row.x[0], row.x[1]));
    return true;
  });
}

std::vector<Row> rows_of_cornette_shanks() {
  return random_rows(kRows, [](Random& random, Row& row) {
    draw_scattering(random, row);
    const Real g = row.x[1], mu = 1 - Real(row.x[0]);
    const Real truth = hg(row.x[0], g) * 1.5L * (1 + mu * mu) / (2 + g * g);
    expect(row, 0, truth, truth);
    return true;
  });
}

std::vector<Row> rows_of_rayleigh() {
  return random_rows(kRows, [](Random& random, Row& row) {
    draw_scattering(random, row);
    const Real mu = 1 - Real(row.x[0]), truth = 3 / (16 * kPi) * (1 + mu * mu);
    expect(row, 0, truth, truth);
    return true;
  });
}

std::vector<Row> rows_of_table_coordinates() {
  return random_rows(kRows, [](Random& random, Row& row) {
    draw_scattering(random, row);
    const Real truth = sqrtl(2 * asinl(sqrtl(Real(row.x[0]) / 2)) / kPi);
    expect(row, 0, truth, truth);
    return true;
  });
}

std::vector<Row> rows_of_octaves() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.wall = random.integer(0, 7);
    row.x[0] = rounded(random.log_uniform(1e-3, 50));
    row.x[1] = rounded(random.uniform(-1, 1));
    const Real n = row.wall, depth = powl(0.4L, n) * row.x[0];
    expect(row, 0, powl(0.651L, n), powl(0.651L, n));
    expect(row, 1, expl(-depth), expl(-depth) * (1 + depth));
    expect(row, 2, row.x[1] * powl(0.684L, n), fabsl(row.x[1]) * powl(0.684L, n));
    return true;
  });
}

std::vector<Row> rows_of_sin_cos() {
  return random_rows(kRows, [](Random& random, Row& row) {
    const double size = random.integer(0, 2) ? random.log_uniform(1e-9, pi) : random.uniform(0, pi);
    row.x[0] = rounded(random.integer(0, 1) ? size : -size);
    if (std::abs(row.x[0]) > pi) return false;
    const Real s = sinl(row.x[0]);
    expect(row, 0, s, size < pi / 2 ? fabsl(s) : 2);
    expect(row, 1, cosl(row.x[0]), 2);
    return true;
  });
}

std::vector<Row> rows_of_arc_tangents() {
  return random_rows(kRows, [](Random& random, Row& row) {
    const double angle =
        random.integer(0, 1) ? random.uniform(0, pi) : random.log_uniform(1e-9, pi);
    const double size = random.log_uniform(1e-6, 1e6);
    row.x[0] = rounded(size * std::sin(random.integer(0, 1) ? angle : -angle));
    row.x[1] = rounded(size * std::cos(angle));
    const Real truth = atan2l(row.x[0], row.x[1]);
    expect(row, 0, truth, fabsl(truth));
    return true;
  });
}

std::vector<Row> rows_of_skies() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.x[0] = rounded(random.integer(0, 1) ? random.uniform(-1, 1) : random.uniform(-0.06, 0.06));
    for (std::size_t i = 1; i < 4; ++i) row.x[i] = rounded(random.log_uniform(1e-3, 10));
    const Real s = row.x[0], zenith = row.x[1], horizon = row.x[2], below = row.x[3];
    const Real down = std::min(-s / 0.052L, Real(1));
    const Real truth = s >= 0 ? zenith + (horizon - zenith) * powl(1 - s, 3)
                              : horizon + (below - horizon) * down * down * (3 - 2 * down);
    expect(row, 0, truth, std::max({zenith, horizon, below}));
    return true;
  });
}

std::vector<Row> rows_of_sky_sources() {
  return random_rows(kRows, [](Random& random, Row& row) {
    for (std::size_t i = 0; i < 3; ++i) row.x[i] = rounded(random.log_uniform(1e-3, 40));
    for (std::size_t i = 3; i < 6; ++i) row.x[i] = rounded(random.log_uniform(1e-3, 10));
    Real sum = 0, scale = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Real depth = Real(row.x[i]) / 5, part = (i == 1 ? 4 : 1) * expl(-depth) * row.x[3 + i];
      sum += part / 6;
      scale += part * (1 + depth) / 6;
    }
    expect(row, 0, sum, scale);
    return true;
  });
}

std::vector<Row> rows_of_luminance() {
  return random_rows(kRows, [](Random& random, Row& row) {
    for (std::size_t i = 0; i < 3; ++i) row.x[i] = rounded(random.log_uniform(1e-4, 1e4));
    const Real truth = 0.2126L * row.x[0] + 0.7152L * row.x[1] + 0.0722L * row.x[2];
    expect(row, 0, truth, truth);
    return true;
  });
}

// Hill's fit as it was published: two matrices around a rational curve.
std::vector<Row> rows_of_tones() {
  constexpr Real in[3][3] = {{0.59719L, 0.35458L, 0.04823L},
                             {0.07600L, 0.90834L, 0.01566L},
                             {0.02840L, 0.13383L, 0.83777L}};
  constexpr Real out[3][3] = {{1.60475L, -0.53108L, -0.07367L},
                              {-0.10208L, 1.10813L, -0.00605L},
                              {-0.00327L, -0.07276L, 1.07602L}};
  return random_rows(kRows, [&](Random& random, Row& row) {
    for (std::size_t i = 0; i < 3; ++i) row.x[i] = rounded(random.log_uniform(1e-4, 1e4));
    Real curve[3];
    for (std::size_t i = 0; i < 3; ++i) {
      Real v = 0;
      for (std::size_t j = 0; j < 3; ++j) v += in[i][j] * row.x[j];
      curve[i] =
          (v * (v + 0.0245786L) - 0.000090537L) / (v * (0.983729L * v + 0.4329510L) + 0.238081L);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      Real shown = 0;
      for (std::size_t j = 0; j < 3; ++j) shown += out[i][j] * curve[j];
      expect(row, i, std::clamp(shown, Real(0), Real(1)), 1);
    }
    return true;
  });
}

std::vector<Row> rows_of_srgb() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.x[0] = rounded(random.log_uniform(1e-4, 1));
    const Real x = row.x[0];
    const Real truth = x <= 0.0031308L ? 12.92L * x : 1.055L * powl(x, 1 / 2.4L) - 0.055L;
    expect(row, 0, truth, 1);
    return true;
  });
}

constexpr Case kCases[] = {
    {"exp_e0", 0, 2e-7, 4e-10, 2e-6, rows_of_e0},
    {"exp_w1", 1, 6e-7, 8e-10, 2e-6, rows_of_w1},
    {"simpson_optical_depth", 2, 3e-7, 5e-16, 6e-7, rows_of_simpson},
    {"step_radiance", 3, 5e-7, 8e-10, 2e-6, rows_of_steps},
    {"hg_phase", 4, 4e-7, 2e-13, 8e-7, rows_of_hg},
    {"cornette_shanks_phase", 5, 5e-7, 2e-13, 1e-6, rows_of_cornette_shanks},
    {"rayleigh_phase", 6, 2e-7, 5e-16, 4e-7, rows_of_rayleigh},
    {"phase_table_coordinate", 7, 2e-7, 1e-10, 6e-7, rows_of_table_coordinates},
    {"octaves", 8, 4e-7, 2e-15, 2e-6, rows_of_octaves},
    {"sin_cos_small", 9, 3e-7, 2e-7, 6e-7, rows_of_sin_cos},
    {"arc_tangent", 10, 3e-7, 1e-10, 6e-7, rows_of_arc_tangents},
    {"sky_radiance", 11, 3e-7, 5e-16, 6e-7, rows_of_skies},
    {"sky_source", 12, 3e-7, 1e-15, 2e-6, rows_of_sky_sources},
    {"luminance", 13, 3e-7, 1e-15, 6e-7, rows_of_luminance},
    {"aces_tone", 14, 6e-7, 2e-15, 2e-6, rows_of_tones},
    {"srgb_encode", 15, 3e-7, 5e-16, 2e-6, rows_of_srgb},
    {"wall_offset", 20, 1.5e-7, 5e-16, 3e-7, rows_of_offsets},
    {"angular_wall_distance", 21, 2.4e-7, 1e-8, 5e-7, rows_of_angular_walls},
    {"sphere_wall_distances", 22, 2e-7, 5e-16, 4e-7, rows_of_spheres},
    {"box_wall_distance", 23, 2.5e-7, 5e-16, 5e-7, rows_of_box_walls},
    {"angle_along_ray", 24, 2e-7, 1e-10, 4e-7, rows_of_swept_angles},
    {"height_along_ray", 25, 3e-7, 1e-15, 6e-7, rows_of_heights_along_rays},
    {"height_of_offset", 26, 3e-7, 1e-15, 6e-7, rows_of_heights_of_offsets},
    {"geodetic_height", 27, 5e-7, 2e-7, 8e-7, rows_of_geodetic_heights},
    {"simpson_steps", 28, 0, 0, 0, rows_of_simpson_steps},
};

}  // namespace

std::span<const Case> cases() {
  return kCases;
}

}  // namespace nepho::test
