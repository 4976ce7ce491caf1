// What the source says and assumes: scale, axes, sequences, counts.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <set>

#include "core/log.h"
#include "vdb_files.h"

namespace nepho::test {
namespace {

// Optical depth along local z over columns with active voxels, from the made field itself.
double mean_depth(const samples::SampleGrid& grid, std::size_t up, double rise_m) {
  double sum = 0;
  std::set<std::pair<int, int>> columns;
  for (const auto& block : grid.blocks)
    for (int at = 0; at < 512; ++at) {
      if (block.values[std::size_t(at)] == 0) continue;
      const std::array<int, 3> v = {block.origin[0] + at % 8, block.origin[1] + at / 8 % 8,
                                    block.origin[2] + at / 64};
      sum += block.values[std::size_t(at)];
      columns.insert({v[(up + 1) % 3], v[(up + 2) % 3]});
    }
  return sum * rise_m / double(columns.size());
}

double brightest(const BrickSource& source, double time_s) {
  double most = 0;
  descend(source, time_s, [&](NodeKey key, const NodeSummary&) {
    if (key.level() == source.info().lattice.max_level())
      for (const double value : read(source, key, time_s).samples) most = std::max(most, value);
  });
  return most;
}

double brightest_made() {
  double most = 0;
  for (const auto& block : samples::puff_grid().blocks)
    for (const double value : block.values) most = std::max(most, value);
  return most;
}

TEST(Scale, DefaultMakesTheMeanOpticalDepthTen) {
  for (const bool is_z : {false, true}) {
    const auto source = open(twin("non_uniform"), {word("up", is_z ? "z" : "y")});
    const double rise_m = is_z ? 0.1317 : 0.1329;
    const double expected = 10 / mean_depth(samples::puff_grid(), is_z ? 2 : 1, rise_m);
    const double found = brightest(*source, 0) / brightest_made();
    std::printf("measured: default scale %.8g 1/m, expected %.8g 1/m\n", found, expected);
    EXPECT_NEAR(found / expected, 1, 1e-6);
    EXPECT_TRUE(any_contains(source->info().assumptions, "mean optical depth along up is 10"));
  }
}

// A tile's columns are counted, not walked: 4096^2 of them.
TEST(Scale, CountsTileColumns) {
  const auto source = open(twin("huge_tile"));
  NodeSummary top = summary(*source, NodeKey(0, 0, 0, 0, 0), 0);
  EXPECT_NEAR(top.max_extinction_per_m, 10.0 / 4096, 1e-8);
  EXPECT_TRUE(any_contains(source->info().assumptions, "1.67772e+07 columns"));
}

TEST(Scale, IsWhatIsAskedFor) {
  const auto source = open(twin("plain"), {number("density_scale", 0.5)});
  EXPECT_NEAR(brightest(*source, 0), 0.5 * brightest_made(), 1e-6);
  EXPECT_FALSE(any_contains(source->info().assumptions, "optical depth"));
}

TEST(Axes, UpIsYUnlessBlenderOrTold) {
  const auto up_row = [](const std::unique_ptr<BrickSource>& source) {
    const Chart& chart = *source->info().chart;
    const glm::dvec3 low = chart.ecef_m({0, {0, 0, 0}});
    // which index axis rises
    for (int a = 0; a < 3; ++a) {
      glm::dvec3 q(0.0);
      q[a] = 1;
      if ((chart.ecef_m({0, q}) - low).z > 1) return a;
    }
    return -1;
  };
  EXPECT_EQ(up_row(open(twin("plain"))), 1);
  EXPECT_EQ(up_row(open(twin("blender"))), 2);
  EXPECT_EQ(up_row(open(twin("plain"), {word("up", "z")})), 2);
  EXPECT_EQ(up_row(open(twin("blender"), {word("up", "y")})), 1);
  EXPECT_TRUE(any_contains(open(twin("plain"))->info().assumptions, "Up is the y axis"));
  EXPECT_TRUE(any_contains(open(twin("blender"))->info().assumptions, "Blender"));
  EXPECT_TRUE(any_contains(open(twin("plain"))->info().assumptions, "1 unit of the file is 1 m"));
}

TEST(Lattice, IsTheFilesOwn) {
  const auto source = open(twin("plain"), {number("metres_per_unit", 2), word("up", "z")});
  const VolumeInfo& info = source->info();
  // The grid's own lowest and highest voxels say where the lattice must lie.
  std::array<int, 3> low{99, 99, 99}, high{-99, -99, -99};
  for (const auto& block : samples::puff_grid().blocks)
    for (int at = 0; at < 512; ++at) {
      if (block.values[std::size_t(at)] == 0) continue;
      const std::array<int, 3> v = {block.origin[0] + at % 8, block.origin[1] + at / 8 % 8,
                                    block.origin[2] + at / 64};
      for (std::size_t a = 0; a < 3; ++a)
        low[a] = std::min(low[a], v[a]), high[a] = std::max(high[a], v[a]);
    }
  ASSERT_EQ(info.lattice.cells(info.lattice.max_level())[0], 64u);
  for (int a = 0; a < 3; ++a) {
    const double origin = 8 * std::floor((low[std::size_t(a)] - 1) / 8.0);
    EXPECT_EQ(info.chart->ecef_m({0, glm::dvec3(0.0)})[a], 2 * origin);
    EXPECT_EQ(info.chart->ecef_m({0, glm::dvec3(1.0)})[a], 2 * (origin + 64));
    EXPECT_EQ(info.bounds.low[a], (low[std::size_t(a)] - 1 - origin) / 64);
    EXPECT_EQ(info.bounds.high[a], (high[std::size_t(a)] + 1 - origin) / 64);
  }
}

TEST(Facts, CountWhatWasCleaned) {
  const auto facts = open(twin("not_finite"))->info().facts;
  EXPECT_TRUE(any_contains(facts, "2 active values are not finite"));
  EXPECT_TRUE(any_contains(facts, "2 active values are negative"));
  EXPECT_TRUE(
      any_contains(open(twin("background"))->info().facts, "inactive values differ from 0"));
  const auto plain = open(twin("plain"))->info().facts;
  EXPECT_FALSE(any_contains(plain, "not finite"));
  EXPECT_FALSE(any_contains(plain, "inactive"));
}

// Whoever only renders hears of it too, each time such a frame is read.
TEST(Facts, WarnOfWhatWasChanged) {
  std::vector<std::string> heard;
  set_log_sink(
      [](void* context, LogLevel level, const char* text) {
        if (level == LogLevel::kWarning)
          static_cast<std::vector<std::string>*>(context)->push_back(text);
      },
      &heard);
  open(twin("plain"));
  EXPECT_TRUE(heard.empty());
  open(twin("not_finite"));
  set_log_sink(nullptr, nullptr);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_TRUE(any_contains(heard, "not_finite.vdb [density]: 2 active values are not finite and 2"))
      << heard.front();
}

TEST(Choice, OfTheGrid) {
  EXPECT_TRUE(any_contains(open(twin("other_name"))->info().facts, "Grid smoke (float)"));
  EXPECT_TRUE(any_contains(open(twin("half"))->info().facts, "Grid density (half)"));
  EXPECT_TRUE(any_contains(open(twin("double"))->info().facts, "Grid density (double)"));
  EXPECT_TRUE(any_contains(open(twin("several"), {word("grid", "steam")})->info().facts,
                           "Grid steam (float)"));
}

TEST(Empty, VolumesAreLegal) {
  for (const char* name : {"empty", "empty_inverted"}) {
    const auto source = open(twin(name));
    const NodeSummary top = summary(*source, NodeKey(0, 0, 0, 0, 0), 0);
    EXPECT_TRUE(top.empty && top.constant && top.children == 0) << name;
    for (const double value : read(*source, NodeKey(0, 0, 0, 0, 0), 0).samples) EXPECT_EQ(value, 0);
  }
}

TEST(Sequence, IsOneVolumeOverAllFrames) {
  const auto source = open(twin("sequence"), {number("fps", 10), number("density_scale", 1)});
  const VolumeInfo& info = source->info();
  ASSERT_EQ(info.times_s, (std::vector<double>{0, 0.1, 0.2, 0.3}));
  EXPECT_TRUE(any_contains(info.facts, "Frame 3 is missing"));
  EXPECT_TRUE(any_contains(info.facts, "1 of 3 files have no active voxel"));
  const NodeKey top(0, 0, 0, 0, 0);
  EXPECT_TRUE(summary(*source, top, info.times_s[0]).empty);
  const auto value = [&](std::size_t frame, double y) {
    double found = -1;
    EXPECT_EQ(source->point_extinction_per_m({12, -7, y}, info.times_s[frame], found), Status::kOk);
    return found;
  };
  const double middle = samples::puff({12, 9, 7});
  EXPECT_GT(middle, 0.4);
  // There and back, so that frames are dropped and loaded again.
  for (int pass = 0; pass < 3; ++pass) {
    EXPECT_EQ(value(0, 9), 0);
    EXPECT_NEAR(value(1, 9), middle, 1e-6);
    EXPECT_EQ(value(2, 9), value(1, 9)) << "a gap holds the frame before it";
    EXPECT_NEAR(value(3, 9 + 17), middle, 1e-6);
  }
  double found;
  EXPECT_EQ(source->point_extinction_per_m({0, 0, 0}, 0.05, found), Status::kNoSuchTime);
}

TEST(Sequence, OneFrameHasTheBoxAndScaleOfAll) {
  const std::string file = twin("sequence");
  const auto all = open(file), one = open(file, {number("frame", 4)});
  EXPECT_EQ(one->info().times_s, std::vector<double>{3 / 24.0});
  EXPECT_EQ(one->info().bounds.high, all->info().bounds.high);
  EXPECT_EQ(brightest(*one, 3 / 24.0), brightest(*all, all->info().times_s[3]));
}

TEST(Sequence, SaysWhichFrameStandsInForAMissingOne) {
  const std::string file = twin("sequence");
  EXPECT_TRUE(any_contains(open(file, {number("frame", 3)})->info().assumptions,
                           "Frame 3 is missing: " + (folder() / "sequence.0002.vdb").string()));
  EXPECT_FALSE(any_contains(open(file, {number("frame", 4)})->info().assumptions, "missing"));
  // A long gap is one line.
  fs::copy(folder() / "sequence.0004.vdb", folder() / "sequence.5000.vdb");
  const auto facts = open(file)->info().facts;
  fs::remove(folder() / "sequence.5000.vdb");
  EXPECT_TRUE(any_contains(facts, "Frames 5 to 4999 are missing"));
  EXPECT_LT(facts.size(), 10u);
}

TEST(Point, IsTrilinearBetweenVoxels) {
  const auto source = open(twin("plain"), {number("density_scale", 1), word("up", "z")});
  const auto at = [&](glm::dvec3 p) {
    double value = -1;
    EXPECT_EQ(source->point_extinction_per_m(p, 0, value), Status::kOk);
    return value;
  };
  EXPECT_NEAR(at({3, 4, 5}), samples::puff({3, 4, 5}), 1e-7);
  EXPECT_NEAR(at({3.25, 4, 5}), 0.75 * samples::puff({3, 4, 5}) + 0.25 * samples::puff({4, 4, 5}),
              1e-7);
  EXPECT_EQ(at({1e9, 0, 0}), 0);
}

TEST(Verbs, RefuseWhatIsNotThere) {
  const auto source = open(twin("plain"));
  NodeSummary found;
  EXPECT_EQ(source->summary(NodeKey(0, 9, 0, 0, 0), 0, found), Status::kNoSuchNode);
  EXPECT_EQ(source->summary(NodeKey(1, 0, 0, 0, 0), 0, found), Status::kNoSuchNode);
  EXPECT_EQ(source->summary(NodeKey(0, 0, 0, 0, 0), 1, found), Status::kNoSuchTime);
  std::array<std::uint16_t, kBrickVolume> codes;
  ChannelView view;
  view.codes = codes.data(), view.channel = Channel::kTemperature;
  EXPECT_EQ(source->read(NodeKey(0, 0, 0, 0, 0), 0, {&view, 1}), Status::kNoSuchChannel);
}

// A frame that vanishes between open and read is a failure with a text, not a crash.
TEST(Verbs, ReportAFrameThatIsGone) {
  const auto source = open(twin("sequence"));
  fs::remove(folder() / "sequence.0004.vdb");
  NodeSummary found;
  const NodeKey top(0, 0, 0, 0, 0);
  EXPECT_EQ(source->summary(top, source->info().times_s[1], found), Status::kOk);
  EXPECT_EQ(source->summary(top, source->info().times_s[3], found), Status::kReadFailed);
  char text[256];
  EXPECT_GT(source->last_error(text, sizeof text), 10u);
  EXPECT_NE(std::string(text).find("sequence.0004.vdb"), std::string::npos) << text;
}

TEST(HugeTile, CostsNeitherTimeNorMemory) {
  const auto start = std::chrono::steady_clock::now();
  const auto source = open(twin("huge_tile"), {number("density_scale", 1)});
  const int finest = source->info().lattice.max_level();
  ASSERT_EQ(source->info().lattice.cells(finest)[0], 8192u);
  const NodeSummary inside = summary(*source, NodeKey(0, finest, 100, 200, 300), 0);
  EXPECT_TRUE(inside.constant);
  EXPECT_FLOAT_EQ(inside.constant_extinction_per_m, 0.01f);
  EXPECT_TRUE(summary(*source, NodeKey(0, finest, 600, 200, 300), 0).empty);
  const NodeSummary skin = summary(*source, NodeKey(0, finest, 1, 200, 300), 0);  // at voxel 0
  EXPECT_FALSE(skin.empty);
  const Brick top = read(*source, NodeKey(0, 0, 0, 0, 0), 0);
  // sample (2, 2, 2) of the root is index 2048 - 8: deep inside; the root's cells are 1024 voxels
  EXPECT_NEAR(top.samples[brick_offset(2, 2, 2)], 0.01, top.max_abs_error);
  EXPECT_EQ(top.samples[brick_offset(7, 2, 2)], 0);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("measured: 4096^3 tile opened and read in %.3f s, source of %.0f kB\n", seconds,
              double(source->info().source_bytes) / 1e3);
  EXPECT_LT(seconds, 3);
  EXPECT_LT(source->info().source_bytes, 4e6);
}

}  // namespace
}  // namespace nepho::test
