// Bricks of files that no one of us wrote: what is kept, where it lies, what it costs.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "accuracy_report.h"
#include "host/source_host.h"
#include "made_source.h"
#include "remapped.h"
#include "sources/netcdf/conventions/convention.h"

namespace nepho::test {
namespace {

std::shared_ptr<const netcdf::Forecast> open(const std::string& file) {
  netcdf::OpenRequest request;
  request.files = {file};
  return netcdf::open_forecast(request);
}

class RealFile : public testing::TestWithParam<const char*> {};

TEST_P(RealFile, KeepOpticalDepthInItsPlace) {
  const std::string file = std::string(NEPHO_TEST_REAL_DATA) + "/nc/" + GetParam() + ".nc";
  const auto forecast = open(file);
  for (std::size_t time = 0; time < forecast->times_s().size(); time += 3) {
    const Remapped r(forecast, {}, 1e-9, time);
    const double drift = std::abs(r.total() / file_total(r) - 1), rms = column_rms(r, 60);
    report_accuracy("netcdf", "real files: total optical depth, file against finest bricks", drift,
                    2e-3, "1");
    report_accuracy("netcdf", "real files: column optical depth under the same hats, rms", rms,
                    5e-3, "1");
    EXPECT_LE(drift, 2e-3);
    EXPECT_LE(rms, 5e-3);
  }
}

TEST_P(RealFile, CostLittle) {
  const std::string file = std::string(NEPHO_TEST_REAL_DATA) + "/nc/" + GetParam() + ".nc";
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const auto forecast = open(file);
  const double opened_s = seconds();
  const auto source = made_source(forecast);
  const VolumeInfo& info = source->info();
  std::printf("measured: %s: open %.2f s, bricks %.2f s, %.1f MB held, %zu finest nodes\n",
              GetParam(), opened_s, seconds() - opened_s, double(info.source_bytes) / 1e6,
              finest_nodes(*source, info.times_s[0]).size());
  for (const std::string& fact : info.facts) std::printf("  fact: %s\n", fact.c_str());
  for (const std::string& text : info.assumptions) std::printf("  assumed: %s\n", text.c_str());
}

std::uint64_t hash_of(const BrickSource& source, NodeKey key, double time_s) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const double c : read_samples(source, key, time_s))
    hash = (hash ^ std::bit_cast<std::uint64_t>(c)) * 0x100000001b3u;
  return hash;
}

// Two sources through the module, four threads, more times than either keeps: files are read again
// and again under the one lock of the process.
TEST(RealBricks, TwoSourcesFromFourThreads) {
  const SourceHost host({NEPHO_TEST_MODULES});
  VolumeSpec volume;
  volume.name = "katrina";
  volume.files = {std::string(NEPHO_TEST_REAL_DATA) + "/nc/wrf_katrina_10km_nest_4t.nc"};
  std::vector<std::pair<NodeKey, double>> work;
  std::vector<std::uint64_t> alone;
  {
    const auto source = host.open(volume);
    for (const double time_s : source->info().times_s) {
      const std::vector<NodeKey> nodes = finest_nodes(*source, time_s);
      for (std::size_t n = 0; n < nodes.size(); n += 100) {
        work.emplace_back(nodes[n], time_s);
        alone.push_back(hash_of(*source, nodes[n], time_s));
      }
    }
  }
  std::vector<std::unique_ptr<BrickSource>> sources;
  sources.push_back(host.open(volume));
  sources.push_back(host.open(volume));
  std::vector<std::vector<std::uint64_t>> hashes(4, std::vector<std::uint64_t>(work.size()));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t n = 0; n < work.size(); ++n) {
        const std::size_t at = (n + t * work.size() / 4) % work.size();  // each its own time
        hashes[t][at] = hash_of(*sources[t % 2], work[at].first, work[at].second);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(work.size(), 20u);
  for (const auto& of_thread : hashes) EXPECT_EQ(of_thread, alone);
}

INSTANTIATE_TEST_SUITE_P(Files, RealFile,
                         testing::Values("wrf_katrina_10km_nest_4t", "um_38lev_cosp_input_2d",
                                         "icon_les_stratocumulus_L150",
                                         "gfs_2p5deg_20110110_f120_DERIVED_cf_packed"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace nepho::test
