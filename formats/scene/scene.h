#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bricks/shell_chart.h"
#include "bricks/volume_info.h"

namespace nepho {

// A scene as plain data: what to draw, from where, in which light, how well. World = ECEF, m,
// double. The JSON form is read in tools/; nothing here knows of files or of OpenGL.

struct SourceParameter {
  std::string name, unit;  // unit as written; empty = dimensionless or text
  double number = 0;       // in SI, converted at the door
  std::string text;        // for words ("sphere", "y")
  bool is_text = false;
  std::string where = {};  // file, line, column and field, for messages
  std::string written =
      {};  // the name as the user wrote it, where `name` is another: base, base_km
};

struct GeodeticPlace {
  double latitude_deg = 0, longitude_deg = 0, height_m = 0, heading_deg = 0;
};

struct VolumeSpec {
  std::string name;
  std::string source;  // id of a source module: "analytic", "openvdb", ...
  std::vector<std::string> files;
  std::vector<SourceParameter> parameters;
  std::optional<GeodeticPlace> place;  // absent: free, at the ECEF origin
  std::optional<Phase> phase;          // absent: the source's own
  std::optional<glm::dvec3> co_albedo;
  // One of the source's times, since its origin, as a date, or by its place among them: "first",
  // "last", "cloudiest" (the most optical depth in all), an index from 0. All absent: the first
  // with cloud.
  std::optional<double> time_s;
  std::optional<std::int64_t> utc_ns;  // since 1970-01-01T00:00:00 UTC
  std::string time_choice = {};
  std::string where = {};  // file, line, column and field, for messages
};

struct Camera {
  glm::dvec3 eye_m{0.0}, target_m{0.0, 1.0, 0.0}, up{0.0, 0.0, 1.0};
  double vertical_fov_rad = 0.6;
};

struct Sun {
  glm::dvec3 to_sun{0.0, 0.0, 1.0};                  // unit, ECEF
  glm::dvec3 irradiance_W_per_m2_nm{1.0, 1.0, 1.0};  // perpendicular to the beam; r, g, b
};

// A background that also lights the cloud: radiance by elevation over `up`, horizon to zenith.
struct Sky {
  glm::dvec3 up{0.0, 0.0, 1.0};
  glm::dvec3 zenith_W_per_m2_sr_nm{0.0}, horizon_W_per_m2_sr_nm{0.0}, below_W_per_m2_sr_nm{0.0};
};

// Clear air around a planet, by altitude h over its ellipsoid. Wavelengths 650, 550, 450 nm.
// Defaults: the Earth, constants of Bruneton 2017 (precomputed_atmospheric_scattering, demo.cc),
// but for two. Ozone absorbs most at 600 nm, between two of the wavelengths: in red and green it
// counts with its mean over what the display's primaries stand for, or twilight is purple, not blue
// (tests/air/colour_test.cpp). Air ends at 100 km, not 60: past -6 degrees the sun lights what is
// higher.
struct Air {
  glm::dvec3 rayleigh_per_m{6.9500e-6, 1.35580e-5, 3.02546e-5};  // at h = 0
  double rayleigh_scale_m = 8000;
  glm::dvec3 aerosol_extinction_per_m{4.44e-6};  // at h = 0
  double aerosol_albedo = 0.9, aerosol_asymmetry = 0.8, aerosol_scale_m = 1200;
  glm::dvec3 ozone_per_m{2.41e-6, 1.81e-6, 1.2446e-7};                  // absorption at the peak
  double ozone_low_m = 10e3, ozone_peak_m = 25e3, ozone_high_m = 40e3;  // a tent
  double top_m = 100e3;                                                 // none above
};

// What a ray meets at the planet's surface: land that scatters evenly, water with the sun's glint.
struct GroundLook {
  glm::dvec3 land_albedo{0.12, 0.11, 0.07};
  glm::dvec3 water_albedo{0.012, 0.026, 0.042};  // of the body of water, below its surface
  double wind_m_per_s = 6;                       // roughens the water (Cox and Munk 1954)
};

struct Planet {
  Ellipsoid body = Ellipsoid::wgs84();
  std::optional<Air> air = Air{};
  GroundLook ground;
};

enum class Fetch : std::uint8_t { kFilter, kTexels8 };
enum class Light : std::uint8_t { kSingle, kOctaves };
enum class WhichPixels : std::uint8_t { kAll, kAdaptive };
enum class ToneMap : std::uint8_t { kNone, kAces };
// What draws: the march on the GPU, or the path tracer that it is measured against.
enum class Engine : std::uint8_t { kMarch, kReference };
enum class PathLevels : std::uint8_t { kFinest, kResident };

struct PathGoals {
  int samples = 0;   // paths a pixel; 0: as many as `noise` needs
  double noise = 0;  // rms of the pixels' standard errors over mean luminance; 0: by `samples`
  PathLevels levels = PathLevels::kFinest;  // or the bricks that the march would have
  double host_mib = 4096;                   // memory for the finest
  int exact_orders = -1;  // scatterings with a tabled phase function (PathSettings); -1: all
};

struct RenderSettings {
  int width = 640, height = 360;
  double budget_mib = 256;
  // Exactly one rules the march: a fixed step in voxels, or the relative error of the integration
  // along view rays that 99 % of the pixels keep below. step_voxels = 0: the cell-exact reference
  // setting.
  std::optional<double> step_voxels;
  double tolerance = 1e-2;
  std::optional<Fetch> fetch;  // absent: kFilter, or kTexels8 where the tolerance is below 2e-3
  Light light = Light::kOctaves;
  int octaves = 8;
  // kAdaptive: over a planet, pixels are interpolated where that changes them by less than the
  // tolerance allows; kAll: each is marched.
  WhichPixels pixels = WhichPixels::kAdaptive;
  double pixels_per_voxel = 1;  // refinement stops when a voxel is smaller than this many pixels
  int max_level = 31;           // and at this level
  std::uint64_t seed = 1;
  int probe_pixels = 128;  // pixels on which the error line is measured; 0 = none
  // Paths on each of them, at most, that measure the light model; 0: a table of plane slabs
  // instead.
  int probe_paths = 256;
  Engine engine = Engine::kMarch;
  PathGoals paths;  // of Engine::kReference; neither goal given: 5 % of noise
};

// What a view of a planet's weather is worked out to be; kAuto: a part obliquely, or the globe.
enum class View : std::uint8_t { kAuto, kOblique, kGlobe, kGround };

// An eye that stands on a planet's ground, or on its sea.
struct Stand {
  double latitude_deg = 0, longitude_deg = 0;
  double eye_height_m = 2;  // above the ground
  // Clockwise from north, and above the horizon; absent: towards the best cloud.
  std::optional<double> azimuth_deg, elevation_deg;
};

// What a scene says of its camera and its sun; what is absent is worked out from the volumes.
struct CameraSpec {
  std::optional<glm::dvec3> eye_m, target_m, up;  // absent: frames the volumes
  std::optional<double> vertical_fov_rad;
  std::optional<Stand> stand;  // instead of eye and target
  View view = View::kAuto;     // where eye and target are absent
};
struct SunSpec {
  // All three absent: on a planet the time of the first volume that has one, else 40 degrees high,
  // behind the camera's left shoulder. More than one given: an error.
  std::optional<glm::dvec3> to_sun;
  // Azimuth and elevation over the horizon of where the camera looks: for scenes without a place.
  std::optional<glm::dvec2> azimuth_elevation_deg;
  std::optional<std::int64_t> utc_ns;  // since 1970-01-01T00:00:00 UTC: where the sun stands then
  std::optional<glm::dvec3> irradiance_W_per_m2_nm;
};

// What the march's settings are to be chosen for, instead of being given; at most one. Both absent:
// RenderSettings says all.
struct PictureTarget {
  std::optional<double> error;     // of integration, level of detail and quantisation together
  std::optional<double> frame_ms;  // of light passes and view
  explicit operator bool() const { return error || frame_ms; }
};

// Heights of ground in a file, in place of what the volumes' data say of it.
struct TerrainSpec {
  std::string file;
  std::string where = {};  // file, line, column and field, for messages
};

struct Scene {
  std::string name;
  // Where local metres (x east, y north, z up) are counted from; absent: the first volume's place.
  std::optional<GeodeticPlace> place;
  std::vector<VolumeSpec> volumes;
  CameraSpec camera;
  SunSpec sun;
  std::optional<Sky> sky;  // absent: a clear day's; not together with a planet
  std::optional<Planet>
      planet;  // absent: the Earth, where a source's volume is on_planet and no sky is given
  bool no_planet = false;  // nor that one
  std::optional<TerrainSpec> terrain;
  RenderSettings render;
  PictureTarget target;               // for which its tolerance and budget are chosen
  std::optional<double> exposure_ev;  // absent: from the picture
  ToneMap tone_map = ToneMap::kAces;
  bool dither = false;  // ordered, in 8-bit pictures
};

}  // namespace nepho
