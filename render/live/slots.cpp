#include "live/slots.h"

namespace nepho {

std::optional<std::uint32_t> Slots::take(const SlotKey& key) {
  std::uint32_t slot = 0;
  const auto known = places_.find(key);
  if (known != places_.end()) {
    slot = known->second;
    if (slots_[slot].state.users == 0) idle_.erase(slots_[slot].idle);
  } else {
    if (fresh_ < capacity()) {
      slot = fresh_++;
    } else if (!idle_.empty()) {
      slot = idle_.front();
      idle_.pop_front();
      places_.erase(*slots_[slot].key);
    } else {
      return std::nullopt;
    }
    slots_[slot].state = {};
    slots_[slot].key = key;
    places_[key] = slot;
  }
  if (slots_[slot].state.users++ == 0) ++in_use_;
  return slot;
}

void Slots::release(std::uint32_t slot) {
  Held& held = slots_[slot];
  if (--held.state.users > 0) return;
  --in_use_;
  held.idle = idle_.insert(idle_.end(), slot);
}

}  // namespace nepho
