#include "reference/light_model_table.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <vector>

#include "accuracy_report.h"

namespace nepho {
namespace {

struct TruthRow {
  SlabView view;
  double radiance;
};

std::vector<TruthRow> truth() {
  std::ifstream table(NEPHO_TRUTH_DIR "/slab_radiance_g085.csv");
  std::vector<TruthRow> rows;
  std::string line;
  while (std::getline(table, line)) {
    double tau, mu0, mu, dphi_deg, up, down;
    char comma;
    std::istringstream row(line);
    if (!(row >> tau >> comma >> mu0 >> comma >> mu >> comma >> dphi_deg >> comma >> up >> comma >>
          down))
      continue;
    const double across =
        std::sqrt((1 - mu * mu) * (1 - mu0 * mu0)) * std::cos(dphi_deg * std::numbers::pi / 180);
    rows.push_back({{tau, mu0, mu, 1 - (across - mu * mu0), true}, up});
    rows.push_back({{tau, mu0, mu, 1 - (across + mu * mu0), false}, down});
  }
  return rows;
}

std::array<LightModelRow, kTableOctaves> measure() {
  struct Sums {
    double squares = 0, truth = 0;
    int count = 0;
  };
  std::array<std::array<std::array<Sums, 3>, 6>, kTableOctaves> sums{};
  for (const TruthRow& row : truth())
    for (int n = 1; n <= kTableOctaves; ++n) {
      const double error = slab_radiance(row.view, n, 0.85) - row.radiance;
      Sums& s = sums[std::size_t(n - 1)][std::size_t(view_depth_bin(row.view.tau / row.view.mu))]
                    [std::size_t(scattering_angle_bin(row.view.one_minus_cos))];
      s.squares += error * error;
      s.truth += row.radiance;
      ++s.count;
    }
  std::array<LightModelRow, kTableOctaves> table{};
  for (std::size_t n = 0; n < kTableOctaves; ++n)
    for (std::size_t d = 0; d < 6; ++d)
      for (std::size_t a = 0; a < 3; ++a) {
        const Sums& s = sums[n][d][a];
        EXPECT_GE(s.count, 3) << "bin " << d << " " << a;
        table[n][d][a] = std::sqrt(s.squares / s.count) / (s.truth / s.count);
      }
  return table;
}

// Writes render/reference/light_model_table.inc where NEPHO_WRITE_LIGHT_MODEL_TABLE names it.
void write(const char* path, const std::array<LightModelRow, kTableOctaves>& table) {
  std::ofstream out(path);
  out << "// Written by tests/reference/light_model_test.cpp: one block per number of octaves, "
         "one\n"
         "// row per bin of view optical depth, columns by scattering angle.\n";
  for (const LightModelRow& block : table) {
    out << "{{";
    for (const auto& row : block) {
      char text[64];
      std::snprintf(text, sizeof text, "%.4f, %.4f, %.4f", row[0], row[1], row[2]);
      out << (&row == &block.front() ? "{{" : "  {{") << text << "}}"
          << (&row == &block.back() ? "" : ",\n");
    }
    out << "}},\n";
  }
}

TEST(LightModel, TableIsWhatSlabsShow) {
  const auto table = measure();
  if (const char* path = std::getenv("NEPHO_WRITE_LIGHT_MODEL_TABLE")) write(path, table);
  for (std::size_t n = 0; n < kTableOctaves; ++n)
    for (std::size_t d = 0; d < 6; ++d)
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(light_model_row(int(n) + 1)[d][a], table[n][d][a], 1e-4 + 1e-3 * table[n][d][a])
            << n << " " << d << " " << a;
}

TEST(LightModel, ThinSlabsAreSingleScattering) {
  // In the limit of no optical depth nothing is missing: the truth's own deviation at 0.1 is what
  // single scattering loses (0.52 .. 0.81 of the light is scattered once).
  double least = 1e9, most = 0;
  for (const TruthRow& row : truth()) {
    if (row.view.tau != 0.1 || row.view.mu0 < 0.19) continue;
    const double ratio = slab_radiance(row.view, 1, 0.85) / row.radiance;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  EXPECT_LT(most, 1.0);
  EXPECT_GT(least, 0.4);
}

TEST(LightModel, MoreOctavesAreNearerOnThickSlabs) {
  const auto thick_error = [](int octaves) { return light_model_error(octaves, 50, 1.5); };
  EXPECT_GT(thick_error(1), thick_error(3));
  EXPECT_GT(thick_error(3), thick_error(8));
  EXPECT_EQ(thick_error(8), thick_error(20));
  test::report_accuracy("light model", "8 octaves on slabs, view optical depth > 8, backward",
                        thick_error(8), 1.0, "relative rms");
}

}  // namespace
}  // namespace nepho
