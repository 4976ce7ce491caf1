#include "common/terrain.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>

#include "bricks/shell_chart.h"
#include "common/cloud_map.h"
#include "common/planet_scene.h"
#include "core/error.h"
#include "geo/place.h"
#include "scene/scene_file.h"

namespace nepho {
namespace {

constexpr double kAround_m = 200e3;
constexpr int kMostNodes = 4096;  // an axis
constexpr double kFall = 1.732;   // of the ground into gaps, m per m: tan 60 degrees
constexpr int kMostRim = 200;     // nodes
constexpr double kWholePlanet_rad = glm::radians(30.0);  // clouds within: a part of it

// The cap that holds the clouds; null for all of the planet. Not eye and target: they are known
// when a picture is drawn again, and it would see another part.
std::optional<Cap> seen(const OpenedScene& opened, const Ellipsoid& body) {
  CloudMap map;
  for (const auto& source : opened.sources) {
    // Procedural clouds are all round, and each look at them costs their making.
    if (source->info().refine_by_variance) return std::nullopt;
    append(map, cloud_map(*source, first_time_with_cloud(*source), body));
  }
  if (map.empty()) return std::nullopt;
  Cap cap = map.extent();
  cap.radius_rad += kAround_m / body.equatorial_m;
  if (cap.radius_rad > kWholePlanet_rad) return std::nullopt;
  return cap;
}

// "SOUTH,WEST,NORTH,EAST" around a cap.
std::string region_of(const Cap& cap, const Ellipsoid& body) {
  const GeodeticPoint middle = geodetic_point(body, cap.direction * body.equatorial_m);
  const double half_deg = glm::degrees(cap.radius_rad) + 0.2;  // geocentric latitudes are that off
  const double south = std::max(middle.latitude_deg - half_deg, -90.0);
  const double north = std::min(middle.latitude_deg + half_deg, 90.0);
  const double narrowest = std::cos(glm::radians(std::max(std::abs(south), std::abs(north))));
  double west = -180, east = 180;
  if (half_deg < 175 * narrowest) {
    west = middle.longitude_deg - half_deg / narrowest;
    east = middle.longitude_deg + half_deg / narrowest;
    if (west < -180) west += 360;
    if (east > 180) east -= 360;
  }
  char text[120];
  std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f,%.6f", south, west, north, east);
  return text;
}

void check_planet(const OpenedScene& opened) {
  const Scene& scene = opened.scene;
  const auto refuse = [&](const char* what, const char* expected, const char* found) {
    throw Error({what, scene.terrain->where, expected, found, ""});
  };
  if (scene.no_planet || !scene.planet) refuse("terrain without a planet", "a planet", "none");
  if (std::abs(scene.planet->body.equatorial_m - Ellipsoid::wgs84().equatorial_m) > 1)
    refuse("terrain is the Earth's", "a planet of its size", "another");
  const bool stands = has_frame(scene) || std::ranges::any_of(opened.sources, [](const auto& s) {
                        return s->info().on_planet;
                      });
  if (!stands) refuse("no cloud stands on the planet", "a place (scene key place)", "none");
}

}  // namespace

std::shared_ptr<SurfaceMap> joined_ground(const SurfaceMap& fine, const SurfaceMap& own) {
  if (own.around || own.nx < 2 || own.ny < 2) return nullptr;
  auto map = std::make_shared<SurfaceMap>();
  map->axes = own.axes;
  glm::dvec2 low = own.low_rad,
             high = own.low_rad + own.step_rad * glm::dvec2(own.nx - 1, own.ny - 1);
  const auto direction = [](const SurfaceMap& of, double i, double j) {
    const glm::dvec2 a = of.low_rad + of.step_rad * glm::dvec2(i, j);
    return of.axes *
           glm::dvec3(std::cos(a.y) * std::cos(a.x), std::cos(a.y) * std::sin(a.x), std::sin(a.y));
  };
  constexpr int kPoints = 16;
  for (int n = 0; n <= kPoints; ++n) {
    const double i = double(fine.nx - 1) * n / kPoints, j = double(fine.ny - 1) * n / kPoints;
    for (const glm::dvec3& u : {direction(fine, i, 0), direction(fine, i, fine.ny - 1),
                                direction(fine, 0, j), direction(fine, fine.nx - 1, j)}) {
      const glm::dvec3 v = glm::transpose(own.axes) * u;
      const glm::dvec2 at = {std::atan2(v.y, v.x), std::asin(std::clamp(v.z, -1.0, 1.0))};
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  }
  const glm::dvec2 nodes = glm::ceil((high - low) / fine.step_rad) + 1.0;
  if (nodes.x > kMostNodes || nodes.y > kMostNodes) return nullptr;
  map->nx = int(nodes.x);
  map->ny = int(nodes.y);
  map->low_rad = low;
  map->step_rad = (high - low) / (nodes - 1.0);
  map->height_m.assign(std::size_t(map->nx) * std::size_t(map->ny), 0.0f);
  map->water.assign(map->height_m.size(), 1.0f);
  for (int j = 0; j < map->ny; ++j)
    for (int i = 0; i < map->nx; ++i) {
      const glm::dvec3 u = direction(*map, i, j);
      const std::size_t n = std::size_t(j) * std::size_t(map->nx) + std::size_t(i);
      for (const SurfaceMap* from : {&fine, &own}) {
        const auto place = place_on(*from, u);
        if (!place) continue;
        const double height_m = place->value(from->height_m);
        if (std::isnan(height_m)) continue;
        map->height_m[n] = float(height_m);
        map->water[n] = float(place->value(from->water));
        break;
      }
    }
  return map;
}

std::shared_ptr<SurfaceMap> filled_ground(const SurfaceMap& fine) {
  auto map = std::make_shared<SurfaceMap>(fine);
  const double north_m = Ellipsoid::wgs84().polar_m * fine.step_rad.y;
  const double fall_m = kFall * north_m;  // a node further
  float highest_m = 0;
  for (const float height_m : fine.height_m)
    if (height_m > highest_m) highest_m = height_m;
  const int room = std::max(0, kMostNodes - std::max(fine.nx, fine.ny)) / 2;
  const int rim = fine.around ? 0 : std::min({int(double(highest_m) / fall_m) + 2, kMostRim, room});
  map->nx += 2 * rim;
  map->ny += 2 * rim;
  map->low_rad -= double(rim) * fine.step_rad;
  const auto at = [&](int i, int j) {
    return std::size_t(j) * std::size_t(map->nx) + std::size_t(i);
  };
  map->height_m.assign(std::size_t(map->nx) * std::size_t(map->ny), NAN);
  map->water.assign(map->height_m.size(), 1.0f);
  for (int j = 0; j < fine.ny; ++j)
    for (int i = 0; i < fine.nx; ++i) {
      const std::size_t n = std::size_t(j) * std::size_t(fine.nx) + std::size_t(i);
      map->height_m[at(i + rim, j + rim)] = fine.height_m[n];
      map->water[at(i + rim, j + rim)] = fine.water[n];
    }
  // Two sweeps, each taking over from the neighbours that it has been to.
  std::vector<char> gap(map->height_m.size());
  for (std::size_t n = 0; n < gap.size(); ++n)
    if ((gap[n] = std::isnan(map->height_m[n]))) map->height_m[n] = 0;
  const auto take = [&](int i, int j, int from_i, int from_j, double far) {
    if (map->around) from_i = (from_i + map->nx) % map->nx;
    if (from_i < 0 || from_j < 0 || from_i >= map->nx || from_j >= map->ny) return;
    float& here_m = map->height_m[at(i, j)];
    here_m = std::max(here_m, float(double(map->height_m[at(from_i, from_j)]) - far * fall_m));
  };
  const auto sweep = [&](int i, int j, int back) {
    if (!gap[at(i, j)]) return;
    take(i, j, i - back, j, 1);
    for (const int side : {-1, 0, 1}) take(i, j, i + side, j - back, std::hypot(side, 1));
  };
  for (int j = 0; j < map->ny; ++j)
    for (int i = 0; i < map->nx; ++i) sweep(i, j, 1);
  for (int j = map->ny - 1; j >= 0; --j)
    for (int i = map->nx - 1; i >= 0; --i) sweep(i, j, -1);
  for (std::size_t n = 0; n < gap.size(); ++n)
    if (gap[n]) map->water[n] = map->height_m[n] <= 0.5f ? 1.0f : 0.0f;
  return map;
}

void open_terrain(const SourceHost& host, OpenedScene& opened) {
  if (!opened.scene.terrain) return;
  check_planet(opened);
  const Ellipsoid body = opened.scene.planet->body;
  VolumeSpec volume;
  volume.name = "terrain";
  volume.source = "gdal";
  volume.files = {opened.scene.terrain->file};
  volume.where = opened.scene.terrain->where;
  volume.parameters = {{"use", "", 0, "terrain", true, volume.where},
                       {"gaps", "", 0, "nan", true, volume.where}};
  if (const auto cap = seen(opened, body))
    volume.parameters.push_back({"region", "", 0, region_of(*cap, body), true, volume.where});
  const std::unique_ptr<BrickSource> source = open_volume(host, volume);
  const VolumeInfo& info = source->info();
  const auto say = [&](const std::string& text) {
    opened.assumptions.push_back("terrain: " + text);
  };
  for (const auto& texts : {info.facts, info.assumptions})
    for (const std::string& text : texts) say(text);
  const SurfaceMap* own = nullptr;
  for (const auto& other : opened.sources)
    if (!own) own = other->info().surface.get();
  std::shared_ptr<SurfaceMap> map = own ? joined_ground(*info.surface, *own) : nullptr;
  if (map) {
    say("Around it, and where it has no data, lies the ground of the clouds' data; sea is where it "
        "is at or below 0.5 m.");
  } else {
    say("Sea is where it is at or below 0.5 m; where it has no data, and around it, the ground "
        "falls to the sea at 60 degrees.");
    if (own) say("The ground of the clouds' data is left out: it is too wide for nodes so fine.");
    map = filled_ground(*info.surface);
  }
  opened.terrain = std::move(map);
  opened.request.terrain = opened.terrain.get();
}

}  // namespace nepho
