#include "bench/page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/pareto.h"
#include "bench/text.h"
#include "image/difference.h"
#include "image/flip.h"

namespace nepho::bench {
namespace {

// All settings have their pictures up to so many; of more, those on the front.
constexpr std::size_t kPictures = 12;

constexpr const char* kStyle = R"(
body { font: 15px/1.45 Helvetica, Arial, sans-serif; color: #1b1b1b; background: #f4f4f2; margin: 0; }
main { max-width: 1180px; margin: 0 auto; padding: 24px; }
section { background: #fff; border: 1px solid #ddd; border-radius: 6px; padding: 8px 24px 20px; margin: 24px 0; }
h1 { font-size: 26px; margin: 8px 0; } h2 { font-size: 21px; } h3 { font-size: 16px; margin-top: 26px; }
.facts, figcaption, .note { color: #555; font-size: 13px; } code { font-size: 13px; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: 13px; }
th, td { padding: 4px 9px; text-align: right; white-space: nowrap; border-bottom: 1px solid #e6e6e6; }
th { vertical-align: bottom; background: #fafafa; } tr.best td { font-weight: bold; }
td.share { background: linear-gradient(to right, #cfe3f3 var(--part), transparent var(--part)); }
td.held { color: #888; } .pictures { display: flex; flex-wrap: wrap; gap: 14px; }
figure { margin: 0; } figure img { width: 260px; display: block; image-rendering: pixelated; background: #000; }
figure .pair { display: flex; gap: 4px; } svg { max-width: 100%; height: auto; }
)";

class Page {
 public:
  explicit Page(const PngOf& png_of) : png_of_(png_of) {}

  void section(const SceneResult& scene, std::size_t number);
  std::string take() { return std::move(out_); }

 private:
  void add(const std::string& text) { out_ += text; }
  void paragraph(const char* kind, const std::string& words) {
    add("<p class=\"" + std::string(kind) + "\">" + xml_text(words) + "</p>\n");
  }
  void facts(const SceneResult& scene);
  void table(const SceneResult& scene, const std::vector<std::size_t>& front);
  void row(const SceneResult& scene, const SettingResult& s, bool best);
  void share(const Term* term, double low, double high);
  void fits(const SceneResult& scene);
  void data(const SceneResult& scene);
  void pictures(const SceneResult& scene, const std::vector<std::size_t>& front);
  void image(const ByteImage& image, const std::string& what);

  const PngOf& png_of_;
  std::string out_;
};

std::string with_quartiles(const Spread& spread) {
  return time_text(spread.median) + " (" + time_text(spread.low) + " to " + time_text(spread.high) +
         ")";
}

void Page::facts(const SceneResult& scene) {
  std::string text = std::to_string(scene.reference.width) + "x" +
                     std::to_string(scene.reference.height) + " pixels on " + scene.device +
                     ". Finest bricks: " + scene.finest + ".";
  if (scene.paths)
    text += " Truth: " + std::to_string(scene.paths) + " paths a pixel, noise " +
            percent_text(scene.noise) + " (taken out of the errors).";
  else
    text += " No paths were traced: the light model's error is not known.";
  text += " Times are medians of " + std::to_string(scene.settings.front().times.frame_s.runs) +
          " runs after a warm-up, in process CPU time over all threads";
  text += scene.no_gpu_clock.empty() ? ", and by the GPU's own clock."
                                     : "; no GPU time: " + scene.no_gpu_clock + ".";
  paragraph("facts", text);
}

// On a logarithmic scale of the whole table: the bar behind a number.
void Page::share(const Term* term, double low, double high) {
  if (!term) return add("<td class=\"held\">not asked for</td>");
  if (!term->told()) {
    const std::string words =
        term->below > 0 ? "&lt; " + xml_text(percent_text(term->below)) : std::string("withheld");
    return add("<td class=\"held\" title=\"" + xml_text(term->withheld) + "\">" + words + "</td>");
  }
  double part = 0;
  if (term->rms > 0 && high > low) part = std::log(term->rms / low) / std::log(high / low);
  char cell[80];
  std::snprintf(cell, sizeof cell, "<td class=\"share\" style=\"--part: %.0f%%\">",
                100 * std::clamp(part, 0.0, 1.0));
  add(cell + xml_text(percent_text(term->rms)) + "</td>");
}

void Page::row(const SceneResult& scene, const SettingResult& s, bool best) {
  double low = INFINITY, high = 0;
  for (const SettingResult& other : scene.settings)
    for (const Term& term : other.terms)
      if (term.told() && term.rms > 1e-5) {
        low = std::min(low, term.rms);
        high = std::max(high, term.rms);
      }
  add(best ? "<tr class=\"best\">" : "<tr>");
  for (const auto& [name, value] : s.setting.values) add("<td>" + xml_text(value) + "</td>");
  if (s.setting.values.empty()) add("<td>as the scene says</td>");
  if (scene.no_gpu_clock.empty() && s.times.gpu_frame_s)
    add("<td>" + xml_text(with_quartiles(*s.times.gpu_frame_s)) + "</td>");
  else if (scene.no_gpu_clock.empty())
    add("<td class=\"held\">the clock gave none</td>");
  add("<td>" + xml_text(with_quartiles(s.times.frame_s)) + "</td>");
  add("<td>" + xml_text(time_text(s.times.light_s.median)) + "</td>");
  add("<td>" + xml_text(time_text(s.times.view_s.median)) + "</td>");
  add("<td>" + std::to_string(s.bricks) + "</td>");
  for (const char* name : {kTotal, kMarch, kLightModel, kLevelOfDetail, kIntegration, kSteps,
                           kLightCache, kQuantisation, kData})
    share(find_term(s.terms, name), low, high);
  const Term* judged = find_term(s.terms, judged_by(scene.settings));
  for (const double value :
       {judged->bias, judged->relative_mse, judged->rmse_8bit, judged->flip_mean}) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    add("<td>" + (judged->told() ? std::string(text) : "withheld") + "</td>");
  }
  add("</tr>\n");
}

void Page::table(const SceneResult& scene, const std::vector<std::size_t>& front) {
  add("<h3>Settings, times and errors</h3>\n<div class=\"wide\"><table>\n<thead><tr>");
  for (const auto& [name, value] : scene.settings.front().setting.values)
    add("<th>" + xml_text(name) + "<br/>" + xml_text(unit_of(name)) + "</th>");
  if (scene.settings.front().setting.values.empty()) add("<th>setting</th>");
  if (scene.no_gpu_clock.empty()) add("<th>frame, GPU<br/>median (quartiles)</th>");
  add("<th>frame, CPU<br/>median (quartiles)</th><th>of it<br/>light</th><th>of it<br/>view</th>"
      "<th>bricks</th>");
  for (const char* name :
       {"total", "all but<br/>light model", "light<br/>model", "level of<br/>detail", "integration",
        "of it<br/>steps", "of it<br/>light cache", "quantisation", "data"})
    add("<th>" + std::string(name) + "</th>");
  add("<th>bias</th><th>relative<br/>MSE</th><th>RMSE<br/>8 bit</th><th>FLIP<br/>mean</th>");
  add("</tr></thead>\n<tbody>\n");
  for (std::size_t i = 0; i < scene.settings.size(); ++i)
    row(scene, scene.settings[i], std::ranges::find(front, i) != front.end());
  add("</tbody></table></div>\n");
  paragraph("note",
            std::string("Errors are the rms of luminance over its mean, where there is cloud (over "
                        "a planet: everywhere). Bold: on the front. Grey, below: the number would "
                        "not be five times what its reference is known to; why is under the mouse. "
                        "Data: the finest bricks against the sources' own fields, both marched; no "
                        "part of the total. "
                        "The last four columns are of ") +
                (std::string(judged_by(scene.settings)) == kTotal ? "the total"
                                                                  : "all but the light model") +
                ", over all pixels.");
}

void Page::fits(const SceneResult& scene) {
  if (scene.convergence.empty()) return;
  add("<h3>Order of convergence</h3>\n<ul>\n");
  for (const Convergence& c : scene.convergence) {
    std::string text =
        "error of steps against " + c.axis + (c.at.empty() ? "" : ", " + c.at) + ": ";
    if (c.fit) {
      char line[120];
      std::snprintf(line, sizeof line, "order %.2f, standard error %.2f, from %d points",
                    c.fit->order, c.fit->standard_error, c.fit->points);
      text += line;
    } else {
      text += "not fitted: " + c.why_not;
    }
    add("<li>" + xml_text(text) + "</li>\n");
  }
  add("</ul>\n");
}

void Page::data(const SceneResult& scene) {
  add("<h3>Data: extinction of the source's own field against its finest bricks</h3>\n<ul>\n");
  for (const VolumeDataError& d : scene.data) {
    char line[200];
    if (d.error)
      std::snprintf(line, sizeof line,
                    ": extinction is off by %.3g 1/m rms, %.2g %% of the field's rms, at %d points",
                    d.error->rms_per_m, 100 * d.error->rms_per_m / d.error->field_rms_per_m,
                    d.error->points);
    else
      std::snprintf(line, sizeof line, ": the source has no field of its own to compare with");
    add("<li>" + xml_text(d.volume + line) + "</li>\n");
  }
  add("</ul>\n");
}

void Page::image(const ByteImage& image, const std::string& what) {
  add("<img src=\"data:image/png;base64," + base64(png_of_(image)) + "\" alt=\"" + xml_text(what) +
      "\"/>");
}

void Page::pictures(const SceneResult& scene, const std::vector<std::size_t>& front) {
  const ByteImage reference = shown(scene.display, scene.reference);
  if (png_of_(reference).empty())
    return paragraph("note",
                     "This build writes no PNG pictures (OpenImageIO), so there are none here.");
  std::vector<std::size_t> which = front;
  if (scene.settings.size() <= kPictures) {
    which.clear();
    for (std::size_t i = 0; i < scene.settings.size(); ++i) which.push_back(i);
  }
  std::vector<ByteImage> pictures;
  std::vector<FloatImage> maps;
  double largest = 0;
  for (const std::size_t i : which) {
    pictures.push_back(shown(scene.display, scene.settings[i].picture));
    maps.push_back(flip_map(pictures.back(), reference));
    largest = std::max(largest, largest_of(maps.back()));
  }
  FloatImage scale(1, 1, 1);
  scale.values[0] = float(largest);
  const double full = round_scale(scale);
  char text[120];
  std::snprintf(text, sizeof text, "; maps of FLIP from 0 (black) to %g (pale yellow)", full);
  add("<h3>Pictures</h3>\n");
  paragraph("note", std::string("Against ") +
                        (scene.reference_is_truth ? "the path traced truth"
                                                  : "the march on the finest bricks") +
                        text + ".");
  add("<div class=\"pictures\">\n<figure>");
  image(reference, scene.name + ", reference");
  add("<figcaption>reference</figcaption></figure>\n");
  for (std::size_t n = 0; n < which.size(); ++n) {
    const std::string label = scene.settings[which[n]].setting.label();
    add("<figure><div class=\"pair\">");
    image(pictures[n], scene.name + ", " + label);
    image(error_colours(maps[n], full), "difference, " + label);
    add("</div><figcaption>" + xml_text(label) + "</figcaption></figure>\n");
  }
  add("</div>\n");
}

void Page::section(const SceneResult& scene, std::size_t number) {
  add("<section id=\"scene" + std::to_string(number) + "\">\n<h2>" + xml_text(scene.name) +
      "</h2>\n");
  facts(scene);
  const std::optional<Pareto> pareto = pareto_of(scene);
  if (pareto) {
    add(svg_of(pareto->chart));
    paragraph("lesson", lesson_of(scene, *pareto));
  }
  const std::vector<std::size_t> front = pareto ? pareto->front : std::vector<std::size_t>();
  table(scene, front);
  fits(scene);
  data(scene);
  pictures(scene, front);
  add("</section>\n");
}

}  // namespace

std::string page_of(const std::vector<SceneResult>& scenes, const std::string& command,
                    const PngOf& png_of) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n"
      "<head><meta charset=\"utf-8\"/><title>Nephoscope bench</title>\n<style>" +
      std::string(kStyle) + "</style></head>\n<body><main>\n";
  out += "<h1>Error against run time</h1>\n<p class=\"facts\"><code>" + xml_text(command) +
         "</code></p>\n";
  if (scenes.size() > 1) {
    out += "<ul>\n";
    for (std::size_t i = 0; i < scenes.size(); ++i)
      out += "<li><a href=\"#scene" + std::to_string(i) + "\">" + xml_text(scenes[i].name) +
             "</a></li>\n";
    out += "</ul>\n";
  }
  Page page(png_of);
  for (std::size_t i = 0; i < scenes.size(); ++i) page.section(scenes[i], i);
  return out + page.take() + "</main></body>\n</html>\n";
}

}  // namespace nepho::bench
