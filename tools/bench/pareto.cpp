#include "bench/pareto.h"

#include <algorithm>

#include "bench/text.h"

namespace nepho::bench {
namespace {

// The values of all axes but one, in words that fit beside a point.
std::string short_label(const Setting& setting, const std::string& without) {
  std::string text;
  for (const auto& [name, value] : setting.values)
    if (name != without) text += (text.empty() ? "" : ", ") + value;
  return text.empty() ? "as set" : text;
}

std::string named(const std::string& axis) {
  return unit_of(axis).empty() ? axis : axis + " (" + unit_of(axis) + ")";
}

std::string subtitle_of(const SceneResult& scene, const std::string& series, std::size_t withheld) {
  std::string labels;
  for (const auto& [name, value] : scene.settings.front().setting.values)
    if (name != series) labels += (labels.empty() ? "" : ", ") + named(name);
  std::string text = std::to_string(scene.reference.width) + "x" +
                     std::to_string(scene.reference.height) + " pixels";
  if (!labels.empty()) text += "; labels: " + labels;
  if (!series.empty()) text += "; colours: " + named(series);
  if (withheld) text += "; " + std::to_string(withheld) + " withheld";
  return text;
}

// The largest of the parts that a setting can change, or the light model.
const Term* largest_part(const std::vector<Term>& terms) {
  const Term* largest = nullptr;
  for (const char* name : {kSteps, kLightCache, kLevelOfDetail}) {
    const Term* term = find_term(terms, name);
    if (term && term->told() && (!largest || term->rms > largest->rms)) largest = term;
  }
  return largest;
}

}  // namespace

std::optional<Pareto> pareto_of(const SceneResult& scene) {
  const std::string judged = judged_by(scene.settings);
  const auto& axes = scene.settings.front().setting.values;
  const std::string series_axis = axes.size() > 1 ? axes.back().first : "";
  const bool gpu = std::ranges::all_of(
      scene.settings, [](const SettingResult& s) { return s.times.gpu_frame_s.has_value(); });
  Pareto found;
  Chart& chart = found.chart;
  for (std::size_t i = 0; i < scene.settings.size(); ++i) {
    const SettingResult& s = scene.settings[i];
    const Term* term = find_term(s.terms, judged);
    if (!term || !term->told() || !(term->rms > 0)) continue;
    const Spread& time = gpu ? *s.times.gpu_frame_s : s.times.frame_s;
    ChartPoint point{.x = time.median, .y = term->rms, .x_low = time.low, .x_high = time.high};
    point.label = short_label(s.setting, series_axis);
    if (!series_axis.empty()) {
      const std::string& value = s.setting.values.back().second;
      const auto known = std::ranges::find(chart.series, value);
      point.series = std::size_t(known - chart.series.begin());
      if (known == chart.series.end()) chart.series.push_back(value);
    }
    chart.points.push_back(std::move(point));
    found.settings.push_back(i);
  }
  if (chart.points.empty()) return {};
  chart.title = scene.name + ": error against run time";
  chart.subtitle = subtitle_of(scene, series_axis, scene.settings.size() - chart.points.size());
  chart.x_label = gpu ? "GPU time of a frame (s)" : "process CPU time of a frame (s)";
  chart.y_label = judged == kTotal ? "error, rms of luminance (all)"
                                   : "error, rms of luminance (all but the light model)";
  const Term* light = find_term(scene.settings.front().terms, kLightModel);
  if (judged == kMarch && light && light->told() && light->rms > 0)
    chart.levels.push_back({light->rms, "light model " + percent_text(light->rms)});
  for (const std::size_t p : front_of(chart.points)) found.front.push_back(found.settings[p]);
  return found;
}

std::string lesson_of(const SceneResult& scene, const Pareto& pareto) {
  std::string text;
  const auto end = [&](const char* which, std::size_t index) {
    const SettingResult& s = scene.settings[index];
    const Term* part = largest_part(s.terms);
    text += std::string(which) + " (" + s.setting.label() + ", " +
            time_text(s.times.frame_s.median) + ") ";
    text += part ? "owes most to " + part->name + ", " + percent_text(part->rms)
                 : "has no part that is told";
  };
  end("The cheap end of the front", pareto.front.front());
  if (pareto.front.size() > 1) end("; the accurate end", pareto.front.back());
  text += ".";
  const Term* light = find_term(scene.settings.front().terms, kLightModel);
  if (light && light->told())
    text += " The light model adds " + percent_text(light->rms) + " to every setting.";
  return text;
}

}  // namespace nepho::bench
