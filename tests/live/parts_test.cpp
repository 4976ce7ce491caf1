// What a live renderer remembers: bricks by the byte, slots of leaves.
#include <gtest/gtest.h>

#include "live/cached_source.h"
#include "live/live_budget.h"
#include "live/slots.h"
#include "live_scenes.h"
#include "tree/source_verbs.h"

namespace nepho::test {
namespace {

SlotKey leaf(std::uint32_t i) {
  return {nullptr, 0, NodeKey(0, 4, i, 0, 0)};
}

TEST(Slots, AreSharedAndKeptUntilTheyAreWanted) {
  Slots slots(2);
  const auto a = slots.take(leaf(1));
  ASSERT_TRUE(a);
  slots[*a].has_brick = true;
  EXPECT_EQ(slots.take(leaf(1)), a);  // of two trees
  slots.release(*a);
  const auto b = slots.take(leaf(2));
  ASSERT_TRUE(b);
  EXPECT_NE(a, b);
  EXPECT_FALSE(slots.take(leaf(3)));  // both have users
  slots.release(*a);
  EXPECT_EQ(slots.take(leaf(1)), a);  // out of use, and still there
  EXPECT_TRUE(slots[*a].has_brick);
  slots.release(*a);
  const auto c = slots.take(leaf(3));
  EXPECT_EQ(c, a);  // now it was wanted
  EXPECT_FALSE(slots[*c].has_brick);
  EXPECT_EQ(slots.in_use(), 2u);
}

TEST(Slots, LongestOutOfUseGoFirst) {
  Slots slots(3);
  for (std::uint32_t n = 0; n < 3; ++n) ASSERT_TRUE(slots.take(leaf(n)));
  for (const std::uint32_t n : {1u, 0u, 2u}) slots.release(n);
  EXPECT_EQ(slots.take(leaf(10)), 1u);
  EXPECT_EQ(slots.take(leaf(11)), 0u);
}

TEST(CachedSource, ReadsOnceAndKeepsWithinItsBytes) {
  const FieldSource field = puffs();
  const SlowSource counted(field, std::chrono::microseconds(0));
  const std::uint64_t most = 40 << 10;
  const CachedSource cached(counted, most);
  LeafBrick mine, truth;
  const NodeKey key(0, 2, 1, 1, 1);
  for (int n = 0; n < 3; ++n) {
    read_brick(cached, 0, key, mine);
    read_brick(field, 0, key, truth);
    EXPECT_EQ(mine.codes, truth.codes);
    EXPECT_EQ(mine.scale, truth.scale);
  }
  EXPECT_EQ(counted.reads, 1);
  for (std::uint32_t n = 0; n < 64; ++n)
    read_brick(cached, 0, NodeKey(0, 2, n % 4, n / 4 % 4, n / 16), mine);
  EXPECT_LE(cached.counts().bytes, most);
  EXPECT_GT(cached.counts().bytes, most / 2);
  read_brick(cached, 0, NodeKey(0, 2, 3, 3, 3), mine);  // the last is there
  EXPECT_EQ(counted.reads, 64);                         // but for one all were new
}

TEST(LiveBudget, SharesAddUp) {
  for (const double mib : {8.0, 64.0, 256.0, 4096.0})
    for (const bool sky : {false, true})
      for (const bool ice : {false, true}) {
        const LiveBudget budget = share_budget(mib, sky, ice);
        EXPECT_LE(budget.gpu_bytes + budget.cache_bytes + 3 * budget.tree_bytes,
                  budget.budget_bytes);
        // No tree takes more than half of the slots.
        EXPECT_GT(budget.cost.bytes(1, 0, budget.most_leaves()), budget.tree_bytes);
        EXPECT_GE(budget.most_leaves(), 64u);
      }
  EXPECT_THROW(share_budget(0.5, true, true), Error);
}

}  // namespace
}  // namespace nepho::test
