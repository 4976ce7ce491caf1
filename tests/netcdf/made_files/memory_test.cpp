// Large files are written level by level: memory follows the level, not the file.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "accuracy_report.h"
#include "made_file.h"
#include "wrf_forecast.h"

namespace nepho::test {
namespace {

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) * 1024;
}

TEST(Memory, OfALargeForecastIsThatOfALevel) {
  const fs::path path = made_folder() / "large.nc";
  // once small: libraries and threads are there from then on
  samples::write_wrf(nc_writer(), path, {.nx = 8, .ny = 8, .nz = 6});
  const double before = peak_bytes();
  const samples::WrfShape shape = {.nx = 128, .ny = 128, .nz = 72, .times = 1, .cell_m = 9000};
  samples::write_wrf(nc_writer(), path, shape);
  const double grown = peak_bytes() - before;
  // 13 variables of 4 bytes
  const double file = 13.0 * 4 * double(shape.nx * shape.ny * shape.nz);
  EXPECT_LE(grown, 0.35 * file) << "bytes above a small file";
  report_accuracy("made files", "peak memory of a large forecast over its bytes", grown / file,
                  0.35, "1");
}

}  // namespace
}  // namespace nepho::test
