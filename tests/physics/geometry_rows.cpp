// Rays from 1.7 m to 1e9 m against walls of the lattice; truth in extended precision.
#include <algorithm>
#include <numbers>

#include "bricks/shell_chart.h"
#include "case_rows.h"

namespace nepho::test {
namespace {

using std::numbers::pi;
constexpr double kRadius_m = 6378137;
constexpr double kNearest_m = 1.7, kFarthest_m = 1e9;
constexpr double kNoHit = 1e30;
constexpr int kRows = 20000, kWallRows = 100000;

// The camera's frame on one axis, as the CPU makes it in double.
void set_frame(Row& row, double camera_cells, std::size_t offset) {
  const double nearest = std::nearbyint(camera_cells);
  row.nearest = int(nearest);
  row.x[offset] = camera_cells - nearest;
}

double plus_or_minus(Random& random, double size) {
  return random.integer(0, 1) ? size : -size;
}

bool angular_wall(Random& random, Row& row) {
  const int n = 8 << random.integer(0, 20);
  const double spacing = pi / 2 / n;
  const double rho = kRadius_m * random.uniform(0.7, 1) +
                     (random.integer(0, 3) ? random.uniform(0, 4e4) : random.log_uniform(4e4, 1e9));
  const double camera = random.uniform(0, n);
  const glm::dvec3 d = random.direction();
  const double radial = rounded(d.x), tangential = rounded(d.y);
  // A wall near the point that the ray reaches at a random distance.
  const double reach = random.log_uniform(kNearest_m, kFarthest_m);
  const double at = std::atan2(reach * tangential, rho + reach * radial) / spacing + camera;
  row.wall = int(at) + (at > camera ? 1 : 0);
  row.x = {rho, 0, spacing, radial, tangential, 0};
  set_frame(row, camera, 1);
  // Truth: the plane through the axis.
  const Real w = (row.wall - n / 2.0L) * (std::numbers::pi_v<Real> / 2 / n);
  const Real a = (Real(camera) - n / 2.0L) * (std::numbers::pi_v<Real> / 2 / n);
  const Real dx = radial * cosl(a) - tangential * sinl(a);
  const Real dy = radial * sinl(a) + tangential * cosl(a);
  const Real ox = rho * cosl(a), oy = rho * sinl(a);
  const Real across = dy * cosl(w) - dx * sinl(w), t = (ox * sinl(w) - oy * cosl(w)) / across;
  const Real along = (ox + t * dx) * cosl(w) + (oy + t * dy) * sinl(w);
  const double delta = double(w - a);
  const double condition =
      1 + (std::abs(tangential * std::cos(delta)) + std::abs(radial * std::sin(delta)) +
           std::abs(tangential * delta / std::sin(delta))) /
              std::abs(double(across));
  if (std::abs(delta) > pi || fabsl(t) < kNearest_m || fabsl(t) > kFarthest_m) return false;
  // Whether the wall or its other half is met is decided within rounding of the axis.
  if (fabsl(along) < 1e-4L * rho || condition > 1e5) return false;
  row.truth[0] = along > 0 ? double(t) : kNoHit;
  row.scale[0] = along > 0 ? condition * double(fabsl(t)) : kNoHit;
  return true;
}

bool sphere(Random& random, Row& row) {
  const int n = 8 << random.integer(0, 16);
  const double spacing = 40000.0 / n;
  const double highest = std::min(25000.0 * n, 2e9);  // 1e9 m, and what int holds
  const double camera =
      random.integer(0, 3) ? random.uniform(0, n) : random.log_uniform(n, highest);
  const double r0 = kRadius_m + camera * spacing;
  row.wall = random.integer(0, 1)
                 ? random.integer(0, n)
                 : int(std::nearbyint(std::min<double>(camera, n))) + random.integer(-2, 2);
  const double mu =
      rounded(random.integer(0, 1) ? random.uniform(-1, 1)
                                   : plus_or_minus(random, random.log_uniform(1e-6, 1)));
  row.x = {r0, 0, spacing, mu, 0, 0};
  set_frame(row, camera, 1);
  const Real above = (Real(camera) - row.wall) * spacing, b = Real(r0) * mu;
  const Real product = above * (2 * Real(r0) - above), discriminant = b * b - product;
  const double condition = 1 + double((b * b + fabsl(product)) / fabsl(discriminant));
  // Closer to the limb than float can see, hit or miss is a matter of rounding.
  if (!(condition < 1e6)) return false;
  if (discriminant < 0) {
    row.truth = row.scale = {kNoHit, kNoHit, 0};
    return true;
  }
  const Real q = -(b + copysignl(sqrtl(discriminant), b)), other = product / q;
  const Real hits[2] = {std::min(q, other), std::max(q, other)};
  for (std::size_t i = 0; i < 2; ++i) {
    const Real size = fabsl(hits[i]);
    if (size < kNearest_m || size > kFarthest_m) continue;
    row.truth[i] = double(hits[i]);
    row.scale[i] = condition * double(size);
  }
  return row.scale[0] > 0 || row.scale[1] > 0;
}

// At the limb, with inputs of so few bits that b, c's factors and the truth are exact: what is left
// is the difference b^2 - c, and hit or miss must be right however small it is.
bool limb(Random& random, Row& row) {
  const double r0 = 2048.0 * random.integer(2048, 4095);
  const double steep = random.integer(1500, 4000) / 4096.0, b = r0 * steep;
  const double above = std::nearbyint(r0 - std::sqrt(r0 * r0 - b * b)) + random.integer(-1, 1);
  row.x = {r0, 0, 1, random.integer(0, 1) ? steep : -steep, 0, 0};
  row.nearest = int(above);
  const Real c = Real(above) * (2 * Real(r0) - above), discriminant = Real(b) * b - c;
  if (discriminant < 0) {
    row.truth = row.scale = {kNoHit, kNoHit, 0};
    return true;
  }
  const Real root = sqrtl(discriminant), middle = -Real(r0) * row.x[3];
  row.truth = {double(middle - root), double(middle + root), 0};
  row.scale = {std::abs(row.truth[0]), std::abs(row.truth[1]), 0};
  return true;
}

}  // namespace

std::vector<Row> rows_of_angular_walls() {
  return random_rows(kWallRows, angular_wall);
}
std::vector<Row> rows_of_spheres() {
  std::vector<Row> rows = random_rows(kWallRows, sphere);
  for (const Row& row : random_rows(kRows, limb)) rows.push_back(row);
  return rows;
}

std::vector<Row> rows_of_offsets() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.nearest = random.integer(0, 1 << 23);
    row.wall =
        random.integer(0, 1) ? random.integer(0, 1 << 23) : row.nearest + random.integer(-3, 3);
    row.x[0] = rounded(random.uniform(-0.5, 0.5));
    row.x[1] = rounded(random.log_uniform(1e-8, 1));
    const Real truth = (Real(row.wall) - row.nearest - Real(row.x[0])) * Real(row.x[1]);
    row.truth[0] = double(truth);
    row.scale[0] = double(fabsl(truth));
    return true;
  });
}

std::vector<Row> rows_of_box_walls() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.nearest = random.integer(0, 1 << 20);
    row.wall = row.nearest + random.integer(-40, 40);
    row.x[0] = random.uniform(-0.5, 0.5);
    row.x[1] = random.log_uniform(0.01, 1e4);
    const bool along = random.integer(0, 30) == 0;
    row.x[2] = along ? 0 : rounded(plus_or_minus(random, random.log_uniform(1e-6, 1)));
    const Real cells = Real(row.wall) - row.nearest - Real(row.x[0]);
    row.truth[0] = along ? kNoHit : double(cells * row.x[1] / row.x[2]);
    row.scale[0] = std::abs(row.truth[0]);
    return true;
  });
}

std::vector<Row> rows_of_swept_angles() {
  return random_rows(kWallRows, [](Random& random, Row& row) {
    const glm::dvec3 d = random.direction();
    const Real r = kRadius_m + random.log_uniform(1, 1e9);
    const Real t = random.log_uniform(kNearest_m, kFarthest_m);
    row.x = {double(r), double(t), rounded(d.x), rounded(d.y), 0, 0};
    const Real x = r + t * row.x[2], y = t * row.x[3];
    row.truth[0] = double(atan2l(y, x));
    // Moves of x and y by one part of their terms, seen from the origin, and the angle's own.
    row.scale[0] = double(fabsl(y) * (fabsl(x) + r + t * fabsl(Real(row.x[2]))) / (x * x + y * y)) +
                   std::abs(row.truth[0]);
    return true;
  });
}

std::vector<Row> rows_of_heights_along_rays() {
  return random_rows(kWallRows, [](Random& random, Row& row) {
    row.x[0] = kRadius_m + random.log_uniform(1, 1e9);
    row.x[1] = random.log_uniform(kNearest_m, kFarthest_m);
    row.x[2] = rounded(random.integer(0, 1) ? random.uniform(-1, 1)
                                            : plus_or_minus(random, random.log_uniform(1e-6, 1)));
    const Real r = row.x[0], t = row.x[1], mu = row.x[2], end = sqrtl(r * r + t * (2 * r * mu + t));
    row.truth[0] = double(t * (2 * r * mu + t) / (end + r));
    // Of the terms, and of r' where the ray passes near the centre.
    row.scale[0] = double(t * (2 * r * fabsl(mu) + t) / (end + r) * (1 + r / end));
    return true;
  });
}

std::vector<Row> rows_of_heights_of_offsets() {
  return random_rows(kRows, [](Random& random, Row& row) {
    const double side = random.log_uniform(1, 5e5);
    const double up = plus_or_minus(random, random.log_uniform(1, 5e5));
    row.x = {rounded(kRadius_m), rounded(up), rounded(side * side + up * up), 0, 0, 0};
    const Real r = row.x[0], rise = 2 * r * Real(row.x[1]) + Real(row.x[2]);
    const Real end = sqrtl(r * r + rise);
    row.truth[0] = double(rise / (end + r));
    row.scale[0] = double((2 * r * fabsl(Real(row.x[1])) + Real(row.x[2])) / (end + r));
    return true;
  });
}

std::vector<Row> rows_of_geodetic_heights() {
  return random_rows(kRows, [](Random& random, Row& row) {
    const Ellipsoid body = Ellipsoid::wgs84();
    const double latitude = random.uniform(-pi / 2, pi / 2);
    const double height = random.integer(0, 1) ? random.uniform(-500, 1e5) : random.uniform(0, 1e4);
    const glm::dvec3 p = geodetic_to_ecef_m(body, latitude, 0.3, height);
    const Real z = Real(p.z) * body.equatorial_m / body.polar_m;
    const Real r = sqrtl(Real(p.x) * p.x + Real(p.y) * p.y + z * z);
    row.x = {double(r - body.equatorial_m), body.equatorial_m, body.polar_m, double(z / r), 0, 0};
    row.truth[0] = height;
    // Relative above 1 km; below, what float leaves of a kilometre.
    row.scale[0] = std::max(std::abs(height), 1000.0);
    return true;
  });
}

std::vector<Row> rows_of_simpson_steps() {
  return random_rows(kRows, [](Random& random, Row& row) {
    row.x = {rounded(random.log_uniform(1, 2e6)),
             rounded(kRadius_m),
             rounded(random.log_uniform(25, 12000)),
             0,
             0,
             0};
    const Real s = row.x[0] * (row.x[0] / Real(row.x[2]) + 3) / (8 * Real(row.x[1]));
    const Real steps = powl(s / 7e-4L, 0.25L);
    // Where rounding decides between two counts, both are right.
    if (fabsl(steps - roundl(steps)) < 1e-6L * steps) return false;
    row.truth[0] = std::max(1.0, double(ceill(steps)));
    row.scale[0] = 1;
    return true;
  });
}

}  // namespace nepho::test
