#include "forecast/conventions/said.h"

#include <algorithm>
#include <cstdio>

#include "forecast/conventions/particle_sizes.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

std::string text(const char* format, double a, double b = 0) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

// What was read under names that no file stands behind.
void say_names(Model& model) {
  const auto note = [&](const FileVariable* variable, Quantity quantity) {
    if (!variable) return;
    if (std::string text = untested(*model.file, quantity, *variable); !text.empty())
      model.assumptions.push_back(std::move(text));
  };
  for (const WaterVariable& w : model.water)
    if (w.row) note(w.variable, w.row->quantity);
  note(model.cloud_fraction, names::kCloudFraction);
  note(model.droplet_number, names::kDropletNumber);
  note(model.droplet_radius, names::kDropletRadius);
  note(model.ice_radius, names::kIceRadius);
  if (const std::string wrote = model_of_file(*model.file); !wrote.empty())
    model.recognised.push_back({"names", "those of " + wrote});
}

// How water became extinction: water.h has the equations.
void say_optics(const WaterStatistics& s, Model& model) {
  const auto has = [&](auto&& wanted) { return std::ranges::any_of(model.water, wanted); };
  auto& to = model.recognised;
  for (SaidOfSizes& said : said_of_sizes(model, s)) to.push_back({said.what, std::move(said.how)});
  if (has([](const WaterVariable& w) { return w.species == Species::kCloudWater; }))
    to.push_back({"mean effective radius", text("%.3g um, of droplets", s.radius_m() * 1e6)});
  for (const WaterVariable& w : model.water)
    if (w.freezes_below_K > 0) {
      const double all_ice_degC = w.freezes_below_K - constants::kZeroCelsius_K,
                   all_liquid_degC = w.liquid_above_K - constants::kZeroCelsius_K;
      to.push_back({"freezing",
                    w.variable->name + text(" is ice below %.0f degC", all_ice_degC) +
                        (w.liquid_above_K > w.freezes_below_K
                             ? text(" and liquid above %.0f degC, linear between", all_liquid_degC)
                             : "")});
    }
  if (has([](const WaterVariable& w) {
        return w.species != Species::kCloudWater && w.species != Species::kCloudIce;
      }))
    to.push_back({"precipitation",
                  "exponential sizes: rain by Marshall and Palmer (1948), snow by "
                  "Houze et al. (1979), graupel by Hong and Lim (2006)"});
}

}  // namespace

void say(const WaterStatistics& s, Model& model) {
  auto& facts = model.facts;
  // The range of EGM2008: Pavlis et al. (2012), doi:10.1029/2011JB008916.
  if (model.geoid_m)
    facts.push_back("Heights stand on the geoid EGM96, and so does the sea of the data.");
  else if (!model.heights_on_ellipsoid)
    model.assumptions.push_back(
        "Heights above sea level are taken as above the ellipsoid: the geoid lies 107 m below to "
        "86 m above it.");
  say_names(model);
  say_optics(s, model);
  if (s.negative > 0)
    facts.push_back(std::to_string(s.negative) +
                    text(" negative water values, down to %.3g, are taken as 0.", s.lowest));
  if (s.missing > 0)
    facts.push_back(std::to_string(s.missing) + text(" of %.0f water values are missing: no cloud "
                                                     "there.",
                                                     double(s.values)));
  if (s.without_air > 0)
    facts.push_back(std::to_string(s.without_air) +
                    " water values have no pressure or temperature: no cloud there.");
}

}  // namespace nepho::forecast
