// Columns of clouds in files of CF or near to it: satellites' products, models' vertical sums. What
// a variable is, its standard_name or name says (quantity.h).
#include <algorithm>

#include "core/error.h"
#include "forecast/conventions/convention.h"
#include "forecast/conventions/dimension_roles.h"
#include "forecast/conventions/field_reader.h"
#include "forecast/conventions/grid_mapping.h"
#include "forecast/conventions/names.h"
#include "forecast/files/file_time.h"
#include "forecast/rasters/raster_forecast.h"

namespace nepho::forecast {
namespace {

// A unit that is missing or not known is asked for later; one of another kind says that the
// variable is something else of the same name.
bool may_be(CloudQuantity quantity, const std::string& unit) {
  try {
    return unit.empty() || parse_unit(unit).dimension == kind_of(quantity).dimension;
  } catch (const Error&) {
    return true;
  }
}

std::optional<CloudQuantity> told(const FileVariable& variable) {
  if (!variable.numeric || variable.dimensions.size() < 2) return std::nullopt;
  for (const std::string& name : {variable.text("standard_name"), variable.name})
    if (const auto quantity = quantity_named(name);
        quantity && may_be(*quantity, variable.text("units")))
      return quantity;
  return std::nullopt;
}

// Of rows and columns, and times at most.
bool is_plane(const DataFile& file, const FileVariable& variable) {
  const auto is_time = [&](int d) {
    const FileVariable* axis = file.find(file.name(d));
    return (axis && is_time_unit(axis->text("units"))) || file.name(d) == "time" ||
           file.name(d) == "Time";
  };
  return std::ranges::count_if(variable.dimensions,
                               [&](int d) { return file.size(d) > 1 && !is_time(d); }) <= 2;
}

// The first of each quantity, depths and paths before heights.
std::vector<std::pair<CloudQuantity, const FileVariable*>> planes(const DataFile& file) {
  std::vector<std::pair<CloudQuantity, const FileVariable*>> all;
  for (const FileVariable& variable : file.variables()) {
    const auto quantity = told(variable);
    if (!quantity || !is_plane(file, variable)) continue;
    const bool known =
        std::ranges::any_of(all, [&](const auto& plane) { return plane.first == *quantity; });
    if (!known) all.emplace_back(*quantity, &variable);
  }
  std::ranges::sort(all, {}, [](const auto& plane) { return plane.first; });
  return all;
}

// Where there is no water on levels, which is more.
int recognise(const DataFile& file) {
  if (planes(file).empty()) return 0;
  try {
    const auto any = [](const FileVariable& v) { return v.dimensions.size() >= 2; };
    return find_water(file, any).empty() ? 2 : 0;
  } catch (const Error&) {
    return 0;  // its units are not understood: the forecast says so
  }
}

std::int64_t time_of(const DataFile& file, int time, Raster& raster) {
  for (const FileVariable& v : file.variables()) {
    const bool axis = time >= 0 ? v.dimensions == std::vector<int>{time} : v.dimensions.empty();
    if (!axis || !v.numeric || !is_time_unit(v.text("units"))) continue;
    const auto [times, assumptions] = read_times(file, v);
    raster.assumptions.insert(raster.assumptions.end(), assumptions.begin(), assumptions.end());
    if (times.size() > 1)
      raster.facts.push_back("The first of the file's " + std::to_string(times.size()) +
                             " times is taken.");
    return times.empty() ? 0 : times.front();
  }
  return 0;
}

std::unique_ptr<Forecast> open(std::shared_ptr<const DataFile> file, const OpenRequest& request) {
  if (!request.raster.bands.empty())
    throw Error({"variables have names of their own", file->path(), "no bands (--bands)",
                 std::to_string(request.raster.bands.size()) + " of them",
                 "set the attribute standard_name, for example with ncatted"});
  const auto found = planes(*file);
  const FileVariable& first = *found.front().second;
  const DimensionRoles roles = dimension_roles(*file, first, Levels::kNone);
  Raster raster;
  raster.path = file->path();
  raster.assumptions = file->assumptions();
  raster.facts = file->facts();
  FieldReader reader;
  reader.file = file;
  reader.time = roles.time;
  reader.y = roles.y;
  reader.x = roles.x;
  std::string how;
  raster.grid = cf_grid(*file, roles, reader, first, raster.assumptions, how);
  reader.nx = raster.grid->nx();
  reader.ny = raster.grid->ny();
  raster.facts.push_back("Grid: " + std::to_string(reader.nx) + " x " + std::to_string(reader.ny) +
                         " cells, " + how + ".");
  if (request.region) {
    const CellWindow window = window_of({&raster.grid, 1}, *request.region, file->path());
    raster.facts.push_back(window_fact(*request.region, window, *raster.grid));
    reader.restrict_to(window, raster.grid->around());
    raster.grid = windowed(raster.grid, window);
  }
  for (const auto& [quantity, variable] : found) {
    if (!reader.is_surface(*variable)) continue;
    const Unit unit = unit_for(quantity, variable->text("units"), file->where(*variable),
                               "set the attribute `units`, for example with ncatted -a units," +
                                   variable->name + ",o,c," + kind_of(quantity).usual_unit);
    std::vector<float> values = reader.surface(*variable, 0);
    for (float& value : values) value = float(unit.to_si(double(value)));
    raster.fields[quantity] = std::move(values);
  }
  raster.utc_ns = time_of(*file, roles.time, raster);
  return make_raster_forecast(std::move(raster), request.raster, request.force);
}

}  // namespace

const Convention kRaster = {"columns", recognise, open};

}  // namespace nepho::forecast
