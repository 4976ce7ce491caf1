// nephoscope: the command line. Exit codes: 0 good; 1 bad data, bad values, or the machine; 2 an
// unknown option, a missing argument, or options that exclude each other.

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "bench/sweep.h"
#include "cli/commands.h"
#include "common/output_file.h"
#include "core/error.h"
#include "core/log.h"

namespace nepho {
namespace {

constexpr const char* kExamples = R"(Examples:
  nephoscope render smoke_0042.vdb -o smoke.png          camera, sun and exposure are worked out
  nephoscope render plume.####.vdb --frame 12 -o p.exr   one frame of a sequence, linear light
  nephoscope render scene.json --size 1920x1080 --sun 120,15 -o dusk.png
  nephoscope render dusk.png -o again.png                the scene is in the picture: same bits
  nephoscope render wrfout_d01.nc -o storm.png           place, time, view and sun are worked out
  nephoscope render wrfout_d01.nc --time 2005-08-28T15:00Z --view globe -o globe.png
  nephoscope render wrfout_d01.nc --at 29.9,-90.1 --heading 180 --pitch 12 -o street.png
  nephoscope render gfs.grib2 --region 30,160,60,-150 -o pacific.png
  nephoscope render wrfout_d01.nc --terrain dem.tif -o alps.png  a finer ground
  nephoscope render cot.tif cth.tif -o satellite.png     rasters of optical depth and height
  nephoscope render wrfout_d01.nc --sun 2005-08-28T23:00Z --no-planet -o evening.png
  nephoscope render scene.json --target-error 1% -o fine.exr   the settings are chosen, and said
  nephoscope render smoke.png --engine reference --noise 1% -o true.exr   the same, path traced
  nephoscope view                                        a window: fly over the procedural planet
  nephoscope view wrfout_d01.nc                          through a forecast; drop files to open them
  nephoscope info smoke_0042.vdb                         what is in the file, what is assumed
  nephoscope render les.nc --names ourmodel.names -o les.png   what its variables are (docs/names.md)
  nephoscope info wrfout_d01.nc --check                  and how well the bricks hold it
  nephoscope compare a.exr b.exr                         how far two pictures are apart
  nephoscope compare a.exr b.exr --diff apart.png        and where (FLIP)
  nephoscope bench scene.json --sweep step=0.5,1,2 --sweep budget-mib=64,256 -o report)";

constexpr const char* kTime =
    "of the data: 2005-08-28T15:00Z, an index from 0, first, last, cloudiest, or seconds: 3600s";
constexpr const char* kRegion =
    "SOUTH,WEST,NORTH,EAST in degrees: read only this part (NetCDF, GRIB, rasters)";

void start_logging() {
  auto logger = spdlog::stderr_logger_mt("nephoscope");
  logger->set_pattern("%n: %l: %v");
  spdlog::set_default_logger(logger);
  set_log_sink(
      [](void*, LogLevel level, const char* text) {
        if (level == LogLevel::kDebug) spdlog::debug("{}", text);
        if (level == LogLevel::kInfo) spdlog::info("{}", text);
        if (level == LogLevel::kWarning) spdlog::warn("{}", text);
      },
      nullptr);
}

using Text = std::optional<std::string>;

void add_data_options(CLI::App& command, Text& grid, Text& names, Text& up, Text& metres_per_unit,
                      Text& density_scale, Text& frame) {
  command
      .add_option("--grid", grid,
                  "name of the grid to draw (VDB); file with the cells' places (NetCDF)")
      ->group("Data");
  command
      .add_option("--names", names,
                  "file with the names of a model that is not known (NetCDF, GRIB; docs/names.md)")
      ->group("Data");
  command.add_option("--up", up, "up axis of the file: y or z (VDB)")->group("Data");
  command.add_option("--metres-per-unit", metres_per_unit, "size of one world unit of the file")
      ->group("Data");
  command.add_option("--density-scale", density_scale, "extinction (1/m) of density 1")
      ->group("Data");
  command.add_option("--frame", frame, "frame of a sequence name.####.vdb")->group("Data");
}

void add_raster_options(CLI::App& command, RasterWords& o) {
  const char* group = "Rasters of clouds";
  command
      .add_option("--bands", o.bands,
                  "what each band is: optical_depth,\"top_height km\",-; otherwise as it says")
      ->group(group);
  command.add_option("--cloud-base", o.cloud_base, "height in m of all bases")->group(group);
  command.add_option("--cloud-top", o.cloud_top, "height in m of all tops")->group(group);
  command
      .add_option("--cloud-thickness", o.cloud_thickness,
                  "in m, of all clouds; otherwise water path over water content")
      ->group(group);
  command.add_option("--optical-depth", o.optical_depth, "of all clouds, where no band holds it")
      ->group(group);
}

constexpr const char* kTerrain = "heights of ground, such as dem.tif: the planet's surface";

void add_drawn_data_options(CLI::App& command, RenderOptions& o) {
  command.add_option("--fps", o.fps, "frames per second of a sequence (24)")->group("Data");
  command.add_flag("--force", o.force, "draw values that no cloud has (NetCDF, GRIB)")
      ->group("Data");
  command.add_option("--region", o.region, kRegion)->group("Data");
  command.add_option("--terrain", o.terrain, kTerrain)->group("Data");
  add_raster_options(command, o.raster);
}

void add_camera_options(CLI::App& command, RenderOptions& o) {
  const char* group = "Camera and light";
  command.add_option("--look-from", o.look_from, "the eye: x,y,z in m, or geo:LAT,LON,HEIGHT")
      ->group(group);
  command.add_option("--look-at", o.look_at, "the target, in the same ways")->group(group);
  command.add_option("--fov", o.fov_deg, "vertical field of view in degrees")->group(group);
  command
      .add_option("--at", o.at, "LAT,LON[,HEIGHT]: stand on the ground there, the eye 2 m above it")
      ->excludes("--look-from")
      ->excludes("--look-at")
      ->group(group);
  command.add_option("--heading", o.heading_deg, "with --at: degrees clockwise from north")
      ->group(group);
  command.add_option("--pitch", o.pitch_deg, "with --at: degrees above the horizon")->group(group);
  command.add_option("--view", o.view, "of a planet's weather: auto, oblique, globe or ground")
      ->excludes("--look-from")
      ->excludes("--look-at")
      ->excludes("--at")
      ->group(group);
  command
      .add_option("--sun", o.sun,
                  "AZIMUTH,ELEVATION in degrees, or a date: where it stands at 2005-08-28T15:00Z")
      ->group(group);
  command.add_option("--time", o.time, kTime)->group(group);
  command.add_flag("--no-planet", o.no_planet, "weather without its planet's ground and air")
      ->group(group);
  command.add_option("--exposure", o.exposure_ev, "in stops (EV); otherwise from the picture")
      ->group(group);
  command.add_option("--tone-map", o.tone_map, "aces or none")->group(group);
  command.add_flag("--dither", o.dither, "ordered dither in 8-bit pictures")->group(group);
}

void add_quality_options(CLI::App& command, RenderOptions& o) {
  const char* group = "Quality";
  command.add_option("--size", o.size, "WIDTHxHEIGHT in pixels (640x360)")->group(group);
  CLI::Option* budget =
      command.add_option("--budget-mib", o.budget_mib, "memory on the GPU (256)")->group(group);
  CLI::Option* step =
      command.add_option("--step", o.step_voxels, "fixed step in voxels; 0 = exact per cell");
  CLI::Option* tolerance =
      command
          .add_option("--tolerance", o.tolerance,
                      "relative error of the integration, of 99 % of the pixels (0.01)")
          ->excludes(step)
          ->group(group);
  step->group(group);
  CLI::Option* error = command.add_option(
      "--target-error", o.target_error,
      "choose tolerance and budget: the cheapest with an error below this, such as 1%");
  CLI::Option* time = command.add_option(
      "--target-ms", o.target_ms,
      "choose them: the most accurate whose light passes and view take no longer");
  for (CLI::Option* target : {error, time})
    target->excludes(step)->excludes(tolerance)->excludes(budget)->group(group);
  error->excludes(time);
  command.add_option("--fetch", o.fetch, "filter (the texture unit) or texels8 (exact)")
      ->group(group);
  command.add_option("--light", o.light, "octaves or single (scattering)")->group(group);
  command.add_option("--pixels", o.pixels, "adaptive (some interpolated, over planets) or all")
      ->group(group);
  command.add_option("--max-level", o.max_level, "finest level of the tree to use")->group(group);
  command.add_option("--seed", o.seed, "of what is drawn by chance: the probe's pixels, paths")
      ->group(group);
  command.add_option("--probe-pixels", o.probe_pixels, "pixels that measure the error; 0 = none")
      ->group(group);
}

void add_reference_options(CLI::App& command, RenderOptions& o) {
  const char* group = "Reference";
  command
      .add_option("--engine", o.engine,
                  "march (the GPU), or reference: a path tracer on the CPU, slow and true")
      ->group(group);
  command.add_option("--spp", o.spp, "reference: paths a pixel")->group(group);
  command.add_option("--noise", o.noise, "reference: go on to this noise, such as 1% (5%)")
      ->group(group);
  command
      .add_option("--levels", o.levels, "reference: finest bricks, or resident (as the march has)")
      ->group(group);
  command
      .add_option(
          "--exact-orders", o.exact_orders,
          "reference: scatterings that keep a Mie phase function (all); 2: less noise, a bias")
      ->group(group);
  command.add_option("--host-mib", o.host_mib, "reference: memory for the finest bricks (4096)")
      ->group(group);
}

void add_compare_options(CLI::App& command, CompareOptions& o) {
  command.add_option("--diff", o.diff, "picture of the differences; .exr, .hdr, .pfm: the numbers");
  command.add_option("--diff-of", o.diff_of,
                     "flip (what an eye sees) or luminance (with its sign)");
  command.add_option("--diff-scale", o.diff_scale,
                     "where its colours end (flip: 1; luminance: from the picture)");
  command.add_option("--exposure", o.exposure_ev, "in stops (EV), of linear pictures as shown");
  command.add_option("--tone-map", o.tone_map, "aces or none; otherwise as B's scene says");
  command.add_option("--pixels-per-degree", o.pixels_per_degree, "of the eye, for FLIP (67)");
  command.add_flag("--json", o.json, "for programs");
}

void add_bench_options(CLI::App& command, BenchOptions& o) {
  command
      .add_option("--sweep", o.sweeps,
                  "NAME=VALUE,...; several: every combination. Of " + bench::known_settings())
      ->allow_extra_args(false);
  command.add_option("--size", o.size, "WIDTHxHEIGHT in pixels (96x54)");
  command.add_option("--repeat", o.repeats, "runs that are timed, after a warm-up (5)");
  command.add_option("--spp", o.spp,
                     "most paths a pixel of the truth (4096); 0: no path tracing, no light model");
  command.add_option("--exact-orders", o.exact_orders,
                     "of the truth: scatterings that keep a Mie phase function (all)");
  command.add_option("--host-mib", o.host_mib, "memory for the finest bricks (1024)");
  command.add_option("--finest-step", o.finest_step,
                     "voxels, of what steps are measured against (a quarter of the finest step)");
}

constexpr const char* kKeys =
    R"(In the window: W S A D move, E Q up and down, shift faster, control slower; drag turns, the wheel steps;
M free, orbit, first person; R back to the start, H hides the panel, F12 a picture with its scene, Esc
ends. Files that are dropped are opened.)";

void add_view_options(CLI::App& command, ViewOptions& o) {
  command.footer(std::string(kKeys) + "\n\n" + kExamples);
  CLI::Option* frames =
      command.add_option("--frames", o.frames, "end after so many, and say how long they took");
  CLI::Option* path =
      command.add_option("--path", o.path, "fly along what --record wrote, and end")
          ->excludes(frames);
  command.add_flag("--settle", o.settle, "of --path: each camera stays until nothing is to come")
      ->needs(path);
  command.add_option("--record", o.record, "write the flight to this file")->excludes(path);
  command.add_option("--bench", o.bench, "times of all passes, median and worst: .csv or .json");
  command.add_option("--screenshot", o.screenshot, "at the end, a picture at full quality");
  command.add_option(
      "--coarse", o.coarse,
      "1, 2, 4 or 8: in motion, every Nth pixel of the window (as the device can bear)");
  command.add_flag("--no-reuse", o.no_reuse,
                   "in motion, no pixels of the last pictures beside the new ones");
}

// A value given twice is a bad value; CLI11 calls it the same as a missing one.
void refuse_repeated(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    for (const CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() == 1 && option->count() > 1)
        throw Error({"given more than once", option->get_name(), "one value",
                     "'" + option->results()[0] + "' and '" + option->results()[1] + "'", ""});
}

int run(int argc, char** argv) {
  CLI::App app("Draws clouds as they are: any source, one contract, a stated error.", "nephoscope");
  app.set_version_flag("--version", "nephoscope " NEPHO_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);

  RenderOptions render;
  CLI::App* draw = app.add_subcommand("render", "draw a scene, data files, or a picture again");
  draw->add_option("INPUT", render.inputs, "SCENE.json, PICTURE, or data FILES")->required();
  draw->add_option("-o,--output", render.output, "picture: .png .exr .hdr .pfm .ppm");
  draw->add_flag("--explain", render.explain, "what was loaded, allocated, run, and left out");
  draw->add_flag("--explain-all", render.explain_all, "the same, with every library by name");
  add_quality_options(*draw, render);
  add_reference_options(*draw, render);
  add_camera_options(*draw, render);
  add_data_options(*draw, render.grid, render.names, render.up, render.metres_per_unit,
                   render.density_scale, render.frame);
  add_drawn_data_options(*draw, render);
  draw->add_flag("--explain-macros", render.explain_macros, "")->group("");
  draw->footer(kExamples);
  draw->callback([&] { render_command(render); });

  ViewOptions view;
  CLI::App* fly = app.add_subcommand("view", "a window to fly through a scene");
  fly->add_option("INPUT", view.render.inputs,
                  "SCENE.json, PICTURE, or data FILES; none: the procedural planet");
  add_view_options(*fly, view);
  add_quality_options(*fly, view.render);
  add_camera_options(*fly, view.render);
  add_data_options(*fly, view.render.grid, view.render.names, view.render.up,
                   view.render.metres_per_unit, view.render.density_scale, view.render.frame);
  add_drawn_data_options(*fly, view.render);
  fly->callback([&] { view_command(view); });

  InfoOptions info;
  CLI::App* tell = app.add_subcommand("info", "what is in a file, a scene or a picture");
  tell->add_option("FILE", info.input, "data, SCENE.json or PICTURE")->required();
  tell->add_flag("--json", info.json, "for programs");
  tell->add_flag("--check", info.check, "the source's own field against its finest bricks");
  tell->add_option("--time", info.time, kTime);
  tell->add_flag("--force", info.force, "take values that no cloud has (NetCDF, GRIB)")
      ->group("Data");
  tell->add_option("--region", info.region, kRegion)->group("Data");
  add_data_options(*tell, info.grid, info.names, info.up, info.metres_per_unit, info.density_scale,
                   info.frame);
  add_raster_options(*tell, info.raster);
  tell->callback([&] { info_command(info); });

  CompareOptions compare;
  CLI::App* differ =
      app.add_subcommand("compare", "how far picture A is from picture B, the truth");
  differ->add_option("A", compare.a, "picture")->required();
  differ->add_option("B", compare.b, "the truth")->required();
  add_compare_options(*differ, compare);
  differ->callback([&] { compare_command(compare); });

  BenchOptions bench;
  CLI::App* measure =
      app.add_subcommand("bench", "error against run time: settings of scenes, as a report");
  measure->add_option("SCENE", bench.scenes, "SCENE.json, PICTURE or data FILE, one section each")
      ->required();
  measure->add_option("--terrain", bench.terrain, kTerrain);
  measure->add_option("-o,--output", bench.output, "folder of the report")->required();
  add_bench_options(*measure, bench);
  measure->callback([&] { bench_command(bench); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    refuse_repeated(app);
    spdlog::error("{} (see nephoscope --help)", e.what());
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace nepho

int main(int argc, char** argv) {
  nepho::start_logging();
  nepho::remove_output_on_signals();
  try {
    return nepho::run(argc, argv);
  } catch (const nepho::Error& e) {
    spdlog::error("{}", e.what());
  } catch (const std::bad_alloc&) {
    spdlog::error("out of memory");
  } catch (const std::exception& e) {
    spdlog::error("internal error: {}", e.what());
  }
  return 1;
}
