#include <gtest/gtest.h>

#include <random>

#include "bricks/lattice.h"

namespace nepho {
namespace {

TEST(NodeKey, PacksAndUnpacks) {
  const NodeKey key(5, 31, (1u << 20) - 1, 12345, (1u << 16) - 1);
  const NodeKey same = NodeKey::from_packed(key.packed());
  EXPECT_EQ(same, key);
  EXPECT_EQ(same.root(), 5);
  EXPECT_EQ(same.level(), 31);
  EXPECT_EQ(same.ijk(), (std::array<std::uint32_t, 3>{(1u << 20) - 1, 12345, (1u << 16) - 1}));
  EXPECT_THROW(NodeKey(0, 0, 1u << 20, 0, 0), std::out_of_range);
  EXPECT_THROW(NodeKey(0, 32, 0, 0, 0), std::out_of_range);
}

TEST(NodeKey, OrderIsTotalAndCoarseFirst) {
  EXPECT_LT(NodeKey(5, 0, 0, 0, 0), NodeKey(0, 1, 0, 0, 0));
  EXPECT_LT(NodeKey(0, 1, 1, 1, 1), NodeKey(1, 1, 0, 0, 0));
  EXPECT_LT(NodeKey(0, 1, 0, 1, 1), NodeKey(0, 1, 1, 0, 0));
  EXPECT_LT(NodeKey(0, 1, 0, 0, 1), NodeKey(0, 1, 0, 1, 0));
}

TEST(Lattice, ChildrenKnowTheirParent) {
  const Lattice lattice({kSplitXy, kSplitXy, kSplitXyz, kSplitZ});
  std::vector<NodeKey> level = {NodeKey(3, 0, 0, 0, 0)};
  for (int l = 0; l < lattice.max_level(); ++l) {
    std::vector<NodeKey> next;
    for (const NodeKey key : level)
      for (const NodeKey child : lattice.children(key)) {
        EXPECT_EQ(lattice.parent(child), key);
        next.push_back(child);
      }
    level = next;
  }
  EXPECT_EQ(level.size(), 4u * 4u * 8u * 2u);
  EXPECT_EQ(lattice.cells(4), (Index3{64, 64, 32}));
  EXPECT_THROW(NodeKey().child(kSplitXy, kSplitZ), std::out_of_range);
}

TEST(Lattice, ChildsEvenSamplesAreItsParents) {
  const Lattice lattice({kSplitXy, kSplitXyz, kSplitZ});
  const NodeKey parent(2, 1, 1, 0, 0);
  for (const NodeKey child : lattice.children(parent))
    for (std::uint32_t s = 0; s < kBrickSamples; s += 2) {
      const glm::dvec3 q = lattice.q(2, Lattice::global_sample(child, {s, s, s}));
      const Index3 n = lattice.cells(1);
      for (const double g : {q.x * n[0], q.y * n[1], q.z * n[2]}) EXPECT_EQ(g, std::floor(g));
    }
}

TEST(Lattice, PositionFindsItsNodeAtAnyDepth) {
  const Lattice lattice(std::vector<SplitMask>(16, kSplitXyz));
  std::mt19937 random(1);
  const auto below = [&](std::uint32_t end) { return std::uint32_t(random() % end); };
  for (int trial = 0; trial < 20000; ++trial) {
    const int level = int(below(17));
    const Index3 n = lattice.nodes(level);
    const NodeKey key(0, level, below(n[0]), below(n[1]), below(n[2]));
    const Index3 s = {1 + below(7), 1 + below(7), 1 + below(7)};
    const Index3 g = Lattice::global_sample(key, s);
    const glm::dvec3 q = lattice.q(level, g);
    EXPECT_EQ(lattice.node_at(0, q, level), key);
    EXPECT_EQ(q.x * lattice.cells(level)[0], g[0]);
  }
}

TEST(Lattice, RefusesWhatAKeyCannotName) {
  EXPECT_NO_THROW(Lattice(std::vector<SplitMask>(20, kSplitXy)));
  EXPECT_THROW(Lattice(std::vector<SplitMask>(21, kSplitXy)), std::invalid_argument);
  EXPECT_THROW(Lattice(std::vector<SplitMask>(17, kSplitZ)), std::invalid_argument);
  EXPECT_THROW(Lattice({SplitMask{0}}), std::invalid_argument);
}

TEST(Lattice, OutsidePositionsGoToTheNearestNode) {
  const Lattice lattice(std::vector<SplitMask>(4, kSplitXyz));
  EXPECT_EQ(lattice.node_at(0, {-1, 0.5, 1}, 4), NodeKey(0, 4, 0, 8, 15));
  EXPECT_EQ(lattice.node_at(0, {1e300, -1e300, 0}, 4), NodeKey(0, 4, 15, 0, 0));
  const double nan = std::nan("");
  EXPECT_EQ(lattice.node_at(0, {nan, nan, nan}, 4), NodeKey(0, 4, 0, 0, 0));
}

}  // namespace
}  // namespace nepho
