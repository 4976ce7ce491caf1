#include "gl/light_samples.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace nepho::gl {
namespace {

constexpr int kSide = 9, kSamples = 729;
using Mask = std::bitset<kSamples>;

int index_of(int x, int y, int z) {
  return (z * kSide + y) * kSide + x;
}

// Each sample and its neighbours, edges and corners included.
Mask grown(const Mask& mask) {
  Mask result = mask;
  for (int stride : {1, kSide, kSide * kSide}) {
    const Mask before = result;
    for (int s = 0; s < kSamples; ++s) {
      if (!before[std::size_t(s)]) continue;
      const int at = s / stride % kSide;
      if (at > 0) result.set(std::size_t(s - stride));
      if (at < kSide - 1) result.set(std::size_t(s + stride));
    }
  }
  return result;
}

Mask needed_of(const LeafBrick& brick) {
  Mask mask;
  for (std::size_t s = 0; s < kSamples; ++s) mask[s] = brick.codes[s] > 0 || brick.offset > 0;
  mask = grown(mask);
  // Nothing to take light from: it must be finite all the same.
  return mask.none() ? mask.set() : mask;
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
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const int s = queue[next];
    for (int stride : {1, kSide, kSide * kSide})
      for (int sign : {-1, 1}) {
        const int at = s / stride % kSide + sign;
        if (at < 0 || at >= kSide || from[std::size_t(s + sign * stride)] >= 0) continue;
        from[std::size_t(s + sign * stride)] = from[std::size_t(s)];
        queue.push_back(s + sign * stride);
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
    std::uint32_t volume_root;
    std::array<std::uint32_t, 3> index;
    bool spare;
    std::uint32_t entry;
    bool same_place(const OnFace& other) const {
      return volume_root == other.volume_root && index == other.index;
    }
  };
  std::vector<OnFace> all;
  for (std::size_t tile = 0; tile < masks.size(); ++tile)
    for (std::size_t s = 0; s < kSamples; ++s) {
      if (!masks[tile][s]) continue;
      const std::array<std::uint32_t, 3> at = {std::uint32_t(s % 9), std::uint32_t(s / 9 % 9),
                                               std::uint32_t(s / 81)};
      if (std::ranges::none_of(at, [](std::uint32_t i) { return i % kBrickCells == 0; })) continue;
      OnFace sample{places[tile].volume_root, places[tile].first, !needed_[tile][s],
                    std::uint32_t(kSamples * tile + s)};
      for (std::size_t a = 0; a < 3; ++a) sample.index[a] += at[a] * places[tile].step[a];
      all.push_back(sample);
    }
  std::ranges::sort(all, {}, [](const OnFace& sample) {
    return std::tie(sample.volume_root, sample.index, sample.spare, sample.entry);
  });
  std::size_t owner = 0;
  for (std::size_t n = 1; n < all.size(); ++n) {
    if (!all[n].same_place(all[owner])) {
      owner = n;
      continue;
    }
    masks[all[n].entry / kSamples].reset(all[n].entry % kSamples);
    pairs.push_back({all[n].entry, all[owner].entry});
  }
  std::ranges::sort(pairs);
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
