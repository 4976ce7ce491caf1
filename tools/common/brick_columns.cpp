#include "common/brick_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "bricks/box_chart.h"
#include "bricks/quantise.h"
#include "bricks/shell_chart.h"
#include "common/framing.h"
#include "core/error.h"
#include "pyramid/level_filter.h"

namespace nepho {
namespace {

constexpr std::size_t kFewNodes = 4096;

struct ColumnOfBricks {
  double depth = 0, base_m = std::numeric_limits<double>::infinity(), top_m = -base_m;
};
using Columns = std::map<std::tuple<int, std::uint32_t, std::uint32_t>, ColumnOfBricks>;

// Of a layer of samples: over the ellipsoid, or along z of a free box.
double height_m(const VolumeInfo& info, int root, const glm::dvec3& q) {
  const glm::dvec3 at = info.chart->ecef_m({root, q});
  if (const auto* shell = dynamic_cast<const ShellChart*>(info.chart.get()))
    return glm::length(shell->to_scaled(at)) - shell->body().equatorial_m;
  return at.z;
}

// Samples along the columns of a node, each once; half at the ends of the lattice.
void add_columns(const VolumeInfo& info, NodeKey key, const std::vector<double>& values,
                 Columns& columns) {
  const Index3& cells = info.lattice.cells(key.level());
  for (std::uint32_t j = 0; j < kBrickCells; ++j)
    for (std::uint32_t i = 0; i < kBrickCells; ++i) {
      ColumnOfBricks* column = nullptr;
      for (std::uint32_t k = 0; k <= kBrickCells; ++k) {
        const double per_m = values[brick_offset(i, j, k)];
        const std::uint32_t at = kBrickCells * key.k() + k;
        if (!(per_m > 0) || (k == kBrickCells && at < cells[2])) continue;
        const Index3 g = {kBrickCells * key.i() + i, kBrickCells * key.j() + j, at};
        if (!column) column = &columns[{key.root(), g[0], g[1]}];
        const auto point = [&](double layer) {
          return info.chart->ecef_m(
              {key.root(), {double(g[0]) / cells[0], double(g[1]) / cells[1], layer / cells[2]}});
        };
        const double low = std::max(at - 0.5, 0.0), high = std::min(at + 0.5, double(cells[2]));
        column->depth += per_m * glm::length(point(high) - point(low));
        if (per_m < DataFacts::kCloud_per_m) continue;
        const auto layer_m = [&](double layer) {
          return height_m(info, key.root(),
                          {double(g[0]) / cells[0], double(g[1]) / cells[1], layer / cells[2]});
        };
        column->base_m = std::min(column->base_m, layer_m(low));
        column->top_m = std::max(column->top_m, layer_m(high));
      }
    }
}

}  // namespace

std::vector<double> brick_values(const BrickSource& source, NodeKey key, double time_s) {
  std::vector<std::uint16_t> codes(kBrickVolume);
  ChannelView view{Channel::kExtinction, codes.data()};
  const Status status = source.read(key, time_s, BrickView(&view, 1));
  if (status != Status::kOk) {
    char text[512] = "";
    source.last_error(text, sizeof text);
    throw Error({to_string(status), "volume '" + source.info().name + "'", "", text, ""});
  }
  std::vector<double> values(kBrickVolume);
  for (std::size_t n = 0; n < values.size(); ++n)
    values[n] = decode(codes[n], view.scale, view.offset);
  return values;
}

double brick_sum(const VolumeInfo& info, NodeKey key, const std::vector<double>& values) {
  constexpr std::size_t kLayer = std::size_t(kBrickSamples) * kBrickSamples;
  const HatWeights hats = owned_hats(*info.chart, info.lattice, key);
  double sum = 0;
  for (std::size_t n = 0; n < values.size(); ++n)
    sum += values[n] * hats.horizontal[n % kLayer] * hats.vertical[n / kLayer];
  return sum;
}

std::vector<NodeKey> cloudy_nodes(const BrickSource& source, double time_s, std::size_t most) {
  const VolumeInfo& info = source.info();
  std::vector<NodeKey> nodes;
  for (int root = 0; root < info.chart->roots(); ++root) nodes.emplace_back(root, 0, 0u, 0u, 0u);
  std::erase_if(nodes, [&](NodeKey key) {
    return !(summary_of(source, key, time_s).max_extinction_per_m > 0);
  });
  for (int level = 0; level < info.lattice.max_level(); ++level) {
    std::vector<NodeKey> finer;
    for (const NodeKey key : nodes) {
      for (const NodeKey child : info.lattice.children(key))
        if (summary_of(source, child, time_s).max_extinction_per_m > 0) finer.push_back(child);
      if (finer.size() > most) return nodes;
    }
    nodes = std::move(finer);
  }
  return nodes;
}

double total_extinction_m2(const BrickSource& source, double time_s, std::size_t most_bricks) {
  double sum = 0;
  for (const NodeKey key : cloudy_nodes(source, time_s, most_bricks))
    sum += brick_sum(source.info(), key, brick_values(source, key, time_s));
  return sum;
}

DataFacts brick_facts(const BrickSource& source, double time_s) {
  const VolumeInfo& info = source.info();
  const std::vector<NodeKey> nodes = cloudy_nodes(source, time_s, kFewNodes);
  DataFacts facts;
  if (nodes.empty()) return facts;
  Columns columns;
  for (const NodeKey key : nodes)
    add_columns(info, key, brick_values(source, key, time_s), columns);
  const int level = nodes.front().level();
  facts.recognised = {{"columns from", "bricks of level " + std::to_string(level) + " of " +
                                           std::to_string(info.lattice.max_level())}};
  double cloudy_m2 = 0, depth = 0, base_m = 0, top_m = 0;
  facts.optical_depth.max = 0;
  for (const auto& [where, column] : columns) {
    facts.optical_depth.max = std::max(facts.optical_depth.max, column.depth);
    if (column.top_m > column.base_m) {
      facts.lowest_base_m = std::fmin(facts.lowest_base_m, column.base_m);
      facts.highest_top_m = std::fmax(facts.highest_top_m, column.top_m);
    }
    if (column.depth < DataFacts::kCloudyDepth || !(column.top_m > column.base_m)) continue;
    const auto& [root, i, j] = where;
    const double area_m2 =
        info.chart->hat_horizontal({root, i, j}, info.lattice.cells(level));  // or sr
    cloudy_m2 += area_m2;
    depth += area_m2 * column.depth;
    base_m += area_m2 * column.base_m;
    top_m += area_m2 * column.top_m;
  }
  facts.columns = columns.size();
  if (cloudy_m2 > 0) {
    facts.optical_depth.mean = depth / cloudy_m2;
    facts.mean_base_m = base_m / cloudy_m2, facts.mean_top_m = top_m / cloudy_m2;
  }
  if (info.chart->kind() == ChartKind::kShell) facts.cover = cloudy_m2 / (4 * 3.14159265358979324);
  return facts;
}

}  // namespace nepho
