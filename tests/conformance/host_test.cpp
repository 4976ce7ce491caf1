// The module host: manifests are read and nothing is loaded before a scene asks; modules of another
// ABI are refused with both ids; nothing that a module throws comes out as anything but an Error.

#include "host/source_host.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "bricks/box_chart.h"
#include "core/error.h"
#include "core/log.h"

namespace nepho::test {
namespace {

namespace fs = std::filesystem;

VolumeSpec volume(const std::string& source, const std::vector<SourceParameter>& parameters = {}) {
  VolumeSpec spec;
  spec.name = "v";
  spec.source = source;
  spec.parameters = parameters;
  return spec;
}
SourceParameter number(const std::string& name, double value) {
  SourceParameter p;
  p.name = name;
  p.number = value;
  return p;
}
SourceParameter word(const std::string& name, const std::string& text) {
  SourceParameter p;
  p.name = name;
  p.text = text;
  p.is_text = true;
  return p;
}

std::string refusal(const SourceHost& host, const VolumeSpec& spec) {
  try {
    host.open(spec);
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing was refused";
}

bool mapped(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find(library) != std::string::npos) return true;
  return false;
}

SourceHost own_host() {
  return SourceHost(default_module_folders());
}
SourceHost fake_host() {
  return SourceHost({fs::path(NEPHO_FAKE_MODULES)});
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// First: it needs a process that has opened nothing.
TEST(Host, LoadsOnlyTheModuleThatIsAskedFor) {
  const SourceHost host({fs::path(NEPHO_FAKE_MODULES), default_module_folders().back()});
  EXPECT_GE(host.catalogue().size(), 4u);
  EXPECT_NE(host.find("analytic"), nullptr);
  EXPECT_TRUE(SourceHost::loaded().empty());
  EXPECT_FALSE(mapped("nepho_source_"));
  EXPECT_NE(host.open(volume("analytic")), nullptr);
  EXPECT_EQ(SourceHost::loaded(), std::vector<std::string>{"analytic"});
  EXPECT_TRUE(mapped("nepho_source_analytic"));
  EXPECT_FALSE(mapped("nepho_source_fake"));
  EXPECT_FALSE(mapped("libopenvdb"));
  host.open(volume("analytic"));
  EXPECT_EQ(SourceHost::loaded().size(), 1u);
}

TEST(Host, RefusesAnotherContractWithBothVersions) {
  const std::string text = refusal(fake_host(), volume("fake_contract"));
  const AbiId own = this_abi();
  EXPECT_TRUE(contains(text, "contract " + std::to_string(own.contract_version) + ",")) << text;
  EXPECT_TRUE(contains(text, "contract " + std::to_string(own.contract_version + 41) + ","))
      << text;
  EXPECT_TRUE(contains(text, "nepho_source_fake_contract")) << text;
  std::printf("measured: %s\n", text.c_str());
}

TEST(Host, RefusesAnotherLayoutWithBothHashes) {
  const std::string text = refusal(fake_host(), volume("fake_layout"));
  for (const std::uint64_t hash : {layout_hash(), layout_hash() ^ 1}) {
    char part[40];
    std::snprintf(part, sizeof part, "layout %016llx", static_cast<unsigned long long>(hash));
    EXPECT_TRUE(contains(text, part)) << text;
  }
}

TEST(Host, ModuleErrorsKeepTheirParts) {
  const SourceHost host = fake_host();
  EXPECT_EQ(refusal(host, volume("fake")), "where: what: found found, expected expected; hint");
  EXPECT_EQ(refusal(host, volume("fake", {word("throw", "bad_alloc")})), "out of memory");
  EXPECT_EQ(refusal(host, volume("fake", {word("throw", "int")})), "an exception of unknown type");
  EXPECT_EQ(refusal(host, volume("fake", {word("throw", "long")})), std::string(511, 'x'));
}

TEST(Host, HandsOverTheLockAndTheLog) {
  std::string heard;
  set_log_sink([](void* context, LogLevel,
                  const char* text) { *static_cast<std::string*>(context) += text; },
               &heard);
  // Twice: a lock that was not given back would hang the second.
  for (int time = 0; time < 2; ++time)
    refusal(fake_host(), volume("fake", {word("throw", "lock")}));
  set_log_sink(nullptr, nullptr);
  EXPECT_EQ(heard, "lockedlocked");
}

TEST(Host, ParametersAreCheckedAndNamed) {
  const SourceHost host = own_host();
  struct {
    std::vector<SourceParameter> parameters;
    std::vector<std::string> parts;
  } cases[] = {
      {{number("radius", 3)}, {"unknown parameter", "'radius'", "max_level"}},
      {{number("size_x", 3)}, {"missing unit", "'size_x'", "a unit like m"}},
      {{number("size_x_kg_per_m3", 3)}, {"wrong unit", "'kg_per_m3'", "a unit like m"}},
      {{word("kind", "sphere"), number("radius_n", 3)},
       {"unknown parameter", "did you mean radius_m?"}},
      {{word("kind", "spere")}, {"unknown word", "did you mean sphere?", "half_space"}},
      {{number("kind", 3)}, {"wrong type", "a word", "3"}},
      {{word("kind", "sphere"), word("radius_m", "big")}, {"wrong type", "a number", "big"}},
      {{word("kind", "sphere"), number("radius_m", -1)}, {"out of range", "more than 0"}},
      {{word("kind", "sphere"), number("radius_m", NAN)}, {"finite"}},
      {{number("max_level", 99)}, {"out of range", "0 to 16"}},
      {{number("max_level", 1.5)}, {"whole number"}},
      {{number("optical_depth", 1), number("extinction_per_m", 1)}, {"two ways"}},
      {{number("optical_depth", -1)}, {"0 or more"}},
      {{word("chart", "shell"), word("kind", "cube")}, {"no such kind on a shell"}},
      {{word("chart", "shell"), word("kind", "gaussian")}, {"needs a place"}},
      {{word("chart", "shell"), number("top_m", -1)}, {"top_m"}},
      {{word("chart", "shell"), word("split_axes", "x")}, {"split together"}},
      {{word("kind", "gaussian"), number("max_level", 9)}, {"choose a smaller max_level"}},
      {{number("asymmetry", 1)}, {"out of range"}},
      {{number("co_albedo", 2)}, {"out of range"}},
  };
  for (const auto& c : cases) {
    const std::string text = refusal(host, volume("analytic", c.parameters));
    for (const std::string& part : c.parts)
      EXPECT_TRUE(contains(text, part)) << text << " / " << part;
  }
  VolumeSpec with_file = volume("analytic");
  with_file.files = {"a.vdb"};
  EXPECT_TRUE(contains(refusal(host, with_file), "reads no files"));
}

TEST(Host, NamesWhatExists) {
  const std::string text = refusal(own_host(), volume("analytik"));
  EXPECT_TRUE(contains(text, "analytik")) << text;
  EXPECT_TRUE(contains(text, "did you mean analytic?")) << text;
  VolumeSpec by_file = volume("");
  by_file.files = {"cloud.XYZ"};
  EXPECT_TRUE(contains(refusal(own_host(), by_file), "answers to 'xyz'"));
}

TEST(Host, BadManifestsAndLibrariesAreErrors) {
  const fs::path folder =
      fs::temp_directory_path() / ("nepho_host_test_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const auto write = [&](const char* file, const char* text) {
    std::ofstream(folder / file) << text;
  };
  write("a.source", "id a\nlib a.so\nkeys a\n");
  EXPECT_THROW(SourceHost({folder}), Error);
  write("a.source", "id a\nlibrary a.so\nkeys\n");
  EXPECT_THROW(SourceHost({folder}), Error);
  write("a.source", "id a\nlibrary a.so\nkeys a b\n");
  const SourceHost host({folder, folder / "missing"});
  EXPECT_TRUE(contains(refusal(host, volume("b")), "cannot load the source module"));
  write("a.so", "not a library");
  EXPECT_TRUE(contains(refusal(host, volume("b")), "cannot load the source module"));
  fs::remove_all(folder);
}

// x to the right of the heading, y along it, z up; checked against geographic directions.
TEST(Host, PlaceTurnsTheBox) {
  VolumeSpec spec = volume("analytic", {word("kind", "cube"), number("size_m", 100)});
  spec.place = GeodeticPlace{30, -60, 500, 90};
  const auto source = own_host().open(spec);
  const auto* box = dynamic_cast<const BoxChart*>(source->info().chart.get());
  ASSERT_NE(box, nullptr);
  const double phi = 30 * std::numbers::pi / 180, lambda = -60 * std::numbers::pi / 180;
  const glm::dvec3 east = {-std::sin(lambda), std::cos(lambda), 0};
  const glm::dvec3 up = {std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda),
                         std::sin(phi)};
  const glm::dvec3 south = -glm::cross(up, east);
  EXPECT_LE(glm::length(box->edges_m()[0] - 100.0 * south), 1e-9);  // heading east: right is south
  EXPECT_LE(glm::length(box->edges_m()[1] - 100.0 * east), 1e-9);
  EXPECT_LE(glm::length(box->edges_m()[2] - 100.0 * up), 1e-9);
  const glm::dvec3 foot = box->ecef_m({0, {0.5, 0.5, 0}});
  EXPECT_LE(glm::length(foot - geodetic_to_ecef_m(Ellipsoid::wgs84(), phi, lambda, 500)), 1e-8);
}

}  // namespace
}  // namespace nepho::test
