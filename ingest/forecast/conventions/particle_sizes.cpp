#include "forecast/conventions/particle_sizes.h"

#include <algorithm>

#include "core/error.h"
#include "units/parse_unit.h"

namespace nepho::forecast {
namespace {

std::optional<Unit> parsed(const std::string& text) {
  try {
    return parse_unit(text);
  } catch (const Error&) {
    return {};
  }
}

const FileVariable* usable(const Model& model, Quantity quantity, const Accept& accept,
                           bool (*understood)(const FileVariable&),
                           std::vector<std::string>& assumptions) {
  const FileVariable* found = find_named(*model.file, quantity, accept);
  if (!found || understood(*found)) return found;
  assumptions.push_back(found->name + " has units that are not understood, \"" +
                        found->text("units") + "\", and is not used.");
  return nullptr;
}

bool has(const Model& model, bool (*kind)(Species)) {
  return std::ranges::any_of(model.water, [&](const WaterVariable& w) {
    return kind(w.species) || (w.freezes_below_K > 0 && kind(Species::kCloudIce));
  });
}

std::string by_martin(const Model& model) {
  return std::string("Droplet radii are by Martin et al. (1994): ") +
         (model.has_land_mask ? "50 and 900 aerosol particles per cm3 over sea and land."
                              : "there is no land mask, 50 aerosol particles per cm3 as over the "
                                "sea.");
}

}  // namespace

std::optional<NumberUnit> number_unit(const FileVariable& variable) {
  std::string text;
  for (const char c : variable.text("units"))
    if (c != '#' && c != '(' && c != ')' && !(c == ' ' && text.empty())) text += c;
  if (text.starts_with("/")) text = "1" + text;
  const auto unit = parsed(text);
  if (!unit) return {};
  if (unit->dimension == Dimension{.kg = -1}) return NumberUnit{unit->factor, true};
  if (unit->dimension == Dimension{.m = -3}) return NumberUnit{unit->factor, false};
  return {};
}

std::optional<double> radius_factor(const FileVariable& variable) {
  const std::string text = variable.text("units");
#ifdef NEPHO_MUTANT_RADIUS_UNIT
  return 1e-6;
#endif
  if (text == "mkm" || text == "micron" || text == "microns") return 1e-6;
  const auto unit = parsed(text);
  if (!unit || unit->dimension != kLength) return {};
  return unit->factor;
}

void find_sizes(const Accept& accept, Model& model) {
  const auto is_number = [](const FileVariable& v) { return number_unit(v).has_value(); };
  const auto is_radius = [](const FileVariable& v) { return radius_factor(v).has_value(); };
  auto& assumptions = model.assumptions;
  model.droplet_radius = usable(model, names::kDropletRadius, accept, is_radius, assumptions);
  model.ice_radius = usable(model, names::kIceRadius, accept, is_radius, assumptions);
  if (!model.droplet_radius)
    model.droplet_number = usable(model, names::kDropletNumber, accept, is_number, assumptions);
}

void read_sizes(const Model& model, std::size_t time, CloudSetting& setting) {
  const auto read = [&](const FileVariable& variable, double factor) {
    std::vector<float> values = model.field(variable, time);
    for (float& value : values) value = float(double(value) * factor);
    return values;
  };
  if (model.droplet_radius)
    setting.droplet_radius_m = read(*model.droplet_radius, *radius_factor(*model.droplet_radius));
  if (model.ice_radius)
    setting.ice_radius_m = read(*model.ice_radius, *radius_factor(*model.ice_radius));
  if (!model.droplet_number) return;
  const NumberUnit unit = *number_unit(*model.droplet_number);
  setting.number_per_kg = unit.per_kg;
  setting.number = read(*model.droplet_number, unit.factor);
}

std::vector<SaidOfSizes> said_of_sizes(const Model& model, const WaterStatistics& statistics) {
  std::vector<SaidOfSizes> said;
  if (has(model, [](Species s) { return s == Species::kCloudWater; }))
    said.push_back(
        {"droplets",
         model.droplet_radius ? "Droplet radii are the file's, " + model.droplet_radius->name + "."
         : model.droplet_number ? "Droplet radii are by the file's number of droplets, " +
                                      model.droplet_number->name + " (Martin et al. 1994)."
                                : by_martin(model)});
  if (has(model, [](Species s) { return s == Species::kCloudIce; }))
    said.push_back({"ice", model.ice_radius
                               ? "Ice radii are the file's, " + model.ice_radius->name + "."
                               : "Ice radii are by Sun and Rikus (1999), from content, temperature "
                                 "and latitude."});
  if (statistics.without_size > 0)
    said.push_back({"sizes", std::to_string(statistics.without_size) + " of " +
                                 std::to_string(statistics.sized) +
                                 " of the file's sizes where there is water are missing or no "
                                 "cloud's: there radii are by Martin et al. and Sun and Rikus."});
  if (model.cloud_fraction)
    said.push_back({"cloud fraction",
                    "Cloud fraction " + model.cloud_fraction->name +
                        ": radii are those of the water in the cloudy part of a cell; the cell is "
                        "drawn with its mean extinction."});
  return said;
}

}  // namespace nepho::forecast
