#include "pyramid/sparse_pyramid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bricks/box_chart.h"
#include "pyramid/level_filter.h"
#include "pyramid/pyramid_level.h"
#include "pyramid/touching.h"

// Mistakes for the tests to find, each one that was made or nearly made.
#if defined(NEPHO_MUTANT_SEAM)
#define NEPHO_MUTATION_SEAM 1
#else
#define NEPHO_MUTATION_SEAM 0
#endif
#if defined(NEPHO_MUTANT_DRIFT)
#define NEPHO_MUTATION_DRIFT 1.02
#else
#define NEPHO_MUTATION_DRIFT 1.0
#endif

namespace nepho {
namespace {

using Region = SparsePyramid::Region;
constexpr std::size_t kVolume = kBrickVolume;

template <class Body>
void parallel(std::size_t count, Body&& body) {
  tbb::parallel_for(std::size_t{0}, count, std::forward<Body>(body));
}

}  // namespace

struct SparsePyramid::Impl {
  using Level = PyramidLevel;

  const Chart& chart;
  Lattice lattice;
  Field field;
  std::vector<Level> levels;
  bool blocks_allowed = false;

  Impl(const Chart& c, const Lattice& l, Field f) : chart(c), lattice(l), field(std::move(f)) {
    if (const auto* box = dynamic_cast<const BoxChart*>(&chart))
      blocks_allowed = !box->periodic().x && !box->periodic().y;
    levels.resize(std::size_t(lattice.max_level()) + 1);
    list_nodes();
    if (lattice.max_level() == 0)
      for (std::size_t node = 0; node < levels[0].keys.size(); ++node) {
        BrickSamples samples;
        field.samples(levels[0].keys[node], samples.data());
        summarise_finest(node, samples);
      }
    for (int level = lattice.max_level() - 1; level >= 0; --level) build(level);
    levels[0].drop_variances();
    bound_errors();
  }

  Level& at(int level) { return levels[std::size_t(level)]; }
  const Level& at(int level) const { return levels[std::size_t(level)]; }
  bool is_finest(int level) const { return level == lattice.max_level(); }

  Region asked(NodeKey key) const {
    const Region r = field.region(key);
    if (r.block && !blocks_allowed)
      throw std::logic_error("SparsePyramid: a block in a curved or periodic chart");
    return r;
  }

  // The closed form of a node that is not stored: its own or, where a source is surer of the large
  // than of the small, that of the node that it is part of.
  Region region(NodeKey key) const {
    if (!field.region) return {.constant = true};
    const std::optional<Region> r = closed_form(key);
    if (!r) throw std::logic_error("SparsePyramid: a node is neither stored nor a closed form");
    return *r;
  }
  bool is_closed(NodeKey key) const { return closed_form(key).has_value(); }
  std::optional<Region> closed_form(NodeKey key) const {
    for (;; key = lattice.parent(key)) {
      const Region r = asked(key);
      if (r.closed_form()) return r;
      if (key.level() == 0) return std::nullopt;
    }
  }

  // Samples of any node; `variance` may be null, and counts above the finest level only.
  void fetch(NodeKey key, double* samples, float* variance) const {
    const Level& level = at(key.level());
    const std::optional<std::size_t> node = level.find(key);
    if (!node) return closed_form_samples(lattice, key, region(key), samples, variance);
    if (is_finest(key.level())) {
      field.samples(key, samples);
      if (variance) std::fill_n(variance, kVolume, 0.0f);
      return;
    }
    std::copy_n(level.at(*node), kVolume, samples);
    if (variance) std::ranges::copy(*level.variances[*node], variance);
  }

  // The finest samples are looked at as they are gathered.
  void summarise_finest(std::size_t node, const BrickSamples& samples) {
    Record& record = levels.back().records[node];
    if (!std::ranges::all_of(samples, [](double c) { return c >= 0 && std::isfinite(c); }))
      throw std::domain_error("SparsePyramid: a finest sample is negative or not finite");
    const auto [least, most] = std::ranges::minmax(samples);
    record.least = least;
    record.most = most;
    record.empty = record.most == 0;
  }

  // What is listed before any filtering: with regions all nodes that are no closed form, from the
  // roots down; without them the finest that the source names.
  void list_nodes() {
    if (field.region) {
      auto keys = collect_nodes(
          chart, lattice, [this](NodeKey key) { return asked(key); }, field.most_nodes);
      for (std::size_t l = 0; l < keys.size(); ++l) levels[l].keys = std::move(keys[l]);
    } else {
      levels.back().keys = std::exchange(field.nodes, {});
    }
    levels.back().records.resize(levels.back().keys.size());
  }

  void build(int l) {
    Level& level = at(l);
    std::vector<NodeKey> parents;
    for (const NodeKey key : at(l + 1).keys)
      if (const NodeKey parent = lattice.parent(key); parents.empty() || parents.back() != parent)
        parents.push_back(parent);
    level.insert(std::move(parents));
    parallel(level.keys.size(), [&](std::size_t node) { gather_children(level, node); });
    level.insert(touched(level));
    at(l + 1).drop_variances();
    parallel(level.keys.size(), [&](std::size_t node) { merge_faces(level, node); });
    level.records.resize(level.keys.size());
    parallel(level.keys.size(), [&](std::size_t node) { summarise(level, node); });
  }

  // The filter carries values across a face, so that a node may hold something on its faces only:
  // the nodes beside sums that are not zero. Their children are closed forms of no other value.
  std::vector<NodeKey> touched(const Level& level) const {
    std::vector<std::vector<NodeKey>> found(level.keys.size());
    parallel(level.keys.size(), [&](std::size_t node) {
      const auto place = [&](NodeKey other) { return level.find(other); };
      const Touching touching(chart, lattice, level.keys[node], place);
      std::array<bool, 27> seen{};  // all samples of a face, edge or corner touch the same nodes
      for (std::uint32_t at = 0; at < kVolume; ++at) {
        const Index3 s = {at % 9, at / 9 % 9, at / 81};
        const auto side = [](std::uint32_t c) { return c == 0 ? 0u : c < kBrickCells ? 1u : 2u; };
        bool& known = seen[side(s[0]) + 3 * side(s[1]) + 9 * side(s[2])];
        if (known || (*level.samples[node])[at] == 0) continue;
        known = true;
        for (const Touch& touch : touching.places(s))
          if (!touch.node && !(field.region && is_closed(touch.key)))
            found[node].push_back(touch.key);
      }
    });
    std::vector<NodeKey> keys;
    for (const auto& some : found) keys.insert(keys.end(), some.begin(), some.end());
    return keys;
  }

  void gather_children(Level& level, std::size_t node) {
    const NodeKey key = level.keys[node];
    const SplitMask mask = lattice.split_axes(key.level());
    BrickSamples samples;
    std::array<float, kVolume> variance;
    for (SplitMask octant = 0; octant <= kSplitXyz; ++octant) {
      if (octant & ~mask) continue;
      const NodeKey child = key.child(mask, octant);
      fetch(child, samples.data(), variance.data());
      if (is_finest(child.level()))
        if (const auto place = levels.back().find(child)) summarise_finest(*place, samples);
      if (all_zero(samples.data())) continue;
      add_child(samples.data(), variance.data(), owned_hats(chart, lattice, child), mask, octant,
                {level.samples[node]->data(), level.variances[node]->data()});
    }
  }

  // Turns sums into means, in place: each sample by the first stored node that holds it, for all
  // that hold it. A node that is a closed form reaches one voxel beyond itself, so that its value
  // holds on the shared face.
  void merge_faces(Level& level, std::size_t node) const {
    const NodeKey key = level.keys[node];
    const HatWeights hats = whole_hats(chart, lattice, key);
    Closed closed;
    const Touching touching(chart, lattice, key, [&](NodeKey other) { return level.find(other); });
    for (std::uint32_t k = 0; k < kBrickSamples; ++k)
      for (std::uint32_t j = 0; j < kBrickSamples; ++j)
        for (std::uint32_t i = 0; i < kBrickSamples; ++i) {
          const std::uint32_t own = i + kBrickSamples * (j + kBrickSamples * k);
          const double volume = hats.horizontal[i + kBrickSamples * j] * hats.vertical[k];
          const auto within = [](std::uint32_t s) { return s > 0 && s < kBrickCells; };
          if (within(i) && within(j) && within(k)) {  // of no other node
            double& sum = (*level.samples[node])[own];
            float& square = (*level.variances[node])[own];
            sum = sum / volume * NEPHO_MUTATION_DRIFT;
            square = float(double(square) / volume);
            continue;
          }
          TouchList places = touching.places({i, j, k});
          if (NEPHO_MUTATION_SEAM) places.keep([&](const Touch& p) { return p.node == node; });
          // A periodic axis one node long holds a sample twice.
          const auto first =
              std::ranges::find_if(places, [](const Touch& p) { return p.node.has_value(); });
          if (first->node != node || first->offset != own) continue;
          const auto [mean, square] = merged(level, places, volume, closed);
          for (const Touch& place : places) {
            if (!place.node) continue;
            (*level.samples[*place.node])[place.offset] = mean;
            (*level.variances[*place.node])[place.offset] = float(square);
          }
        }
  }

  // Regions of a node's neighbours, each asked for once.
  using Closed = std::vector<std::pair<NodeKey, Region>>;
  const Region& closed_region(NodeKey key, Closed& closed) const {
    for (const auto& [known, r] : closed)
      if (known == key) return r;
    return closed.emplace_back(key, region(key)).second;
  }

  std::pair<double, double> merged(const Level& level, const TouchList& places, double volume,
                                   Closed& closed) const {
    double sum = 0, square = 0;
    for (const Touch& place : places) {
      if (!place.node) {
        const Region& r = closed_region(place.key, closed);
        if (r.constant) return {r.value, r.value * r.value};
        BrickSamples samples;
        std::array<float, kVolume> variance;
        closed_form_samples(lattice, place.key, r, samples.data(), variance.data());
        const double c = samples[place.offset];
        return {c, c * c + double(variance[place.offset])};
      }
      sum += (*level.samples[*place.node])[place.offset];
      square += double((*level.variances[*place.node])[place.offset]);
    }
    return {sum / volume * NEPHO_MUTATION_DRIFT, square / volume};
  }

  void summarise(Level& level, std::size_t node) {
    const NodeKey key = level.keys[node];
    const double* samples = level.at(node);
    Record& record = level.records[node];
    float* variances = level.variances[node]->data();
    for (std::size_t s = 0; s < kVolume; ++s) {
      // Sums in float resolve no less than a millionth: what is constant has no variance.
      const double square = samples[s] * samples[s];
      const double variance = double(variances[s]) - square;
      variances[s] = variance > 1e-6 * square ? float(variance) : 0;
    }
    const auto [least, most] = std::minmax_element(samples, samples + kVolume);
    record.least = *least;
    record.most = *most;
    record.empty = *most == 0;
    record.variance = node_mean(variances);
#ifdef NEPHO_MUTANT_NOT_GROWN
    record.most = 0;  // what lies below, and not what the filter carried in from the neighbours
#endif
    const SplitMask mask = lattice.split_axes(key.level());
    for (SplitMask octant = 0; octant <= kSplitXyz; ++octant) {
      if (octant & ~mask) continue;
      const Record child = record_of(key.child(mask, octant));
      record.least = std::min(record.least, child.least);
      record.most = std::max(record.most, child.most);
      if (!child.empty || child.children) record.children |= std::uint8_t(1u << octant);
    }
  }

  Record record_of(NodeKey key) const {
    const Level& level = at(key.level());
    if (const auto node = level.find(key)) return level.records[*node];
    const Region r = region(key);
    Record record;
    if (r.constant) {
      record.least = record.most = r.value;
      record.empty = r.value == 0;
      if (!record.empty && !is_finest(key.level())) record.children = octants(key.level());
      return record;
    }
    // A block: its two values bound all levels, and their difference any interpolant's error.
    BrickSamples samples;
    std::array<float, kVolume> variance;
    closed_form_samples(lattice, key, r, samples.data(), variance.data());
    std::tie(record.least, record.most) = std::minmax(r.value, r.outside);
    record.empty = all_zero(samples.data());
    record.variance = node_mean(variance.data());
    if (is_finest(key.level())) return record;
    record.error = record.most - record.least;
    // A sample inside a child at any level is inside the hat of one of its own samples.
    const SplitMask mask = lattice.split_axes(key.level());
    for (SplitMask octant = 0; octant <= kSplitXyz; ++octant) {
      if (octant & ~mask) continue;
      const NodeKey child = key.child(mask, octant);
      closed_form_samples(lattice, child, r, samples.data(), nullptr);
      if (!all_zero(samples.data())) record.children |= std::uint8_t(1u << octant);
    }
    return record;
  }

  std::uint8_t octants(int level) const {
    const SplitMask mask = lattice.split_axes(level);
    unsigned bits = 0;
    for (SplitMask octant = 0; octant <= kSplitXyz; ++octant)
      if (!(octant & ~mask)) bits |= 1u << octant;
    return std::uint8_t(bits);
  }

  // The difference of two nested trilinear fields is greatest at a finest sample: exact. Each node
  // that ends a branch (finest, or a closed form) is held against all its ancestors.
  void bound_errors() {
    for (int l = 0; l < lattice.max_level(); ++l)
      parallel(at(l).keys.size(), [&](std::size_t node) { compare_ends(at(l).keys[node]); });
  }

  void compare_ends(NodeKey key) {
    struct Ancestor {
      NodeKey key;
      const double* samples;
      std::atomic_ref<double> error;  // which others raise at the same time
      void raise(double to) const {
        for (double now = error; now < to && !error.compare_exchange_weak(now, to);) continue;
      }
    };
    std::vector<Ancestor> ancestors;  // itself first
    for (NodeKey a = key;; a = lattice.parent(a)) {
      Level& level = at(a.level());
      const std::size_t node = *level.find(a);
      ancestors.push_back({a, level.at(node), std::atomic_ref(level.records[node].error)});
      if (a.level() == 0) break;
    }
    for (const NodeKey child : lattice.children(key)) {
      const bool stored = at(child.level()).find(child).has_value();
      if (stored && !is_finest(child.level())) continue;
      BrickSamples low, high;
      if (stored) {
        field.samples(child, low.data());
        high = low;
      } else {
        const Region r = region(child);
        low.fill(r.block ? std::min(r.value, r.outside) : r.value);
        high.fill(r.block ? std::max(r.value, r.outside) : r.value);
      }
      const double most_low = *std::ranges::max_element(low),
                   least_high = *std::ranges::min_element(high);
      for (const Ancestor& ancestor : ancestors) {
        // Its field lies between its samples there, but for rounding: most often no gap can be
        // greater than one that is known.
        const auto [least, most] = range_around(lattice, ancestor.key, ancestor.samples, child);
        if (std::max(most_low - least, most - least_high) * (1 + 1e-12) <= ancestor.error) continue;
        BrickSamples own;
        refine(lattice, ancestor.key, ancestor.samples, child, own.data());
        ancestor.raise(greatest_gap(own, low, high));
      }
    }
  }
};

SparsePyramid::SparsePyramid(const Chart& chart, const Lattice& lattice, Field field)
    : impl_(std::make_unique<Impl>(chart, lattice, std::move(field))) {}
SparsePyramid::~SparsePyramid() = default;
SparsePyramid::SparsePyramid(SparsePyramid&&) noexcept = default;
SparsePyramid& SparsePyramid::operator=(SparsePyramid&&) noexcept = default;

NodeSummary SparsePyramid::summary(NodeKey key) const {
  return to_summary(impl_->record_of(key));
}

void SparsePyramid::samples(NodeKey key, double* samples) const {
  impl_->fetch(key, samples, nullptr);
#ifdef NEPHO_MUTANT_FLIP
  if (key.level() == 1)
    for (std::size_t k = 0; k < kBrickCells / 2; ++k)
      std::swap_ranges(samples + 81 * k, samples + 81 * (k + 1), samples + 81 * (kBrickCells - k));
#endif
}

std::uint64_t SparsePyramid::bytes() const {
  std::uint64_t bytes = sizeof(Impl) + impl_->levels.capacity() * sizeof(Impl::Level);
  for (const Impl::Level& level : impl_->levels) bytes += level.bytes();
  return bytes;
}

}  // namespace nepho
