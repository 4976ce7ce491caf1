// The forecast that make_samples writes, read with netCDF-C alone: what a WRF file promises.

#include <gtest/gtest.h>

#include <GeographicLib/LambertConformalConic.hpp>
#include <cmath>

#include "accuracy_report.h"
#include "made_file.h"
#include "wrf_forecast.h"

namespace nepho::test {
namespace {

constexpr double kGravity = 9.81, kGasDry = 287, kHeatDry = 1004.5;
const char* const kSection = "made files";

const MadeFile& forecast() {
  static const MadeFile file = [] {
    const fs::path path = made_folder() / "forecast.nc";
    samples::write_wrf(nc_writer(), path, {});
    return MadeFile(path);
  }();
  return file;
}

std::size_t nx() {
  return forecast().length("west_east");
}
std::size_t ny() {
  return forecast().length("south_north");
}
std::size_t nz() {
  return forecast().length("bottom_top");
}
std::size_t layer() {
  return nx() * ny();
}

// Height of the levels' interfaces, pressure and temperatures, as the model's users derive them.
struct State {
  std::vector<double> interface_m, pressure_Pa, temperature_K, virtual_K, vapour;
};
const State& state() {
  static const State made = [] {
    State s;
    const std::vector<double> ph = forecast().values("PH"), phb = forecast().values("PHB");
    const std::vector<double> p = forecast().values("P"), pb = forecast().values("PB");
    const std::vector<double> t = forecast().values("T");
    s.vapour = forecast().values("QVAPOR");
    for (std::size_t at = 0; at < ph.size(); ++at)
      s.interface_m.push_back((ph[at] + phb[at]) / kGravity);
    for (std::size_t at = 0; at < p.size(); ++at) {
      s.pressure_Pa.push_back(p[at] + pb[at]);
      s.temperature_K.push_back((t[at] + 300) *
                                std::pow(s.pressure_Pa[at] / 1e5, kGasDry / kHeatDry));
      s.virtual_K.push_back(s.temperature_K[at] * (1 + 0.608 * s.vapour[at]));
    }
    return s;
  }();
  return made;
}

TEST(WrfSample, HydrostaticInItsOwnPressureTemperatureAndVapour) {
  // From the lowest middle to the highest by the hypsometric equation, against the file's heights.
  const State& s = state();
  double worst_m = 0;
  for (std::size_t cell = 0; cell < layer(); ++cell) {
    double climbed_m = 0;
    for (std::size_t k = 0; k + 1 < nz(); ++k) {
      const std::size_t low = k * layer() + cell, high = low + layer();
      climbed_m += kGasDry / kGravity * 0.5 * (s.virtual_K[low] + s.virtual_K[high]) *
                   std::log(s.pressure_Pa[low] / s.pressure_Pa[high]);
      const auto middle_m = [&](std::size_t at) {
        return 0.5 * (s.interface_m[at] + s.interface_m[at + layer()]);
      };
      worst_m = std::max(worst_m, std::abs(climbed_m - (middle_m(high) - middle_m(cell))));
    }
  }
  EXPECT_LE(worst_m, 8) << "metres off the hypsometric height";
  report_accuracy(kSection, "forecast: heights off the hypsometric", worst_m, 8, "m");
}

TEST(WrfSample, PlacesAreThoseOfItsProjection) {
  const MadeFile& f = forecast();
  ASSERT_EQ(f.number("", "MAP_PROJ"), 1);
  const GeographicLib::LambertConformalConic map(6370e3, 0, f.number("", "TRUELAT1"),
                                                 f.number("", "TRUELAT2"), 1);
  const double lon0 = f.number("", "STAND_LON");
  double x0 = 0, y0 = 0;
  map.Forward(lon0, f.number("", "CEN_LAT"), f.number("", "CEN_LON"), x0, y0);
  const std::vector<double> lat = f.values("XLAT"), lon = f.values("XLONG");
  double worst_deg = 0;
  for (std::size_t at = 0; at < layer(); ++at) {
    const double x = x0 + (double(at % nx()) - 0.5 * double(nx() - 1)) * f.number("", "DX");
    const double y = y0 + (double(at / nx()) - 0.5 * double(ny() - 1)) * f.number("", "DY");
    double want_lat = 0, want_lon = 0;
    map.Reverse(lon0, x, y, want_lat, want_lon);
    worst_deg = std::max({worst_deg, std::abs(lat[at] - want_lat), std::abs(lon[at] - want_lon)});
  }
  EXPECT_LE(worst_deg, 1e-4) << "degrees off the projection";
  report_accuracy(kSection, "forecast: places off Lambert's projection", worst_deg, 1e-4, "deg");
}

TEST(WrfSample, StaggeringUnitsAndTimes) {
  const MadeFile& f = forecast();
  using Shape = std::vector<std::size_t>;
  EXPECT_EQ(f.shape("T"), (Shape{1, nz(), ny(), nx()}));
  EXPECT_EQ(f.shape("PH"), (Shape{1, nz() + 1, ny(), nx()}));
  EXPECT_EQ(f.shape("U"), (Shape{1, nz(), ny(), nx() + 1}));
  EXPECT_EQ(f.shape("V"), (Shape{1, nz(), ny() + 1, nx()}));
  EXPECT_EQ(f.number("", "WEST-EAST_GRID_DIMENSION"), double(nx() + 1));
  for (const char* name : {"QVAPOR", "QCLOUD", "QRAIN", "QICE", "QSNOW", "QGRAUP"})
    EXPECT_EQ(f.note(name, "units"), "kg kg-1") << name;
  EXPECT_EQ(f.note("PHB", "units"), "m2 s-2");
  EXPECT_EQ(f.note("PHB", "stagger"), "Z");
  EXPECT_EQ(f.note("P", "units"), "Pa");
  EXPECT_EQ(f.note("T", "units"), "K");
  EXPECT_EQ(f.note("HGT", "units"), "m");
  EXPECT_EQ(f.text("Times"), "2024-07-20_01:00:00");
  EXPECT_EQ(f.note("XTIME", "units"), "minutes since 2024-07-19 12:00:00");
  EXPECT_EQ(f.values("XTIME"), std::vector<double>{780});
}

TEST(WrfSample, StandsOnItsGround) {
  const std::vector<double> height = forecast().values("HGT"), land = forecast().values("LANDMASK");
  double highest = 0, sea = 0;
  for (std::size_t at = 0; at < layer(); ++at) {
    EXPECT_NEAR(state().interface_m[at], height[at], 0.5);
    if (land[at] == 0) {
      EXPECT_EQ(height[at], 0);
      ++sea;
    } else {
      EXPECT_GT(height[at], 0);
    }
    highest = std::max(highest, height[at]);
  }
  EXPECT_GT(sea / double(layer()), 0.15);
  EXPECT_LT(sea / double(layer()), 0.6);
  EXPECT_GT(highest, 2000);
  EXPECT_LT(highest, 4000);
  for (std::size_t at = 0; at + layer() < state().interface_m.size(); ++at)
    ASSERT_GT(state().interface_m[at + layer()], state().interface_m[at]);
}

TEST(WrfSample, WaterIsThereAndSaturatedWhereCloudy) {
  double driest = 2;
  for (const char* name : {"QCLOUD", "QRAIN", "QICE", "QSNOW", "QGRAUP"}) {
    const std::vector<double> q = forecast().values(name);
    const auto [least, most] = std::ranges::minmax(q);
    EXPECT_GE(least, 0) << name;
    EXPECT_GT(most, 2e-4) << name;
    EXPECT_LT(most, 5e-3) << name;
    if (std::string(name) != "QCLOUD") continue;
    for (std::size_t at = 0; at < q.size(); ++at) {
      if (q[at] < 2e-5 || state().temperature_K[at] < 273.15) continue;
      const double t = state().temperature_K[at] - 273.15;
      const double e = 611.2 * std::exp(17.67 * t / (t + 243.5));
      const double full = 0.622 * e / (state().pressure_Pa[at] - e);
      driest = std::min(driest, state().vapour[at] / full);
    }
  }
  EXPECT_GT(driest, 0.98);
  EXPECT_LT(driest, 1.02);
}

TEST(WrfSample, CloudsOfManyKinds) {
  // Column by column: a deck at sea with its top below 1.2 km, towers through 10 km, level bases.
  const std::vector<double> liquid = forecast().values("QCLOUD"), ice = forecast().values("QICE");
  const std::vector<double> land = forecast().values("LANDMASK");
  double deck = 0, sea = 0, towers = 0, cumulus = 0, cirrus = 0;
  for (std::size_t cell = 0; cell < layer(); ++cell) {
    double low = 0, middle = 0, high = 0;
    for (std::size_t k = 0; k < nz(); ++k) {
      const std::size_t at = k * layer() + cell;
      const double z = state().interface_m[at];
      (z < 1200 ? low : z < 6000 ? middle : high) += liquid[at] + ice[at];
    }
    sea += land[cell] == 0;
    deck += land[cell] == 0 && low > 1e-4;
    towers += middle > 5e-3 && high > 2e-3;
    cumulus += land[cell] == 1 && middle > 2e-4 && high == 0;
    cirrus += high > 0 && middle == 0;
  }
  EXPECT_GT(deck / sea, 0.5);
  EXPECT_LT(deck / sea, 0.98);
  EXPECT_GT(towers, 20);
  EXPECT_LT(towers, 0.1 * double(layer()));
  EXPECT_GT(cumulus / double(layer()), 0.05);
  EXPECT_GT(cirrus / double(layer()), 0.02);
}

TEST(WrfSample, AMovingNestMoves) {
  const fs::path path = made_folder() / "nest.nc";
  const samples::WrfShape shape = {
      .nx = 8, .ny = 6, .nz = 5, .times = 2, .cell_m = 9000, .nest_step_m = 18000};
  samples::write_wrf(nc_writer(), path, shape);
  const MadeFile file(path);
  const std::vector<double> lat = file.values("XLAT"), lon = file.values("XLONG");
  // 18 km east and north are two cells: the later corner is the earlier third diagonal place
  EXPECT_NEAR(lat[48], lat[2 * 8 + 2], 1e-4);
  EXPECT_NEAR(lon[48], lon[2 * 8 + 2], 1e-4);
  EXPECT_EQ(file.text("Times"), "2024-07-20_01:00:002024-07-20_02:00:00");
}

}  // namespace
}  // namespace nepho::test
