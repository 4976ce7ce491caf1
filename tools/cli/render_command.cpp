#include <algorithm>
#include <cstdio>

#include "cli/commands.h"
#include "cli/reference_picture.h"
#include "cli/report.h"
#include "cli/saved_picture.h"
#include "cli/scene_input.h"
#include "cli/target_picture.h"
#include "common/gl_context.h"
#include "common/open_scene.h"
#include "common/output_file.h"
#include "core/error.h"
#include "core/log.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;

// The first input's name, here: .png where this build writes it.
fs::path output_of(const RenderOptions& options, const PictureFiles& pictures) {
  if (!options.output.empty()) return options.output;
  std::string stem = fs::path(options.inputs.front()).stem().string();
  std::erase(stem, '#');
  while (stem.ends_with('.')) stem.pop_back();
  fs::path path = stem + ".png";
  try {
    pictures.check_format(path);
  } catch (const Error&) {
    path = stem + ".ppm";
  }
  // A picture that is drawn again stands beside the first.
  std::error_code ignored;
  for (const std::string& input : options.inputs)
    if (fs::equivalent(path, input, ignored)) return stem + "-again" + path.extension().string();
  return path;
}

void print_result(const fs::path& output, const OpenedScene& opened,
                  const std::vector<std::string>& said, bool exposure_found) {
  const RenderSettings& settings = opened.scene.render;
  const Usage usage = usage_now();
  std::printf("%s: %dx%d, exposure %+.2f EV%s\n", output.c_str(), settings.width, settings.height,
              *opened.scene.exposure_ev, exposure_found ? " (from the picture)" : "");
  for (const std::string& line : said) std::printf("%s\n", line.c_str());
  for (const std::string& text : opened.assumptions) std::printf("assumed: %s\n", text.c_str());
  std::printf("time: %.2f s CPU, %.2f s from launch to picture; peak memory %.0f MiB\n",
              usage.cpu_s, usage.wall_s, usage.peak_mib);
}

// What no one would notice was without an effect.
void refuse_idle_options(const RenderOptions& options, const Scene& asked,
                         const OpenedScene& opened) {
  const bool weather = std::ranges::any_of(
      opened.sources, [](const auto& source) { return source->info().on_planet; });
  if (options.no_planet && !weather && !asked.planet)
    throw Error({"nothing to leave out", "--no-planet", "a volume that is weather of a planet",
                 "none", ""});
}

}  // namespace

void render_command(const RenderOptions& options) {
  const PictureFiles pictures(default_module_folders());
  const SourceHost host(default_module_folders());
  const Scene scene = scene_from(options, pictures);
  const fs::path output = output_of(options, pictures);
  const PictureFormat format = picture_format(output);
  Libraries libraries;
  libraries.start = mapped_libraries();
  pictures.check_format(output);
  check_target(scene.target, scene, format);
  libraries.format_known = mapped_libraries();
  // Before any work: what cannot be written later is known now.
  OutputFile file(output, largest_size(scene.render, format));
  const bool march = scene.render.engine == Engine::kMarch;
  const auto context = march ? make_egl_context() : nullptr;
  libraries.device = mapped_libraries();
  OpenedScene opened = open_scene(host, scene);
  refuse_idle_options(options, scene, opened);
  libraries.scene_open = mapped_libraries();

  std::string target;
  const ReferencePicture drawn = [&]() -> ReferencePicture {
    if (!march) return draw_reference(opened);
    if (!opened.scene.target) return {render(opened.request), ""};
    TargetPicture picture = draw_for_target(opened);
    target = std::move(picture.line);
    return {std::move(picture.result), ""};
  }();
  const RenderResult& result = drawn.result;
  const FloatImage linear = linear_image(result.image);
  const bool find = !opened.scene.exposure_ev;
  if (find) opened.scene.exposure_ev = find_exposure(opened, linear, result.image.optical_depth);
  const std::string error = march ? error_line(result.error) : drawn.error_line;
  Metadata metadata = metadata_of(opened, output, error);
  std::vector<std::string> said{error};
  if (!target.empty()) metadata["nephoscope:target"] = target, said.push_back(target);
  write_picture(pictures, file.temporary(), format, opened, linear, metadata);
  file.commit();
  libraries.picture_written = mapped_libraries();
  print_result(output, opened, said, find);
  if (options.explain || options.explain_all)
    std::printf("%s", explanation(opened, result, context ? context->description() : "none",
                                  libraries, options.explain_all)
                          .c_str());
  if (options.explain_macros)
    for (const std::string& macro : result.report.shader_switches)
      std::printf("macro: %s\n", macro.c_str());
}

}  // namespace nepho
