// Levels of pressure, one per level or a field: hydrostatic heights.
#include <algorithm>
#include <cmath>

#include "forecast/conventions/levels.h"
#include "forecast/water/air.h"
#include "forecast/water/level_heights.h"

namespace nepho::forecast {
namespace {

// Hydrostatic columns over the surface, or over mean sea level at 1013.25 hPa.
struct Hydrostatic {
  std::shared_ptr<Levels> levels;
  std::vector<double> pressure_Pa;  // of levels, from the ground up; or
  const FileVariable* surface_pressure = nullptr;
  double surface_factor = 1;

  std::vector<float> interfaces_m(std::size_t time, const Air* known) const {
    const Air own = known ? Air{} : levels->request.air(time);
    const Air& air = known ? *known : own;
    const std::size_t cells = levels->cells(), nz = std::size_t(levels->nz());
    std::vector<float> surface;
    if (surface_pressure) surface = levels->reader().surface(*surface_pressure, time);
    const std::vector<double> ground = levels->terrain_m(time);
    std::vector<float> result(cells * (nz + 1));
    std::vector<double> p(nz), tv(nz), z(nz);
    bool any = false;
    for (std::size_t n = 0; n < cells; ++n) {
      for (std::size_t k = 0; k < nz; ++k) {
        const Air::State state = air.at(k, n, cells);
        p[k] = state.pressure_Pa;
        tv[k] = virtual_temperature_K(state.temperature_K, state.specific_humidity);
      }
      const bool known_ground = !surface.empty() && std::isfinite(ground[n]);
      hypsometric_heights_m(
          p, tv, known_ground ? double(surface[n]) * surface_factor : kStandardSurfacePressure_Pa,
          known_ground ? ground[n] : 0, z);
      for (double& height : z) height = height_of_geopotential_height_m(height);
      any |= fill_levels(z);
      interfaces_of_levels_m(z, ground[n], {&result[n * (nz + 1)], nz + 1});
    }
    if (!any) refuse_levels(levels->file().where(*levels->variable), "no pressure or temperature");
    return levels->checked(std::move(result));
  }
};

void set_hydrostatic(const VerticalRequest& request, Vertical& vertical,
                     const FileVariable& variable) {
  auto column = std::make_shared<Hydrostatic>();
  column->levels = levels_of(request, variable, request.z);
  const FieldReader& reader = *request.reader;
  column->surface_pressure = find_named(
      *reader.file, names::kSurfacePressure,
      [&](const FileVariable& v) { return reader.is_surface(v) && unit_of(v, kPressure).fits; });
  if (column->surface_pressure && request.terrain_m) {
    column->surface_factor = unit_of(*column->surface_pressure, kPressure).factor;
  } else {
    column->surface_pressure = nullptr;
    vertical.assumptions.push_back(
        "Heights are hydrostatic over 1013.25 hPa at sea level: there is no surface pressure with "
        "its terrain.");
  }
  if (!request.temperature)
    vertical.assumptions.push_back(
        "There is no temperature: heights and densities are the standard atmosphere's.");
  vertical.heights_change = true;
  vertical.how = "hydrostatic from " + variable.name;
  vertical.interfaces_m = [column](std::size_t time, const Air* air) {
    return column->interfaces_m(time, air);
  };
}

}  // namespace

PressureLevels pressure_levels(const DataFile& file, int z) {
  PressureLevels levels;
  const FileVariable* axis = file.find(file.name(z));
  if (!axis || axis->dimensions.size() != 1 || !axis->numeric) return levels;
  const UnitOf unit = unit_of(*axis, kPressure);
  if (!unit.fits) return levels;
  levels.pressure_Pa = file.read_all(*axis);
  for (double& p : levels.pressure_Pa) p = p * unit.factor + unit.offset;
  levels.from_top = direction(levels.pressure_Pa, file.where(*axis)) > 0;
  if (levels.pressure_Pa.size() == 1) levels.from_top = false;
  if (levels.from_top) std::ranges::reverse(levels.pressure_Pa);
  if (!(levels.pressure_Pa.back() > 0))
    refuse_levels(file.where(*axis), "a pressure of " + std::to_string(levels.pressure_Pa.back()));
  return levels;
}

bool by_pressure_levels(const VerticalRequest& request, Vertical& vertical) {
  const DataFile& file = *request.reader->file;
  const PressureLevels levels = pressure_levels(file, request.z);
  if (levels.pressure_Pa.empty()) return false;
  set_hydrostatic(request, vertical, *file.find(file.name(request.z)));
  vertical.from_top = levels.from_top;
  return true;
}

bool by_pressure_field(const VerticalRequest& request, Vertical& vertical) {
  const FieldReader& reader = *request.reader;
  const FileVariable* found =
      find_named(*reader.file, names::kPressure, [&](const FileVariable& v) {
        return reader.is_field(v, request.z) && unit_of(v, kPressure).fits;
      });
  if (!found) return false;
  vertical.from_top = !falls(reader, *found, request.z);
  vertical.pressure = found;
  set_hydrostatic(request, vertical, *found);
  return true;
}

}  // namespace nepho::forecast
