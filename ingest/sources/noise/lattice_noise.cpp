#include "sources/noise/lattice_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sources/noise/normal.h"

namespace nepho::noise {
namespace {

constexpr std::uint32_t kX = 0x9e3779b1u, kY = 0x85ebca77u, kZ = 0xc2b2ae3du;
constexpr int kNormalBits = 11;

std::uint32_t mixed(std::uint32_t h) {
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return h ^ h >> 15;
}

// Quantiles of the middles of 2048 equal parts, scaled to a variance of 1.
struct NormalTable {
  std::array<double, 1 << kNormalBits> value;
  NormalTable() {
    double square = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] = normal_quantile((double(i) + 0.5) / double(value.size()));
      square += value[i] * value[i];
    }
    const double scale = std::sqrt(double(value.size()) / square);
    for (double& v : value) v *= scale;
  }
};
const NormalTable kNormal;

double normal_at(std::uint32_t linear) {
  return kNormal.value[mixed(linear) >> (32 - kNormalBits)];
}

// Position in a lattice cell: index, weight of the upper end, 1/sqrt of both weights' squares.
struct Axis {
  std::uint32_t index;
  double upper, square;
  explicit Axis(double x) {
    const std::int32_t whole = floor_to_int(x);
    const double f = x - whole;
    index = std::uint32_t(whole);
    upper = f * f * f * (f * (f * 6 - 15) + 10);
    square = (1 - upper) * (1 - upper) + upper * upper;
  }
};
double mixed(double low, double high, const Axis& axis) {
  return low + axis.upper * (high - low);
}

// A map of [0, high] to standard normal values, linear between even knots.
struct Bend {
  static constexpr int kKnots = 1024;
  double per_unit = 1;
  std::array<double, kKnots + 1> value{};
  double operator()(double x) const {
    const double at = std::min(x * per_unit, kKnots - 1e-9);
    const int knot = int(at);
    const double f = at - knot;
    return value[std::size_t(knot)] + f * (value[std::size_t(knot) + 1] - value[std::size_t(knot)]);
  }
};

// Creases end here; what is left is shifted and scaled to mean 0 and variance 1.
constexpr double kCrease = -2.75;

struct Billow : Bend {
  Billow() {
    per_unit = kKnots / kTail;
    for (int i = 0; i <= kKnots; ++i) {
      const double p = 2 * normal_cdf(i / per_unit) - 1;
      value[std::size_t(i)] =
          p <= 0 ? kCrease : std::clamp(normal_quantile(std::min(p, 1 - 1e-9)), kCrease, kTail);
    }
    constexpr int kParts = 16 * kKnots;
    double mean = 0, square = 0, weight = 0;
    for (int i = 0; i < kParts; ++i) {
      const double x = kTail * (i + 0.5) / kParts, w = normal_density(x), v = (*this)(x);
      mean += w * v, square += w * v * v, weight += w;
    }
    mean /= weight;
    const double scale = 1 / std::sqrt(square / weight - mean * mean);
    for (double& v : value) v = std::clamp((v - mean) * scale, -kTail, kTail);
  }
};
const Billow kBillow;

// cell_border_distance() whose share below is Phi(z), z = -2.75, -2.5, ... 3.5; measured on
// 200000 draws, whose moments come out within 0.006 of a normal's (tests/noise, EveryShape).
constexpr std::array<double, 26> kBorderAtNormal = {
#include "sources/noise/cell_quantiles.inc"
};

struct Cells : Bend {
  Cells() {
    per_unit = kKnots / kBorderAtNormal.back();
    std::size_t above = 1;
    for (int i = 0; i <= kKnots; ++i) {
      const double x = i / per_unit;
      while (above + 1 < kBorderAtNormal.size() && kBorderAtNormal[above] < x) ++above;
      const double low = kBorderAtNormal[above - 1], high = kBorderAtNormal[above];
      const double z = kCrease + 0.25 * (double(above) - 1 + (x - low) / (high - low));
      value[std::size_t(i)] = std::clamp(z, kCrease, 3.5);
    }
  }
};
const Cells kCells;

}  // namespace

std::uint32_t hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
  return mixed(std::uint32_t(x) * kX + std::uint32_t(y) * kY + std::uint32_t(z) * kZ + seed);
}

double value_noise(const glm::dvec3& p, std::uint32_t seed) {
  const Axis x(p.x), y(p.y), z(p.z);
  const std::uint32_t at = x.index * kX + y.index * kY + z.index * kZ + seed;
  const double low = mixed(mixed(normal_at(at), normal_at(at + kX), x),
                           mixed(normal_at(at + kY), normal_at(at + kX + kY), x), y);
  const double high = mixed(mixed(normal_at(at + kZ), normal_at(at + kX + kZ), x),
                            mixed(normal_at(at + kY + kZ), normal_at(at + kX + kY + kZ), x), y);
  const double n = mixed(low, high, z) / std::sqrt(x.square * y.square * z.square);
  return std::clamp(n, -kTail, kTail);
}

double value_noise(const glm::dvec2& p, std::uint32_t seed) {
  const Axis x(p.x), y(p.y);
  const std::uint32_t at = x.index * kX + y.index * kY + seed;
  const double n = mixed(mixed(normal_at(at), normal_at(at + kX), x),
                         mixed(normal_at(at + kY), normal_at(at + kX + kY), x), y) /
                   std::sqrt(x.square * y.square);
  return std::clamp(n, -kTail, kTail);
}

double billow(double normal) {
  return kBillow(std::abs(normal));
}

double cell_border_distance(const glm::dvec2& p, std::uint32_t seed) {
  const std::int32_t i = floor_to_int(p.x), j = floor_to_int(p.y);
  const double fx = p.x - i, fy = p.y - j;
  double nearest = 9, second = 9;
  for (std::int32_t dy = -1; dy <= 1; ++dy)
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      const std::uint32_t h = hash(i + dx, j + dy, 0, seed);
      const double x = dx + 0.05 + 0.9 * double(h & 0xffff) / 65536 - fx;
      const double y = dy + 0.05 + 0.9 * double(h >> 16) / 65536 - fy;
      const double d = x * x + y * y;
      second = std::min(second, std::max(nearest, d));
      nearest = std::min(nearest, d);
    }
  return std::sqrt(second) - std::sqrt(nearest);
}

double cells(const glm::dvec2& p, std::uint32_t seed) {
  return kCells(cell_border_distance(p, seed));
}

Range cells_range(const glm::dvec2& p, double radius, std::uint32_t seed) {
  const double distance = cell_border_distance(p, seed);
  return {kCells(std::max(0.0, distance - 2 * radius)), kCells(distance + 2 * radius)};
}

namespace {

double quintic(double f) {
  f = std::clamp(f, 0.0, 1.0);
  return f * f * f * (f * (f * 6 - 15) + 10);
}

// One axis of a box inside one lattice cell: the range of the upper weight and of sqrt(sum w^2).
struct AxisRange {
  double low, high, least, most;
  AxisRange(double first, double last, std::int32_t cell)
      : low(quintic(first - cell)), high(quintic(last - cell)) {
    const double a = norm(low), b = norm(high);
    most = std::max(a, b);
    least = low <= 0.5 && high >= 0.5 ? norm(0.5) : std::min(a, b);
  }
  static double norm(double w) { return std::sqrt((1 - w) * (1 - w) + w * w); }
};

template <int N>
Range range_over(const std::array<double, N>& first, const std::array<double, N>& last,
                 std::uint32_t seed) {
  std::array<std::int32_t, 3> from{}, to{};
  for (int a = 0; a < N; ++a) {
    from[std::size_t(a)] = floor_to_int(first[std::size_t(a)]);
    to[std::size_t(a)] = floor_to_int(last[std::size_t(a)]);
    if (to[std::size_t(a)] - from[std::size_t(a)] > 2) return {-kTail, kTail};
  }
  Range range = {kTail, -kTail};
  for (std::int32_t k = from[2]; k <= to[2]; ++k)
    for (std::int32_t j = from[1]; j <= to[1]; ++j)
      for (std::int32_t i = from[0]; i <= to[0]; ++i) {
        const AxisRange x(first[0], last[0], i), y(first[1], last[1], j);
        const AxisRange z = N == 3 ? AxisRange(first[N - 1], last[N - 1], k) : AxisRange(0, 0, 0);
        const std::uint32_t at = std::uint32_t(i) * kX + std::uint32_t(j) * kY +
                                 (N == 3 ? std::uint32_t(k) * kZ : 0) + seed;
        // Multilinear in the weights, so that its extremes are at the corners of their box.
        double low = 1e9, high = -1e9;
        for (int corner = 0; corner < (1 << N); ++corner) {
          const double wx = corner & 1 ? x.high : x.low, wy = corner & 2 ? y.high : y.low;
          const double wz = corner & 4 ? z.high : z.low;
          const auto plane = [&](std::uint32_t h) {
            const double a = normal_at(h), b = normal_at(h + kX);
            const double c = normal_at(h + kY), d = normal_at(h + kX + kY);
            return (a + wx * (b - a)) * (1 - wy) + (c + wx * (d - c)) * wy;
          };
          double sum = plane(at);
          if (N == 3) sum += wz * (plane(at + kZ) - sum);
          low = std::min(low, sum), high = std::max(high, sum);
        }
        const double least = x.least * y.least * (N == 3 ? z.least : 1);
        const double most = x.most * y.most * (N == 3 ? z.most : 1);
        range.low = std::min(range.low, low / (low < 0 ? least : most));
        range.high = std::max(range.high, high / (high > 0 ? least : most));
      }
  // Roundings of the interpolation.
  return {std::max(range.low - 1e-9, -kTail), std::min(range.high + 1e-9, kTail)};
}

}  // namespace

Range value_noise_range(const glm::dvec3& low, const glm::dvec3& high, std::uint32_t seed) {
  return range_over<3>({low.x, low.y, low.z}, {high.x, high.y, high.z}, seed);
}
Range value_noise_range(const glm::dvec2& low, const glm::dvec2& high, std::uint32_t seed) {
  return range_over<2>({low.x, low.y}, {high.x, high.y}, seed);
}

}  // namespace nepho::noise
