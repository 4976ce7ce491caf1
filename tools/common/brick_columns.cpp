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

// The lattice's axis that stands most upright: the third, but in free boxes.
std::size_t upright_axis(const VolumeInfo& info) {
  const auto* box = dynamic_cast<const BoxChart*>(info.chart.get());
  if (!box || info.on_planet) return 2;
  std::size_t best = 2;
  for (const std::size_t a : {std::size_t{0}, std::size_t{1}})
    if (std::abs(box->edges_m()[int(a)].z) > std::abs(box->edges_m()[int(best)].z)) best = a;
  return best;
}

// Samples along the columns of a node, each once; half at the ends of the lattice.
void add_columns(const VolumeInfo& info, std::size_t up, NodeKey key,
                 const std::vector<double>& values, Columns& columns) {
  const Index3& cells = info.lattice.cells(key.level());
  const std::size_t u = (up + 1) % 3, v = (up + 2) % 3;
  const auto at_q = [&](Index3 g, double layer) {
    glm::dvec3 q{double(g[0]) / cells[0], double(g[1]) / cells[1], double(g[2]) / cells[2]};
    q[int(up)] = layer / cells[up];
    return q;
  };
  for (std::uint32_t j = 0; j < kBrickCells; ++j)
    for (std::uint32_t i = 0; i < kBrickCells; ++i) {
      ColumnOfBricks* column = nullptr;
      for (std::uint32_t k = 0; k <= kBrickCells; ++k) {
        Index3 s{};
        s[u] = i, s[v] = j, s[up] = k;
        const double per_m = values[brick_offset(s[0], s[1], s[2])];
        const Index3 g = Lattice::global_sample(key, s);
        if (!(per_m > 0) || (k == kBrickCells && g[up] < cells[up])) continue;
        if (!column) column = &columns[{key.root(), g[u], g[v]}];
        const double low = std::max(g[up] - 0.5, 0.0),
                     high = std::min(g[up] + 0.5, double(cells[up]));
        column->depth += per_m * glm::length(info.chart->ecef_m({key.root(), at_q(g, high)}) -
                                             info.chart->ecef_m({key.root(), at_q(g, low)}));
        if (per_m < DataFacts::kCloud_per_m) continue;
        const double a_m = height_m(info, key.root(), at_q(g, low)),
                     b_m = height_m(info, key.root(), at_q(g, high));
        column->base_m = std::min({column->base_m, a_m, b_m});
        column->top_m = std::max({column->top_m, a_m, b_m});
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
  const std::size_t up = upright_axis(info);
  for (const NodeKey key : nodes)
    add_columns(info, up, key, brick_values(source, key, time_s), columns);
  const int level = nodes.front().level();
  facts.recognised = {{"columns from", "bricks of level " + std::to_string(level) + " of " +
                                           std::to_string(info.lattice.max_level())}};
  const bool shell = info.chart->kind() == ChartKind::kShell;
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
    // Columns of a box are alike; of a shell, sr.
    const double area_m2 =
        shell ? info.chart->hat_horizontal({root, i, j}, info.lattice.cells(level)) : 1;
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
  if (shell) facts.cover = cloudy_m2 / (4 * 3.14159265358979324);
  return facts;
}

}  // namespace nepho
