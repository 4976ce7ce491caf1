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
constexpr double kWholePlanet_rad = glm::radians(30.0);  // clouds within: a part of it

// The cap that holds clouds, eye and target; null for all of the planet.
std::optional<Cap> seen(const OpenedScene& opened, const Ellipsoid& body) {
  CloudMap map;
  for (const auto& source : opened.sources) {
    // Procedural clouds are all round, and each look at them costs their making.
    if (source->info().refine_by_variance) return std::nullopt;
    append(map, cloud_map(*source, first_time_with_cloud(*source), body));
  }
  if (map.empty()) return std::nullopt;
  Cap cap = map.extent();
  const CameraSpec& camera = opened.scene.camera;
  std::vector<glm::dvec3> points;
  for (const auto& point : {camera.eye_m, camera.target_m})
    if (point && glm::length(*point) > 1) points.push_back(*point);
  if (camera.stand)
    points.push_back(ecef_m(body, {camera.stand->latitude_deg, camera.stand->longitude_deg, 0}));
  for (const glm::dvec3& point : points)
    cap.radius_rad =
        std::max(cap.radius_rad,
                 std::acos(std::clamp(glm::dot(glm::normalize(point), cap.direction), -1.0, 1.0)));
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

void open_terrain(const SourceHost& host, OpenedScene& opened) {
  if (!opened.scene.terrain) return;
  check_planet(opened);
  const Ellipsoid body = opened.scene.planet->body;
  VolumeSpec volume;
  volume.name = "terrain";
  volume.source = "gdal";
  volume.files = {opened.scene.terrain->file};
  volume.where = opened.scene.terrain->where;
  volume.parameters = {{"use", "", 0, "terrain", true, volume.where}};
  if (const auto cap = seen(opened, body))
    volume.parameters.push_back({"region", "", 0, region_of(*cap, body), true, volume.where});
  opened.terrain = open_volume(host, volume);
  const VolumeInfo& info = opened.terrain->info();
  opened.request.terrain = info.surface.get();
  for (const std::string& text : info.facts) opened.assumptions.push_back("terrain: " + text);
  for (const std::string& text : info.assumptions) opened.assumptions.push_back("terrain: " + text);
}

}  // namespace nepho
