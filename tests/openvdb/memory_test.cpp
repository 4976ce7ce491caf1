// Two clouds 26 km apart: what is held follows the voxels, not the 8192^3 cells of their lattice.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <fstream>

#include "vdb_files.h"

namespace nepho::test {
namespace {

// Peak resident memory (bytes) of a child that runs `work`.
template <class Work>
double peak_of(Work&& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    try {
      work();
      _exit(0);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
      _exit(1);
    }
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return double(usage.ru_maxrss) * 1024;
}

// The child's own figure: what fork shares with this process would count for it too, so both
// children do all but the same, and their difference is taken.
TEST(Memory, TwoCloudsFarApart) {
  const fs::path pair = folder() / "pair.vdb", nothing = folder() / "nothing.vdb";
  // Files are made in children, so that this process stays small.
  peak_of([&] { writer().write(pair, {samples::far_pair(26000, 2.6e6)}); });
  peak_of([&] { writer().write(nothing, {samples::SampleGrid{}}); });
  std::string facts;
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const double empty = peak_of([&] { open(nothing.string()); });
  const double full = peak_of([&] {
    const auto source = open(pair.string());
    double tree = 0, active = 0;
    for (const std::string& fact : source->info().facts) {
      std::sscanf(fact.c_str(), "Grid density (float): %lf", &active);
      std::sscanf(fact.c_str(), "The tree takes %lf", &tree);
    }
    const double found[4] = {
        tree, active, double(source->info().source_bytes),
        double(source->info().lattice.cells(source->info().lattice.max_level())[0])};
    if (::write(pipe_ends[1], found, sizeof found) != sizeof found) _exit(2);
  });
  double found[4];
  ASSERT_EQ(::read(pipe_ends[0], found, sizeof found), ssize_t(sizeof found));
  const auto [tree, active, held, cells] = found;
  std::printf(
      "measured: %.3g active voxels in %.0f^3 cells; tree %.1f MB, held %.1f MB, peak over "
      "an empty volume %.1f MB = %.2f x tree; %.1f bytes per active voxel\n",
      active, cells, tree / 1e6, held / 1e6, (full - empty) / 1e6, (full - empty) / tree,
      (full - empty) / active);
  EXPECT_NEAR(active, 2.6e6, 0.2e6);
  EXPECT_GE(cells, 8192);
  EXPECT_GT(tree, 8e6);
  EXPECT_LE(full - empty, 3 * tree);
}

}  // namespace
}  // namespace nepho::test
