#include "gl/light_samples.h"

#include <algorithm>
#include <array>
#include <bit>

namespace nepho::gl {
namespace {

constexpr int kSide = 9, kSamples = 729;
using Mask = std::bitset<kSamples>;

int index_of(int x, int y, int z) {
  return (z * kSide + y) * kSide + x;
}

// Samples at one end of an axis.
std::array<Mask, 3> ends_of(int end) {
  std::array<Mask, 3> ends;
  const std::array<int, 3> strides = {1, kSide, kSide * kSide};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int s = 0; s < kSamples; ++s)
      ends[axis][std::size_t(s)] = s / strides[axis] % kSide == end;
  return ends;
}

// Each sample and its neighbours, edges and corners included.
Mask grown(const Mask& mask) {
  static const std::array<Mask, 3> first = ends_of(0), last = ends_of(kSide - 1);
  Mask result = mask;
  std::size_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis, stride *= kSide)
    result |= (result & ~first[axis]) >> stride | (result & ~last[axis]) << stride;
  return result;
}

// Samples of a tile that another may hold as well.
std::vector<std::uint32_t> on_faces() {
  std::vector<std::uint32_t> list;
  for (std::uint32_t s = 0; s < kSamples; ++s)
    if (s % 9 % kBrickCells == 0 || s / 9 % 9 % kBrickCells == 0 || s / 81 % kBrickCells == 0)
      list.push_back(s);
  return list;
}

Mask needed_of(const LeafBrick& brick) {
  Mask mask;
  for (std::size_t s = 0; s < kSamples; ++s) mask[s] = brick.codes[s] > 0 || brick.offset > 0;
  mask = grown(mask);
  // Nothing to take light from: it must be finite all the same.
  return mask.none() ? mask.set() : mask;
}

// Those beside a sample, by faces: below and above along each axis.
struct Beside {
  std::array<int, 6> sample;
  int count = 0;
};
std::vector<Beside> all_beside() {
  std::vector<Beside> all(kSamples);
  for (int s = 0; s < kSamples; ++s)
    for (int stride : {1, kSide, kSide * kSide})
      for (int sign : {-1, 1}) {
        const int at = s / stride % kSide + sign;
        Beside& beside = all[std::size_t(s)];
        if (at >= 0 && at < kSide) beside.sample[std::size_t(beside.count++)] = s + sign * stride;
      }
  return all;
}

// Of each sample the nearest of the mask, by faces.
std::array<int, kSamples> nearest(const Mask& mask) {
  std::array<int, kSamples> from;
  from.fill(-1);
  std::vector<int> queue;
  queue.reserve(kSamples);
  for (int s = 0; s < kSamples; ++s)
    if (mask[std::size_t(s)]) {
      from[std::size_t(s)] = s;
      queue.push_back(s);
    }
  static const std::vector<Beside> beside = all_beside();
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const Beside& here = beside[std::size_t(queue[next])];
    for (int n = 0; n < here.count; ++n) {
      const int other = here.sample[std::size_t(n)];
      if (from[std::size_t(other)] >= 0) continue;
      from[std::size_t(other)] = from[std::size_t(queue[next])];
      queue.push_back(other);
    }
  }
  return from;
}

}  // namespace

// Where a tile is: its volume, root and first sample on the finest lattice.
struct LightSamples::Place {
  std::uint32_t volume_root = 0;
  std::array<std::uint32_t, 3> first{}, step{};
};

LightSamples::LightSamples(const Forest& forest, bool all) {
  std::vector<Place> places;
  for (std::size_t v = 0; v < forest.volumes.size(); ++v) {
    const VolumeTree& tree = forest.volumes[v];
    const Lattice& lattice = tree.source->info().lattice;
    const std::size_t first = needed_.size();
    needed_.resize(first + tree.lit_nodes, Mask().set());
    places.resize(needed_.size());
    for (const TreeNode& node : tree.nodes) {
      if (!node.seen || (node.kind != NodeKind::kBrick && node.kind != NodeKind::kConstant))
        continue;
      if (node.kind == NodeKind::kBrick && !all)
        needed_[first + node.lit] = needed_of(tree.bricks[node.brick]);
      Place& place = places[first + node.lit];
      place.volume_root = std::uint32_t(8 * v) + std::uint32_t(node.key.root());
      for (std::size_t a = 0; a < 3; ++a) {
        place.step[a] = std::uint32_t(lattice.cells(lattice.max_level())[a] /
                                      lattice.cells(node.key.level())[a]);
        place.first[a] = kBrickCells * node.key.ijk()[a] * place.step[a];
      }
    }
  }
  Mask every_second;
  for (int z = 0; z < kSide; z += 2)
    for (int y = 0; y < kSide; y += 2)
      for (int x = 0; x < kSide; x += 2) every_second.set(std::size_t(index_of(x, y, z)));
  for (const Mask& mask : needed_) coarse_.push_back(grown(mask) & every_second);
  owned_ = needed_;
  if (all) return;
  share(places, owned_, shared_);
  share(places, coarse_, shared_coarse_);
}

// Leaves each sample in one of the masks that hold it. An owner is needed where any of them is:
// what the sun's pass has found there goes along with the sky's.
void LightSamples::share(const std::vector<Place>& places, Masks& masks, Pairs& pairs) const {
  struct OnFace {
    std::array<std::uint32_t, 4> place;  // volume and root, index on the finest lattice
    std::uint32_t entry;
  };
  static const std::vector<std::uint32_t> faces = on_faces();
  std::vector<OnFace> all;
  std::size_t count = 0;
  for (const Mask& mask : masks)
    for (const std::uint32_t s : faces) count += mask[s];
  all.reserve(count);
  for (std::size_t tile = 0; tile < masks.size(); ++tile)
    for (const std::uint32_t s : faces) {
      if (!masks[tile][s]) continue;
      const Place& place = places[tile];
      OnFace& sample = all.emplace_back();
      sample.entry = std::uint32_t(kSamples * tile) + s;
      sample.place = {place.volume_root, place.first[0] + s % 9 * place.step[0],
                      place.first[1] + s / 9 % 9 * place.step[1],
                      place.first[2] + s / 81 * place.step[2]};
    }
  // By place, in an open hash table: the first needed one there, or the first.
  constexpr std::uint32_t kFree = ~0u;
  std::vector<std::uint32_t> owners(std::bit_ceil(2 * all.size() + 1), kFree);
  const auto needed = [&](std::uint32_t n) {
    return needed_[all[n].entry / kSamples][all[n].entry % kSamples];
  };
  const auto slot_of = [&](const OnFace& sample) -> std::uint32_t& {
    std::uint64_t h = 0;
    for (const std::uint32_t part : sample.place) h = (h ^ part) * 0x9e3779b97f4a7c15u;
    for (std::size_t at = h >> 32;; ++at) {
      std::uint32_t& owner = owners[at & (owners.size() - 1)];
      if (owner == kFree || all[owner].place == sample.place) return owner;
    }
  };
  for (std::uint32_t n = 0; n < all.size(); ++n) {
    std::uint32_t& owner = slot_of(all[n]);
    if (owner == kFree || (!needed(owner) && needed(n))) owner = n;
  }
  for (std::uint32_t n = 0; n < all.size(); ++n) {
    const std::uint32_t owner = slot_of(all[n]);
    if (owner == n) continue;
    masks[all[n].entry / kSamples].reset(all[n].entry % kSamples);
    pairs.push_back({all[n].entry, all[owner].entry});
  }
}

namespace {

std::vector<std::uint32_t> listed(const std::vector<Mask>& masks, std::size_t first,
                                  std::size_t count) {
  std::vector<std::uint32_t> list;
  for (std::size_t tile = first; tile < first + count; ++tile)
    for (std::size_t s = 0; s < kSamples; ++s)
      if (masks[tile][s]) list.push_back(std::uint32_t(kSamples * tile + s));
  return list;
}

std::vector<std::uint32_t> listed(const std::vector<std::array<std::uint32_t, 2>>& pairs,
                                  std::size_t first, std::size_t count) {
  std::vector<std::uint32_t> list;
  const auto to = [](const std::array<std::uint32_t, 2>& pair) { return pair[0]; };
  const auto begin = std::ranges::lower_bound(pairs, std::uint32_t(kSamples * first), {}, to);
  const auto end =
      std::ranges::lower_bound(pairs, std::uint32_t(kSamples * (first + count)), {}, to);
  for (auto pair = begin; pair != end; ++pair) list.insert(list.end(), pair->begin(), pair->end());
  return list;
}

}  // namespace

double LightSamples::spared_share() const {
  std::size_t marched = 0;
  for (const Mask& mask : owned_) marched += mask.count();
  return needed_.empty() ? 0 : 1 - double(marched) / double(kSamples * needed_.size());
}

std::vector<std::uint32_t> LightSamples::needed(std::size_t first, std::size_t count) const {
  return listed(needed_, first, count);
}
std::vector<std::uint32_t> LightSamples::owned(std::size_t first, std::size_t count) const {
  return listed(owned_, first, count);
}
std::vector<std::uint32_t> LightSamples::coarse(std::size_t first, std::size_t count) const {
  return listed(coarse_, first, count);
}
std::vector<std::uint32_t> LightSamples::shared(std::size_t first, std::size_t count) const {
  return listed(shared_, first, count);
}
std::vector<std::uint32_t> LightSamples::shared_coarse(std::size_t first, std::size_t count) const {
  return listed(shared_coarse_, first, count);
}

std::vector<std::uint32_t> LightSamples::pairs(std::size_t first, std::size_t count) const {
  std::vector<std::uint32_t> list;
  for (std::size_t tile = first; tile < first + count; ++tile) {
    if (needed_[tile].all()) continue;
    std::array<int, kSamples> from = nearest(needed_[tile]);
#if defined(NEPHO_MUTANT_ANY_LIGHT)
    std::ranges::reverse(from);
#endif
    for (std::size_t s = 0; s < kSamples; ++s) {
      if (needed_[tile][s]) continue;
      list.push_back(std::uint32_t(kSamples * tile + s));
      list.push_back(std::uint32_t(kSamples * tile) + std::uint32_t(from[s]));
    }
  }
  return list;
}

}  // namespace nepho::gl
