#include "forecast/conventions/convention.h"

#include <array>
#include <filesystem>

#include "core/error.h"

namespace nepho::forecast {
namespace {

const std::array<const Convention*, 2> kConventions = {&kWrf, &kCf};

std::unique_ptr<Forecast> open_file(const std::string& path, const OpenRequest& request) {
  const std::shared_ptr<const DataFile> file = request.open_file(path);
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
  return best->open(file, request);
}

}  // namespace

std::unique_ptr<Forecast> open_forecast(const OpenRequest& request) {
  if (request.files.empty())
    throw Error({"a forecast without files", "", "at least one .nc file", "none", ""});
  std::vector<NamedForecast> parts;
  for (const std::string& path : request.files)
    parts.push_back({std::filesystem::path(path).filename().string(), open_file(path, request)});
  return nest_forecasts(std::move(parts));
}

}  // namespace nepho::forecast
