#include "reference/path/leaves.h"

#include <bit>

#include "bricks/quantise.h"
#include "tree/source_verbs.h"

namespace nepho {
namespace {

// Decoded value at a place, in the units of one code; codes are 9 x 9 x 9, x fastest.
double interpolated(const std::array<std::uint16_t, 729>& codes, std::size_t first,
                    const glm::dvec3& f) {
  const auto along_x = [&](std::size_t c) {
    return double(codes[c]) + f.x * (double(codes[c + 1]) - double(codes[c]));
  };
  const auto layer = [&](std::size_t c) {
    const double near = along_x(c);
    return near + f.y * (along_x(c + 9) - near);
  };
  const double low = layer(first);
  return low + f.z * (layer(first + 81) - low);
}

template <class Codes>
double decoded(const Codes& codes, double code) {
  return double(codes.offset) + double(codes.scale) * code;
}

// The largest of a brick's samples, with what decoding in float may add.
float most_of(const LeafBrick& brick) {
  const std::uint16_t most = *std::ranges::max_element(brick.codes);
  return decoded_bound(
      std::max(double(decode(most, brick.scale, brick.offset)), decoded(brick, double(most))));
}

struct Spot {
  std::size_t first;  // sample
  glm::dvec3 f;
};
Spot spot_of(const Leaves::Leaf& leaf, const ChartRay::Block& block, const glm::dvec3& at) {
  Spot spot{0, glm::dvec3{0.0}};
  std::size_t stride = 1;
  for (int a = 0; a < 3; ++a) {
    const auto i = std::size_t(a);
    const double own = std::clamp(
        (at[a] - double(block.low[i])) / double(std::int64_t(1) << leaf.cell_bits[i]), 0.0, 8.0);
    const auto cell = std::min(std::size_t(own), std::size_t(7));
    spot.first += stride * cell;
    spot.f[a] = own - double(cell);
    stride *= 9;
  }
  return spot;
}

}  // namespace

double Leaves::Leaf::extinction_per_m(const ChartRay::Block& block, const glm::dvec3& at) const {
  if (kind != NodeKind::kBrick) return most_per_m;
  const Spot spot = spot_of(*this, block, at);
  const double extinction = decoded(*brick, interpolated(brick->codes, spot.first, spot.f));
#if defined(NEPHO_MUTANT_HALF_EXTINCTION)
  return 0.5 * extinction;
#endif
  return extinction;
}

double Leaves::Leaf::ice_part(const ChartRay::Block& block, const glm::dvec3& at) const {
  if (kind != NodeKind::kBrick || !brick->ice) return 0;
  const Spot spot = spot_of(*this, block, at);
  const double all = decoded(*brick, interpolated(brick->codes, spot.first, spot.f));
  const double ice = decoded(*brick->ice, interpolated(brick->ice->codes, spot.first, spot.f));
  return all > 0 ? std::clamp(ice / all, 0.0, 1.0) : 0;
}

Leaves::Leaves(const VolumeTree& tree) : tree_(tree) {
  const Lattice& lattice = tree.source->info().lattice;
  const Index3& finest = lattice.cells(lattice.max_level());
  for (int level = 0; level <= lattice.max_level(); ++level) {
    Level& entry = levels_.emplace_back();
    entry.mask = level < lattice.max_level() ? lattice.split_axes(level) : SplitMask(0);
    for (std::size_t a = 0; a < 3; ++a)
      entry.cell_bits[a] = std::countr_zero(finest[a] / lattice.cells(level)[a]);
  }
  nodes_.reserve(tree.nodes.size());
  for (const TreeNode& from : tree.nodes) {
    Node& node = nodes_.emplace_back();
    node.kind = from.kind;
    node.level = std::uint8_t(from.key.level());
    node.first_child = from.first_child;
    node.brick = from.brick;
    if (from.kind == NodeKind::kConstant) node.most_per_m = from.constant_per_m;
    if (from.kind == NodeKind::kBrick) node.most_per_m = most_of(tree.bricks[from.brick]);
#if defined(NEPHO_MUTANT_LOW_MAJORANT)
    if (from.kind == NodeKind::kBrick) node.most_per_m *= 0.7f;
#endif
    if (node.most_per_m == 0 && node.kind != NodeKind::kInner) node.kind = NodeKind::kEmpty;
  }
}

Leaves::Leaf Leaves::leaf(int root, const Index3& finest_cell) const {
  const Node* node = &nodes_[std::size_t(root)];
  for (int level = 0; node->kind == NodeKind::kInner; ++level) {
    const Sizes& bits = levels_[std::size_t(level) + 1].cell_bits;
    const SplitMask mask = levels_[std::size_t(level)].mask;
    std::uint32_t child = 0, bit = 0;
    for (int a = 0; a < 3; ++a)
      if (splits(mask, a)) {
        const auto i = std::size_t(a);
        child |= (finest_cell[i] >> (bits[i] + 3) & 1u) << bit++;
      }
    node = &nodes_[node->first_child + child];
  }
  return {node->kind, double(node->most_per_m),
          node->kind == NodeKind::kBrick ? &tree_.bricks[node->brick] : nullptr,
          levels_[node->level].cell_bits};
}

}  // namespace nepho
