#include "common/cloud_map.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <tuple>

#include "common/brick_columns.h"
#include "common/framing.h"
#include "core/error.h"

namespace nepho {
namespace {

constexpr std::size_t kEnoughNodes = 300;      // some ten thousand columns
constexpr double kSeen_per_m = 1e-5;           // 100 km of sight: thinner is no edge of a cloud
constexpr std::size_t kMostCandidates = 1000;  // of the search for the cloudiest place

double angle_rad(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

bool touches(const VolumeInfo& info, NodeKey key, const Cap& cap) {
  const Index3 count = info.lattice.nodes(key.level());
  const auto direction = [&](double x, double y) {
    return glm::normalize(info.chart->ecef_m(
        {key.root(), {(key.i() + x) / count[0], (key.j() + y) / count[1], 0.5}}));
  };
  const glm::dvec3 middle = direction(0.5, 0.5);
  double radius_rad = 0;
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      radius_rad = std::max(radius_rad, angle_rad(middle, direction(x, y)));
  return angle_rad(middle, cap.direction) <= radius_rad + cap.radius_rad;
}

std::vector<NodeKey> nodes_in_cap(const BrickSource& source, double time_s,
                                  const std::optional<Cap>& cap) {
  const VolumeInfo& info = source.info();
  std::vector<NodeKey> nodes;
  for (int root = 0; root < info.chart->roots(); ++root) nodes.emplace_back(root, 0, 0u, 0u, 0u);
  for (int level = 0;; ++level) {
    const bool last = level == info.lattice.max_level();
    std::vector<NodeKey> kept, finer;
    for (const NodeKey key : nodes) {
      if (cap && !touches(info, key, *cap)) continue;
      const NodeSummary summary = summary_of(source, key, time_s);
      if (!(summary.max_extinction_per_m > 0)) continue;
      kept.push_back(key);
      if (last) continue;
      const SplitMask mask = info.lattice.split_axes(level);
      for (SplitMask octant = 0; octant <= kSplitXyz; ++octant)
        if ((octant & ~mask) == 0 && (summary.constant || (summary.children >> octant & 1)))
          finer.push_back(key.child(mask, octant));
    }
    if (last || kept.size() >= kEnoughNodes || finer.empty()) return kept;
    nodes = std::move(finer);
  }
}

// Extinction at the middle of a cell.
double cell_per_m(const std::vector<double>& brick, std::size_t x, std::size_t y, std::size_t z) {
  double sum = 0;
  for (std::size_t c = 0; c < 8; ++c)
    sum += brick[(x + (c & 1)) +
                 kBrickSamples * ((y + (c >> 1 & 1)) + kBrickSamples * (z + (c >> 2)))];
  return sum / 8;
}

using ColumnKey = std::tuple<int, std::uint32_t, std::uint32_t>;

void add_brick(const VolumeInfo& info, NodeKey key, const std::vector<double>& brick,
               const Ellipsoid& body, std::map<ColumnKey, CloudColumn>& columns) {
  const Index3& cells = info.lattice.cells(key.level());
  for (std::uint32_t y = 0; y < kBrickCells; ++y)
    for (std::uint32_t x = 0; x < kBrickCells; ++x) {
      const std::uint32_t i = kBrickCells * key.i() + x, j = kBrickCells * key.j() + y;
      const auto point = [&](double di, double dj, std::uint32_t k) {
        return info.chart->ecef_m(
            {key.root(), {(i + di) / cells[0], (j + dj) / cells[1], double(k) / cells[2]}});
      };
      const auto found = columns.find({key.root(), i, j});
      CloudColumn column = found != columns.end() ? found->second : CloudColumn{};
      for (std::uint32_t z = 0; z < kBrickCells; ++z) {
        const double c_per_m = cell_per_m(brick, x, y, z);
        if (!(c_per_m > 0)) continue;
        const std::uint32_t k = kBrickCells * key.k() + z;
        const glm::dvec3 low = point(0.5, 0.5, k), high = point(0.5, 0.5, k + 1);
        const double low_m = geodetic_height_m(body, low), high_m = geodetic_height_m(body, high);
        const bool first = column.optical_depth == 0;
        column.optical_depth += c_per_m * glm::length(high - low);
        column.direction = glm::normalize(low);
        if (first || c_per_m >= kSeen_per_m) {
          column.base_m = first ? low_m : std::min(column.base_m, low_m);
          column.top_m = first ? high_m : std::max(column.top_m, high_m);
        }
      }
      if (column.optical_depth == 0) continue;
      if (column.area_m2 == 0) {
        const std::uint32_t k = kBrickCells * key.k();
        column.area_m2 = glm::length(
            glm::cross(point(1, 0.5, k) - point(0, 0.5, k), point(0.5, 1, k) - point(0.5, 0, k)));
      }
      columns[{key.root(), i, j}] = column;
    }
}

// Of a Gaussian around a place: the part where there are data, from points that share it evenly.
double known_share(const glm::dvec3& place, double width_rad, const PlanetGround& ground) {
  if (ground.maps.empty()) return 1;
  constexpr int kPoints = 24;
  constexpr double kGoldenTurn_rad = 2.399963229728653;
  const LocalAxes axes = ground.axes(place * ground.body.equatorial_m);
  int known = 0;
  for (int n = 0; n < kPoints; ++n) {
    const double away_rad = width_rad * std::sqrt(-2 * std::log(1 - (n + 0.5) / kPoints));
    const double turn_rad = kGoldenTurn_rad * n;
    const glm::dvec3 at =
        place + away_rad * (std::cos(turn_rad) * axes.east + std::sin(turn_rad) * axes.north);
    known += ground.known(at * ground.body.equatorial_m);
  }
  return double(known) / kPoints;
}

// Where `score` of the place and of the mean and the mean square of cloudiness under a Gaussian is
// greatest.
template <class Score>
glm::dvec3 best_place(const CloudMap& map, double width_rad, double body_m, Score&& score) {
  const std::size_t step = 1 + map.columns.size() / kMostCandidates;
  const double far = std::cos(std::min(4 * width_rad, glm::pi<double>()));
  const double all_m2 = glm::two_pi<double>() * width_rad * width_rad * body_m * body_m;
  glm::dvec3 best = map.columns.front().direction;
  double most = -1;
  for (std::size_t c = 0; c < map.columns.size(); c += step) {
    const glm::dvec3& candidate = map.columns[c].direction;
    double mean = 0, square = 0;
    for (const CloudColumn& other : map.columns) {
      if (glm::dot(other.direction, candidate) < far) continue;
      const double apart = glm::length(other.direction - candidate) / width_rad;
      const double weight = other.area_m2 / all_m2 * std::exp(-0.5 * apart * apart);
      mean += weight * other.cloudiness();
      square += weight * other.cloudiness() * other.cloudiness();
    }
    const double found = score(candidate, mean, square);
    if (found > most) most = found, best = candidate;
  }
  return best;
}

}  // namespace

Cap CloudMap::extent() const {
  glm::dvec3 sum(0.0);
  double area_m2 = 0;
  for (const CloudColumn& c : columns) {
    sum += c.area_m2 * c.direction;
    area_m2 += c.area_m2;
  }
  if (!(glm::length(sum) > 0.1 * area_m2)) return {{0, 0, 1}, glm::pi<double>()};
  Cap cap{glm::normalize(sum), 0};
  for (const CloudColumn& c : columns)
    cap.radius_rad = std::max(cap.radius_rad, angle_rad(cap.direction, c.direction));
  return cap;
}

Cap CloudMap::bulk() const {
  const auto cover_m2 = [](const CloudColumn& c) {
    return (1 - std::exp(-c.optical_depth)) * c.area_m2;  // what hides the ground
  };
  constexpr double kSquare = 2.4;  // corner of a square over its rms radius (1.73), and some margin
  glm::dvec3 sum(0.0);
  double all = 0, squares = 0;
  for (const CloudColumn& c : columns) {
    sum += cover_m2(c) * c.direction;
    all += cover_m2(c);
  }
  if (!(glm::length(sum) > 0.1 * all)) return {{0, 0, 1}, glm::pi<double>()};
  Cap cap{glm::normalize(sum), 0};
  for (const CloudColumn& c : columns) {
    const double away_rad = angle_rad(cap.direction, c.direction);
    squares += cover_m2(c) * away_rad * away_rad;
  }
  cap.radius_rad = kSquare * std::sqrt(squares / all);
  return cap;
}

CloudMap cloud_map(const BrickSource& source, double time_s, const Ellipsoid& body,
                   const std::optional<Cap>& cap) {
  const VolumeInfo& info = source.info();
  const std::vector<NodeKey> nodes = nodes_in_cap(source, time_s, cap);
  std::map<ColumnKey, CloudColumn> columns;
  for (const NodeKey key : nodes)
    add_brick(info, key, brick_values(source, key, time_s), body, columns);
  CloudMap result;
  std::vector<double> sides_m;
  for (const auto& [key, column] : columns) {
    if (cap && angle_rad(column.direction, cap->direction) > cap->radius_rad) continue;
    result.columns.push_back(column);
    sides_m.push_back(std::sqrt(column.area_m2));
  }
  if (sides_m.empty()) return result;
  const auto middle = sides_m.begin() + std::ptrdiff_t(sides_m.size() / 2);
  std::nth_element(sides_m.begin(), middle, sides_m.end());
  result.cell_m = *middle;
  const Index3 &own = info.lattice.cells(nodes.front().level()),
               &finest = info.lattice.cells(info.lattice.max_level());
  result.finest_cell_m = result.cell_m * double(own[0]) / double(finest[0]);
  return result;
}

void append(CloudMap& map, const CloudMap& more) {
  const bool first = map.empty();
  map.columns.insert(map.columns.end(), more.columns.begin(), more.columns.end());
  if (more.empty()) return;
  map.cell_m = first ? more.cell_m : std::max(map.cell_m, more.cell_m);
  map.finest_cell_m = first ? more.finest_cell_m : std::min(map.finest_cell_m, more.finest_cell_m);
}

glm::dvec3 cloudiest(const CloudMap& map, double width_rad) {
  return best_place(map, width_rad, 1, [](const glm::dvec3&, double mean, double) { return mean; });
}

glm::dvec3 most_varied(const CloudMap& map, double width_rad, const PlanetGround& ground) {
#ifdef NEPHO_MUTANT_THICKEST
  return cloudiest(map, width_rad + 0 * ground.body.equatorial_m);
#endif
  const auto variance = [&](const glm::dvec3& place, double mean, double square) {
    const double known = known_share(place, width_rad, ground);
    if (!(known > 0)) return 0.0;
    return known * std::max(0.0, square / known - mean * mean / (known * known));
  };
  return best_place(map, width_rad, ground.body.equatorial_m, variance);
}

}  // namespace nepho
