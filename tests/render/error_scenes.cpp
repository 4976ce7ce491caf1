#include "error_scenes.h"

#include "analytic_field.h"
#include "host/source_host.h"
#include "scene/scene_file.h"
#include "scenes.h"

namespace nepho::test {
namespace {

const SourceHost& host() {
  static const SourceHost modules({NEPHO_TEST_MODULES});
  return modules;
}

// A field that is drawn here, in a box of 1 km, under a sky.
ErrorScene drawn(const FieldSource& source) {
  RenderRequest request = request_of({&source});
  request.settings = {};
  request.settings.width = 32;
  request.settings.height = 18;
  request.sky.zenith_W_per_m2_sr_nm = {0.02, 0.04, 0.08};
  request.sky.horizon_W_per_m2_sr_nm = glm::dvec3(0.07);
  request.sky.below_W_per_m2_sr_nm = glm::dvec3(0.03);
  request.sun.to_sun = glm::normalize(glm::dvec3(-0.5, -0.3, 0.6));
  request.camera = {{500, -1500, 700}, {0, 0, 480}, {0, 0, 1}, 0.75};
  return {{}, request};
}

ErrorScene clumps() {
  static const FieldSource source(box(1000, 1000), isotropic(3), [](glm::dvec3 p) {
    return 8 * cloud(0.005 * p) + 1.5 * puffs(0.001 * p);
  });
  ErrorScene scene = drawn(source);
  scene.request.settings.budget_mib = 1;
  return scene;
}

// Of optical depth 40 with a top that is not flat.
ErrorScene thick_slab() {
  static const FieldSource source(box(1000, 1000), isotropic(3), [](glm::dvec3 p) {
    const double top_m = 700 + 60 * std::sin(p.x / 70) * std::cos(p.y / 90);
    return 0.08 * std::clamp((top_m - p.z) / 120, 0.0, 1.0) * std::clamp(p.z / 200, 0.0, 1.0);
  });
  ErrorScene scene = drawn(source);
  scene.request.camera = {{0, -900, 1500}, {0, 0, 600}, {0, 0, 1}, 0.5};
  scene.request.settings.budget_mib = 2;
  return scene;
}

// Four octaves of gradient-like noise, all of the box.
ErrorScene noise_box() {
  static const FieldSource source(box(1000, 1000), isotropic(3), [](glm::dvec3 p) {
    double sum = 0, height = 1;
    for (int octave = 0; octave < 4; ++octave, height *= 0.6) {
      const glm::dvec3 q = p * (std::exp2(octave) / 90) + glm::dvec3(7.1 * octave);
      sum += height * std::sin(q.x + 1.3 * std::cos(q.y)) * std::sin(q.y + 1.1 * std::cos(q.z)) *
             std::sin(q.z + 0.7 * std::cos(q.x));
    }
    return 0.02 * std::max(sum, 0.0);
  });
  ErrorScene scene = drawn(source);
  scene.request.settings.budget_mib = 2;
  return scene;
}

ErrorScene read(const std::string& json) {
  Scene scene = parse_scene(json, "error scene", NEPHO_TEST_SAMPLES);
  scene.render.width = 32;
  scene.render.height = 18;
  ErrorScene made{open_scene(host(), scene), {}};
  made.request = made.opened.request;
  return made;
}

ErrorScene plume() {
  return read(R"({"volumes": [{"name": "plume", "source": "openvdb", "files": "plume.####.vdb",
    "parameters": {"frame": 5}, "phase": {"kind": "henyey_greenstein", "asymmetry": 0.6},
    "co_albedo": [0.12, 0.13, 0.15]}], "camera": {"fov_deg": 25},
    "render": {"budget_mib": 0.5}})");
}

ErrorScene les() {
  return read(R"({"volumes": [{"name": "les", "source": "netcdf", "files": "les.nc"}],
    "render": {"budget_mib": 2}})");
}

ErrorScene forecast() {
  return read(R"({"volumes": [{"name": "forecast", "source": "netcdf", "files": "forecast.nc"}],
    "render": {"budget_mib": 2}})");
}

ErrorScene from_the_ground() {
  return read(R"({"volumes": [{"name": "sky", "source": "noise",
    "parameters": {"seed": 3, "finest_resolution": "50 m"}}],
    "sun": {"utc": "2024-05-10T17:30:00Z"},
    "camera": {"stand": {"lat_deg": 31.98, "lon_deg": -35.5, "azimuth_deg": 5,
                         "elevation_deg": 14}, "fov_deg": 50},
    "render": {"budget_mib": 6}})");
}

ErrorScene from_space() {
  return read(R"({"volumes": [{"name": "sky", "source": "noise", "parameters": {"seed": 3}}],
    "sun": {"utc": "2024-05-10T11:30:00Z"},
    "camera": {"look_from": {"lat_deg": 15, "lon_deg": 80, "height_m": 1.2e7},
               "look_at": {"lat_deg": 15, "lon_deg": 80, "height_m": 0}, "fov_deg": 48},
    "render": {"budget_mib": 4}})");
}

double thin_clumps_per_m(const glm::dvec3& p) {
  return 0.15 * cloud(0.003 * p);
}
double haze_per_m(const glm::dvec3& p) {
  return 1e-3 * std::exp(-p.z / 300) * (1 + 0.3 * std::sin(p.x / 90));
}
double thin_slab_per_m(const glm::dvec3& p) {
  const double top_m = 700 + 60 * std::sin(p.x / 90) * std::cos(p.y / 110);
  return 2e-3 * std::clamp((top_m - p.z) / 200, 0.0, 1.0) * std::clamp(p.z / 200, 0.0, 1.0);
}
double ball_per_m(const glm::dvec3& p) {
  const double r = glm::length(p - glm::dvec3(0, 0, 500)) / 450;
  return 4e-3 * std::pow(std::max(1 - r * r, 0.0), 2);
}

template <double (*kField)(const glm::dvec3&)>
ErrorScene thin() {
  static const FieldSource source(box(1000, 1000), isotropic(3),
                                  [](glm::dvec3 p) { return kField(p); });
  return drawn(source);
}

}  // namespace

const std::vector<ErrorSceneKind>& thin_scenes() {
  static const std::vector<ErrorSceneKind> kinds = {{"thin clumps", thin<thin_clumps_per_m>, 0},
                                                    {"haze", thin<haze_per_m>, 0},
                                                    {"thin slab", thin<thin_slab_per_m>, 0},
                                                    {"ball", thin<ball_per_m>, 0}};
  return kinds;
}

const std::vector<ErrorSceneKind>& error_scenes() {
  static const std::vector<ErrorSceneKind> kinds = {
      {"drawn shapes", clumps, 2048},
      {"thick slab", thick_slab, 512},
      {"box of noise", noise_box, 1024},
      {"plume (VDB)", plume, 512},
      {"LES", les, 2048},
      {"forecast", forecast, 512},
      {"planet from its ground", from_the_ground, 1024},
      {"planet from space", from_space, 1024},
  };
  return kinds;
}

}  // namespace nepho::test
