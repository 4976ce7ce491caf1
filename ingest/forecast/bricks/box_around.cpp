#include "forecast/bricks/box_around.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bricks/coarsen.h"
#include "core/error.h"

namespace nepho::forecast {
namespace {

constexpr std::size_t kManyNodes = 60'000, kMostNodes = 400'000;

double edge_m(const BoxChart& chart) {
  return chart.edges_m()[0].x;
}

// The extent of a column of a shell's node, curved sides included.
struct Extent {
  glm::dvec3 low{1e30}, high{-1e30};
};
Extent extent_of(const ShellChart& shell, const Lattice& lattice, NodeKey node, std::uint32_t i,
                 std::uint32_t j) {
  const Index3 g = Lattice::global_sample(node, {i, j, 0});
  const Index3& n = lattice.cells(node.level());
  Extent extent;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p =
        shell.ecef_m({node.root(),
                      {double(g[0] + (corner & 1)) / n[0], double(g[1] + (corner >> 1 & 1)) / n[1],
                       double(g[2] + kBrickCells * (corner >> 2)) / n[2]}});
    extent.low = glm::min(extent.low, p);
    extent.high = glm::max(extent.high, p);
  }
  // An arc of chord w rises w^2 / 8 a above it.
  const double width_m = glm::length(extent.high - extent.low);
  const double rise_m = width_m * width_m / (6 * shell.body().polar_m);
  extent.low -= rise_m;
  extent.high += rise_m;
  return extent;
}

}  // namespace

BoxAround::BoxAround(std::shared_ptr<const ShellChart> shell, const HatRemap& remap, int max_level)
    : shell_(std::move(shell)) {
  const double half_m = shell_->body().equatorial_m + shell_->bottom_m() + shell_->thickness_m();
  chart_ = std::make_shared<BoxChart>(glm::dvec3(-half_m), glm::dmat3(2 * half_m));
  if (max_level == 0) {
    max_level = 4;
    while (max_level < NodeKey::kMaxSplitsZ &&
           touched(remap, HatRemap::Part::kTotal, max_level + 1, kManyNodes).size() <= kManyNodes)
      ++max_level;
  }
  lattice_ = Lattice(std::vector<SplitMask>(std::size_t(max_level), kSplitXyz));
}

double BoxAround::voxel_m() const {
  return edge_m(*chart_) / lattice_.cells(lattice_.max_level())[0];
}

std::vector<NodeKey> BoxAround::touched(const HatRemap& remap, HatRemap::Part part, int level,
                                        std::size_t most) const {
  const Lattice& from = remap.lattice();
  const double node_m = edge_m(*chart_) / std::exp2(level), last = std::exp2(level) - 1;
  std::vector<NodeKey> nodes;
  BrickSamples samples;
  const auto unique = [&] {
    std::ranges::sort(nodes);
    nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  };
  std::size_t next = 2 * most;
  for (const NodeKey source : remap.nodes(part)) {
    remap.samples(source, part, samples.data());
    for (std::uint32_t column = 0; column < kBrickCells * kBrickCells; ++column) {
      const std::uint32_t i = column % kBrickCells, j = column / kBrickCells;
      bool any = false;
      for (std::uint32_t at = 0; at < 4 * kBrickSamples && !any; ++at)
        any = samples[brick_offset(i + (at & 1), j + (at >> 1 & 1), at >> 2)] > 0;
      if (!any) continue;
      const Extent extent = extent_of(*shell_, from, source, i, j);
      const glm::dvec3 low =
          glm::clamp(glm::floor((extent.low - chart_->origin_m()) / node_m - 1e-9), glm::dvec3(0),
                     glm::dvec3(last));
      const glm::dvec3 high =
          glm::clamp(glm::floor((extent.high - chart_->origin_m()) / node_m + 1e-9), glm::dvec3(0),
                     glm::dvec3(last));
      for (double z = low.z; z <= high.z; ++z)
        for (double y = low.y; y <= high.y; ++y)
          for (double x = low.x; x <= high.x; ++x)
            nodes.emplace_back(0, level, std::uint32_t(x), std::uint32_t(y), std::uint32_t(z));
    }
    if (nodes.size() < next) continue;
    unique();
    if (nodes.size() > most) return nodes;
    next = 2 * nodes.size() + most;
  }
  unique();
  return nodes;
}

std::vector<NodeKey> BoxAround::nodes(const HatRemap& remap, HatRemap::Part part) const {
  std::vector<NodeKey> nodes = touched(remap, part, lattice_.max_level(), kMostNodes);
  if (nodes.size() > kMostNodes)
    throw Error({"too many cubes around the planet", "parameter 'max_level'",
                 "at most " + std::to_string(kMostNodes) + " bricks",
                 "more at level " + std::to_string(lattice_.max_level()),
                 "choose a smaller max_level"});
  std::vector<char> holds(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t n) {
    BrickSamples values;
    samples(remap, part, nodes[n], values.data());
    holds[n] = std::ranges::any_of(values, [](double value) { return value > 0; });
  });
  std::size_t kept = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (holds[n]) nodes[kept++] = nodes[n];
  nodes.resize(kept);
  return nodes;
}

void BoxAround::samples(const HatRemap& remap, HatRemap::Part part, NodeKey key,
                        double* samples) const {
  for (std::uint32_t at = 0; at < kBrickVolume; ++at) {
    const Index3 g = Lattice::global_sample(key, {at % 9, at / 9 % 9, at / 81});
    samples[at] = remap.interpolated(chart_->ecef_m({0, lattice_.q(key.level(), g)}), part);
  }
}

}  // namespace nepho::forecast
