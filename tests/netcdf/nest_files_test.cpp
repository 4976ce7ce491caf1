// Files of several domains as one picture's forecast: which are drawn when, and that no cloud
// counts twice.

#include "accuracy_report.h"
#include "cf_twin.h"
#include "nests.h"
#include "wrf_twin.h"

namespace nepho::forecast::test {
using nepho::test::report_accuracy;
using nepho::test::Together;
namespace {

std::shared_ptr<const Forecast> open_all(const std::vector<std::string>& files) {
  OpenRequest request;
  request.files = files;
  return netcdf::open_netcdf(request);
}

std::string told(const Forecast& forecast) {
  std::string text;
  for (const std::string& fact : forecast.facts()) text += fact + "\n";
  for (const std::string& assumption : forecast.assumptions()) text += assumption + "\n";
  return text;
}

WrfTwin cloudy(double dx_m, int nx, int ny, double west_m, double south_m) {
  WrfTwin twin;
  twin.dx_m = dx_m;
  twin.nx = nx;
  twin.ny = ny;
  twin.west_m = west_m;
  twin.south_m = south_m;
  twin.moves = 0;
  twin.flat = true;
  twin.water = [dx_m](int t, int k, int j, int i) {
    return k == 0 ? 0 : 1e-4 * (1 + t + k) * (1.2 + std::sin(9e-5 * dx_m * i) * std::cos(0.7 * j));
  };
  return twin;
}

WrfTwin d01() {
  return cloudy(27000, 12, 11, 0, 2500000);
}
// Starts on no wall of the coarse one, and moves by two cells.
WrfTwin d02() {
  WrfTwin twin = cloudy(9000, 14, 13, 80000, 2571000);
  twin.moves = 2;
  return twin;
}
WrfTwin d03() {
  WrfTwin twin = cloudy(3000, 10, 9, 121000, 2620000);
  twin.nt = 4;
  twin.step_h = 1;
  return twin;
}

// Each place once, at all times, with a nest that moves between two others.
TEST(NestFiles, NothingCountsTwice) {
  const auto nests =
      open_all({d01().write("wrfout_d01"), d02().write("wrfout_d02"), d03().write("wrfout_d03")});
  EXPECT_EQ(nests->times_s(), (std::vector<double>{0, 3600, 7200, 10800}));
  double worst = 0;
  for (const std::size_t time : {0u, 3u}) {
    const Together together(nests, time);
    ASSERT_EQ(together.grids.size(), 3u);
    EXPECT_EQ(together.grids[0]->nx(), 10);  // finest first
    EXPECT_EQ(together.grids[2]->nx(), 12);
    worst = std::max(worst, std::abs(together.all().total() / together.files_total() - 1));
  }
  report_accuracy("netcdf", "optical depth of WRF nests, one moving, bricks against files", worst,
                  2e-3, "1");
  EXPECT_LT(worst, 2e-3);
}

TEST(NestFiles, DomainsAreDrawnAtTheirNearestTimes) {
  const auto nests = open_all({d03().write("times_d03"), d01().write("times_d01")});
  const auto drawn = nests->domains(1);  // 13:00: 12:00 of the coarse domain
  ASSERT_EQ(drawn.size(), 2u);
  EXPECT_EQ(drawn[0].time, 1u);
  EXPECT_EQ(drawn[1].time, 0u);
  EXPECT_EQ(nests->domains(2)[1].time, 1u);  // 14:00: 15:00
  EXPECT_NE(told(*nests).find("times_d01.nc is drawn at its nearest time, up to 60 min off."),
            std::string::npos)
      << told(*nests);
  // What ends early covers nothing later on.
  WrfTwin brief = d03();
  brief.nt = 2;
  const auto ended = open_all({brief.write("brief_d03"), d01().write("brief_d01")});
  ASSERT_EQ(ended->times_s().size(), 3u);  // 12, 13 and 15 h
  EXPECT_EQ(ended->domains(1).size(), 2u);
  ASSERT_EQ(ended->domains(2).size(), 1u);
  EXPECT_EQ(ended->domains(2)[0].domain->grid(0)->nx(), 12);
  EXPECT_NE(told(*ended).find("brief_d03.nc has nothing near 1 of 3 times: it is left out there."),
            std::string::npos)
      << told(*ended);
}

// One file a time, also of a nest that moves, is one domain; a copy of a grid is no other domain.
TEST(NestFiles, PartsOfADomainAreOne) {
  WrfTwin early = d02(), late = d02();
  early.nt = late.nt = 1;
  late.first_h = 15;
  late.west_m += 18000;
  const auto nests =
      open_all({d01().write("parts_d01"), early.write("parts_d02_12"), late.write("parts_d02_15")});
  ASSERT_EQ(nests->domains(0).size(), 2u);
  ASSERT_EQ(nests->domains(1).size(), 2u);
  EXPECT_EQ(nests->domains(1)[0].time, 1u);
  const auto joined = open_all({early.write("join_12"), late.write("join_15")});
  EXPECT_EQ(joined->domains(0).size(), 1u);
  EXPECT_EQ(joined->times_s(), (std::vector<double>{0, 10800}));
  // Two nests of one run, as fine as each other, at one time: two domains.
  late.first_h = 12;
  late.west_m = 230000;
  EXPECT_EQ(open_all({early.write("twin_a"), late.write("twin_b")})->domains(0).size(), 2u);
}

// Latitudes and longitudes of CF, the finer one without data in its corner.
TEST(NestFiles, AnyForecastsNest) {
  CfTwin coarse, fine;
  fine.latitude.clear();
  fine.longitude.clear();
  for (double lat = -7; lat < 25; lat += 3) fine.latitude.push_back(lat);
  for (double lon = 126; lon < 164; lon += 3) fine.longitude.push_back(lon);
  fine.fill = -999;
  const auto nests = open_all({coarse.write("coarse"), fine.write("fine")});
  Together together(nests);
  together.points = 100;  // walls of both run along meridians
  ASSERT_EQ(together.grids.size(), 2u);
  ASSERT_FALSE(together.columns[0].without_data.empty());
  EXPECT_EQ(std::ranges::count(together.columns[0].without_data, 1), 1);
  EXPECT_LT(std::abs(together.all().total() / together.files_total() - 1), 2e-3);
}

}  // namespace
}  // namespace nepho::forecast::test
