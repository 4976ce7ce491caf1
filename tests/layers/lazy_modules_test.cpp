// A scene loads what it needs and nothing else. Each TEST is a ctest entry, so a process of its
// own.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>

#include "host/source_host.h"

namespace nepho {
namespace {

const char kHeavy[] = "/lib(openvdb|netcdf|gdal|hdf5|OpenImageIO|Half|blosc)[^/]*\\.so";

// The files mapped into this process whose path matches.
std::string mapped(const std::string& pattern) {
  std::ifstream maps("/proc/self/maps");
  const std::regex wanted(pattern);
  std::string all;
  for (std::string line; std::getline(maps, line);)
    if (std::regex_search(line, wanted)) all += line + '\n';
  return all;
}

std::unique_ptr<BrickSource> open_analytic() {
  VolumeSpec volume;
  volume.name = "ball";
  volume.source = "analytic";
  volume.parameters = {{"kind", "", 0, "sphere", true},
                       {"radius_m", "m", 100, "", false},
                       {"extinction_per_m", "1/m", 0.05, "", false}};
  return SourceHost(default_module_folders()).open(volume);
}

TEST(LazyModules, CatalogueOpensNoLibrary) {
  const SourceHost host(default_module_folders());
  ASSERT_NE(host.find("analytic"), nullptr);
  EXPECT_EQ(mapped("nepho_source_"), "");
  EXPECT_EQ(mapped(kHeavy), "");
  EXPECT_NE(mapped("/libc[.]so|/libc-"), "") << "the test cannot see what is mapped";
}

TEST(LazyModules, AnalyticSceneLoadsItsModuleOnly) {
  const auto source = open_analytic();
  ASSERT_NE(source, nullptr);
  EXPECT_NE(mapped("nepho_source_analytic"), "");
  EXPECT_EQ(mapped("nepho_source_openvdb"), "");
  EXPECT_EQ(mapped(kHeavy), "");
}

TEST(LazyModules, ProceduralSceneLoadsNoDataLibrary) {
  VolumeSpec volume;
  volume.name = "sky";
  volume.source = "noise";
  const auto source = SourceHost(default_module_folders()).open(volume);
  ASSERT_NE(source, nullptr);
  NodeSummary summary;
  ASSERT_EQ(source->summary(NodeKey(0, 0, 0, 0, 0), 0, summary), Status::kOk);
  EXPECT_FALSE(summary.empty);
  EXPECT_NE(mapped("nepho_source_noise"), "");
  EXPECT_EQ(mapped("nepho_source_(openvdb|netcdf|analytic)"), "");
  EXPECT_EQ(mapped(kHeavy), "");
}

#ifdef NEPHO_SAMPLE_VDB
TEST(LazyModules, VdbSceneLoadsOpenVdb) {
  VolumeSpec volume;
  volume.name = "smoke";
  volume.source = "openvdb";
  volume.files = {NEPHO_SAMPLE_VDB};
  const auto source = SourceHost(default_module_folders()).open(volume);
  ASSERT_NE(source, nullptr);
  EXPECT_NE(mapped("nepho_source_openvdb"), "");
  EXPECT_NE(mapped("/libopenvdb"), "") << "the names that the other tests look for are stale";
  EXPECT_EQ(mapped("libOpenImageIO"), "");
}
#endif

}  // namespace
}  // namespace nepho
