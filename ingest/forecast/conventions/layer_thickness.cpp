// Layers whose thickness the file gives, in m (FV3's delz over hgtsfc) or Pa (dpres under pressfc).
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "forecast/conventions/levels.h"

namespace nepho::forecast {
namespace {

const VariableNames kThickness = {{"atmosphere_layer_thickness"}, {"delz", "dz", "dzf"}};
const VariableNames kPressureThickness = {
    {"atmosphere_layer_thickness_expressed_as_air_pressure_difference"}, {"dpres", "delp", "dp"}};

const FileVariable* find_thickness(const VerticalRequest& request, const VariableNames& names,
                                   const Dimension& wanted) {
  return find_named(*request.reader->file, names, [&](const FileVariable& v) {
    return request.reader->is_field(v, request.z) && unit_of(v, wanted).fits;
  });
}

// Is the file's first layer the highest? By the hybrid coefficients; the axis, of pressures that
// rise or positive downwards; or the layers themselves: in metres they grow upwards, in pressure
// downwards.
bool first_is_highest(const VerticalRequest& request, const FileVariable& thickness,
                      bool grows_up) {
  const FieldReader& reader = *request.reader;
  if (const auto hybrid = hybrid_pressure(request, true)) return hybrid->from_top;
  const DataFile& file = *reader.file;
  if (const FileVariable* axis = file.find(file.name(request.z));
      axis && axis->numeric && axis->dimensions == std::vector<int>{request.z}) {
    const std::vector<double> level = file.read_all(*axis);
    const bool rises = level.back() > level.front();
    if (level.size() > 1 && unit_of(*axis, kPressure).fits) return rises;
    const std::string positive = axis->text("positive");
    if (level.size() > 1 && !positive.empty()) return rises == (positive == "down");
  }
  const auto mean = [&](int k) {
    double sum = 0;
    for (const float value : reader.levels(thickness, request.z, false, 0, k, 1))
      if (!std::isnan(value)) sum += std::abs(double(value));
    return sum;
  };
  const bool first_thicker = mean(0) > mean(int(file.size(request.z)) - 1);
  return first_thicker == grows_up;
}

}  // namespace

// From the ground up; FV3 counts downwards and writes lengths below 0.
bool by_thickness(const VerticalRequest& request, Vertical& vertical) {
  const FileVariable* found = find_thickness(request, kThickness, kLength);
  if (!found) return false;
  auto levels = levels_of(request, *found, request.z);
  levels->factor = unit_of(*found, kLength).factor;
  levels->from_top = first_is_highest(request, *found, true);
#ifdef NEPHO_MUTANT_UPSIDE_DOWN
  levels->from_top = !levels->from_top;
#endif
  vertical.from_top = levels->from_top;
  vertical.heights_change = varies(*found, request.reader->time);
  vertical.has_interfaces = true;
  vertical.how = "thickness of layers " + found->name + " over the ground";
  if (!request.terrain_m)
    vertical.assumptions.push_back(
        "The layers of " + found->name +
        " are stacked from sea level: there is no height of the ground.");
  vertical.interfaces_m = [levels](std::size_t time, const Air*) {
    const std::vector<float> thick =
        levels->reader().field(*levels->variable, levels->z, levels->from_top, time);
    const std::vector<double> ground = levels->terrain_m(time);
    const std::size_t cells = levels->cells(), nz = std::size_t(levels->nz());
    std::vector<float> result(cells * (nz + 1));
    for (std::size_t n = 0; n < cells; ++n) {
      double height_m = std::isfinite(ground[n]) ? ground[n] : 0;
      result[n * (nz + 1)] = float(height_m);
      for (std::size_t k = 0; k < nz; ++k) {
        height_m += std::abs(double(thick[k * cells + n])) * levels->factor;
        result[n * (nz + 1) + k + 1] = float(height_m);
      }
    }
    return levels->checked(std::move(result));
  };
  return true;
}

LayerPressures pressure_of_thickness(const VerticalRequest& request) {
  const FieldReader& reader = *request.reader;
  const FileVariable* found = find_thickness(request, kPressureThickness, kPressure);
  const FileVariable* surface =
      find_named(*reader.file, names::kSurfacePressure,
                 [&](const auto& v) { return reader.is_surface(v) && unit_of(v, kPressure).fits; });
  if (!found || !surface) return {};
  const PressureField interface_Pa =
      [reader = request.reader, z = request.z, found, surface,
       from_top = first_is_highest(request, *found, false)](std::size_t time) {
        const double factor = unit_of(*found, kPressure).factor,
                     surface_factor = unit_of(*surface, kPressure).factor;
        const std::vector<float> thick = reader->field(*found, z, from_top, time);
        std::vector<float> pressure = reader->surface(*surface, time);
        const std::size_t cells = pressure.size();
        for (float& value : pressure) value = float(double(value) * surface_factor);
        pressure.reserve(thick.size() + cells);
        for (std::size_t at = 0; at < thick.size(); ++at)
          pressure.push_back(float(double(pressure[at]) - std::abs(double(thick[at])) * factor));
        return pressure;
      };
  const PressureField level_Pa = [interface_Pa,
                                  nz = reader.file->size(request.z)](std::size_t time) {
    std::vector<float> pressure = interface_Pa(time);
    const std::size_t cells = pressure.size() / (nz + 1);
    for (std::size_t at = 0; at < nz * cells; ++at)
      pressure[at] = 0.5f * (pressure[at] + pressure[at + cells]);
    pressure.resize(nz * cells);
    return pressure;
  };
  return {level_Pa, interface_Pa};
}

bool by_pressure_thickness(const VerticalRequest& request, Vertical& vertical) {
  LayerPressures pressures = pressure_of_thickness(request);
  if (!pressures.level_Pa) return false;
  const FileVariable* found = find_thickness(request, kPressureThickness, kPressure);
  vertical.from_top = first_is_highest(request, *found, false);
  vertical.pressure_Pa = std::move(pressures.level_Pa);
  set_hydrostatic(request, vertical, *found, {}, std::move(pressures.interface_Pa));
  return true;
}

}  // namespace nepho::forecast
