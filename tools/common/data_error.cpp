#include "common/data_error.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "common/brick_columns.h"
#include "common/framing.h"
#include "core/error.h"

namespace nepho {
namespace {

constexpr int kNodes = 96, kPointsPerNode = 24;

[[noreturn]] void refuse(const BrickSource& source, Status status) {
  char text[512] = "";
  source.last_error(text, sizeof text);
  throw Error({to_string(status), "volume '" + source.info().name + "'", "", text, ""});
}

class Drawing {
 public:
  Drawing(const BrickSource& source, double time_s, std::uint64_t seed)
      : source_(source), info_(source.info()), time_s_(time_s), random_(seed) {}

  // Uniform in [0, 1), the same on every machine.
  double number() { return double(random_() >> 11) * 0x1p-53; }

  struct Node {
    NodeKey key;
    double weight = 1;  // the inverse of its probability
  };
  Node finest_node() {
    constexpr int kTries = 1000;
    for (int n = 0; n < kTries; ++n)
      if (const auto node = descend()) return *node;
    throw Error({"nothing to check", "volume '" + info_.name + "'", "some cloud", "none", ""});
  }

 private:
  // Nothing where the way ends above the finest level: a coarse brick may hold a neighbour's cloud
  // on its face and nothing below.
  std::optional<Node> descend() {
    std::vector<NodeKey> choices;
    for (int root = 0; root < info_.chart->roots(); ++root)
      choices.emplace_back(root, 0, 0u, 0u, 0u);
    Node node{choices.front()};
    for (;;) {
      std::vector<double> most;
      double sum = 0;
      for (const NodeKey key : choices) {
        most.push_back(double(summary_of(source_, key, time_s_).max_extinction_per_m));
        sum += most.back();
      }
      if (!(sum > 0)) return std::nullopt;
      double left = number() * sum;
      std::size_t chosen = 0;
      while (chosen + 1 < most.size() && (left -= most[chosen]) >= 0) ++chosen;
      if (!(most[chosen] > 0)) return std::nullopt;  // by rounding, at the end
      node.key = choices[chosen];
      node.weight *= sum / most[chosen];
      if (node.key.level() == info_.lattice.max_level()) return node;
      choices = info_.lattice.children(node.key);
    }
  }

  const BrickSource& source_;
  const VolumeInfo& info_;
  double time_s_;
  std::mt19937_64 random_;
};

// At a position in cells of the brick, 0 to 8 on each axis.
double interpolated(const std::vector<double>& brick, const glm::dvec3& at) {
  const glm::dvec3 cell = glm::min(glm::floor(at), glm::dvec3(kBrickCells - 1)), f = at - cell;
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
    const int index =
        int(cell.x) + dx + kBrickSamples * (int(cell.y) + dy + kBrickSamples * (int(cell.z) + dz));
    sum += (dx ? f.x : 1 - f.x) * (dy ? f.y : 1 - f.y) * (dz ? f.z : 1 - f.z) *
           brick[std::size_t(index)];
  }
  return sum;
}

}  // namespace

DataError data_error(const BrickSource& source, double time_s, std::uint64_t seed) {
  const VolumeInfo& info = source.info();
  Drawing draw(source, time_s, seed);
  const Index3& cells = info.lattice.cells(info.lattice.max_level());
  DataError result;
  double squares = 0, field_squares = 0, weights = 0;
  for (int n = 0; n < kNodes; ++n) {
    const auto [key, weight] = draw.finest_node();
    const std::vector<double> brick = brick_values(source, key, time_s);
    ++result.nodes;
    for (int p = 0; p < kPointsPerNode; ++p) {
      const double x = draw.number(), y = draw.number(), z = draw.number();
      const glm::dvec3 at = double(kBrickCells) * glm::dvec3(x, y, z);
      const glm::dvec3 q = (double(kBrickCells) * glm::dvec3(key.i(), key.j(), key.k()) + at) /
                           glm::dvec3(cells[0], cells[1], cells[2]);
      double own_per_m = 0;
      const Status status =
          source.point_extinction_per_m(info.chart->ecef_m({key.root(), q}), time_s, own_per_m);
      if (status == Status::kUnsupported)
        throw Error({"this source has no field of its own to check its bricks against",
                     "volume '" + info.name + "'", "", "", ""});
      if (status != Status::kOk) refuse(source, status);
      const double off_per_m = std::abs(interpolated(brick, at) - own_per_m);
      squares += weight * off_per_m * off_per_m;
      field_squares += weight * own_per_m * own_per_m;
      weights += weight;
      result.largest_per_m = std::max(result.largest_per_m, off_per_m);
      ++result.points;
    }
  }
  result.rms_per_m = std::sqrt(squares / weights);
  result.field_rms_per_m = std::sqrt(field_squares / weights);
  return result;
}

}  // namespace nepho
