#include "forecast/conventions/open_request.h"

#include "core/error.h"

namespace nepho::forecast {

OpenRequest open_request(const SourceRequest& request, Parameters& parameters, const char* format) {
  const std::string name = request.volume_name ? request.volume_name : "";
  if (request.file_count == 0)
    throw Error({std::string("a ") + format + " volume without a file", "volume '" + name + "'",
                 "one file, or several that hold times of one forecast", "none", ""});
  OpenRequest open;
  open.files.assign(request.files, request.files + request.file_count);
  open.force = parameters.integer("force", 0, 0, 1) == 1;
  open.grid_file = parameters.word("grid", "");
  open.names_file = parameters.word("names", "");
  if (const std::string region = parameters.word("region", ""); !region.empty())
    open.region = parse_region(region, parameters.where("region"));
  return open;
}

}  // namespace nepho::forecast
