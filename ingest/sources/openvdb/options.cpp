#include "options.h"

#include "api/module_support.h"

namespace nepho::vdb {

Options parse_options(const SourceRequest& request) {
  Options options;
  options.volume_name = request.volume_name ? request.volume_name : "";
  if (request.file_count != 1)
    throw Error(
        {"an openvdb volume is one file or one sequence", "volume '" + options.volume_name + "'",
         "1 file, or a pattern such as smoke.####.vdb",
         std::to_string(request.file_count) + " files", "several files are several volumes"});
  options.file = request.files[0];
  Parameters parameters(request);
  options.grid = parameters.word("grid", "");
  options.density_scale_per_m = parameters.positive("density_scale");
  options.metres_per_unit = parameters.positive("metres_per_unit");
  options.frames_per_second = parameters.positive("fps");
  const std::string up = parameters.choice("up", {"auto", "y", "z"});
  if (up != "auto") options.up = up == "y" ? UpAxis::kY : UpAxis::kZ;
  if (parameters.number("frame")) options.frame = parameters.integer("frame", 0, 0, 1000000000);
  parameters.finish();
  return options;
}

}  // namespace nepho::vdb
