#include "reference/path/leaves.h"

#include <bit>
#include <cmath>

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
    const double own =
        std::clamp((at[a] - double(block.low[i])) * leaf.level->cells_per_finest[a], 0.0, 8.0);
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
    for (std::size_t a = 0; a < 3; ++a) {
      entry.cell_bits[a] = std::countr_zero(finest[a] / lattice.cells(level)[a]);
      entry.cells_per_finest[int(a)] = std::ldexp(1.0, -entry.cell_bits[a]);
    }
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
  make_entries(lattice, tree.source->info().chart->roots());
}

// Of the finest level whose grid has no more places than there are nodes.
void Leaves::make_entries(const Lattice& lattice, int roots) {
  int entry_level = 0;
  for (int level = 0; level <= lattice.max_level(); ++level) {
    const Index3& cells = lattice.cells(level);
    Index3 count{};
    std::size_t places = std::size_t(roots);
    for (std::size_t a = 0; a < 3; ++a) places *= count[a] = std::max(cells[a] / 8, 1u);
    if (level > 0 && places > nodes_.size()) break;
    entry_level = level;
    entry_count_ = count;
  }
  const Level& level = levels_[std::size_t(entry_level)];
  for (std::size_t a = 0; a < 3; ++a) entry_bits_[a] = level.cell_bits[a] + 3;
  for (int root = 0; root < roots; ++root)
    for (std::uint32_t z = 0; z < entry_count_[2]; ++z)
      for (std::uint32_t y = 0; y < entry_count_[1]; ++y)
        for (std::uint32_t x = 0; x < entry_count_[0]; ++x) {
          const Index3 cell{x << entry_bits_[0], y << entry_bits_[1], z << entry_bits_[2]};
          const Node* node = &nodes_[std::size_t(root)];
          for (int l = 0; l < entry_level && node->kind == NodeKind::kInner; ++l)
            node = &child(*node, l, cell);
          entries_.push_back(std::uint32_t(node - nodes_.data()));
        }
}

const Leaves::Node& Leaves::child(const Node& parent, int level, const Index3& finest_cell) const {
  const Sizes& bits = levels_[std::size_t(level) + 1].cell_bits;
  const SplitMask mask = levels_[std::size_t(level)].mask;
  std::uint32_t number = 0, bit = 0;
  for (int a = 0; a < 3; ++a)
    if (splits(mask, a)) {
      const auto i = std::size_t(a);
      number |= (finest_cell[i] >> (bits[i] + 3) & 1u) << bit++;
    }
  return nodes_[parent.first_child + number];
}

Leaves::Leaf Leaves::leaf(int root, const Index3& finest_cell) const {
  std::size_t entry = std::size_t(root);
  for (std::size_t a : {2u, 1u, 0u})
    entry = entry * entry_count_[a] + (finest_cell[a] >> entry_bits_[a]);
  const Node* node = &nodes_[entries_[entry]];
  while (node->kind == NodeKind::kInner) node = &child(*node, node->level, finest_cell);
  return {node->kind, double(node->most_per_m),
          node->kind == NodeKind::kBrick ? &tree_.bricks[node->brick] : nullptr,
          &levels_[node->level]};
}

}  // namespace nepho
