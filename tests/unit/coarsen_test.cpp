#include "bricks/coarsen.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "accuracy_report.h"
#include "analytic_field.h"
#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "codes.h"
#include "dense_levels.h"
#include "frames.h"

namespace nepho::test {
namespace {

struct Case {
  std::string name;
  const Chart& chart;
  Lattice lattice;
  std::function<double(glm::dvec3)> field;
};

const ShellChart kEarth(Ellipsoid::wgs84(), 0, 16000);
const glm::dvec3 kOrigin = geodetic_to_ecef_m(Ellipsoid::wgs84(), 0.5, 0.2, 500);
const glm::dmat3 kEdges = scaled_columns(east_north_up(0.5, 0.2), {6400, 6400, 3200});
const BoxChart kOpenBox(kOrigin, kEdges);
const BoxChart kPeriodicBox(kOrigin, kEdges, {true, true});
const Lattice kShellLattice({kSplitXy, kSplitXy, kSplitXyz, kSplitZ});
const Lattice kBoxLattice({kSplitXy, kSplitXyz, kSplitXyz});

// Features of 400 km across and 4 km up: value noise of direction, shifted with height.
double shell_cloud(glm::dvec3 ecef) {
  const double height_m = length(ecef) - 6.36e6;
  return cloud(16 / glm::length(ecef) * ecef + glm::dvec3{0, 0, height_m / 4000});
}

std::vector<Case> cases() {
  return {
      {"shell, noise", kEarth, kShellLattice, shell_cloud},
      {"shell, puffs", kEarth, kShellLattice, [](glm::dvec3 p) { return puffs(1 / 2.5e6 * p); }},
      {"open box, noise", kOpenBox, kBoxLattice, [](glm::dvec3 p) { return cloud(1 / 300. * p); }},
      {"periodic box, noise", kPeriodicBox, kBoxLattice,
       [](glm::dvec3 p) { return cloud(1 / 300. * p); }}};
}

double worst_drift(const Chart& chart, const Pyramid& pyramid) {
  double worst = 0, finer = total(chart, pyramid.levels.back());
  for (std::size_t l = pyramid.levels.size() - 1; l-- > 0;) {
    const double coarser = total(chart, pyramid.levels[l]);
    worst = std::max(worst, std::abs(coarser / finer - 1));
    finer = coarser;
  }
  return worst;
}

constexpr auto kMean = [](const auto& columns, const auto& layers, const DenseLevel& fine) {
  return weighted_mean(columns, layers, fine);
};
constexpr auto kMax = [](const auto& columns, const auto& layers, const DenseLevel& fine) {
  return stencil_max(columns, layers, fine);
};

TEST(Coarsen, ConservesEachLevelWithoutSeams) {
  for (const Case& c : cases()) {
    const Pyramid pyramid = build_pyramid(c.chart, c.lattice, c.field, kMean);
    const double drift = worst_drift(c.chart, pyramid);
    report_accuracy("coarsening", "drift of sum c V per level: " + c.name, drift, 1e-12, "1");
    EXPECT_LE(drift, 1e-12) << c.name;
    EXPECT_EQ(pyramid.seams, 0u) << c.name;
  }
}

TEST(Coarsen, ConstantStaysConstant) {
  const Pyramid pyramid = build_pyramid(
      kEarth, kShellLattice, [](glm::dvec3) { return 0.01; }, kMean);
  for_each_sample(kEarth, pyramid.levels[0].cells(), [&](Column c, std::uint32_t k) {
    EXPECT_NEAR(pyramid.levels[0](c, k), 0.01, 1e-16);
  });
}

// A neighbour taken from the wrong place would be off by a spacing or more. At cube edges the hat
// itself leans: grid lines meet the edge at an angle, its centroid lies 0.12 spacings along it.
TEST(Coarsen, SmoothFieldIsFollowedAcrossEdges) {
  const auto smooth = [](glm::dvec3 p) {
    return 2 + dot(1 / length(p) * p, glm::dvec3{0.5, -0.3, 0.7});
  };
  const Pyramid pyramid = build_pyramid(kEarth, kShellLattice, smooth, kMean);
  double inside = 0, edges = 0;
  const int level = 2;
  for_each_sample(kEarth, pyramid.levels[level].cells(), [&](Column c, std::uint32_t k) {
    const glm::dvec3 p = sample_ecef_m(kEarth, kShellLattice, c.root, level, {c.i, c.j, k});
    const bool shared = kEarth.names(c, pyramid.levels[level].cells()).size() > 1;
    double& worst = shared ? edges : inside;
    worst = std::max(worst, std::abs(pyramid.levels[level](c, k) - smooth(p)));
  });
  std::printf("measured: smooth field, level 2: inside faces %.1e, edges and corners %.1e\n",
              inside, edges);
  const double spacing_rad = std::numbers::pi / 2 / 32, gradient = std::sqrt(0.83);
  EXPECT_LE(inside, 0.2 * spacing_rad * spacing_rad);
  EXPECT_LE(edges, 0.15 * spacing_rad * gradient);
}

TEST(Coarsen, MutantsAreSeen) {
  const auto half_the_names = [](ColumnStencil columns, const LayerStencil& layers,
                                 const DenseLevel& fine) {
    if (columns.size() > 9) columns.resize(columns.size() / 2);
    return weighted_mean(columns, layers, fine);
  };
  const auto without_volume = [](ColumnStencil columns, const LayerStencil& layers,
                                 const DenseLevel& fine) {
    double least = columns[0].weight;
    for (const auto& column : columns) least = std::min(least, column.weight);
    // Back to the plain 1, 2, 4 that the volumes modulate.
    for (auto& column : columns)
      column.weight = std::exp2(std::round(std::log2(column.weight / least)));
    return weighted_mean(columns, layers, fine);
  };
  for (const Case& c : cases()) {
    const double cut =
        worst_drift(c.chart, build_pyramid(c.chart, c.lattice, c.field, half_the_names));
    const double plain =
        worst_drift(c.chart, build_pyramid(c.chart, c.lattice, c.field, without_volume));
    std::printf("measured: %-20s drift without wrap or edges %.1e, without V %.1e\n",
                c.name.c_str(), cut, plain);
    if (&c.chart != &kOpenBox) {
      EXPECT_GT(cut, 1e-5) << c.name;
    }
    if (&c.chart == &kEarth) {
      EXPECT_GT(plain, 1e-5) << c.name;
    }
  }
}

// What a decoded brick, and a chain of levels made from decoded bricks, adds to the drift.
TEST(Coarsen, QuantisedLevelsStillConserve) {
  for (const Case& c : cases()) {
    Pyramid pyramid = build_pyramid(c.chart, c.lattice, c.field, kMean);
    double worst_step_gap = 0;
    std::size_t shared = 0, unequal = 0;
    for (int level = 0; level <= c.lattice.max_level(); ++level) {
      DenseLevel decoded(c.chart, c.lattice, level), step(c.chart, c.lattice, level);
      for_each_node(c.chart, c.lattice, level, [&](NodeKey key) {
        const Codes codes = code_values(brick_of(pyramid.levels[std::size_t(level)], key));
        for_each_brick_sample(key, [&](std::size_t at, Column column, std::uint32_t k) {
          double& known = decoded.at(column, k);
          const double now = codes.decode(at), err = codes.q.max_abs_error;
          shared += !std::isnan(known);
          if (!std::isnan(known) && now != known) {
            ++unequal;
            worst_step_gap =
                std::max(worst_step_gap, std::abs(now - known) / (err + step(column, k)));
          }
          known = now;
          step.at(column, k) = err;
        });
      });
      pyramid.levels[std::size_t(level)] = decoded;
    }
    const double drift = worst_drift(c.chart, pyramid);
    std::printf("measured: %s: %.0f %% of shared samples differ when decoded\n", c.name.c_str(),
                100.0 * double(unequal) / double(shared));
    report_accuracy("coarsening", "drift of sum c V per decoded level: " + c.name, drift, 1e-5,
                    "1");
    report_accuracy("coarsening", "decoded gap at shared faces / both max_abs_error: " + c.name,
                    worst_step_gap, 1, "1");
    EXPECT_LE(drift, 1e-5) << c.name;
    EXPECT_LE(worst_step_gap, 1) << c.name;
  }
}

TEST(Summary, BoundsDecodedSamplesOfNodeAndDescendants) {
  std::size_t mutant_broken = 0;
  for (const Case& c : cases()) {
    const Pyramid mean = build_pyramid(c.chart, c.lattice, c.field, kMean);
    const Pyramid grown = build_pyramid(c.chart, c.lattice, c.field, kMax);
    std::size_t nodes = 0, broken = 0, naive_broken = 0, wide = 0, full_of_nothing = 0;
    const std::function<float(NodeKey)> decoded_max = [&](NodeKey key) {
      const Codes codes = code_values(brick_of(mean.levels[std::size_t(key.level())], key));
      float truth = 0, own_leaves = 0;
      for (std::size_t at = 0; at < codes.code.size(); ++at)
        truth = std::max(truth, codes.decode(at));
      if (key.level() < c.lattice.max_level())
        for (const NodeKey child : c.lattice.children(key))
          truth = std::max(truth, decoded_max(child));
      const BrickSamples bounds = brick_of(grown.levels[std::size_t(key.level())], key);
      const float bound = decoded_bound(*std::max_element(bounds.begin(), bounds.end()));
      // Mutant: the finest samples inside the node's own closed box, not grown.
      const Index3 n = c.lattice.cells(c.lattice.max_level()), count = c.lattice.nodes(key.level());
      for (std::uint32_t k = key.k() * (n[2] / count[2]); k <= (key.k() + 1) * (n[2] / count[2]);
           ++k)
        for (std::uint32_t j = key.j() * (n[1] / count[1]); j <= (key.j() + 1) * (n[1] / count[1]);
             ++j)
          for (std::uint32_t i = key.i() * (n[0] / count[0]);
               i <= (key.i() + 1) * (n[0] / count[0]); ++i)
            own_leaves =
                std::max(own_leaves, decoded_bound(mean.levels.back()({key.root(), i, j}, k)));
      ++nodes;
      broken += bound < truth;
      naive_broken += own_leaves < truth;
      wide += truth > 0 && bound > 4 * truth;
      full_of_nothing += truth == 0 && bound > 0;
      return truth;
    };
    for (int root = 0; root < c.chart.roots(); ++root) decoded_max(NodeKey(root, 0, 0, 0, 0));
    std::printf(
        "measured: %-20s %zu nodes: bound broken %zu, naive broken %zu, > 4x wide %zu, "
        "zero brick with bound > 0 %zu\n",
        c.name.c_str(), nodes, broken, naive_broken, wide, full_of_nothing);
    EXPECT_EQ(broken, 0u) << c.name;
    mutant_broken += naive_broken;
  }
  EXPECT_GT(mutant_broken, 0u);
}

}  // namespace
}  // namespace nepho::test
