#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nepho {

// What the command line says, still as the user wrote it: the commands check and convert.

// Of rasters of clouds.
struct RasterWords {
  std::optional<std::string> bands, cloud_base, cloud_top, cloud_thickness, optical_depth;
};

struct RenderOptions {
  std::vector<std::string> inputs;  // a scene, a picture with a scene in it, or data files
  std::string output;  // "": the input's name in this folder, .png (or .ppm); NAME-again for NAME
  std::optional<std::string> size, look_from, look_at, fov_deg, sun, up, metres_per_unit, grid,
      names;
  std::optional<std::string> target_error, target_ms;
  std::optional<std::string> budget_mib, step_voxels, tolerance, fetch, light, pixels, seed,
      probe_pixels;
  std::optional<std::string> frame, fps, density_scale, exposure_ev, tone_map, max_level;
  std::optional<std::string> engine, spp, noise, levels, host_mib, exact_orders;
  std::optional<std::string> at, heading_deg, pitch_deg, view, time, region;
  bool explain = false, explain_all = false, dither = false, no_planet = false, force = false;
  RasterWords raster;
  std::optional<std::string> terrain;
  bool explain_macros = false;  // hidden: what the tests of the shaders' text compile them with
};

struct InfoOptions {
  std::string input;
  std::optional<std::string> grid, names, up, metres_per_unit, density_scale, frame, time, region;
  RasterWords raster;
  bool json = false, check = false, force = false;
};

struct CompareOptions {
  std::string a, b;
  std::optional<std::string> diff, diff_of, diff_scale, exposure_ev, tone_map, pixels_per_degree;
  bool json = false;
};

struct BenchOptions {
  std::vector<std::string> scenes;  // each a section of the report
  std::vector<std::string> sweeps;  // NAME=VALUE,VALUE,...
  std::string output;               // a folder
  std::optional<std::string> size, repeats, spp, exact_orders, host_mib, finest_step, terrain;
};

struct ViewOptions {
  RenderOptions render;  // inputs (none: the procedural planet), camera, quality, data
  std::optional<std::string> frames, path, record, bench, screenshot, coarse;
  bool settle = false, no_reuse = false;
};

// Each throws Error for what a user can cause, and prints its result on standard output.
void render_command(const RenderOptions& options);
void info_command(const InfoOptions& options);
void compare_command(const CompareOptions& options);
void bench_command(const BenchOptions& options);
void view_command(const ViewOptions& options);

}  // namespace nepho
