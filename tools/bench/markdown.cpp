#include "bench/markdown.h"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "bench/text.h"
#include "image/difference.h"

namespace nepho::bench {
namespace {

constexpr const char* kParts[] = {kMarch, kSteps, kLightCache, kLevelOfDetail, kLightModel, kData};

std::string cell(const Term* term) {
  if (!term) return " |";
  if (term->told()) return " " + percent_text(term->rms) + " |";
  return term->below > 0 ? " < " + percent_text(term->below) + " |" : " withheld |";
}

std::string levels(double rmse) {
  char text[32];
  std::snprintf(text, sizeof text, " %.3g |", rmse);
  return text;
}

// Each reason once, with the terms that it holds for.
std::string missing(const SceneResult& scene) {
  std::vector<std::pair<std::string, std::string>> reasons;  // and the terms
  for (const char* part : kParts)
    for (const SettingResult& s : scene.settings) {
      const Term* term = find_term(s.terms, part);
      if (!term || term->told()) continue;
      const auto known =
          std::ranges::find(reasons, term->withheld, &std::pair<std::string, std::string>::first);
      if (known == reasons.end())
        reasons.emplace_back(term->withheld, part);
      else if (known->second.find(part) == std::string::npos)
        known->second += std::string(", ") + part;
    }
  std::string text;
  for (const auto& [why, terms] : reasons) text += " Not told, " + terms + ": " + why + ".";
  return text;
}

std::string references_of(const SceneResult& scene) {
  std::string text = std::to_string(scene.reference.width) + "x" +
                     std::to_string(scene.reference.height) +
                     " pixels; finest bricks: " + scene.finest;
  if (scene.paths)
    text +=
        "; " + std::to_string(scene.paths) + " paths a pixel, noise " + percent_text(scene.noise);
  return text + ".";
}

}  // namespace

std::string markdown_of(const SceneResult& scene) {
  std::string text = "|", rule = "|";
  const auto column = [&](const std::string& name) {
    text += " " + name + " |";
    rule += "---|";
  };
  const SettingResult& first = scene.settings.front();
  const std::vector<std::string> axes = scene.varied();
  for (const std::string& name : axes)
    column(name + (unit_of(name).empty() ? "" : ", " + unit_of(name)));
  column("frame, CPU");
  column("bricks");
  column("RMSE to the first");
  column("RMSE to the finest");
  for (const char* part : kParts)
    column(part == std::string(kMarch) ? "all but light model" : part);
  text += "\n" + rule + "\n";
  const ByteImage first_shown = shown(scene.display, first.picture);
  for (const SettingResult& s : scene.settings) {
    text += "|";
    for (const std::string& name : axes) text += " " + s.setting.value(name) + " |";
    text += " " + time_text(s.times.frame_s.median) + " | " + std::to_string(s.bricks) + " |";
    text += levels(byte_difference(shown(scene.display, s.picture), first_shown).rmse);
    const Term* march = find_term(s.terms, kMarch);
    text += march->told() ? levels(march->rmse_8bit) : " withheld |";
    for (const char* part : kParts) text += cell(find_term(s.terms, part));
    text += "\n";
  }
  text += "\n" + references_of(scene) + missing(scene) + "\n";
  return text;
}

}  // namespace nepho::bench
