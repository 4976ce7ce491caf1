#include "tile_boxes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bricks/quantise.h"

namespace nepho::vdb {
namespace {

using Corner = std::array<std::int64_t, 3>;

// Joins boxes that are equal but for touching ends on one axis.
std::vector<TileBox> joined(std::vector<TileBox> boxes, std::size_t axis) {
  const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
  const auto rank = [&](const TileBox& t) {
    return std::tuple(t.value, t.low[b], t.high[b], t.low[c], t.high[c], t.low[axis]);
  };
  std::ranges::sort(boxes, {}, rank);
  std::vector<TileBox> result;
  for (const TileBox& box : boxes) {
    if (!result.empty()) {
      TileBox& last = result.back();
      if (last.value == box.value && last.low[b] == box.low[b] && last.high[b] == box.high[b] &&
          last.low[c] == box.low[c] && last.high[c] == box.high[c] &&
          last.high[axis] + 1 == box.low[axis]) {
        last.high[axis] = box.high[axis];
        continue;
      }
    }
    result.push_back(box);
  }
  return result;
}

// Sum of the weights s - |d| over d <= n.
double triangle_sum(std::int64_t n, std::int64_t s) {
  const auto below = [](std::int64_t k) { return 0.5 * double(k) * double(k + 1); };
  if (n <= -s) return 0;
  if (n < 0) return below(n + s);
  return double(s) * double(s) - below(std::max<std::int64_t>(s - 1 - n, 0));
}

// Share of the samples low..high in the coarse sample at finest index `at`; a root's end has half a
// hat, of the same height.
double share(std::int64_t at, std::int64_t low, std::int64_t high, std::int64_t s,
             std::int64_t cells) {
  const double whole = double(s) * double(s);
  const double end = at == 0 || at == cells ? 2 : 1;
  return end * (triangle_sum(high - at, s) - triangle_sum(low - 1 - at, s)) / whole;
}

// First and last finest sample of a node's closed box.
std::pair<Corner, Corner> closed_box(NodeKey key, std::int64_t step) {
  Corner low{}, high{};
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::int64_t(key.ijk()[a]) * kBrickCells * step;
    high[a] = low[a] + kBrickCells * step;
  }
  return {low, high};
}

bool overlap(const TileBox& box, const Corner& low, const Corner& high) {
  for (std::size_t a = 0; a < 3; ++a)
    if (box.high[a] < low[a] || box.low[a] > high[a]) return false;
  return true;
}

// What the node's own hats reach: its closed box and one own voxel, ends excluded.
std::pair<Corner, Corner> reach(NodeKey key, std::int64_t step) {
  auto [low, high] = closed_box(key, step);
  for (std::size_t a = 0; a < 3; ++a) low[a] -= step - 1, high[a] += step - 1;
  return {low, high};
}

}  // namespace

TileBoxes::TileBoxes(const Lattice& lattice, std::vector<TileBox> boxes)
    : lattice_(lattice), boxes_(std::move(boxes)) {
  for (std::size_t axis = 0; axis < 3; ++axis) boxes_ = joined(std::move(boxes_), axis);
  std::ranges::sort(boxes_, {}, &TileBox::low);
}

bool TileBoxes::touches(NodeKey key) const {
  const auto [low, high] = reach(key, step(key.level()));
  return std::ranges::any_of(boxes_, [&](const TileBox& box) { return overlap(box, low, high); });
}

const TileBox* TileBoxes::covering(NodeKey key) const {
  const std::int64_t s = step(key.level());
  const auto [low, high] = closed_box(key, s);
  for (const TileBox& box : boxes_) {
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a)
      inside = inside && box.low[a] <= low[a] - s && box.high[a] >= high[a] + s;
    if (inside) return &box;
  }
  return nullptr;
}

void TileBoxes::add(NodeKey key, double* samples, bool squared) const {
  const std::int64_t s = step(key.level());
  const auto [low, high] = reach(key, s);
  const std::int64_t cells = lattice_.cells(lattice_.max_level())[0];
  for (const TileBox& box : boxes_) {
    if (!overlap(box, low, high)) continue;
    std::array<std::array<double, kBrickSamples>, 3> weight;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::int64_t g = 0; g < kBrickSamples; ++g)
        weight[a][std::size_t(g)] = share((std::int64_t(key.ijk()[a]) * kBrickCells + g) * s,
                                          box.low[a], box.high[a], s, cells);
    const double value = squared ? box.value * box.value : box.value;
    for (std::size_t k = 0, at = 0; k < kBrickSamples; ++k)
      for (std::size_t j = 0; j < kBrickSamples; ++j)
        for (std::size_t i = 0; i < kBrickSamples; ++i, ++at)
          samples[at] += value * (weight[0][i] * weight[1][j] * weight[2][k]);
  }
}

double TileBoxes::value(const Corner& at) const {
  for (const TileBox& box : boxes_)
    if (overlap(box, at, at)) return box.value;
  return 0;
}

// A box that the node's closed box does not meet lends its samples, and those of all nodes below,
// no more than its share at the nearest face: the hats below are narrower.
double TileBoxes::bound(NodeKey key, double rest) const {
  const std::int64_t s = step(key.level()), cells = lattice_.cells(lattice_.max_level())[0];
  const auto [low, high] = closed_box(key, s);
  const auto [reach_low, reach_high] = reach(key, s);
  double met = rest, lent = 0, most = rest;
  for (const TileBox& box : boxes_) {
    if (!overlap(box, reach_low, reach_high)) continue;
    most = std::max(most, box.value);
    double nearest = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      if (box.low[a] > high[a])
        nearest = std::min(nearest, share(high[a], box.low[a], box.high[a], s, cells));
      if (box.high[a] < low[a])
        nearest = std::min(nearest, share(low[a], box.low[a], box.high[a], s, cells));
    }
    if (overlap(box, low, high))
      met = std::max(met, box.value);
    else
      lent += nearest * box.value;
  }
  return std::min(most, met + lent);
}

NodeSummary TileBoxes::summary(NodeKey key, const NodeSummary& rest,
                               const double* rest_samples) const {
  if (!touches(key)) return rest;
  NodeSummary result;
  result.empty = false;
  const int level = key.level();
  const bool is_finest = level == lattice_.max_level();
  const SplitMask mask = is_finest ? SplitMask(0) : lattice_.split_axes(level);
  result.children = rest.children;
  for (SplitMask octant = 0; !is_finest && octant <= kSplitXyz; ++octant)
    if ((octant & ~mask) == 0 && touches(key.child(mask, octant)))
      result.children |= std::uint8_t(1u << octant);
  if (const TileBox* box = covering(key)) {
    // The codes' offset is the float below the value.
    result.constant_extinction_per_m = float(box->value);
    result.min_extinction_per_m = std::nextafter(float(box->value), 0.0f);
    result.max_extinction_per_m = decoded_bound(box->value);
    return result;
  }
  result.constant = false;
  result.min_extinction_per_m = 0;
  result.max_extinction_per_m = decoded_bound(bound(key, double(rest.max_extinction_per_m)));
  if (is_finest) return result;

  // Both parts lie between 0 and the bound, coarse and fine. <filtered beta^2> is linear in the
  // parts, which share no voxel; <c^2> is not, so the cross term is taken out.
  result.error_bound_per_m = double(result.max_extinction_per_m);
  BrickSamples mean{}, square{};
  add(key, mean.data(), false);
  add(key, square.data(), true);
  double sum = 0, total = 0;
  for (std::size_t k = 0, at = 0; k < kBrickSamples; ++k)
    for (std::size_t j = 0; j < kBrickSamples; ++j)
      for (std::size_t i = 0; i < kBrickSamples; ++i, ++at) {
        const auto half = [](std::size_t g) { return g % kBrickCells ? 1.0 : 0.5; };
        const double weight = half(i) * half(j) * half(k);
        sum += weight * (square[at] - mean[at] * mean[at] - 2 * mean[at] * rest_samples[at]);
        total += weight;
      }
  result.unresolved_variance_per_m2 = std::max(0.0, rest.unresolved_variance_per_m2 + sum / total);
  return result;
}

}  // namespace nepho::vdb
