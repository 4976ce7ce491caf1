// Files that no one of us wrote (NEPHO_REAL_DATA): identity, sequences, and what is refused.

#include <algorithm>

#include "identity.h"

namespace nepho::test {
namespace {

const fs::path kData = NEPHO_TEST_REAL_DATA;

Identity compare_real(const std::string& file, const std::string& grid = "density") {
  const std::string path = (kData / file).string();
  const auto source = open(path, {number("density_scale", 0.05)});
  return compare(*source, 0, 0.05, active_voxels(path, grid), y_up);
}

TEST(Real, IdentityHolds) {
  for (const char* file : {"vdb/wdas_cloud_sixteenth.vdb", "vdb/openvdb_smoke1_f222_half.vdb",
                           "vdb/openusd_smoke_000002.vdb", "vdb/openusd_smoke_000003.vdb",
                           "vdb/openusd_densityAndHeat.vdb"}) {
    const Identity found = compare_real(file);
    expect_identity(file, found);
    EXPECT_GT(found.not_zero, 1000u) << file;
  }
}

TEST(Real, CountsAreTheKnownOnes) {
  EXPECT_EQ(compare_real("vdb/wdas_cloud_sixteenth.vdb").voxels, 415642u);
  EXPECT_EQ(compare_real("vdb/openvdb_smoke1_f222_half.vdb").voxels, 1049275u);
}

TEST(Real, SequenceWithAnEmptyFirstFrame) {
  const auto source = open((kData / "vdb/openusd_smoke_######.vdb").string());
  const VolumeInfo& info = source->info();
  ASSERT_EQ(info.times_s.size(), 3u);
  NodeSummary s = summary(*source, NodeKey(0, 0, 0, 0, 0), info.times_s[0]);
  EXPECT_TRUE(s.empty);
  EXPECT_FALSE(summary(*source, NodeKey(0, 0, 0, 0, 0), info.times_s[1]).empty);
  EXPECT_FALSE(summary(*source, NodeKey(0, 0, 0, 0, 0), info.times_s[2]).empty);
  EXPECT_TRUE(any_contains(info.facts, "no active voxel"));
}

// Opens or refuses; which, and in which words.
TEST(Real, EdgeFiles) {
  struct Case {
    const char* file;
    const char* says;  // empty: it opens
  };
  const Case cases[] = {
      {"vdb/openusd_smoke_000001.vdb", ""},
      {"vdb/fvdb_smoke-blosc.nvdb", "NanoVDB"},
      {"edge/cortex_levelset_sphere_f222.vdb", "level set"},
      {"edge/oiio_sphereCd_vec3.vdb", "no density"},
      {"edge/oiio_damaged_truncated_b.vdb", "truncated"},
      {"edge/gdal_netcdf-4d.nc", "not a VDB file"},
  };
  for (const Case& c : cases) {
    std::string text;
    try {
      open((kData / c.file).string());
    } catch (const Error& e) {
      text = e.what();
    }
    std::printf("measured: %s: %s\n", c.file, text.empty() ? "opens" : text.c_str());
    EXPECT_EQ(text.empty(), *c.says == 0) << c.file;
    EXPECT_NE(text.find(c.says), std::string::npos) << c.file << ": " << text;
  }
}

// Whatever they hold, they are read or refused.
TEST(Real, AllFilesAreReadOrRefused) {
  for (const char* folder : {"vdb", "edge"})
    for (const auto& entry : fs::directory_iterator(kData / folder)) {
      if (entry.path().extension() != ".vdb") continue;
      try {
        const auto source = open(entry.path().string());
        std::printf("measured: %s: read\n", entry.path().filename().c_str());
        for (const std::string& fact : source->info().facts) std::printf("  %s\n", fact.c_str());
        for (const std::string& text : source->info().assumptions)
          std::printf("  %s\n", text.c_str());
      } catch (const Error& e) {
        std::printf("measured: %s\n", e.what());
        EXPECT_FALSE(e.parts().what.empty());
      }
    }
}

}  // namespace
}  // namespace nepho::test
