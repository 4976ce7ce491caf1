#include "bench/csv.h"

#include <cstdio>

namespace nepho::bench {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

class Row {
 public:
  Row& add(const std::string& field) {
    if (!text_.empty() || !first_) text_ += ',';
    first_ = false;
    if (field.find_first_of(",\"\r\n") == std::string::npos) {
      text_ += field;
      return *this;
    }
    text_ += '"';
    for (const char c : field) text_ += c == '"' ? std::string("\"\"") : std::string(1, c);
    text_ += '"';
    return *this;
  }
  Row& add(double value) { return add(number(value)); }
  Row& add_if(bool known, double value) { return add(known ? number(value) : ""); }
  std::string line() const { return text_ + "\n"; }

 private:
  std::string text_;
  bool first_ = true;
};

// The scene and its swept settings: what a row is of.
Row head(const std::vector<SceneResult>& scenes) {
  Row row;
  row.add("scene");
  for (const auto& [name, value] : scenes.front().settings.front().setting.values)
    row.add(unit_of(name).empty() ? name : name + " [" + unit_of(name) + "]");
  return row;
}
Row head_of(const SceneResult& scene, const SettingResult& setting) {
  Row row;
  row.add(scene.name);
  for (const auto& [name, value] : setting.setting.values) row.add(value);
  return row;
}

}  // namespace

std::string settings_csv(const std::vector<SceneResult>& scenes) {
  Row top = head(scenes);
  top.add("runs [1]").add("bricks [1]").add("prepare median [s]");
  top.add("light median [s]").add("view median [s]").add("frame median [s]");
  top.add("frame low quartile [s]").add("frame high quartile [s]");
  top.add("gpu frame median [s]").add("gpu frame low quartile [s]");
  top.add("gpu frame high quartile [s]");
  // Of a scene with all terms, where one has them.
  const SceneResult* fullest = &scenes.front();
  for (const SceneResult& scene : scenes)
    if (scene.settings.front().terms.size() > fullest->settings.front().terms.size())
      fullest = &scene;
  std::vector<std::string> names;
  for (const Term& term : fullest->settings.front().terms) names.push_back(term.name);
  for (const std::string& name : names) top.add(name + " rms [1]");
  top.add("paths [1/pixel]").add("noise of truth [1]");
  std::string text = top.line();
  for (const SceneResult& scene : scenes)
    for (const SettingResult& s : scene.settings) {
      const Times& t = s.times;
      Row row = head_of(scene, s);
      row.add(double(t.frame_s.runs)).add(double(s.bricks)).add(t.prepare_s.median);
      row.add(t.light_s.median).add(t.view_s.median).add(t.frame_s.median);
      row.add(t.frame_s.low).add(t.frame_s.high);
      const Spread gpu = t.gpu_frame_s.value_or(Spread{});
      for (const double value : {gpu.median, gpu.low, gpu.high})
        row.add_if(t.gpu_frame_s.has_value(), value);
      for (const std::string& name : names) {
        const Term* term = find_term(s.terms, name);
        row.add_if(term && term->told(), term ? term->rms : 0);
      }
      row.add_if(scene.paths > 0, scene.paths).add_if(scene.paths > 0, scene.noise);
      text += row.line();
    }
  return text;
}

std::string terms_csv(const std::vector<SceneResult>& scenes) {
  Row top = head(scenes);
  top.add("term").add("rms [1]").add("not above [1]").add("bias [1]").add("bias over truth [1]");
  top.add("relative MSE [1]").add("RMSE of 8-bit RGB [levels]").add("FLIP mean [1]");
  top.add("withheld");
  std::string text = top.line();
  for (const SceneResult& scene : scenes) {
    for (const SettingResult& s : scene.settings)
      for (const Term& term : s.terms) {
        Row row = head_of(scene, s);
        row.add(term.name).add_if(term.told(), term.rms).add_if(term.below > 0, term.below);
        for (const double value :
             {term.bias, term.bias_of_truth, term.relative_mse, term.rmse_8bit, term.flip_mean})
          row.add_if(term.told(), value);
        text += row.add(term.withheld).line();
      }
    for (const VolumeDataError& d : scene.data) {
      Row row;
      row.add(scene.name);
      for (std::size_t axis = 0; axis < scene.settings.front().setting.values.size(); ++axis)
        row.add("");
      row.add("data: " + d.volume);
      row.add_if(d.error.has_value(), d.error ? d.error->rms_per_m / d.error->field_rms_per_m : 0);
      for (int empty = 0; empty < 6; ++empty) row.add("");
      text += row.add(d.error ? "" : "the source has no field of its own").line();
    }
  }
  return text;
}

std::string orders_csv(const std::vector<SceneResult>& scenes) {
  Row top;
  top.add("scene").add("axis").add("at").add("order [1]").add("standard error [1]");
  std::string text = top.add("points [1]").add("not fitted").line();
  for (const SceneResult& scene : scenes)
    for (const Convergence& c : scene.convergence) {
      const OrderFit fit = c.fit.value_or(OrderFit{});
      Row row;
      row.add(scene.name).add(c.axis).add(c.at);
      row.add_if(c.fit.has_value(), fit.order).add_if(c.fit.has_value(), fit.standard_error);
      text += row.add_if(c.fit.has_value(), fit.points).add(c.why_not).line();
    }
  return text;
}

}  // namespace nepho::bench
