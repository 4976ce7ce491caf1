// One cell with cloud on every grid that GRIB has: where the reader puts it, against the places
// that ecCodes itself gives.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

#include "accuracy_report.h"
#include "planted_cell.h"

namespace nepho::grib::test {
namespace {

std::vector<Case> cases() {
  std::vector<Case> all;
  const std::size_t n = kNx * kNy;
  const Keys sphere = {{"shapeOfTheEarth", 6}}, wgs84 = {{"shapeOfTheEarth", 5}};
  for (const int edition : {1, 2}) {
    const auto name = [&](const char* type) { return type + std::to_string(edition); };
    all.push_back({name("regular_ll"), edition, n, lat_lon("regular_ll", 2.5, 60, 350), 2.5});
    all.push_back(
        {name("rotated_ll"), edition, n,
         with(lat_lon("rotated_ll", 0.5, 3, 357.5), {{"latitudeOfSouthernPoleInDegrees", -39.25},
                                                     {"longitudeOfSouthernPoleInDegrees", 18.0},
                                                     {"angleOfRotationInDegrees", 0.0}}),
         0.5});
    all.push_back({name("lambert"), edition, n,
                   with(edition == 2 ? sphere : Keys{}, map("lambert", 32, 250,
                                                            {{"Latin1InDegrees", 33.0},
                                                             {"Latin2InDegrees", 45.0},
                                                             {"LoVInDegrees", 262.5},
                                                             {"DxInMetres", 40000},
                                                             {"DyInMetres", 40000}})),
                   0.4});
    all.push_back({name("polar_stereographic"), edition, n,
                   map("polar_stereographic", 70, 190,
                       with(edition == 2 ? Keys{{"LaDInDegrees", 60.0}} : Keys{},
                            {{"orientationOfTheGridInDegrees", 249.0},
                             {"DxInMetres", 30000},
                             {"DyInMetres", 30000}})),
                   0.3});
  }
  all.push_back({"lambert_ellipsoid", 2, n,
                 with(wgs84, map("lambert", 44, 2,
                                 {{"LaDInDegrees", 46.5},
                                  {"Latin1InDegrees", 46.5},
                                  {"Latin2InDegrees", 46.5},
                                  {"LoVInDegrees", 3.0},
                                  {"DxInMetres", 25000},
                                  {"DyInMetres", 25000}})),
                 0.25});
  all.push_back({"polar_south", 2, n,
                 with(sphere, map("polar_stereographic", -62, 100,
                                  {{"LaDInDegrees", -71.0},
                                   {"projectionCentreFlag", 128},
                                   {"orientationOfTheGridInDegrees", 90.0},
                                   {"DxInMetres", 30000},
                                   {"DyInMetres", 30000}})),
                 0.3});
  all.push_back({"mercator", 2, n,
                 with(sphere, map("mercator", 10, 250,
                                  {{"LaDInDegrees", 20.0},
                                   {"DiInMetres", 50000},
                                   {"DjInMetres", 50000},
                                   {"orientationOfTheGridInDegrees", 0.0},
                                   {"latitudeOfLastGridPointInDegrees", 13.8},
                                   {"longitudeOfLastGridPointInDegrees", 255.26}})),
                 0.5});
  // Of no map of ours: cell by cell, as ecCodes places them.
  all.push_back({"lambert_azimuthal_equal_area", 2, n,
                 with(sphere, map("lambert_azimuthal_equal_area", 40, 5,
                                  {{"standardParallelInDegrees", 52.0},
                                   {"centralLongitudeInDegrees", 10.0},
                                   {"DxInMetres", 40000},
                                   {"DyInMetres", 40000}})),
                 0.4, false});
  return all;
}

// Snyder (1987), Map Projections: A Working Manual, 15-1 to 15-4 and 21-33, on a sphere: from a
// place to m, without constants that cancel between two places.
glm::dvec2 forward_m(const Case& c, double lat, double lon) {
  const auto key = [&](const char* name) {
    const auto at = std::ranges::find(c.grid, name, &Key::name);
    return at == c.grid.end() ? NAN : at->number;
  };
  const double d = std::numbers::pi / 180, half = std::numbers::pi / 4;
  const double radius_m = key("shapeOfTheEarth") == 6 ? 6371229 : 6367470;
  if (c.name.starts_with("lambert")) {
    const double p1 = key("Latin1InDegrees") * d, p2 = key("Latin2InDegrees") * d;
    const double n = p1 == p2 ? std::sin(p1)
                              : std::log(std::cos(p1) / std::cos(p2)) /
                                    std::log(std::tan(half + p2 / 2) / std::tan(half + p1 / 2));
    const double f = std::cos(p1) * std::pow(std::tan(half + p1 / 2), n) / n;
    const double rho = radius_m * f / std::pow(std::tan(half + lat * d / 2), n);
    const double theta = n * std::remainder(lon - key("LoVInDegrees"), 360) * d;
    return {rho * std::sin(theta), -rho * std::cos(theta)};
  }
  const bool south = key("projectionCentreFlag") == 128;
  const double true_deg = std::isnan(key("LaDInDegrees")) ? 60 : std::abs(key("LaDInDegrees"));
  const double rho =
      radius_m * (1 + std::sin(true_deg * d)) * std::tan(half - (south ? -lat : lat) * d / 2);
  const double theta = (lon - key("orientationOfTheGridInDegrees")) * d;
  return {rho * std::sin(theta), (south ? 1 : -1) * rho * std::cos(theta)};
}

// How far, in degrees of arc, a place is from where point `at` of the message stands on its map.
double off_map_deg(const Case& c, glm::dvec2 place, std::size_t at, bool north, bool columns) {
  const auto key = [&](const char* name) {
    return std::ranges::find(c.grid, name, &Key::name)->number;
  };
  const double i = double(columns ? at / kNy : at % kNx), j = double(columns ? at % kNy : at / kNx);
  const glm::dvec2 first = forward_m(c, key("latitudeOfFirstGridPointInDegrees"),
                                     key("longitudeOfFirstGridPointInDegrees"));
  const glm::dvec2 step(key("DxInMetres"), key("DyInMetres") * (north ? 1 : -1));
  return glm::distance(forward_m(c, place.x, place.y), first + glm::dvec2(i, j) * step) / 111195;
}

TEST(GribGrids, OneCellStaysInItsPlace) {
  double worst_deg = 0;
  for (const Case& c : cases()) {
    int ways = 0;
    for (const bool north : {false, true})
      for (const bool columns : {false, true}) {
        if ((columns || !north) && !c.any_scan) continue;
        // Degrees of both ends say the direction; maps have the flag alone.
        const bool degrees = c.name.find("_ll") != std::string::npos;
        if (north && (degrees || c.name == "mercator")) continue;
        if (!north && c.name == "lambert_ellipsoid") continue;
        SCOPED_TRACE(c.name + (north ? " northwards" : "") + (columns ? " by columns" : ""));
        const Keys scan = {{"iScansNegatively", 0},
                           {"jScansPositively", int(north || c.name == "mercator")},
                           {"jPointsAreConsecutive", int(columns)}};
        for (const std::size_t at : {std::size_t{0}, c.points - 1, c.points / 2 + 1}) {
          const Planted planted = plant(c, at, scan);
          const auto forecast = open({planted.path});
          const glm::dvec2 place = column_place(*forecast);
          const bool on_sphere = c.name.starts_with("lambert1") || c.name.starts_with("lambert2") ||
                                 c.name.starts_with("polar");
          double apart = on_sphere ? off_map_deg(c, place, at, north, columns) : 0;
          EXPECT_LT(apart, 1e-3) << place.x << " " << place.y << " on its map";
          // ecCodes itself places rows of maps that run north only (2.28).
          if (degrees || c.name == "mercator" || (north && !columns))
            apart = std::max(apart, distance_deg(place.x, place.y, planted.place.latitude,
                                                 planted.place.longitude));
          EXPECT_LT(apart, 1e-3) << place.x << " " << place.y << " for " << planted.place.latitude
                                 << " " << planted.place.longitude;
          EXPECT_LT(apart, 0.5 * c.cell_deg);
          worst_deg = std::max(worst_deg, apart);
        }
        ++ways;
      }
    EXPECT_GE(ways, 1) << c.name;
  }
  nepho::test::report_accuracy("Forecasts in GRIB", "centres of cells against ecCodes, 12 grids",
                               worst_deg, 1e-3, "deg");
}

// Gaussian rows: 2 N latitudes, whole turns or rows of their own numbers of points.
Keys gaussian(const char* type, long n, const Keys& more) {
  return with({{"gridType", type}, {"N", n}}, more);
}

TEST(GribGrids, GaussianLatitudes) {
  for (const int edition : {1, 2}) {
    const long n = 16, rows = 2 * n, columns = 64;
    const double first = gaussian_latitudes_deg(n).front();
    Case c{"regular_gg" + std::to_string(edition), edition, std::size_t(rows * columns),
           gaussian("regular_gg", n,
                    {{"Ni", columns},
                     {"Nj", rows},
                     {"latitudeOfFirstGridPointInDegrees", first},
                     {"latitudeOfLastGridPointInDegrees", -first},
                     {"longitudeOfFirstGridPointInDegrees", 0.0},
                     {"longitudeOfLastGridPointInDegrees", 354.375},
                     {"iDirectionIncrementInDegrees", 5.625}}),
           5.625};
    for (const std::size_t at : {std::size_t{5}, c.points / 2 + 30}) {
      const Planted planted = plant(c, at, {});
      const auto forecast = open({planted.path});
      EXPECT_TRUE(forecast->grid(0)->around());
      // Cells end half way between centres, which are not even: their middles are near.
      const glm::dvec2 place = column_place(*forecast);
      EXPECT_LT(distance_deg(place.x, place.y, planted.place.latitude, planted.place.longitude),
                0.5 * c.cell_deg);
      const GribFile file({planted.path}, {});
      const std::vector<double> lat = all_of(file, "lat");
      double nearest = 90;
      for (const double y : lat) nearest = std::min(nearest, std::abs(y - planted.place.latitude));
      EXPECT_LT(nearest, 1e-3);
    }
  }
}

// An octahedral grid: rows of 20, 24, ... points (Malardel et al. 2016).
TEST(GribGrids, ReducedRowsKeepTheirSums) {
  std::vector<long> rows;
  const long n = 8;
  std::string bytes;
  std::vector<double> water;
  for (const double hPa : {900.0, 800.0})
    for (const char* name : {"clwmr", "t", "gh"}) {
      rows.clear();
      for (long j = 0; j < 2 * n; ++j) rows.push_back(16 + 4 * (1 + std::min(j, 2 * n - 1 - j)));
      const std::size_t points = std::size_t(std::accumulate(rows.begin(), rows.end(), 0l));
      const double first = gaussian_latitudes_deg(n).front();
      Made made(2, gaussian("reduced_gg", n, {{"Nj", 2 * n}}));
      made.set("pl", rows);
      made.set({{"numberOfDataPoints", long(points)},
                {"latitudeOfFirstGridPointInDegrees", first},
                {"latitudeOfLastGridPointInDegrees", -first},
                {"longitudeOfFirstGridPointInDegrees", 0.0}});
      made.set(parameter(2, name)).set(isobaric(2, hPa)).set(at_hour(2, 0));
      made.set({{"bitsPerValue", 24}});
      std::vector<double> values(points);
      for (std::size_t p = 0; p < points; ++p)
        values[p] = name[0] == 't'   ? GribTwin::temperature_K(hPa)
                    : name[0] == 'g' ? GribTwin::geopotential_height_m(hPa)
                                     : 1e-4 * double((p * 7919) % 13 > 8);
      if (name[0] == 'c' && hPa == 800) water = values;
      bytes += made.values(values).bytes();
    }
  const GribFile file({write_bytes("reduced.grib2", bytes)}, {});
  const std::vector<double> all = all_of(file, "clwmr");
  const std::size_t nx = all_of(file, "lon").size(), ny = all_of(file, "lat").size();
  ASSERT_EQ(nx, 48u);
  ASSERT_EQ(ny, 16u);
  // Level 0 is 800 hPa; rows are read from the south.
  std::size_t first = 0;
  double worst = 0, west = 0;
  for (std::size_t j = 0; j < ny; ++j) {
    const std::size_t points = std::size_t(rows[j]);
    double ours = 0, theirs = 0, ours_x = 0, theirs_x = 0;
    for (std::size_t i = 0; i < nx; ++i) {
      const double value = all[(ny - 1 - j) * nx + i];
      ours += value / double(nx);
      ours_x += value / double(nx) * std::cos(2 * std::numbers::pi * double(i) / double(nx));
    }
    for (std::size_t p = 0; p < points; ++p) {
      theirs += water[first + p] / double(points);
      theirs_x += water[first + p] / double(points) *
                  std::cos(2 * std::numbers::pi * double(p) / double(points));
    }
    worst = std::max(worst, std::abs(ours - theirs) / theirs);
    west = std::max(west, std::abs(ours_x - theirs_x) / theirs);
    first += points;
  }
  nepho::test::report_accuracy("Forecasts in GRIB", "reduced rows: water of a row", worst, 1e-6,
                               "1");
  nepho::test::report_accuracy("Forecasts in GRIB", "reduced rows: first harmonic of a row", west,
                               0.02, "1");
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(west, 0.02);
  EXPECT_TRUE(says(file.assumptions(), "reduced grid"));
}

// The same field on two grids of the same places, and on others.
TEST(GribGrids, OtherGridsAreLeftOutOrRefused) {
  GribTwin twin;
  twin.hours = {0};
  std::string bytes = twin.all(0);
  GribTwin shifted = twin;
  for (double& x : shifted.longitude) x += 10;
  const auto zero = [](double, double) { return 1e-5; };
  const std::string wind = shifted.message("u", 700, 0, zero);
  const GribFile file({write_bytes("staggered.grib2", bytes + wind)}, {});
  EXPECT_TRUE(says(file.facts(), "1 field of the file are on other grids"));
  EXPECT_TRUE(says(file.facts(), "u"));
  const std::string refused =
      refusal(write_bytes("two.grib2", bytes + shifted.message("clwmr", 700, 0, zero)));
  for (const char* part : {"several grids", "regular_ll, 6 x 5", "from 100, -30", "from 110, -30"})
    EXPECT_NE(refused.find(part), std::string::npos) << refused;
  // The other way of scanning is no other grid.
  GribTwin north = twin;
  north.north = true;
  const std::string both = bytes + north.message("icmr", 700, 0, [](double lat, double) {
    return lat == 50 ? 1e-4 : 0.0;
  });
  const GribFile scanned({write_bytes("both.grib2", both)}, {});
  const std::vector<double> ice = all_of(scanned, "icmr");
  EXPECT_NEAR(ice[30 + 24], 1e-4, 1e-9);  // 700 hPa, 50 N
  EXPECT_EQ(ice[30], 0);
}

TEST(GribGrids, RegionReadsItsCells) {
  const std::string path = GribTwin().write("region.grib2");
  const auto whole = open({path});
  const auto part = open({path}, forecast::parse_region("-15,110,15,150", "--region"));
  const forecast::ForecastColumns all = whole->columns(0), some = part->columns(0);
  EXPECT_LT(some.nx * some.ny, all.nx * all.ny);
  const auto grid = part->grid(0), full = whole->grid(0);
  int compared = 0;
  for (int n = 0; n < some.nx * some.ny; ++n) {
    const glm::dvec2 at = grid->lat_lon_deg(n % some.nx + 0.5, n / some.nx + 0.5);
    for (int m = 0; m < all.nx * all.ny; ++m) {
      if (glm::distance(full->lat_lon_deg(m % all.nx + 0.5, m / all.nx + 0.5), at) > 1e-9) continue;
      for (int k = 0; k < all.nz; ++k)
        EXPECT_EQ(some.extinction_per_m[std::size_t(n * all.nz + k)],
                  all.extinction_per_m[std::size_t(m * all.nz + k)]);
      ++compared;
    }
  }
  EXPECT_EQ(compared, some.nx * some.ny);
}

TEST(GribGrids, TrianglesAreNamed) {
  std::string bytes;
  for (const double hPa : {900.0, 800.0}) {
    Made made(2, {{"gridType", "unstructured_grid"}, {"numberOfDataPoints", 50}});
    made.set(parameter(2, "clwmr")).set(isobaric(2, hPa)).set(at_hour(2, 0));
    bytes += made.values(std::vector<double>(50, 1e-4)).bytes();
  }
  const auto place = [](int number, double first, double step) {
    Made made(2, {{"gridType", "unstructured_grid"}, {"numberOfDataPoints", 50}});
    made.set({{"discipline", 0}, {"parameterCategory", 191}, {"parameterNumber", number}});
    made.set(level(2, 1, 1, 0)).set(at_hour(2, 0)).set({{"bitsPerValue", 24}});
    std::vector<double> values;
    for (int n = 0; n < 50; ++n) values.push_back(first + step * (number == 1 ? n / 10 : n % 10));
    return made.values(values).bytes();
  };
  // With the centres of the cells in the file they have places.
  const GribFile placed({write_bytes("placed.grib2", bytes + place(1, 45, 0.5) + place(2, 5, 0.5))},
                        {});
  EXPECT_EQ(placed.shape_text(*placed.find("clat")), "clat(ncells 50)");
  EXPECT_NEAR(all_of(placed, "clon")[13], 6.5, 1e-4);
  const std::string path = write_bytes("icon.grib2", bytes);
  const GribFile file({path}, {});
  EXPECT_EQ(file.shape_text(*file.find("clwmr")), "clwmr(time 1, isobaric 2, ncells 50)");
  const std::string text = refusal(path);
  EXPECT_NE(text.find("50 cells without centres"), std::string::npos) << text;
  EXPECT_NE(text.find("--grid FILE"), std::string::npos) << text;
}

}  // namespace
}  // namespace nepho::grib::test
