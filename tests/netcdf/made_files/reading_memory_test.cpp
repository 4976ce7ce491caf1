// What reading a forecast takes beside the source that it leaves.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "accuracy_report.h"
#include "forecast/bricks/forecast_source.h"
#include "made_file.h"
#include "sources/netcdf/open_netcdf.h"
#include "wrf_forecast.h"

namespace nepho::test {
namespace {

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) * 1024;
}

// Bytes of the variables that were read.
double open_source(const fs::path& path) {
  forecast::OpenRequest request;
  request.files = {path.string()};
  const std::shared_ptr<const forecast::Forecast> forecast = netcdf::open_netcdf(request);
  const SourceRequest none{};
  Parameters parameters(none);
  const auto source = forecast::make_source("made", forecast, parameters);
  EXPECT_EQ(source->info().channels.size(), 2u);
  double bytes = 0;
  for (const forecast::VariableBytes& variable : forecast->bytes_read())
    bytes += double(variable.read);
  return bytes;
}

TEST(ReadingMemory, IsAboutThatOfWhatIsRead) {
  const fs::path small = made_folder() / "small.nc", large = made_folder() / "large.nc";
  samples::write_wrf(nc_writer(), small, {.nx = 8, .ny = 8, .nz = 6});
  const samples::WrfShape shape = {.nx = 128, .ny = 128, .nz = 40, .times = 1, .cell_m = 9000};
  samples::write_wrf(nc_writer(), large, shape);
  open_source(small);  // once small: libraries and threads are there from then on
  const double before = peak_bytes();
  const double read = open_source(large);
  const double grown = peak_bytes() - before;
  EXPECT_GT(read, 11.0 * 4 * 128 * 128 * 40);
  EXPECT_LE(grown, 1.35 * read);
  report_accuracy("netcdf", "peak memory of opening a forecast over the bytes read", grown / read,
                  1.35, "1");
}

}  // namespace
}  // namespace nepho::test
