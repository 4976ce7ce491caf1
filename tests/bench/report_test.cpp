// The report of made-up results: read back, and checked as XML.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "bench/csv.h"
#include "bench/markdown.h"
#include "bench/page.h"
#include "bench/pareto.h"
#include "bench/text.h"

namespace nepho::bench {
namespace {

HdrImage grey(double level) {
  return {8, 4, std::vector<float>(3 * 8 * 4, float(level)), std::vector<float>(8 * 4, 1.0f)};
}

// Two by three settings; the errors fall with the step and with the budget.
SceneResult made(const std::string& name) {
  SceneResult scene{.name = name};
  scene.device = "a <device> & more";
  scene.no_gpu_clock = "there is none";
  scene.finest = "all levels";
  scene.paths = 64;
  scene.noise = 0.01;
  scene.reference = grey(0.5);
  const std::vector<Axis> axes{parse_axis("step=0.5,1"), parse_axis("budget-mib=8,16,32")};
  for (const Setting& setting : combinations(axes)) {
    const double step = *setting.number("step"), budget = *setting.number("budget-mib");
    SettingResult s{.setting = setting};
    const double time_s = budget / step;
    s.times.frame_s = {time_s, 0.9 * time_s, 1.2 * time_s, 5};
    s.times.light_s = s.times.view_s = {time_s / 2, time_s / 2, time_s / 2, 5};
    s.bricks = std::uint64_t(10 * budget);
    s.picture = grey(0.5 + 0.01 * step);
    for (const char* term : {kTotal, kMarch, kIntegration, kSteps, kLightCache, kLevelOfDetail,
                             kLightModel, kQuantisation}) {
      Term t{.name = term};
      t.rms = term == std::string(kLightModel) ? 0.5 : 0.01 * step * step + 0.1 / budget;
      s.terms.push_back(t);
    }
    s.terms[7].withheld = "a \"reason\", with a comma";
    s.terms[7].below = 0.25;
    scene.settings.push_back(s);
  }
  scene.convergence.push_back({"step", "budget-mib 8", OrderFit{2, 0.1, 3}, ""});
  scene.convergence.push_back({"step", "budget-mib 16", {}, "too few < 3"});
  scene.data.push_back({"volume & co", {}});
  return scene;
}

using Table = std::vector<std::vector<std::string>>;
// RFC 4180; throws where a quote is out of place.
Table parse_csv(const std::string& text) {
  Table table(1);
  std::string field;
  bool quoted = false, was_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') {
        field += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        field += c;
        ++i;
      } else {
        quoted = false;
        was_quoted = true;
      }
    } else if (c == '"') {
      if (!field.empty() || was_quoted) throw std::runtime_error("a quote inside a field");
      quoted = true;
    } else if (c == ',' || c == '\n') {
      table.back().push_back(field);
      field.clear();
      was_quoted = false;
      if (c == '\n') table.emplace_back();
    } else {
      field += c;
    }
  }
  if (quoted || !table.back().empty()) throw std::runtime_error("no end of the last line");
  table.pop_back();
  return table;
}
std::size_t column(const Table& table, const std::string& name) {
  for (std::size_t c = 0; c < table[0].size(); ++c)
    if (table[0][c] == name) return c;
  throw std::runtime_error("no column " + name);
}

TEST(Report, csv_of_settings_is_read_back) {
  const std::vector<SceneResult> scenes{made("one, \"two\""), made("three")};
  const Table table = parse_csv(settings_csv(scenes));
  ASSERT_EQ(table.size(), 1 + 2 * 6u);
  for (const auto& row : table) ASSERT_EQ(row.size(), table[0].size());
  EXPECT_EQ(table[1][0], "one, \"two\"");
  std::size_t line = 1;
  for (const SceneResult& scene : scenes)
    for (const SettingResult& s : scene.settings) {
      const auto& row = table[line++];
      EXPECT_EQ(row[0], scene.name);
      EXPECT_EQ(std::stod(row[column(table, "step [voxels]")]), *s.setting.number("step"));
      EXPECT_EQ(std::stod(row[column(table, "budget-mib [MiB]")]), *s.setting.number("budget-mib"));
      EXPECT_NEAR(std::stod(row[column(table, "frame median [s]")]), s.times.frame_s.median, 1e-5);
      EXPECT_EQ(row[column(table, "gpu frame median [s]")], "");
      EXPECT_NEAR(std::stod(row[column(table, "march rms [1]")]), s.terms[1].rms, 1e-6);
      EXPECT_EQ(row[column(table, "quantisation rms [1]")], "");  // withheld
    }
  // Every number says its unit.
  for (std::size_t c = 1; c < table[0].size(); ++c)
    EXPECT_NE(table[0][c].find(" ["), std::string::npos) << table[0][c];
}

TEST(Report, csv_of_terms_says_why_a_number_is_missing) {
  const std::vector<SceneResult> scenes{made("one")};
  const Table table = parse_csv(terms_csv(scenes));
  ASSERT_EQ(table.size(), 1 + 6 * 8u + 1);
  EXPECT_EQ(table.back()[column(table, "term")], "data: volume & co");
  for (const auto& row : table) {
    ASSERT_EQ(row.size(), table[0].size());
    if (row[column(table, "term")] != kQuantisation) continue;
    EXPECT_EQ(row[column(table, "rms [1]")], "");
    EXPECT_EQ(row[column(table, "not above [1]")], "0.25");
    EXPECT_EQ(row[column(table, "withheld")], "a \"reason\", with a comma");
  }
}

TEST(Report, csv_of_orders_is_read_back) {
  const Table table = parse_csv(orders_csv({made("one")}));
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[1],
            (std::vector<std::string>{"one", "step", "budget-mib 8", "2", "0.1", "3", ""}));
  EXPECT_EQ(table[2][column(table, "order [1]")], "");
  EXPECT_EQ(table[2][column(table, "not fitted")], "too few < 3");
}

TEST(Report, the_front_is_what_nothing_beats) {
  std::vector<ChartPoint> points;
  for (const auto& [x, y] :
       {std::pair{3.0, 1.0}, std::pair{1.0, 4.0}, std::pair{2.0, 4.0}, std::pair{2.0, 2.0},
        std::pair{1.0, 5.0}, std::pair{4.0, 1.0}, std::pair{2.0, 2.0}})
    points.push_back({.x = x, .y = y});
  EXPECT_EQ(front_of(points), (std::vector<std::size_t>{1, 3, 0}));
}

TEST(Report, ticks_are_round_and_within) {
  for (const auto& [low, high] :
       {std::pair{0.012, 0.9}, std::pair{1e-6, 3.0}, std::pair{0.05, 0.11}, std::pair{2.1, 2.4},
        std::pair{9.0, 21.0}}) {
    const std::vector<double> ticks = log_ticks(low, high);
    ASSERT_GE(ticks.size(), 2u) << low;
    EXPECT_LE(ticks.size(), 16u) << low;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      EXPECT_GE(ticks[i], low);
      EXPECT_LE(ticks[i], high);
      EXPECT_GT(ticks[i], i ? ticks[i - 1] : 0);
    }
  }
}

TEST(Report, a_chart_off_its_axes_is_a_mistake) {
  Chart chart;
  EXPECT_THROW(svg_of(chart), std::invalid_argument);
  chart.points.push_back({.x = 1, .y = 0});
  EXPECT_THROW(svg_of(chart), std::invalid_argument);
  chart.points[0].y = 0.1;
  EXPECT_NE(svg_of(chart).find("<circle"), std::string::npos);
}

TEST(Report, the_chart_holds_every_setting_and_the_light_model) {
  const SceneResult scene = made("one");
  const auto pareto = pareto_of(scene);
  ASSERT_TRUE(pareto);
  EXPECT_EQ(pareto->chart.points.size(), 6u);
  EXPECT_EQ(pareto->chart.series, (std::vector<std::string>{"0.5", "1"}));
  EXPECT_EQ(pareto->chart.points[2].label, "32");
  ASSERT_EQ(pareto->chart.levels.size(), 1u);
  EXPECT_EQ(pareto->chart.levels[0].y, 0.5);
  // step 1 with 8, the cheapest, comes first.
  EXPECT_EQ(pareto->front.front(), 3u);
  EXPECT_NE(lesson_of(scene, *pareto).find("The light model adds 50 %"), std::string::npos);
}

TEST(Report, an_axis_of_one_value_is_no_axis_of_the_chart) {
  SceneResult scene = made("one");
  std::erase_if(scene.settings,
                [](const SettingResult& s) { return s.setting.value("step") != "1"; });
  EXPECT_EQ(scene.varied(), (std::vector<std::string>{"budget-mib"}));
  const auto pareto = pareto_of(scene);
  EXPECT_TRUE(pareto->chart.series.empty());
  EXPECT_EQ(pareto->chart.points[0].label, "8");
  const std::string table = markdown_of(scene);
  EXPECT_EQ(table.find("step"), table.find("steps"));  // the term, not the setting
  EXPECT_NE(table.find("| 8 | 8 s |"), std::string::npos) << table;
  EXPECT_EQ(std::ranges::count(table, '\n'), 7);
  EXPECT_NE(table.find("\n8x4 pixels; finest bricks: all levels; 64 paths a pixel, noise 1.0 %.\n"),
            std::string::npos)
      << table;
}

TEST(Report, the_table_says_why_a_number_is_missing) {
  SceneResult scene = made("one");
  for (SettingResult& s : scene.settings) {
    s.terms.push_back({.name = kData, .withheld = "no field"});
    for (Term& term : s.terms)
      if (term.name == kLightModel) term.withheld = "no field";
  }
  const std::string table = markdown_of(scene);
  EXPECT_NE(table.find(" Not told, light model, data: no field.\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("no field"), table.rfind("no field"));
  // Of a term that no column shows nothing is said.
  EXPECT_EQ(table.find("a \"reason\""), std::string::npos);
}

TEST(Report, withheld_points_are_not_drawn) {
  SceneResult scene = made("one");
  scene.settings[2].terms[1].withheld = "noise";
  EXPECT_EQ(pareto_of(scene)->chart.points.size(), 5u);
  EXPECT_NE(pareto_of(scene)->chart.subtitle.find("1 withheld"), std::string::npos);
  for (SettingResult& s : scene.settings) s.terms[1].withheld = "noise";
  EXPECT_FALSE(pareto_of(scene));
  // The page goes on without it.
  EXPECT_NE(page_of({scene}, "", [](const ByteImage&) { return std::string(); }).find("noise"),
            std::string::npos);
}

TEST(Report, base64_is_that_of_its_rfc) {
  for (const auto& [bytes, text] :
       {std::pair{"", ""}, std::pair{"f", "Zg=="}, std::pair{"fo", "Zm8="},
        std::pair{"foo", "Zm9v"}, std::pair{"foob", "Zm9vYg=="}, std::pair{"fooba", "Zm9vYmE="},
        std::pair{"foobar", "Zm9vYmFy"}})
    EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Report, numbers_have_two_digits) {
  EXPECT_EQ(percent_text(0.0123), "1.2 %");
  EXPECT_EQ(percent_text(0.354), "35 %");
  EXPECT_EQ(percent_text(3.54), "354 %");
  EXPECT_EQ(percent_text(0.00004), "0.0040 %");
  EXPECT_EQ(percent_text(0), "0 %");
  EXPECT_EQ(time_text(0.01234), "12.3 ms");
  EXPECT_EQ(time_text(2.5), "2.5 s");
}

// Tags that open and close in order, attributes in quotes, no stray & or <. Empty: well-formed.
std::string fault_of_xml(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '&') {
      const std::size_t end = text.find(';', i);
      if (end == std::string::npos || end - i > 6) return "a bare & at " + std::to_string(i);
    }
    if (text[i] == '>') return "a bare > at " + std::to_string(i);
    if (text[i] != '<') continue;
    const std::size_t end = text.find('>', i);
    if (end == std::string::npos) return "a tag without its end";
    const std::string tag = text.substr(i + 1, end - i - 1);
    i = end;
    if (tag.starts_with('!')) continue;
    if (tag.find('<') != std::string::npos) return "a < in the tag " + tag;
    if (std::ranges::count(tag, '"') % 2) return "an odd quote in the tag " + tag;
    const std::string name = tag.substr(0, tag.find_first_of(" /\n", 1));
    if (tag.starts_with('/')) {
      if (open.empty() || "/" + open.back() != tag) return "closes what is not open: " + tag;
      open.pop_back();
    } else if (!tag.ends_with('/')) {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "never closed: " + open.back();
}

void expect_xml(const std::string& text, const char* name) {
  EXPECT_EQ(fault_of_xml(text), "");
#ifdef NEPHO_XMLLINT
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string(name) + std::to_string(std::rand()) + ".xml");
  std::ofstream(file) << text;
  const std::string command = std::string(NEPHO_XMLLINT) + " --noout " + file.string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::filesystem::remove(file);
#else
  (void)name;
#endif
}

TEST(Report, page_and_chart_are_well_formed_and_need_no_network) {
  const std::vector<SceneResult> scenes{made("one <b>&\""), made("two")};
  int pictures = 0;
  const std::string page = page_of(scenes, "nephoscope bench <one> && more", [&](const ByteImage&) {
    ++pictures;
    return std::string("PNG");
  });
  expect_xml(page, "nepho-page");
  expect_xml(svg_of(pareto_of(scenes[0])->chart), "nepho-chart");
  // A reference, six settings and their maps, for each scene.
  std::size_t images = 0;
  for (std::size_t at = page.find("<img"); at != std::string::npos; at = page.find("<img", at + 1))
    ++images;
  EXPECT_EQ(images, 2 * 13u);
  for (const char* outside : {"src=\"http", "href=\"http", "url(", "<script", "@import", "<link"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_NE(page.find("order 2.00, standard error 0.10, from 3 points"), std::string::npos);
  EXPECT_NE(page.find("not fitted: too few &lt; 3"), std::string::npos);
  EXPECT_NE(page.find("&lt; 25 %"), std::string::npos);
  // The check can fail.
  EXPECT_NE(fault_of_xml("<a><b></a></b>"), "");
  EXPECT_NE(fault_of_xml("<a>1 & 2</a>"), "");
}

TEST(Report, without_png_the_page_says_so) {
  const std::string page =
      page_of({made("one")}, "", [](const ByteImage&) { return std::string(); });
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_NE(page.find("writes no PNG"), std::string::npos);
}

}  // namespace
}  // namespace nepho::bench
