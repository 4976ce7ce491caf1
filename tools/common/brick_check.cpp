#include "common/brick_check.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

#include "bricks/box_chart.h"
#include "bricks/coarsen.h"
#include "bricks/shell_chart.h"
#include "common/brick_columns.h"
#include "common/framing.h"
#include "core/error.h"

namespace nepho {
namespace {

constexpr std::size_t kEnoughTowers = 1024;         // from there on, towers are drawn
constexpr std::size_t kTowers = 64, kColumns = 64;  // that are compared
constexpr int kStrata = 48;                         // a side of the square under a hat
constexpr int kPointsEach = 8;                      // along a line, in each cell
constexpr std::size_t kMostBricks = 1024;           // of the level that is summed up

// All nodes of one level above each other, those with cloud.
struct Tower {
  std::vector<NodeKey> nodes;
  double weight = 1;  // the inverse of its probability
};
using Place = std::tuple<int, std::uint32_t, std::uint32_t>;

class Checker {
 public:
  Checker(const BrickSource& source, double time_s, std::uint64_t seed)
      : source_(source),
        info_(source.info()),
        time_s_(time_s),
        shell_(dynamic_cast<const ShellChart*>(info_.chart.get())),
        cells_(info_.lattice.cells(info_.lattice.max_level())),
        random_(seed) {
    OwnColumn ignored;
    const glm::dvec3 middle = info_.chart->ecef_m({0, glm::dvec3(0.5)});
    const Status status = source.own_column(middle, time_s, ignored);
    if (status != Status::kOk && status != Status::kUnsupported) refuse(status);
    has_columns_ = info_.finest == SampleKind::kHat && status == Status::kOk;
    // Sum of hats times this is the length of a line through a box, or a shell's widened height.
    if (const auto* box = dynamic_cast<const BoxChart*>(info_.chart.get())) {
      double rise_m = 0;
      for (std::uint32_t k = 0; k <= cells_[2]; ++k) rise_m += box->hat_vertical(k, cells_);
      unit_ = glm::length(box->edges_m()[2]) / rise_m;
    } else if (shell_) {
      unit_ = 1 / (shell_->body().equatorial_m * shell_->body().polar_m);
    }
  }

  BrickCheck run();

 private:
  struct Compared {
    double bricks = 0, own[2] = {0, 0};  // two estimates of the same depth
  };

  [[noreturn]] void refuse(Status status) const {
    char text[512] = "";
    source_.last_error(text, sizeof text);
    throw Error({to_string(status), "volume '" + info_.name + "'", "", text, ""});
  }
  double number() { return double(random_() >> 11) * 0x1p-53; }

  std::vector<Tower> finer(const Tower& tower) const;
  std::vector<Tower> draw_towers();
  Compared compare(const std::map<std::uint32_t, std::vector<double>>& bricks, int root,
                   const Index3& at, double& weight);
  double own_under_hat(int root, const Index3& at, double q_z);
  double own_on_line(const std::map<std::uint32_t, std::vector<double>>& bricks, int root,
                     const Index3& at) const;
  // Depths are told as bricks count them: columns widen with height.
  double widening(double height_m) const {
    const double wider = shell_ ? 1 + height_m / shell_->body().equatorial_m : 1;
    return wider * wider;
  }
  double height_m(const glm::dvec3& ecef_m) const {
    return glm::length(shell_->to_scaled(ecef_m)) - shell_->body().equatorial_m;
  }

  const BrickSource& source_;
  const VolumeInfo& info_;
  double time_s_;
  const ShellChart* shell_;
  Index3 cells_;
  std::mt19937_64 random_;
  bool has_columns_ = false;
  double unit_ = 1;
};

std::vector<Tower> Checker::finer(const Tower& tower) const {
  std::map<Place, Tower> towers;
  for (const NodeKey key : tower.nodes)
    for (const NodeKey child : info_.lattice.children(key))
      if (summary_of(source_, child, time_s_).max_extinction_per_m > 0) {
        Tower& found = towers[{child.root(), child.i(), child.j()}];
        found.weight = tower.weight;
        found.nodes.push_back(child);
      }
  std::vector<Tower> result;
  for (auto& [_, found] : towers) result.push_back(std::move(found));
  return result;
}

// All towers of a level that has enough of them; some of these, followed down to the finest level.
std::vector<Tower> Checker::draw_towers() {
  std::vector<Tower> towers;
  for (int root = 0; root < info_.chart->roots(); ++root) {
    const NodeKey key(root, 0, 0u, 0u, 0u);
    if (summary_of(source_, key, time_s_).max_extinction_per_m > 0) towers.push_back({{key}, 1});
  }
  int level = 0;
  for (; level < info_.lattice.max_level() && towers.size() < kEnoughTowers; ++level) {
    std::vector<Tower> next;
    for (const Tower& tower : towers) std::ranges::move(finer(tower), std::back_inserter(next));
    towers = std::move(next);
  }
  std::ranges::shuffle(towers, random_);
  if (towers.size() > kTowers) {
    for (Tower& tower : towers) tower.weight *= double(towers.size()) / double(kTowers);
    towers.resize(kTowers);
  }
  for (; level < info_.lattice.max_level(); ++level) {
    std::vector<Tower> next;
    for (const Tower& tower : towers) {
      std::vector<Tower> choices = finer(tower);
      if (choices.empty()) continue;  // a coarse brick may hold what its children do not
      const std::size_t chosen =
          std::min(std::size_t(number() * double(choices.size())), choices.size() - 1);
      choices[chosen].weight *= double(choices.size());
      next.push_back(std::move(choices[chosen]));
    }
    towers = std::move(next);
  }
  return towers;
}

// Mean over the column's hat of the source's own depth, at stratified random points.
double Checker::own_under_hat(int root, const Index3& at, double q_z) {
  double sum = 0, total = 0;
  for (int b = 0; b < kStrata; ++b)
    for (int a = 0; a < kStrata; ++a) {
      const double u = 2 * (a + number()) / kStrata - 1, v = 2 * (b + number()) / kStrata - 1;
      const glm::dvec3 q = {(at[0] + u) / cells_[0], (at[1] + v) / cells_[1], q_z};
      double weight = (1 - std::abs(u)) * (1 - std::abs(v));
      if (shell_) {  // area of the cube's face on the sphere
        const double x = std::tan(std::numbers::pi / 4 * (2 * q.x - 1)),
                     y = std::tan(std::numbers::pi / 4 * (2 * q.y - 1));
        weight *= (1 + x * x) * (1 + y * y) / std::pow(1 + x * x + y * y, 1.5);
      }
      OwnColumn own;
      const Status status = source_.own_column(info_.chart->ecef_m({root, q}), time_s_, own);
      if (status != Status::kOk) refuse(status);
      sum += weight * own.optical_depth * widening(own.mean_height_m);
      total += weight;
    }
  return sum / total;
}

// The source's own field along the column's line; in nodes without a brick one point in each cell.
double Checker::own_on_line(const std::map<std::uint32_t, std::vector<double>>& bricks, int root,
                            const Index3& at) const {
  const auto ecef = [&](double k) {
    return info_.chart->ecef_m(
        {root, {double(at[0]) / cells_[0], double(at[1]) / cells_[1], k / cells_[2]}});
  };
  double sum = 0;
  for (std::uint32_t k = 0; k < cells_[2]; ++k) {
    const int points = bricks.contains(k / kBrickCells) ? kPointsEach : 1;
    const double step_m = glm::length(ecef(k + 1.0) - ecef(k)) / points;
    for (int p = 0; p < points; ++p) {
      const glm::dvec3 here = ecef(k + (p + 0.5) / points);
      double per_m = 0;
      const Status status = source_.point_extinction_per_m(here, time_s_, per_m);
      if (status == Status::kUnsupported)
        throw Error({"this source has no field of its own to check its bricks against",
                     "volume '" + info_.name + "'", "", "", ""});
      if (status != Status::kOk) refuse(status);
      sum += per_m * step_m * (shell_ ? widening(height_m(here)) : 1);
    }
  }
  return sum;
}

Checker::Compared Checker::compare(const std::map<std::uint32_t, std::vector<double>>& bricks,
                                   int root, const Index3& at, double& weight) {
  Compared result;
  double middle = 0;
  for (const auto& [layer, values] : bricks)
    for (std::uint32_t s = 0; s <= kBrickCells; ++s) {
      const std::uint32_t k = kBrickCells * layer + s;
      // A shared layer is the upper node's, where that has a brick.
      if (s == kBrickCells && k < cells_[2] && bricks.contains(layer + 1)) continue;
      const double part = values[brick_offset(at[0] % kBrickCells, at[1] % kBrickCells, s)] *
                          info_.chart->hat_vertical(k, cells_) * unit_;
      result.bricks += part;
      middle += part * k;
    }
  weight = info_.chart->hat_horizontal({root, at[0], at[1]}, cells_);
  if (!has_columns_) {
    result.own[0] = result.own[1] = own_on_line(bricks, root, at);
    return result;
  }
  const double q_z = result.bricks > 0 ? middle / result.bricks / cells_[2] : 0.5;
  for (double& own : result.own) own = own_under_hat(root, at, q_z);
  return result;
}

BrickCheck Checker::run() {
  struct Sums {
    double off = 0, own = 0, square = 0, own_square = 0;
  };
  std::vector<Sums> columns;
  BrickCheck check;
  const std::vector<Tower> drawn = draw_towers();
  const std::size_t each = (kColumns + drawn.size()) / std::max<std::size_t>(drawn.size(), 1);
  for (const Tower& tower : drawn) {
    std::map<std::uint32_t, std::vector<double>> bricks;
    for (const NodeKey key : tower.nodes) bricks[key.k()] = brick_values(source_, key, time_s_);
    const NodeKey first = tower.nodes.front();
    for (std::size_t c = 0; c < each; ++c) {
      const auto offset = [&] { return std::uint32_t(number() * kBrickCells); };
      const std::uint32_t i = kBrickCells * first.i() + offset();
      const std::uint32_t j = kBrickCells * first.j() + offset();
      const Index3 at = {i, j, 0};
      if (i == 0 || j == 0) continue;  // hats that go on in another root
      double area = 0;
      const Compared depth = compare(bricks, first.root(), at, area);
      const double off[2] = {depth.bricks - depth.own[0], depth.bricks - depth.own[1]};
      const double weight = tower.weight * area;
      // Squares by two estimates are free of the points' noise.
      columns.push_back({weight * (off[0] + off[1]) / 2, weight * (depth.own[0] + depth.own[1]) / 2,
                         weight * off[0] * off[1], weight * depth.own[0] * depth.own[1]});
    }
  }
  Sums all;
  for (const Sums& s : columns)
    all.off += s.off, all.own += s.own, all.square += s.square, all.own_square += s.own_square;
  check.columns = int(columns.size());
  if (!(all.own > 0) && columns.empty())
    throw Error({"nothing to check", "volume '" + info_.name + "'", "some cloud", "none", ""});
  const double square = all.own_square > 0 ? all.square / all.own_square : 1;
  check.total_difference = all.own > 0 ? all.off / all.own : 1;
  double doubt = 0, square_doubt = 0;
  for (const Sums& s : columns) {
    doubt += std::pow((s.off - check.total_difference * s.own) / all.own, 2);
    square_doubt += std::pow((s.square - square * s.own_square) / all.own_square, 2);
  }
  check.total_doubt = std::sqrt(doubt);
  check.column_rms = std::sqrt(std::max(square, 0.0));
  check.column_rms_least = std::sqrt(std::max(square - 2 * std::sqrt(square_doubt), 0.0));
  return check;
}

}  // namespace

bool BrickCheck::total_kept() const {
  return std::abs(total_difference) - 2 * total_doubt <= kTotal;
}

BrickCheck check_bricks(const BrickSource& source, double time_s, std::uint64_t seed) {
  BrickCheck check = Checker(source, time_s, seed).run();
  DataFacts facts;
  if (source.data_facts(time_s, facts) == Status::kOk && facts.extinction_m2 > 0) {
    check.total_difference =
        total_extinction_m2(source, time_s, kMostBricks) / facts.extinction_m2 - 1;
    check.total_doubt = 0;
  }
  return check;
}

}  // namespace nepho
