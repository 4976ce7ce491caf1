// WRF files: grid, heights, water and times of a file in closed form.

#include <algorithm>

#include "accuracy_report.h"
#include "forecast/water/air.h"
#include "forecast/water/water.h"
#include "sources/netcdf/open_netcdf.h"
#include "wrf_twin.h"

namespace nepho::forecast::test {
using nepho::test::report_accuracy;
namespace {

std::string facts_of(const Forecast& f) {
  std::string text;
  for (const auto& fact : f.facts()) text += fact + "\n";
  return text;
}

TEST(Wrf, GridMovesWithTheNest) {
  const WrfTwin twin;
  const auto f = open(twin.write("wrf"));
  EXPECT_EQ(f->time_origin_ns(), 1125230400000000000);  // 2005-08-28 12:00 UTC
  ASSERT_EQ(f->times_s().size(), 2u);
  EXPECT_EQ(f->times_s()[1], 3 * 3600.0);
  double worst = 0;
  for (const std::size_t t : {0u, 1u}) {
    const auto grid = f->grid(t);
    ASSERT_EQ(grid->nx(), twin.nx);
    ASSERT_EQ(grid->ny(), twin.ny);
    for (int j = 0; j < twin.ny; ++j)
      for (int i = 0; i < twin.nx; ++i) {
        const glm::dvec2 place = grid->lat_lon_deg(i + 0.5, j + 0.5);
        worst = std::max({worst, std::abs(place.x - twin.latitude(int(t), j)),
                          std::abs(place.y - twin.longitude(i))});
      }
  }
  EXPECT_LT(worst, 1e-5);  // XLAT is a float
  EXPECT_NE(facts_of(*f).find("agree with the map"), std::string::npos) << facts_of(*f);
}

TEST(Wrf, HeightsAreSaidToBeOverTheEllipsoid) {
  const auto said = open(WrfTwin().write("geoid"))->assumptions();
  EXPECT_TRUE(std::ranges::any_of(said, [](const std::string& text) {
    return text.find("above the ellipsoid") != std::string::npos &&
           text.find("107 m below to 86 m above") != std::string::npos;
  }));
}

TEST(Wrf, MapAloneIsTheSameGrid) {
  WrfTwin twin;
  const std::string with = twin.write("with_xlat");
  twin.with_xlat = false;
  const auto a = open(with)->grid(0), b = open(twin.write("without_xlat"))->grid(0);
  double worst = 0;
  for (double y = 0; y <= twin.ny; y += 0.5)
    for (double x = 0; x <= twin.nx; x += 0.5) {
      const glm::dvec2 d = a->lat_lon_deg(x, y) - b->lat_lon_deg(x, y);
      worst = std::max({worst, std::abs(d.x), std::abs(d.y)});
    }
  report_accuracy("netcdf", "WRF grid by its map against XLAT, XLONG", worst, 1e-3, "deg");
  EXPECT_LT(worst, 1e-3);
}

TEST(Wrf, AMapThatDiffersIsSaid) {
  WrfTwin twin;
  twin.dx_m = 10000;
  const std::string path = twin.write("differs");
  {
    int id = 0;
    ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &id), NC_NOERR);
    const double dx = 11000;
    nc_redef(id);
    nc_put_att_double(id, NC_GLOBAL, "DX", NC_DOUBLE, 1, &dx);
    nc_close(id);
  }
  EXPECT_NE(facts_of(*open(path)).find("DIFFER from the map"), std::string::npos);
}

TEST(Wrf, HeightsStandOnTheModelsGround) {
  const WrfTwin twin;
  const auto f = open(twin.write("heights"));
  const ForecastColumns c = f->columns(0);
  const ForecastGround ground = f->ground(0);
  for (int j = 0; j < twin.ny; ++j)
    for (int i = 0; i < twin.nx; ++i) {
      const std::size_t cell = std::size_t(j * twin.nx + i);
      EXPECT_NEAR(double(c.interface_m[cell * 5]), twin.terrain_m(i, j), 1e-3);
      EXPECT_NEAR(double(ground.height_m[cell]), twin.terrain_m(i, j), 1e-3);
      EXPECT_EQ(ground.water[cell], i < 3 ? 0.0f : 1.0f);
      // 2000 m of the model's 9.81 are 2000.68 m of standard gravity, and it falls with height.
      const double base = twin.phi(0, i, j) / 9.80665, top = twin.phi(4, i, j) / 9.80665;
      const double rise = top / (1 - top / 6356766) - base / (1 - base / 6356766);
      EXPECT_NEAR(double(c.interface_m[cell * 5 + 1]), twin.terrain_m(i, j) + 350.15, 0.1);
      EXPECT_NEAR(double(c.interface_m[cell * 5 + 4]), twin.terrain_m(i, j) + rise, 2e-3);
    }
  EXPECT_NEAR(f->height_range_m().x, 0, 1e-3);
  EXPECT_GT(f->height_range_m().y, twin.terrain_m(5, 4) + 2000);
  EXPECT_LT(f->height_range_m().y, twin.terrain_m(5, 4) + 2003);
  EXPECT_NE(facts_of(*f).find("data end at 2.5 km"), std::string::npos) << facts_of(*f);
}

TEST(Wrf, WaterIsTheFormulas) {
  const WrfTwin twin;
  const auto f = open(twin.write("water"));
  EXPECT_TRUE(f->has_ice());
  for (const int t : {1, 0}) {
    const ForecastColumns c = f->columns(std::size_t(t));
    const std::size_t cloud = std::size_t(1 * twin.nx + 2) * 4 + 1;
    // Layer 1: 901 hPa, theta 296 K, 8 g/kg of vapour per dry air; over land.
    const double p = 90100, temperature = 296 * std::pow(p / 1e5, 2.0 / 7);
    const double q = 0.008 / 1.008;
    const double density = p / (287.058 * temperature * (1 + (461.5228 / 287.058 - 1) * q));
    const double content = twin.cloud * (t + 1) * density * (1 - q);
    const double radius = std::cbrt(3 * content / (4 * M_PI * 999.84 * 0.69 * 313.2e6));
    const double efficiency = 2 + 2.12 * std::pow(2 * M_PI * radius / 550e-9, -2.0 / 3);
    const double wanted = 3 * content * efficiency / (4 * 999.84 * radius);
    EXPECT_NEAR(double(c.extinction_per_m[cloud]), wanted, 2e-5 * wanted);
    EXPECT_EQ(c.ice_extinction_per_m[cloud], 0.0f);
    // Nothing but the two planted cells: tiny negatives are clear.
    const std::size_t ice = std::size_t(3 * twin.nx + 4) * 4 + 3;
    for (std::size_t n = 0; n < c.extinction_per_m.size(); ++n)
      if (n != cloud && n != ice) {
        EXPECT_EQ(c.extinction_per_m[n], 0.0f);
      }
    EXPECT_EQ(c.extinction_per_m[ice], c.ice_extinction_per_m[ice]);
    EXPECT_GT(c.ice_extinction_per_m[ice], 0.0f);
  }
  EXPECT_NE(facts_of(*f).find("119 negative water values"), std::string::npos) << facts_of(*f);
  EXPECT_NEAR(f->liquid_radius_m(), 7.6e-6, 1.5e-6);
}

// Rain, snow and graupel, numbers of droplets, and radii, which come before numbers.
TEST(Wrf, SizesAndKindsAreTheFiles) {
  WrfTwin twin;
  twin.with_kinds = twin.with_number = true;
  const auto at = [&](const ForecastColumns& c, int i, int j, int k) {
    return double(c.extinction_per_m[std::size_t((j * twin.nx + i) * twin.nz + k)]);
  };
  const auto density = [](int k) {  // of dry air
    const double p = 95100 - 5000 * k, q = 0.008 / 1.008;
    const double t = (295.0 + k) * std::pow(p / 1e5, 2.0 / 7);
    return p / (287.058 * t * (1 + 0.608 * q)) * (1 - q);
  };
  const double temperature_K = 296 * std::pow(0.901, 2.0 / 7), content = 5e-4 * density(1);
  const auto by_number = open(twin.write("numbers"));
  const ForecastColumns c = by_number->columns(0);
  const double number = 2e8 * density(1) * 1.008;
  EXPECT_NEAR(at(c, 2, 1, 1) / (content * droplet_extinction_m2_per_kg(
                                              droplet_radius_m(content, {number, 0.69}))),
              1, 2e-3);
  const double fall = 1e-4 * density(1);
  for (const auto& [cell, species] :
       {std::pair{1, Species::kRain}, {2, Species::kSnow}, {3, Species::kGraupel}})
    EXPECT_NEAR(at(c, cell, 2, 1) /
                    (fall * precipitation_extinction_m2_per_kg(species, fall, temperature_K)),
                1, 2e-3)
        << cell;
  twin.with_radii = true;
  const auto by_radius = open(twin.write("radii"));
  const ForecastColumns r = by_radius->columns(0);
  EXPECT_NEAR(at(r, 2, 1, 1) / (content * droplet_extinction_m2_per_kg(12e-6)), 1, 2e-3);
  EXPECT_NEAR(at(r, 4, 3, 3) / (1e-5 * density(3) * ice_extinction_m2_per_kg(55e-6)), 1, 2e-3);
  const auto said = by_radius->recognised();
  EXPECT_TRUE(std::ranges::any_of(said, [](const DataFacts::Recognised& r) {
    return r.text.find("Droplet radii are the file's, RE_CLOUD.") != std::string::npos;
  }));
}

TEST(Wrf, OneCondensateFreezes) {
  WrfTwin twin;
  twin.scheme = 3;
  twin.with_ice = false;
  const auto f = open(twin.write("wsm3"));
  EXPECT_TRUE(f->has_ice());
  EXPECT_NE(facts_of(*f).find("WSM3"), std::string::npos);
  const ForecastColumns c = f->columns(0);  // at 14 degC it is still water
  for (const float ice : c.ice_extinction_per_m) EXPECT_EQ(ice, 0.0f);
}

TEST(Wrf, SeveralFilesAreOneForecast) {
  WrfTwin early, late;
  early.nt = 1;
  const std::string first = early.write("first"), both = late.write("both");
  OpenRequest request;
  request.files = {both, first};
  const auto f = netcdf::open_netcdf(request);
  ASSERT_EQ(f->times_s().size(), 2u);  // one time is in both
  EXPECT_EQ(f->times_s()[1], 3 * 3600.0);
  EXPECT_EQ(f->columns(0).extinction_per_m, open(first)->columns(0).extinction_per_m);
  EXPECT_EQ(f->columns(1).extinction_per_m, open(both)->columns(1).extinction_per_m);
  EXPECT_NE(facts_of(*f).find("1 time occurs twice"), std::string::npos);
}

}  // namespace
}  // namespace nepho::forecast::test
