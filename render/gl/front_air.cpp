#include "gl/front_air.h"

#include <algorithm>
#include <cmath>

namespace nepho::gl {
namespace {

constexpr double kShare = 0.01;  // of the tolerance

// Of the cubic through four values, after the part f of the way between the middle two.
std::array<double, 4> weights(double f) {
#if defined(NEPHO_MUTANT_PIXEL_FRONT)
  f = 0;  // the ray before
#endif
  return {-f * (f - 1) * (f - 2) / 6, (f + 1) * (f - 1) * (f - 2) / 2, -(f + 1) * f * (f - 2) / 2,
          (f + 1) * f * (f - 1) / 6};
}

}  // namespace

// One column and row more in front of the picture and behind it: each pixel has four around it.
FrontAir::FrontAir(int width, int height, double tolerance)
    : width_(width),
      columns_((width - 1) / kStep + 4),
      rows_((height - 1) / kStep + 4),
      tolerance_(tolerance) {}

std::vector<std::array<int, 2>> FrontAir::places() const {
  std::vector<std::array<int, 2>> places;
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) places.push_back({(x - 1) * kStep, (y - 1) * kStep});
  return places;
}

void FrontAir::set(const PixelValues& found) {
  nodes_.clear();
  met_.clear();
  for (std::size_t n = 0; n < found.seen.size(); ++n) {
    const PixelTexel &seen = found.seen[n], &met = found.met[n];
    nodes_.push_back({double(seen[0]), double(seen[1]), double(seen[2]), double(met[0]),
                      double(met[1]), double(met[2])});
    met_.push_back(seen[3] != kMissed);
  }
  good_.assign(nodes_.size(), 0);
  for (int y = 1; y + 2 < rows_; ++y)
    for (int x = 1; x + 2 < columns_; ++x)
      good_[std::size_t(y * columns_ + x)] = cell_is_good(x, y);
}

// Four in a row: half way, the cubic is this far from each of the parabolas through three of them.
bool FrontAir::smooth(std::size_t first, std::size_t stride) const {
  for (std::size_t i = 0; i < 6; ++i) {
    const auto value = [&](std::size_t n) { return nodes_[first + n * stride][i]; };
    const double apart = std::abs(value(0) - 3 * value(1) + 3 * value(2) - value(3)) / 16;
    if (!(apart <= kShare * tolerance_ * std::max(value(1), value(2)))) return false;
  }
  return true;
}

bool FrontAir::cell_is_good(int x, int y) const {
  const auto stride = std::size_t(columns_);
  const std::size_t first = std::size_t(y - 1) * stride + std::size_t(x - 1);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      if (!met_[first + j * stride + i]) return false;
  for (std::size_t i = 0; i < 4; ++i)
    if (!smooth(first + i * stride, 1) || !smooth(first + i, stride)) return false;
  return true;
}

bool FrontAir::at(std::uint32_t pixel, Air& air) const {
  const int x = int(pixel) % width_, y = int(pixel) / width_;
  const int cell_x = x / kStep + 1, cell_y = y / kStep + 1;
  const auto stride = std::size_t(columns_);
  if (!good_[std::size_t(cell_y) * stride + std::size_t(cell_x)]) return false;
  const auto wx = weights(double(x % kStep) / kStep), wy = weights(double(y % kStep) / kStep);
  Node sum{};
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      const Node& node =
          nodes_[(std::size_t(cell_y - 1) + j) * stride + std::size_t(cell_x - 1) + i];
      for (std::size_t c = 0; c < 6; ++c) sum[c] += wx[i] * wy[j] * node[c];
    }
  for (std::size_t c = 0; c < 3; ++c) {
    air.radiance[c] = float(std::max(sum[c], 0.0));
    air.transmittance[c] = float(std::clamp(sum[c + 3], 0.0, 1.0));
  }
  return true;
}

}  // namespace nepho::gl
