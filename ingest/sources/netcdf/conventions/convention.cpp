#include "conventions/convention.h"

#include <array>

#include "core/error.h"

namespace nepho::netcdf {
namespace {

const std::array<const Convention*, 2> kConventions = {&kWrf, &kCf};

std::unique_ptr<Forecast> open_file(const std::string& path, const OpenRequest& request) {
  auto file = std::make_shared<const NcFile>(path, request.io_lock);
  const Convention* best = nullptr;
  int best_score = 0;
  for (const Convention* convention : kConventions)
    if (const int score = convention->recognise(*file); score > best_score) {
      best = convention;
      best_score = score;
    }
  if (!best)
    throw Error({"the file follows no convention that is known", path, "WRF or CF",
                 std::to_string(file->variables().size()) + " variables", ""});
  return best->open(std::move(file), request);
}

}  // namespace

std::unique_ptr<Forecast> open_forecast(const OpenRequest& request) {
  if (request.files.empty())
    throw Error({"a forecast without files", "", "at least one .nc file", "none", ""});
  std::vector<std::unique_ptr<Forecast>> parts;
  for (const std::string& path : request.files) parts.push_back(open_file(path, request));
  return join_forecasts(std::move(parts));
}

}  // namespace nepho::netcdf
