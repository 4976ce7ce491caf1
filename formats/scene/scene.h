#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

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
  std::optional<double> time_s;  // absent: the first
  std::string where = {};        // file, line, column and field, for messages
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

enum class Fetch : std::uint8_t { kFilter, kTexels8 };
enum class Light : std::uint8_t { kSingle, kOctaves };
enum class ToneMap : std::uint8_t { kNone, kAces };

struct RenderSettings {
  int width = 640, height = 360;
  double budget_mib = 256;
  // Exactly one rules the march: a fixed step in voxels, or the relative error that a step may
  // make. step_voxels = 0: the cell-exact reference setting.
  std::optional<double> step_voxels;
  double tolerance = 1e-2;
  std::optional<Fetch> fetch;  // absent: kFilter, or kTexels8 where the tolerance is below 2e-3
  Light light = Light::kOctaves;
  int octaves = 8;
  double pixels_per_voxel = 1;  // refinement stops when a voxel is smaller than this many pixels
  int max_level = 31;           // and at this level
  std::uint64_t seed = 1;
  int probe_pixels = 128;  // pixels on which the error line is measured; 0 = none
};

// What a scene says of its camera and its sun; what is absent is worked out from the volumes.
struct CameraSpec {
  std::optional<glm::dvec3> eye_m, target_m, up;  // absent: frames the volumes
  std::optional<double> vertical_fov_rad;
};
struct SunSpec {
  std::optional<glm::dvec3> to_sun;  // absent: 40 degrees high, behind the camera's left shoulder
  std::optional<glm::dvec3> irradiance_W_per_m2_nm;
};

struct Scene {
  std::string name;
  // Where local metres (x east, y north, z up) are counted from; absent: the first volume's place.
  std::optional<GeodeticPlace> place;
  std::vector<VolumeSpec> volumes;
  CameraSpec camera;
  SunSpec sun;
  std::optional<Sky> sky;  // absent: a clear day's
  RenderSettings render;
  std::optional<double> exposure_ev;  // absent: from the picture
  ToneMap tone_map = ToneMap::kAces;
  bool dither = false;  // ordered, in 8-bit pictures
};

}  // namespace nepho
