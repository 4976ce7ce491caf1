#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "bricks/brick_source.h"

namespace nepho {

// One leaf with extinction, whatever tree it is in.
struct SlotKey {
  const BrickSource* source;
  double time_s;
  NodeKey node;
  auto order() const { return std::tuple(source, time_s, node); }
  bool operator<(const SlotKey& other) const { return order() < other.order(); }
};

// Which tile of the atlases a leaf has: one of bricks and one of light, of the same number. Leaves
// of the trees in use hold theirs; others keep theirs until it is wanted, those longest out of use
// first, so that turning back finds brick and light still there.
class Slots {
 public:
  explicit Slots(std::uint32_t capacity) : slots_(capacity) {}

  struct Slot {
    bool has_brick = false;
    std::uint64_t lit_for = 0;  // what its light was worked out for; 0: it has none
    int users = 0;
  };
  // Takes a slot for one more user; one that is new is empty. Absent: all are in use.
  std::optional<std::uint32_t> take(const SlotKey& key);
  void release(std::uint32_t slot);

  Slot& operator[](std::uint32_t slot) { return slots_[slot].state; }
  const Slot& operator[](std::uint32_t slot) const { return slots_[slot].state; }
  std::uint32_t capacity() const { return std::uint32_t(slots_.size()); }
  std::uint32_t in_use() const { return in_use_; }

 private:
  struct Held {
    Slot state;
    std::optional<SlotKey> key;
    std::list<std::uint32_t>::iterator idle;  // in idle_, where it has no user
  };
  std::vector<Held> slots_;
  std::map<SlotKey, std::uint32_t> places_;
  std::list<std::uint32_t> idle_;  // longest without a user first
  std::uint32_t fresh_ = 0, in_use_ = 0;
};

}  // namespace nepho
