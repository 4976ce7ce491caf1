#include "bench/sweep.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "cli/values.h"
#include "core/error.h"

namespace nepho::bench {
namespace {

struct Knob {
  const char* name;
  const char* unit;
  const char* field;  // of the scene grammar's object "render"
  bool is_word;
  void (*set)(RenderSettings& settings, double number, const std::string& word);
};

constexpr Knob kKnobs[] = {
    {"step", "voxels", "step_voxels", false,
     [](RenderSettings& s, double n, const std::string&) { s.step_voxels = n; }},
    {"tolerance", "", "tolerance", false,
     [](RenderSettings& s, double n, const std::string&) {
       s.step_voxels.reset();
       s.tolerance = n;
     }},
    {"budget-mib", "MiB", "budget_mib", false,
     [](RenderSettings& s, double n, const std::string&) { s.budget_mib = n; }},
    {"pixels-per-voxel", "pixels", "pixels_per_voxel", false,
     [](RenderSettings& s, double n, const std::string&) { s.pixels_per_voxel = n; }},
    {"max-level", "", "max_level", false,
     [](RenderSettings& s, double n, const std::string&) { s.max_level = int(n); }},
    {"light", "", "light", true,
     [](RenderSettings& s, double, const std::string& w) {
       s.light = w == "single" ? Light::kSingle : Light::kOctaves;
     }},
    {"octaves", "", "octaves", false,
     [](RenderSettings& s, double n, const std::string&) {
       s.light = Light::kOctaves;
       s.octaves = int(n);
     }},
    {"fetch", "", "fetch", true,
     [](RenderSettings& s, double, const std::string& w) {
       s.fetch = w == "filter" ? Fetch::kFilter : Fetch::kTexels8;
     }},
    {"pixels", "", "pixels", true,
     [](RenderSettings& s, double, const std::string& w) {
       s.pixels = w == "all" ? WhichPixels::kAll : WhichPixels::kAdaptive;
     }},
};

const Knob* find_knob(const std::string& name) {
  const auto* found = std::ranges::find(kKnobs, name, &Knob::name);
  return found == std::end(kKnobs) ? nullptr : found;
}

const Knob& knob(const std::string& name) {
  if (const Knob* found = find_knob(name)) return *found;
  throw std::logic_error("no setting " + name);
}

double checked_number(const Knob& knob, const std::string& text) {
  return number_value("--sweep " + std::string(knob.name), text, "render", knob.field);
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    parts.push_back(list.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

// "1" and "1.0" are one value: the same picture twice would stand for two.
bool same_value(const Knob& knob, const std::string& a, const std::string& b) {
  return knob.is_word ? a == b : checked_number(knob, a) == checked_number(knob, b);
}

void refuse_pair(std::span<const Axis> axes, const char* a, const char* b, const char* why) {
  const auto swept = [&](const char* name) {
    return std::ranges::any_of(axes, [name](const Axis& axis) { return axis.name == name; });
  };
  if (swept(a) && swept(b))
    throw Error({"sweeps exclude each other", "--sweep", std::string(a) + " or " + b, "both", why});
}

}  // namespace

std::string known_settings() {
  std::string text;
  for (const Knob& known : kKnobs) {
    text += (text.empty() ? "" : ", ") + std::string(known.name);
    if (*known.unit) text += " (" + std::string(known.unit) + ")";
  }
  return text;
}

std::string unit_of(const std::string& name) {
  return knob(name).unit;
}

Axis parse_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const Knob* known = find_knob(name);
  if (!known)
    throw Error({"no such setting", "--sweep", "NAME=VALUE,... of " + known_settings(),
                 "'" + text + "'", ""});
  if (equals == std::string::npos || equals + 1 == text.size())
    throw Error({"an empty range", "--sweep", name + "=VALUE,VALUE,...", "'" + text + "'", ""});
  Axis axis{name, split(text.substr(equals + 1))};
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    const std::string& value = axis.values[i];
    if (value.empty())
      throw Error(
          {"a value is missing", "--sweep", name + "=VALUE,VALUE,...", "'" + text + "'", ""});
    if (known->is_word)
      choice_value("--sweep " + name, value, "render", known->field);
    else
      checked_number(*known, value);
    for (std::size_t before = 0; before < i; ++before)
      if (same_value(*known, axis.values[before], value))
        throw Error({"a value twice", "--sweep", "each value once", "'" + text + "'", ""});
  }
  return axis;
}

std::string Setting::label() const {
  std::string text;
  for (const auto& [name, value] : values) text += (text.empty() ? "" : ", ") + name + " " + value;
  return text.empty() ? "as the scene says" : text;
}

std::optional<double> Setting::number(const std::string& name) const {
  for (const auto& [known, value] : values)
    if (known == name && !knob(name).is_word) return checked_number(knob(name), value);
  return {};
}

std::string Setting::value(const std::string& name) const {
  for (const auto& [known, text] : values)
    if (known == name) return text;
  return "";
}

std::vector<std::string> varied_axes(std::span<const Setting> settings) {
  std::vector<std::string> varied;
  for (const auto& [name, value] : settings.front().values)
    if (std::ranges::any_of(settings, [&](const Setting& s) { return s.value(name) != value; }))
      varied.push_back(name);
  return varied;
}

std::vector<Setting> combinations(std::span<const Axis> axes) {
  std::size_t count = 1;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (std::size_t before = 0; before < a; ++before)
      if (axes[before].name == axes[a].name)
        throw Error({"swept twice", "--sweep " + axes[a].name, "one list of values", "two", ""});
    count *= axes[a].values.size();
    if (count > kMostSettings)
      throw Error({"too many settings", "--sweep",
                   "at most " + std::to_string(kMostSettings) + " combinations",
                   std::to_string(count) + " or more", "sweep fewer values"});
  }
  refuse_pair(axes, "step", "tolerance", "either rules the march");
  refuse_pair(axes, "light", "octaves", "light=single is octaves=1");
  std::vector<Setting> all(1);
  for (const Axis& axis : axes) {
    std::vector<Setting> next;
    for (const Setting& setting : all)
      for (const std::string& value : axis.values) {
        next.push_back(setting);
        next.back().values.emplace_back(axis.name, value);
      }
    all = std::move(next);
  }
  return all;
}

void lay_over(const Setting& setting, RenderSettings& settings) {
  for (const auto& [name, value] : setting.values) {
    const Knob& known = knob(name);
    known.set(settings, known.is_word ? 0 : checked_number(known, value), value);
  }
}

}  // namespace nepho::bench
