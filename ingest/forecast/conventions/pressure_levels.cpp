// Levels of pressure, one per level, a field, or by a formula: hydrostatic heights.
#include <algorithm>
#include <cmath>

#include "forecast/conventions/cell_bounds.h"
#include "forecast/conventions/hybrid_pressure.h"
#include "forecast/conventions/levels.h"
#include "forecast/water/air.h"
#include "forecast/water/level_heights.h"

namespace nepho::forecast {
namespace {

// Hydrostatic columns over the surface, or over mean sea level at 1013.25 hPa.
struct Hydrostatic {
  std::shared_ptr<Levels> levels;
  const FileVariable* surface_pressure = nullptr;
  double surface_factor = 1;
  std::optional<HybridPressure> hybrid;  // pressures of the interfaces, or
  PressureField interface_Pa;            // likewise, [k][n]

  std::vector<float> interfaces_m(std::size_t time, const Air* known) const;
  void place_interfaces(std::span<const double> p, std::span<const double> tv,
                        std::span<const double> z, std::span<const double> at_Pa,
                        std::span<float> interface_m) const;
};

std::vector<float> Hydrostatic::interfaces_m(std::size_t time, const Air* known) const {
  const Air own = known ? Air{} : levels->request.air(time);
  const Air& air = known ? *known : own;
  const std::size_t cells = levels->cells(), nz = std::size_t(levels->nz());
  std::vector<float> surface, formula_surface, walls;
  if (interface_Pa) walls = interface_Pa(time);
  if (surface_pressure) surface = levels->reader().surface(*surface_pressure, time);
  if (hybrid && hybrid->surface) formula_surface = levels->reader().surface(*hybrid->surface, time);
  const std::vector<double> ground = levels->terrain_m(time);
  std::vector<float> result(cells * (nz + 1));
  std::vector<double> p(nz), tv(nz), z(nz), at_Pa(nz + 1);
  bool any = false;
  for (std::size_t n = 0; n < cells; ++n) {
    for (std::size_t k = 0; k < nz; ++k) {
      const Air::State state = air.at(k, n, cells);
      p[k] = state.pressure_Pa;
      tv[k] = virtual_temperature_K(state.temperature_K, state.specific_humidity);
    }
    const double formula_Pa =
        formula_surface.empty() ? NAN : hybrid->surface_Pa(double(formula_surface[n]));
    double surface_Pa = surface.empty() ? formula_Pa : double(surface[n]) * surface_factor;
    const bool known_ground = std::isfinite(surface_Pa) && std::isfinite(ground[n]);
    hypsometric_heights_m(p, tv, known_ground ? surface_Pa : kStandardSurfacePressure_Pa,
                          known_ground ? ground[n] : 0, z);
    const std::span<float> interfaces{&result[n * (nz + 1)], nz + 1};
    const bool whole = std::ranges::all_of(z, [](double h) { return std::isfinite(h); });
    any |= whole;
    if (hybrid && !hybrid->interface_a_Pa.empty() && whole) {
      for (std::size_t k = 0; k <= nz; ++k) {
        const double b = hybrid->interface_b[k];
        at_Pa[k] = hybrid->interface_a_Pa[k] + (b == 0 ? 0 : b * formula_Pa);
      }
      place_interfaces(p, tv, z, at_Pa, interfaces);
      continue;
    }
    if (!walls.empty() && whole) {
      for (std::size_t k = 0; k <= nz; ++k) at_Pa[k] = double(walls[k * cells + n]);
      place_interfaces(p, tv, z, at_Pa, interfaces);
      continue;
    }
    for (double& height : z) height = height_of_geopotential_height_m(height);
    any |= fill_levels(z);
    interfaces_of_levels_m(z, ground[n], interfaces);
  }
  if (!any) refuse_levels(levels->file().where(*levels->variable), "no pressure or temperature");
  return levels->checked(std::move(result));
}

// A top of the model without pressure is as far above its level as the interface below it.
void Hydrostatic::place_interfaces(std::span<const double> p, std::span<const double> tv,
                                   std::span<const double> z, std::span<const double> at_Pa,
                                   std::span<float> interface_m) const {
  double below = 0;
  for (std::size_t k = 0; k < interface_m.size(); ++k) {
    const bool has_pressure = at_Pa[k] > 0.1 * p[std::min(k, p.size() - 1)] || k == 0;
    const double h = has_pressure ? height_in_layers_m(p, tv, z, at_Pa[k]) : 2 * z[k - 1] - below;
    below = h;
    interface_m[k] = float(height_of_geopotential_height_m(h));
  }
}

}  // namespace

void set_hydrostatic(const VerticalRequest& request, Vertical& vertical,
                     const FileVariable& variable, std::optional<HybridPressure> hybrid,
                     PressureField interface_Pa) {
  auto column = std::make_shared<Hydrostatic>();
  column->levels = levels_of(request, variable, request.z);
  const FieldReader& reader = *request.reader;
  column->surface_pressure = find_named(
      *reader.file, names::kSurfacePressure,
      [&](const FileVariable& v) { return reader.is_surface(v) && unit_of(v, kPressure).fits; });
  if (column->surface_pressure)
    column->surface_factor = unit_of(*column->surface_pressure, kPressure).factor;
  if (!request.terrain_m || !(column->surface_pressure || (hybrid && hybrid->surface))) {
    column->surface_pressure = nullptr;
    vertical.assumptions.push_back(
        "Heights are hydrostatic over 1013.25 hPa at sea level: there is no surface pressure with "
        "its terrain.");
  }
  if (!request.temperature)
    vertical.assumptions.push_back(
        "There is no temperature: heights and densities are the standard atmosphere's.");
  vertical.heights_change = true;
  vertical.has_interfaces = interface_Pa || (hybrid && !hybrid->interface_a_Pa.empty());
  column->interface_Pa = std::move(interface_Pa);
  vertical.how = hybrid && !hybrid->how.empty() ? hybrid->how : "hydrostatic from " + variable.name;
  column->hybrid = std::move(hybrid);
  vertical.interfaces_m = [column](std::size_t time, const Air* air) {
    return column->interfaces_m(time, air);
  };
}

PressureLevels pressure_levels(const DataFile& file, int z) {
  PressureLevels levels;
  const FileVariable* axis = file.find(file.name(z));
  if (!axis || axis->dimensions.size() != 1 || !axis->numeric) return levels;
  const UnitOf unit = unit_of(*axis, kPressure);
  if (!unit.fits || !axis->text("formula_terms").empty()) return levels;
  levels.pressure_Pa = file.read_all(*axis);
  for (double& p : levels.pressure_Pa) p = p * unit.factor + unit.offset;
  levels.from_top = direction(levels.pressure_Pa, file.where(*axis)) > 0;
  if (levels.pressure_Pa.size() == 1) levels.from_top = false;
  if (const auto bounds = axis_bounds(file, *axis, levels.pressure_Pa, unit.factor, false))
    levels.interface_Pa = *bounds;
  if (levels.from_top) std::ranges::reverse(levels.pressure_Pa);
  if (!levels.interface_Pa.empty() && levels.interface_Pa.front() < levels.interface_Pa.back())
    std::ranges::reverse(levels.interface_Pa);
  if (!(levels.pressure_Pa.back() > 0))
    refuse_levels(file.where(*axis), "a pressure of " + std::to_string(levels.pressure_Pa.back()));
  return levels;
}

bool by_pressure_levels(const VerticalRequest& request, Vertical& vertical) {
  const DataFile& file = *request.reader->file;
  const PressureLevels levels = pressure_levels(file, request.z);
  if (levels.pressure_Pa.empty()) return false;
  std::optional<HybridPressure> bounds;
  if (!levels.interface_Pa.empty()) {
    bounds.emplace();
    bounds->interface_a_Pa = levels.interface_Pa;
    bounds->interface_b.assign(levels.interface_Pa.size(), 0.0);
  }
  set_hydrostatic(request, vertical, *file.find(file.name(request.z)), std::move(bounds));
  vertical.from_top = levels.from_top;
  const FileVariable& axis = *file.find(file.name(request.z));
  if (axis.name == "pfull" || axis.text("long_name").starts_with("ref "))
    vertical.assumptions.push_back(
        axis.name +
        " holds reference pressures of hybrid levels, taken as they are: without ak and "
        "bk, delz or dpres clouds over high ground stand too low.");
  return true;
}

bool by_hybrid_pressure(const VerticalRequest& request, Vertical& vertical) {
  const FieldReader& reader = *request.reader;
  const auto is_pressure = [&](const FileVariable& v) {
    return reader.is_field(v, request.z) && unit_of(v, kPressure).fits;
  };
  const bool has_field = find_named(*reader.file, names::kPressure, is_pressure);
  auto hybrid = hybrid_pressure(request, has_field);
  if (!hybrid) return false;
  vertical.from_top = hybrid->from_top;
  vertical.pressure_Pa = hybrid_field(request, *hybrid);
  const FileVariable& named = hybrid->surface ? *hybrid->surface : *request.water;
  set_hydrostatic(request, vertical, named, std::move(hybrid));
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
  set_hydrostatic(request, vertical, *found, {});
  return true;
}

}  // namespace nepho::forecast
