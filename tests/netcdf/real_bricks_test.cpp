// Bricks of files that no one of us wrote: what is kept, where it lies, what it costs.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "accuracy_report.h"
#include "made_source.h"
#include "remapped.h"
#include "sources/netcdf/open_netcdf.h"

namespace nepho::test {
namespace {

std::shared_ptr<const forecast::Forecast> open(const std::string& file) {
  forecast::OpenRequest request;
  request.files = {file};
  return netcdf::open_netcdf(request);
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

INSTANTIATE_TEST_SUITE_P(Files, RealFile,
                         testing::Values("wrf_katrina_10km_nest_4t", "um_38lev_cosp_input_2d",
                                         "icon_les_stratocumulus_L150",
                                         "gfs_2p5deg_20110110_f120_DERIVED_cf_packed"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace nepho::test
