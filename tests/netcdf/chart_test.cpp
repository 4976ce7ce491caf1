// The same forecast in a shell and in cubes around the planet: bricks for one error of what a ray
// through the clouds lets pass. Each level of either chart is drawn as it is, whole; the truth is
// the shell's finest level. Rays cross the clouds upright and at 70 degrees from the zenith.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "accuracy_report.h"
#include "geo/place.h"
#include "made_source.h"

namespace nepho::test {
namespace {

// A source's field at one level, bricks kept once read.
class LevelField {
 public:
  LevelField(const BrickSource& source, int level) : source_(source), level_(level) {}

  double operator()(const glm::dvec3& ecef_m) {
    const VolumeInfo& info = source_.info();
    const RootPosition place = info.chart->locate(ecef_m);
    for (int a = 0; a < 3; ++a)
      if (!(place.q[a] >= 0 && place.q[a] <= 1)) return 0;
    const NodeKey key = info.lattice.node_at(place.root, place.q, level_);
    auto [at, first] = bricks_.try_emplace(key);
    if (first) at->second = read_samples(source_, key);
    const Index3& n = info.lattice.cells(level_);
    glm::dvec3 t;
    Index3 s;
    for (int a = 0; a < 3; ++a) {
      const double x = place.q[a] * n[std::size_t(a)] - 8.0 * key.ijk()[std::size_t(a)];
      s[std::size_t(a)] = std::uint32_t(std::clamp(std::floor(x), 0.0, 7.0));
      t[a] = x - s[std::size_t(a)];
    }
    double sum = 0;
    for (std::uint32_t c = 0; c < 8; ++c)
      sum += (c & 1 ? t.x : 1 - t.x) * (c >> 1 & 1 ? t.y : 1 - t.y) * (c >> 2 ? t.z : 1 - t.z) *
             at->second[brick_offset(s[0] + (c & 1), s[1] + (c >> 1 & 1), s[2] + (c >> 2))];
    return sum;
  }

 private:
  const BrickSource& source_;
  int level_;
  std::map<NodeKey, BrickSamples> bricks_;
};

// Bricks of a level that are not zero.
std::size_t bricks_of(const BrickSource& source, int level) {
  const VolumeInfo& info = source.info();
  std::vector<NodeKey> nodes;
  for (int root = 0; root < info.chart->roots(); ++root) nodes.emplace_back(root, 0, 0, 0, 0);
  NodeSummary summary;
  for (int l = 0; l < level; ++l) {
    std::vector<NodeKey> finer;
    for (const NodeKey key : nodes) {
      source.summary(key, 0, summary);
      if (summary.children)
        for (const NodeKey child : info.lattice.children(key)) finer.push_back(child);
    }
    nodes = std::move(finer);
  }
  return std::size_t(std::ranges::count_if(nodes, [&](NodeKey key) {
    source.summary(key, 0, summary);
    return !summary.empty && !summary.constant;
  }));
}

struct Ray {
  glm::dvec3 from, step;  // m
};
constexpr int kSteps = 240;

std::vector<Ray> rays_through(const SyntheticForecast& forecast, int count) {
  const Ellipsoid body = Ellipsoid::wgs84();
  std::mt19937 random(17);
  std::uniform_real_distribution<double> within(0.05, 0.95);
  std::vector<Ray> rays;
  for (int n = 0; n < count; ++n) {
    const glm::dvec2 p = forecast.cells->lat_lon_deg(within(random) * forecast.cells->nx(),
                                                     within(random) * forecast.cells->ny());
    const glm::dvec3 low = ecef_m(body, {p.x, std::remainder(p.y, 360.0), 0});
    const glm::dvec3 up =
        glm::normalize(ecef_m(body, {p.x, std::remainder(p.y, 360.0), 1000}) - low);
    const glm::dvec3 side = glm::normalize(glm::cross(up, glm::dvec3(0.3, -0.5, 0.8)));
    const glm::dvec3 along = n % 2 ? up : up * std::cos(1.22) + side * std::sin(1.22);
    rays.push_back({low, along * (9000.0 / glm::dot(along, up) / kSteps)});
  }
  return rays;
}

template <class Field>
std::vector<double> along(const std::vector<Ray>& rays, Field&& field) {
  std::vector<double> values;
  for (const Ray& ray : rays)
    for (int s = 0; s < kSteps; ++s) values.push_back(field(ray.from + (s + 0.5) * ray.step));
  return values;
}

struct LevelCost {
  int level;
  std::size_t bricks;
  double error;  // rms of the difference over rms of the field
};

std::vector<LevelCost> costs(const char* name, const char* chart, const BrickSource& source,
                             const std::vector<Ray>& rays, const std::vector<double>& truth) {
  std::vector<LevelCost> list;
  for (int level = 0; level <= source.info().lattice.max_level(); ++level) {
    LevelField field(source, level);
    const std::vector<double> values =
        along(rays, [&](const glm::dvec3& ecef_m) { return field(ecef_m); });
    double gap = 0, square = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      gap += (values[n] - truth[n]) * (values[n] - truth[n]);
      square += truth[n] * truth[n];
    }
    list.push_back({level, bricks_of(source, level), std::sqrt(gap / square)});
    std::printf("measured: %s: %s level %2d, %7zu bricks, field rms %.3f\n", name, chart, level,
                list.back().bricks, list.back().error);
  }
  return list;
}

// Fewest bricks for an error; 0: none reaches it.
std::size_t bricks_for(const std::vector<LevelCost>& list, double error) {
  for (const LevelCost& cost : list)
    if (cost.error <= error) return cost.bricks;
  return 0;
}

TEST(Charts, ShellNeedsFewerBricksThanCubes) {
  for (const char* name : {"mercator", "globe"}) {
    auto forecast = synthetic_forecast(name);
    forecast->ice_per_m = nullptr;
    const auto shell = made_source(forecast);
    const auto box = made_source(forecast, {{"chart", "box", 0, ""}});
    const std::vector<Ray> rays = rays_through(*forecast, 300);
    const std::vector<double> truth = along(rays, [&](const glm::dvec3& ecef_m) {
      double beta = 0;
      shell->point_extinction_per_m(ecef_m, 0, beta);
      return beta;
    });
    const auto of_shell = costs(name, "shell", *shell, rays, truth);
    const auto of_box = costs(name, "box", *box, rays, truth);
    // At the shell's own error or, where no cubes that memory holds reach it, at theirs.
    double error = 1.05 * of_shell.back().error;
    if (bricks_for(of_box, error) == 0) error = of_box.back().error;
    const double cells = double(bricks_for(of_shell, error)),
                 cubes = double(bricks_for(of_box, error));
    ASSERT_GT(cells, 0);
    report_accuracy(
        "netcdf", std::string("bricks of the shell over those of cubes at the same error, ") + name,
        cells / cubes, 0.05, "1");
    EXPECT_LE(cells / cubes, 0.05) << name;
  }
}

}  // namespace
}  // namespace nepho::test
