#include "sources/gdal/terrain.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "forecast/bricks/surface_of.h"
#include "sources/gdal/raster_file.h"
#include "units/parse_unit.h"

namespace nepho::gdal {
namespace {

using forecast::CellWindow;
using forecast::HorizontalGrid;

constexpr float kLowest_m = -12000, kHighest_m = 9000;

std::string text(const char* format, auto... values) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

double unit_of(const RasterFile& file, std::vector<std::string>& assumptions) {
  const Band& band = file.bands().front();
  const std::string where = file.path() + " [band 1]";
  if (band.coloured)
    throw Error({"a picture is no terrain", where, "heights of ground",
                 std::to_string(file.bands().size()) + " bands of colours (" + band.type + ")",
                 ""});
  if (band.unit.empty()) {
    assumptions.push_back("The heights have no unit: metres are taken.");
    return 1;
  }
  Unit unit;
  try {
    // GDAL's drivers write these in words.
    const bool metres = band.unit == "metre" || band.unit == "meter" || band.unit == "metres" ||
                        band.unit == "meters";
    unit = parse_unit(metres ? "m" : band.unit);
  } catch (const Error&) {
    unit = {1, 0, kDimensionless};
  }
  if (unit.dimension != kLength)
    throw Error({"the terrain's unit is no length", where, "m, ft or another length",
                 "\"" + band.unit + "\"", "set it: gdal_translate, or gdal_edit.py -units m FILE"});
  return unit.factor;
}

// The pixels under a region, and two around them; the whole raster where it does not reach there.
CellWindow window_of(const RasterPlace& place, const MapFormula& pixels,
                     const std::optional<forecast::Region>& region,
                     std::vector<std::string>& assumptions) {
  const CellWindow all{0, 0, place.nx, place.ny};
  if (!region) return all;
  glm::dvec2 low(1e18), high(-1e18);
  constexpr int kSteps = 64;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const glm::dvec2 at =
          pixels.map_m({region->south_deg + (region->north_deg - region->south_deg) * j / kSteps,
                        region->west_deg + (region->east_deg - region->west_deg) * i / kSteps});
      if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  const auto clipped = [](double value, int n) { return int(std::clamp(value, 0.0, double(n))); };
  const int x0 = clipped(std::floor(low.x) - 2, place.nx),
            y0 = clipped(std::floor(low.y) - 2, place.ny);
  const int x1 = clipped(std::ceil(high.x) + 2, place.nx),
            y1 = clipped(std::ceil(high.y) + 2, place.ny);
  if (x1 - x0 >= 2 && y1 - y0 >= 2) return {x0, y0, x1 - x0, y1 - y0};
  assumptions.push_back("The terrain does not reach under the clouds.");
  return all;
}

// Pixels become cells of `reduced` means; the ground between their centres is bilinear.
RasterPlace reduced(const RasterPlace& window, int nx, int ny) {
  RasterPlace place = window;
  place.nx = nx;
  place.ny = ny;
  const double x = double(window.nx) / nx, y = double(window.ny) / ny;
  for (const int n : {1, 4}) place.transform[std::size_t(n)] *= x;
  for (const int n : {2, 5}) place.transform[std::size_t(n)] *= y;
  return place;
}

}  // namespace

Terrain open_terrain(const TerrainRequest& request) {
  const RasterFile file(request.file);
  Terrain terrain;
  const double unit_m = unit_of(file, terrain.assumptions);
  const CellWindow window = window_of(file.place(), *pixel_map(file.place(), file.path()),
                                      request.region, terrain.assumptions);
  const int nx = std::min(window.nx, request.most_nodes);
  const int ny = std::min(window.ny, request.most_nodes);
  forecast::ForecastGround ground;
  ground.height_m = file.read_reduced(0, window, nx, ny);
  std::size_t missing = 0;
  float lowest = 1e9f, highest = -1e9f;
  for (float& height : ground.height_m) {
    if (std::isnan(height)) {
      ++missing;
      if (!request.keep_gaps) height = 0;
      continue;
    }
    height = float(double(height) * unit_m);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  if (missing == ground.height_m.size())
    throw Error({"the terrain holds no heights there", file.path(), "numbers", "nodata only", ""});
  if (lowest < kLowest_m || highest > kHighest_m)
    throw Error({"no ground lies so high or so low", file.path(),
                 text("heights from %.0f to %.0f m", double(kLowest_m), double(kHighest_m)),
                 text("%.5g to %.5g m", double(lowest), double(highest)),
                 "the unit may be wrong, or a value that means nothing is not declared as nodata"});
  const RasterPlace place = reduced(file.place().part(window), nx, ny);
  const auto pixels = pixel_map(place, file.path());
#ifdef NEPHO_MUTANT_RASTER_UPSIDE_DOWN
  std::ranges::reverse(ground.height_m);
#endif
  terrain.map = forecast::ground_map(
      grid_of(place, 1, file.path()), ground, [&](glm::dvec2 at) { return pixels->map_m(at); },
      request.keep_gaps ? NAN : 0.0f);
  terrain.facts.push_back(
      text("Terrain: %d x %d of %d x %d pixels, read as %d x %d means, %.0f to %.0f m; %d "
           "overviews.",
           window.nx, window.ny, file.place().nx, file.place().ny, nx, ny, double(lowest),
           double(highest), file.overviews(0)));
  if (missing > 0 && !request.keep_gaps)
    terrain.assumptions.push_back(
        text("%.3g %% of the terrain have no data: sea level is taken there.",
             100 * double(missing) / double(ground.height_m.size())));
  if (!request.keep_gaps)
    terrain.assumptions.push_back("Sea is where the terrain is at or below 0.5 m, and around it.");
  terrain.assumptions.push_back(
      "Heights above sea level are taken as above the ellipsoid: the geoid lies 107 m below to 86 "
      "m "
      "above it.");
  return terrain;
}

}  // namespace nepho::gdal
