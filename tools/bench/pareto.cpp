#include "bench/pareto.h"

#include <algorithm>

#include "bench/text.h"

namespace nepho::bench {
namespace {

// The values of axes, in words that fit beside a point.
std::string short_label(const Setting& setting, const std::vector<std::string>& axes) {
  std::string text;
  for (const std::string& axis : axes) text += (text.empty() ? "" : ", ") + setting.value(axis);
  return text.empty() ? "as set" : text;
}

std::string named(const std::string& axis) {
  return unit_of(axis).empty() ? axis : axis + " (" + unit_of(axis) + ")";
}

std::string subtitle_of(const SceneResult& scene, const std::string& series,
                        const std::vector<std::string>& labels, std::size_t withheld) {
  std::string text = std::to_string(scene.reference.width) + "x" +
                     std::to_string(scene.reference.height) + " pixels";
  for (const std::string& axis : labels)
    text += (axis == labels.front() ? "; labels: " : ", ") + named(axis);
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
  std::vector<std::string> labels = scene.varied();
  std::string series_axis;
  if (labels.size() > 1) {
    series_axis = labels.front();
    labels.erase(labels.begin());
  }
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
    point.label = short_label(s.setting, labels);
    if (!series_axis.empty()) {
      const std::string value = s.setting.value(series_axis);
      const auto known = std::ranges::find(chart.series, value);
      point.series = std::size_t(known - chart.series.begin());
      if (known == chart.series.end()) chart.series.push_back(value);
    }
    chart.points.push_back(std::move(point));
    found.settings.push_back(i);
  }
  if (chart.points.empty()) return {};
  chart.title = scene.name + ": error against run time";
  chart.subtitle =
      subtitle_of(scene, series_axis, labels, scene.settings.size() - chart.points.size());
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
