#include "live/cached_source.h"

#include <algorithm>
#include <bit>
#include <exception>

namespace nepho {

std::size_t CachedSource::Hash::operator()(const Place& place) const noexcept {
  // Multipliers of splitmix64 (Steele, Lea and Flood 2014).
  std::uint64_t h = place.key * 0xbf58476d1ce4e5b9u;
  h ^= (h >> 29) + std::bit_cast<std::uint64_t>(place.time_s);
  h = (h + std::uint64_t(place.what + 1)) * 0x94d049bb133111ebu;
  return std::size_t(h ^ h >> 31);
}

std::uint64_t CachedSource::bytes_of(const Entry& entry) {
  // The list's and the table's own nodes are of this order.
  constexpr std::uint64_t kNodes = 96;
  return sizeof(Entry) + entry.brick.size() * sizeof(Brick) + kNodes;
}

const CachedSource::Entry* CachedSource::find(const Place& place) const {
  const auto found = places_.find(place);
  if (found == places_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return &*found->second;
}

void CachedSource::keep(Entry entry) const {
  const std::uint64_t bytes = bytes_of(entry);
  if (bytes > most_bytes_ || places_.contains(entry.place)) return;
#if !defined(NEPHO_MUTANT_CACHE_GROWS)
  while (counts_.bytes + bytes > most_bytes_) {
    counts_.bytes -= bytes_of(entries_.back());
    places_.erase(entries_.back().place);
    entries_.pop_back();
  }
#endif
  entries_.push_front(std::move(entry));
  places_[entries_.front().place] = entries_.begin();
  counts_.bytes += bytes;
}

Status CachedSource::summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept {
  if (stopped_) return Status::kReadFailed;
  const Place place{key.packed(), time_s, kSummary};
  try {
    const std::lock_guard lock(mutex_);
    if (const Entry* known = find(place)) {
      summary = known->summary;
      return Status::kOk;
    }
  } catch (const std::exception&) {  // no memory to look with: the source is asked
  }
  const Status status = source_.summary(key, time_s, summary);
  if (status != Status::kOk) return status;
  try {
    const std::lock_guard lock(mutex_);
    keep({place, summary, {}});
  } catch (const std::exception&) {  // not remembered
  }
  return status;
}

Status CachedSource::read(NodeKey key, double time_s, BrickView brick) const noexcept {
  if (stopped_) return Status::kReadFailed;
  try {
    const std::lock_guard lock(mutex_);
    std::size_t known = 0;
    for (ChannelView& view : brick) {
      const Entry* entry = find({key.packed(), time_s, int(view.channel)});
      if (!entry) break;
      const Brick& from = entry->brick.front();
      std::copy(from.codes.begin(), from.codes.end(), view.codes);
      view.scale = from.scale;
      view.offset = from.offset;
      view.max_abs_error = from.max_abs_error;
      ++known;
    }
    if (known == brick.size()) {
      ++counts_.bricks_remembered;
      return Status::kOk;
    }
    ++counts_.bricks_read;
  } catch (const std::exception&) {
  }
  const Status status = source_.read(key, time_s, brick);
  if (status != Status::kOk) return status;
  try {
    for (const ChannelView& view : brick) {
      Entry entry{{key.packed(), time_s, int(view.channel)}, {}, std::vector<Brick>(1)};
      Brick& to = entry.brick.front();
      std::copy(view.codes, view.codes + to.codes.size(), to.codes.begin());
      to.scale = view.scale;
      to.offset = view.offset;
      to.max_abs_error = view.max_abs_error;
      const std::lock_guard lock(mutex_);
      keep(std::move(entry));
    }
  } catch (const std::exception&) {
  }
  return status;
}

CachedSource::Counts CachedSource::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace nepho
