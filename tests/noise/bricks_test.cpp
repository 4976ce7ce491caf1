// Seams, bounds, bits and heights of the procedural sky's bricks.

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <map>
#include <thread>

#include "accuracy_report.h"
#include "open_noise.h"
#include "pyramid/level_filter.h"
#include "sources/noise/field.h"

namespace nepho::test {
namespace {

// Before quantisation: every sample on a node's sides, under all its names.
TEST(NoiseBricks, SharedFacesAreBitEqual) {
  const noise::Planet planet = noise_planet({});
  const noise::Field field(planet.layers, planet.chart, planet.info.lattice);
  const Lattice& lattice = planet.info.lattice;
  Random random;
  std::size_t shared = 0, broken = 0, edges = 0, not_zero = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int level = random.integer(2, lattice.max_level());
    const Index3 &cells = lattice.cells(level), nodes = lattice.nodes(level);
    const auto anywhere = [&](int axis) {
      return std::uint32_t(random.integer(0, int(nodes[std::size_t(axis)]) - 1));
    };
    // Every other one at an edge of a cube's face, some of them at its corner.
    const std::uint32_t i = trial % 2 ? nodes[0] - 1 : anywhere(0);
    const std::uint32_t j = trial % 4 == 1 ? 0 : anywhere(1);
    const NodeKey key(random.integer(0, 5), level, i, j, anywhere(2));
    std::map<NodeKey, std::unique_ptr<noise::FieldBrick>> known;
    const auto brick = [&](NodeKey node) -> const BrickSamples& {
      auto& slot = known[node];
      if (!slot) field.brick(node, *(slot = std::make_unique<noise::FieldBrick>()));
      return slot->total;
    };
    for (std::uint32_t at = 0; at < kBrickVolume; ++at) {
      const Index3 s = {at % 9, at / 9 % 9, at / 81};
      if (s[0] % 8 && s[1] % 8) continue;
      const Index3 g = Lattice::global_sample(key, s);
      const double own = brick(key)[at];
      for (const Column& name : planet.chart->names({key.root(), g[0], g[1]}, cells))
        for (const std::uint32_t a : {0u, 1u})
          for (const std::uint32_t b : {0u, 1u}) {
            // The node with this sample in it, and the one before it where it is on a side.
            const auto node = [&](std::uint32_t c, std::uint32_t back, std::uint32_t count) {
              return std::min(c / 8 - (back && c % 8 == 0 && c > 0 ? 1 : 0), count - 1);
            };
            const NodeKey other(name.root, level, node(name.i, a, nodes[0]),
                                node(name.j, b, nodes[1]), key.k());
            const double theirs =
                brick(other)[brick_offset(name.i - 8 * other.i(), name.j - 8 * other.j(), s[2])];
            ++shared, edges += name.root != key.root(), not_zero += own > 0;
            broken += std::bit_cast<std::uint64_t>(own) != std::bit_cast<std::uint64_t>(theirs);
          }
    }
  }
  EXPECT_EQ(broken, 0u);
  EXPECT_GT(edges, 3000u);
  EXPECT_GT(not_zero, shared / 50);
}

std::uint64_t hash_of(const BrickSource& source, NodeKey key) {
  std::array<std::uint16_t, kBrickVolume> codes;
  ChannelView view;
  view.codes = codes.data();
  EXPECT_EQ(source.read(key, 0, {&view, 1}), Status::kOk);
  std::uint64_t hash = std::bit_cast<std::uint32_t>(view.scale);
  for (const std::uint16_t code : codes) hash = (hash ^ code) * 0x100000001b3u;
  const NodeSummary s = summary_noise(source, key);
  return (hash ^ std::bit_cast<std::uint32_t>(s.max_extinction_per_m)) * 31 + s.children;
}

TEST(NoiseBricks, SameBitsOnAnyMachineForAnyNumberOfThreads) {
  const auto hash_with = [](unsigned threads) {
    const auto source = open_noise({{"seed", 3}});
    Random random;
    std::vector<NodeKey> keys;
    for (int n = 0; n < 400; ++n)
      keys.push_back(
          draw_node(source->info(), n % (source->info().lattice.max_level() + 1), random));
    std::vector<std::uint64_t> hashes(keys.size());
    std::vector<std::thread> workers;
    for (unsigned t = 0; t < threads; ++t)
      workers.emplace_back([&, t] {
        for (std::size_t n = t; n < keys.size(); n += threads)
          hashes[n] = hash_of(*source, keys[n]);
      });
    for (std::thread& worker : workers) worker.join();
    std::uint64_t all = 0;
    for (const std::uint64_t hash : hashes) all = all * 0x100000001b3u + hash;
    return all;
  };
  const std::uint64_t one = hash_with(1);
  EXPECT_EQ(one, hash_with(8));
  EXPECT_EQ(one, 14441074379443403614u);  // of this sky: changes with it only
}

// Bounds against the node's own samples and drawn descendants, and how wide they are.
TEST(NoiseBricks, SummariesBoundNodesAndDescendants) {
  double bounds = 0, seen = 0, nearest = 0, worst_error = 0;
  int counted = 0, vain = 0, broken = 0, lies = 0, errors = 0;
  for (const std::string& type : layer_types()) {
    const auto source = open_noise(one_layer(type));
    const Lattice& lattice = source->info().lattice;
    Random random;
    for (int trial = 0; trial < 500; ++trial) {
      const int level = 2 + trial % (lattice.max_level() - 1);
      const NodeKey key = draw_node(source->info(), level, random);
      const NodeSummary summary = summary_noise(*source, key);
      const BrickSamples own = read_noise(*source, key);
      double most = std::ranges::max(own), gap = 0;
      const bool to_the_end = level >= lattice.max_level() - 2;
      lies += summary.empty != (most == 0);
      if (summary.constant) lies += most > summary.constant_extinction_per_m;
      const auto visit = [&](auto&& self, NodeKey node, const BrickSamples& parent,
                             int deeper) -> void {
        if (node.level() == lattice.max_level()) return;
        const std::vector<NodeKey> children = lattice.children(node);
        for (const NodeKey child : children) {
          const BrickSamples fine = read_noise(*source, child);
          BrickSamples refined;
          refine(lattice, node, parent.data(), child, refined.data());
          for (std::size_t at = 0; at < fine.size(); ++at)
            gap = std::max(gap, std::abs(fine[at] - refined[at]));
          const double top = std::ranges::max(fine);
          most = std::max(most, top);
          if (top > 0 && node == key) {
            const SplitMask mask = lattice.split_axes(key.level());
            SplitMask octant = 0;
            for (SplitMask o = 0; o <= kSplitXyz; ++o)
              if ((o & ~mask) == 0 && key.child(mask, o) == child) octant = o;
            lies += !(summary.children >> octant & 1);
          }
          if (deeper > 0 && (to_the_end || random.integer(0, 3) == 0))
            self(self, child, refined, deeper - 1);
        }
      };
      visit(visit, key, own, 2);
      broken += most > summary.max_extinction_per_m;
      errors += gap > summary.error_bound_per_m + 1e-5 * summary.max_extinction_per_m;
      // How wide, where all that is below was seen.
      if (to_the_end) {
        bounds += summary.max_extinction_per_m, seen += most, ++counted;
        vain += !summary.constant && !(most > 0);
      }
      if (!(most > 0)) continue;
      nearest = std::max(nearest, most / summary.max_extinction_per_m);
      if (gap > 0) worst_error = std::max(worst_error, gap / summary.error_bound_per_m);
    }
  }
  report_accuracy("procedural sky", "largest sample below / summary maximum", nearest, 1, "1");
  report_accuracy("procedural sky", "descendants off own trilinear / error bound", worst_error, 1,
                  "1");
  report_accuracy("procedural sky", "summary maximum / largest sample below, means", bounds / seen,
                  4, "1");
  report_accuracy("procedural sky", "empty nodes that are not known to be", double(vain) / counted,
                  0.15, "1");
  EXPECT_EQ(broken, 0);
  EXPECT_EQ(lies, 0);
  EXPECT_EQ(errors, 0);
  EXPECT_GT(seen, 0);
  EXPECT_LE(bounds / seen, 4);
  EXPECT_LE(double(vain) / counted, 0.15);
}

// Trees are refined by it: how far the finest samples are from a node's own, in root mean square.
TEST(NoiseBricks, UnresolvedVarianceIsThatOfTheField) {
  double worst = 1;
  for (const std::string& type : layer_types()) {
    const auto source = open_noise(one_layer(type));
    const VolumeInfo& info = source->info();
    const noise::Planet planet = noise_planet(one_layer(type));
    const noise::Field field(planet.layers, planet.chart, planet.info.lattice);
    Random random;
    for (const int above : {2, 4}) {
      const int level = info.lattice.max_level() - above;
      double predicted = 0, found = 0;
      for (int trial = 0; trial < 1000; ++trial) {
        const NodeKey key = draw_node(info, level, random);
        const NodeSummary summary = summary_noise(*source, key);
        if (summary.empty) continue;
        predicted += summary.unresolved_variance_per_m2;
        const BrickSamples own = read_noise(*source, key);
        double squares = 0;
        constexpr int kPoints = 32;
        for (int n = 0; n < kPoints; ++n) {
          glm::dvec3 f{0.0};  // a finest sample's place among the node's own
          for (int axis = 0; axis < 3; ++axis) {
            const auto a = std::size_t(axis);
            const int finer =
                int(info.lattice.cells(info.lattice.max_level())[a] / info.lattice.cells(level)[a]);
            f[axis] = double(random.integer(0, 8 * finer)) / finer;
          }
          const Index3 nodes = info.lattice.nodes(level);
          const glm::dvec3 first{double(key.i()), double(key.j()), double(key.k())};
          const glm::dvec3 count{double(nodes[0]), double(nodes[1]), double(nodes[2])};
          const glm::dvec3 at = planet.chart->to_scaled(
              planet.chart->ecef_m({key.root(), (first + f / 8.0) / count}));
          const double radius = glm::length(at);
          double value = 0;
          for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            std::array<std::uint32_t, 3> s{};
            for (int a = 0; a < 3; ++a) {
              const auto low = std::min(std::uint32_t(f[a]), 7u);
              const bool upper = corner >> a & 1;
              s[std::size_t(a)] = low + upper;
              weight *= upper ? f[a] - low : 1 - (f[a] - low);
            }
            value += weight * own[brick_offset(s[0], s[1], s[2])];
          }
          const double off = value - field.extinction_per_m(
                                         at / radius, radius - planet.chart->body().equatorial_m);
          squares += off * off;
        }
        found += squares / kPoints;
      }
      const double ratio = std::sqrt(found / predicted);
      std::printf("measured: %s, %d levels above the finest: rms off / deviation %.3f\n",
                  type.c_str(), above, ratio);
      worst = std::max({worst, ratio, 1 / ratio});
    }
  }
  report_accuracy("procedural sky",
                  "finest samples off own trilinear / unresolved deviation, factor", worst, 1.4,
                  "1");
  EXPECT_LE(worst, 1.4);
}

// The part of the planet whose clouds are thicker than 0.1, against the parameter.
class Coverage : public testing::TestWithParam<std::string> {};
TEST_P(Coverage, IsThePartOfThePlanetUnderCloud) {
  double worst = 0;
  for (const double coverage : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const noise::Planet planet =
        noise_planet(one_layer(GetParam(), {{"layer1.coverage", coverage}}));
    const noise::Field field(planet.layers, planet.chart, planet.info.lattice);
    const noise::LayerSpec& layer = planet.layers[0];
    Random random;
    constexpr int kColumns = 12000, kHeights = 16;
    int covered = 0;
    for (int n = 0; n < kColumns; ++n) {
      const glm::dvec3 direction = random.direction();
      double depth = 0;
      const double step_m = (layer.top_m - layer.base_m) / kHeights;
      for (int k = 0; k < kHeights && depth <= 0.1; ++k)
        depth += step_m * field.extinction_per_m(direction, layer.base_m + (k + 0.5) * step_m);
      covered += depth > 0.1;
    }
    const double off = double(covered) / kColumns - coverage;
    std::printf("measured: %s, coverage %.1f: %+.3f\n", GetParam().c_str(), coverage, off);
    worst = std::max(worst, std::abs(off));
  }
  report_accuracy("procedural sky", GetParam() + ": covered part of the planet, off", worst, 0.05,
                  "1");
  EXPECT_LE(worst, 0.05);
}
INSTANTIATE_TEST_SUITE_P(Types, Coverage, testing::ValuesIn(layer_types()),
                         [](const auto& type) { return type.param; });

// Nothing, exactly, outside a layer; something just inside its base and near its top.
TEST(NoiseBricks, LayersStandBetweenBaseAndTop) {
  for (const std::string& type : layer_types()) {
    const auto source = open_noise(one_layer(
        type, {{"layer1.coverage", 0.95}, {"layer1.base_m", 2000}, {"layer1.top_m", 3000}}));
    const VolumeInfo& info = source->info();
    const int level = info.lattice.max_level();
    const auto& shell = dynamic_cast<const ShellChart&>(*info.chart);
    const double dz_m = shell.thickness_m() / info.lattice.cells(level)[2];
    Random random;
    double low_m = 1e9, high_m = 0;
    for (int trial = 0; trial < 300; ++trial) {
      const NodeKey key = draw_node(info, level, random);
      const BrickSamples samples = read_noise(*source, key);
      for (std::size_t at = 0; at < samples.size(); ++at) {
        if (!(samples[at] > 0)) continue;
        const double height_m = shell.bottom_m() + dz_m * double(8 * key.k() + at / 81);
        low_m = std::min(low_m, height_m), high_m = std::max(high_m, height_m);
      }
    }
    EXPECT_GT(low_m, 2000) << type;
    EXPECT_LT(high_m, 3000) << type;
    EXPECT_LT(low_m, 2000 + 1.5 * dz_m + (type == "cirrus" ? 100 : 0)) << type;
    EXPECT_GT(high_m, 3000 - 2.5 * dz_m) << type;
  }
}

TEST(NoiseBricks, IceIsThePartOfCirrus) {
  const auto source = open_noise({{"seed", 3}});
  ASSERT_EQ(source->info().channels.size(), 2u);
  const auto water = open_noise(one_layer("cumulus"));
  EXPECT_EQ(water->info().channels.size(), 1u);
  Random random;
  int ice_somewhere = 0, water_somewhere = 0, broken = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const NodeKey key = draw_node(source->info(), source->info().lattice.max_level() - 2, random);
    std::array<std::array<std::uint16_t, kBrickVolume>, 2> codes;
    std::array<ChannelView, 2> views;
    views[0] = {Channel::kExtinction, codes[0].data()};
    views[1] = {Channel::kIceExtinction, codes[1].data()};
    ASSERT_EQ(source->read(key, 0, views), Status::kOk);
    bool any_ice = false, any_water = false;
    for (std::size_t at = 0; at < kBrickVolume; ++at) {
      const double all = double(decode(codes[0][at], views[0].scale, views[0].offset));
      const double ice = double(decode(codes[1][at], views[1].scale, views[1].offset));
      const double allowed = views[0].max_abs_error + views[1].max_abs_error;
      broken += ice > all + allowed;
      any_ice |= ice > allowed, any_water |= all > ice + allowed;
    }
    ice_somewhere += any_ice, water_somewhere += any_water;
    broken += any_ice && any_water;  // the default sky's cirrus is far above its water
  }
  EXPECT_EQ(broken, 0);
  EXPECT_GT(ice_somewhere, 20);
  EXPECT_GT(water_somewhere, 5);
}

}  // namespace
}  // namespace nepho::test
