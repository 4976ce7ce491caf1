#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <list>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "bricks/brick_source.h"

namespace nepho {

// A source that remembers: bricks and summaries that were asked for come from memory, the least
// used go first. So a tree that is refined anew for each place of the eye reads what is new only.
class CachedSource : public BrickSource {
 public:
  // `source` outlives it. No more than `most_bytes` are held, this class's own tables included.
  CachedSource(const BrickSource& source, std::uint64_t most_bytes)
      : source_(source), most_bytes_(most_bytes) {}

  const VolumeInfo& info() const noexcept override { return source_.info(); }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override;
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override;
  Status point_extinction_per_m(const glm::dvec3& ecef_m, double time_s,
                                double& extinction_per_m) const noexcept override {
    return source_.point_extinction_per_m(ecef_m, time_s, extinction_per_m);
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return source_.last_error(buffer, size);
  }

  // What is asked for from now on fails at once: whoever reads is to come to an end.
  void stop() const { stopped_ = true; }

  struct Counts {
    std::uint64_t bytes = 0, bricks_read = 0, bricks_remembered = 0;
  };
  Counts counts() const;

 private:
  struct Place {
    std::uint64_t key;
    double time_s;
    int what;  // a channel, or kSummary
    bool operator==(const Place&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Place& place) const noexcept;
  };
  struct Brick {
    std::array<std::uint16_t, 729> codes;
    float scale, offset;
    double max_abs_error;
  };
  struct Entry {
    Place place;
    NodeSummary summary;
    std::vector<Brick> brick;  // one, or none for a summary
  };
  static constexpr int kSummary = -1;

  static std::uint64_t bytes_of(const Entry& entry);
  const Entry* find(const Place& place) const;  // under the lock
  void keep(Entry entry) const;

  const BrickSource& source_;
  std::uint64_t most_bytes_;
  mutable std::atomic<bool> stopped_ = false;
  mutable std::mutex mutex_;
  mutable std::list<Entry> entries_;  // last used first
  mutable std::unordered_map<Place, std::list<Entry>::iterator, Hash> places_;
  mutable Counts counts_;
};

}  // namespace nepho
