// Water to extinction, times, missing values, maps: each against its own source.

#include <cmath>
#include <fstream>
#include <sstream>

#include "accuracy_report.h"
#include "forecast/files/file_time.h"
#include "forecast/water/water.h"
#include "geo/map_projection.h"
#include "nc_writer.h"
#include "sources/netcdf/nc_file.h"

namespace nepho::forecast::test {
using nepho::test::report_accuracy;
namespace {

TEST(Water, WrittenOutNumbers) {
  // 1 g/m3 of 10 um drops is 0.157 per m; 0.01 g/m3 of 40 um crystals 4.1e-4 per m.
  EXPECT_NEAR(1e-3 * droplet_extinction_m2_per_kg(10e-6), 0.157, 0.0005);
  EXPECT_NEAR(1e-5 * ice_extinction_m2_per_kg(40e-6), 4.1e-4, 1e-6);
  // 0.3 g/m3 in 100 drops per cm3 over the sea.
  EXPECT_NEAR(droplet_radius_m(0.3e-3, {100e6, 0.77}), 9.8e-6, 0.05e-6);
  EXPECT_NEAR(droplets_over(0).number_per_m3, 50.6e6, 0.1e6);
  EXPECT_NEAR(droplets_over(1).number_per_m3, 313e6, 0.5e6);
  EXPECT_EQ(droplet_radius_m(0, droplets_over(0)), 4e-6);
  EXPECT_EQ(droplet_radius_m(1, droplets_over(0)), 30e-6);
  // Sun & Rikus at 0.1 g/m3 and -40 degC, by hand: (1.2351 - 0.42) (45.8966 0.1^0.2214 +
  // 0.7957 0.1^0.2535 150) um of diameter.
  EXPECT_NEAR(ice_radius_m(1e-4, 233.15, 45),
              0.64952e-6 * 0.8151 * (45.8966 * 0.60062 + 0.7957 * 0.55783 * 150), 2e-9);
  EXPECT_NEAR(ice_radius_m(0, 200, 0), 0.64952 * 60e-6, 1e-12);
  // Marshall & Palmer: 1 g/m3 of rain has D0 = (1e-3 / (pi 1000 8e6))^(1/4) = 447 um.
  EXPECT_NEAR(precipitation_extinction_m2_per_kg(Species::kRain, 1e-3, 290),
              1 / (999.84 * 446.6e-6), 0.003);
  // Large particles are thin: a tenth of the drops of the same water, and less.
  for (const Species s : {Species::kRain, Species::kSnow, Species::kGraupel})
    EXPECT_LT(precipitation_extinction_m2_per_kg(s, 1e-3, 265), 0.1 * 157);
}

// The Mie sums of tests/data/truth/mie_bulk.csv at 550 nm.
TEST(Water, DropletEfficiencyAgainstMie) {
  std::ifstream in(NEPHO_TEST_MIE_BULK);
  std::string line;
  std::getline(in, line);
  double worst = 0;
  int rows = 0;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    double radius_um = 0, variance = 0, wavelength_um = 0, real = 0, imaginary = 0, efficiency = 0;
    fields >> radius_um >> variance >> wavelength_um >> real >> imaginary >> efficiency;
    if (wavelength_um != 0.55) continue;
    ++rows;
    worst = std::max(worst, std::abs(droplet_efficiency(radius_um * 1e-6) / efficiency - 1));
  }
  EXPECT_EQ(rows, 5);
  report_accuracy("netcdf", "droplet extinction efficiency against Mie", worst, 1e-3, "1");
  EXPECT_LT(worst, 1e-3);
}

struct TimeCase {
  const char *units, *calendar;
  double value;
  const char* date;
};

TEST(Time, AxesAgainstDates) {
  const TimeCase cases[] = {
      {"hours since 1900-01-01 00:00:00.0", "gregorian", 973356, "2011-01-15 12:00:00"},
      {"seconds since 1970-01-01", "", 1e9, "2001-09-09 01:46:40"},
      {"minutes since 2005-08-28 00:00:00", "standard", 720, "2005-08-28_12:00:00"},
      {"days since 0001-01-01", "standard", 730121, "2000-01-01"},
      {"days since 0001-01-01", "proleptic_gregorian", 730119, "2000-01-01"},
      {"days since 1900-01-01", "noleap", 36559.5, "2000-03-01 12:00:00"},
      {"hours since 2000-01-01T06:00:00Z", "", -6, "2000-01-01"},
      {"hours since 2000-01-01 00:00:00 +02:00", "", 0, "1999-12-31 22:00:00"},
      {"day as %Y%m%d.%f", "proleptic_gregorian", 20130502.569444, "2013-05-02 13:40:00"},
  };
  int n = 0;
  for (const TimeCase& c : cases) {
    const std::string path = folder() / ("time" + std::to_string(n++) + ".nc");
    {
      NcWriter nc(path);
      nc.dimension("time", 1);
      Attributes attributes = {{"units", std::string(c.units)}};
      if (*c.calendar) attributes["calendar"] = std::string(c.calendar);
      nc.variable("time", NC_DOUBLE, {"time"}, {c.value}, attributes);
    }
    const netcdf::NcFile file(path, {});
    const auto wanted = parse_date_ns(c.date);
    ASSERT_TRUE(wanted);
    EXPECT_NEAR(double(read_times(file, *file.find("time")).utc_ns[0] - *wanted) * 1e-9, 0, 1e-3)
        << c.units << " " << c.calendar;
  }
  EXPECT_EQ(parse_date_ns("1970-01-02T00:00:01Z"), 86401000000000);
  EXPECT_EQ(parse_date_ns("2005-13-01"), std::nullopt);
  EXPECT_EQ(parse_date_ns("yesterday"), std::nullopt);
}

// What is missing is told by the packed number, before scale and offset.
TEST(Packing, MissingValues) {
  const std::string path = folder() / "packing.nc";
  {
    NcWriter nc(path);
    nc.dimension("n", 4);
    const auto put = [&](const char* name, int type, std::vector<double> values, Attributes a) {
      nc.variable(name, type, {"n"}, values, a);
    };
    put("packed", NC_SHORT, {-32767, 0, 1, 2},
        {{"_FillValue", -32767.0}, {"scale_factor", 0.5}, {"add_offset", 10.0}});
    put("missing", NC_SHORT, {-1, -2, 3, 4}, {{"missing_value", std::vector<double>{-1, -2}}});
    put("ranged", NC_SHORT, {-1, 0, 100, 101}, {{"valid_range", std::vector<double>{0, 100}}});
    put("least", NC_FLOAT, {-1, 0, 1, 2}, {{"valid_min", 0.0}, {"valid_max", 1.0}});
    put("byte", NC_BYTE, {-1, 0, 127, -128}, {{"_Unsigned", "true"}, {"_FillValue", -1.0}});
    put("untouched", NC_FLOAT, {9.969209968386869e36, 1, NAN, 2}, {});
    put("twenty", NC_FLOAT, {-1e20, 1, 2, 3}, {{"missing_value", -1e20}});
    put("bytes", NC_BYTE, {-127, 1, 2, 3}, {});  // bytes have no default fill
  }
  const netcdf::NcFile file(path, {});
  const auto expect = [&](const char* name, std::vector<double> wanted) {
    const std::vector<double> doubles = file.read_all(*file.find(name));
    const std::vector<float> floats = file.read_floats(*file.find(name), {0}, {4});
    for (std::size_t n = 0; n < 4; ++n) {
      EXPECT_EQ(std::isnan(doubles[n]), std::isnan(wanted[n])) << name << " " << n;
      EXPECT_EQ(std::isnan(floats[n]), std::isnan(wanted[n])) << name << " " << n;
      if (!std::isnan(wanted[n])) {
        EXPECT_EQ(doubles[n], wanted[n]) << name;
        EXPECT_EQ(double(floats[n]), wanted[n]) << name;
      }
    }
  };
  expect("packed", {NAN, 10, 10.5, 11});
  expect("missing", {NAN, NAN, 3, 4});
  expect("ranged", {NAN, 0, 100, NAN});
  expect("least", {NAN, 0, 1, NAN});
  expect("byte", {NAN, 0, 127, 128});
  expect("untouched", {NAN, 1, NAN, 2});
  expect("twenty", {NAN, 1, 2, 3});
  expect("bytes", {-127, 1, 2, 3});
}

constexpr double kDegree = M_PI / 180, kSphere = 6370000;

// Snyder (1987), USGS Professional Paper 1395, the spherical forms.
TEST(Map, SphereAgainstSnyder) {
  MapSpec spec;
  spec.true_latitude1_deg = 30;
  spec.true_latitude2_deg = 60;
  spec.central_longitude_deg = -97;
  spec.origin_latitude_deg = 40;
  const MapProjection lambert(spec);
  const auto tan_half = [](double lat) { return std::tan((45 + lat / 2) * kDegree); };
  const double n = std::log(std::cos(30 * kDegree) / std::cos(60 * kDegree)) /
                   std::log(tan_half(60) / tan_half(30));
  const double f = std::cos(30 * kDegree) * std::pow(tan_half(30), n) / n;
  const auto rho = [&](double lat) { return kSphere * f / std::pow(tan_half(lat), n); };
  spec.kind = MapKind::kPolarStereographic;
  spec.true_latitude1_deg = 60;
  const MapProjection polar(spec);
  double worst = 0, back = 0;
  for (const double lat : {20.0, 40.0, 55.0})
    for (const double lon : {-120.0, -97.0, -70.0}) {
      const double theta = n * (lon + 97) * kDegree;
      const glm::dvec2 wanted(rho(lat) * std::sin(theta), rho(40) - rho(lat) * std::cos(theta));
      worst = std::max(worst, glm::length(lambert.map_m({lat, lon}) - wanted));
      back = std::max(back, glm::length(lambert.lat_lon_deg(wanted) - glm::dvec2(lat, lon)));
      const double r = kSphere * (1 + std::sin(60 * kDegree)) / tan_half(lat);
      const double angle = (lon + 97) * kDegree;
      const glm::dvec2 on_pole(r * std::sin(angle), -r * std::cos(angle));
      worst = std::max(worst, glm::length(polar.map_m({lat, lon}) - on_pole));
      const glm::dvec2 place = polar.lat_lon_deg(on_pole);
      back =
          std::max({back, std::abs(place.x - lat), std::abs(std::remainder(place.y - lon, 360))});
    }
  report_accuracy("netcdf", "maps of a sphere against Snyder's closed forms", worst, 1e-6, "m");
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(back, 1e-10);
}

TEST(Map, RotatedPole) {
  MapSpec spec;
  spec.kind = MapKind::kRotated;
  spec.pole_latitude_deg = 39.25;
  spec.pole_longitude_deg = -162;
  const MapProjection map(spec);
  // The rotated origin lies opposite to the pole's meridian, 90 degrees from it.
  const glm::dvec2 origin = map.lat_lon_deg({0, 0});
  EXPECT_NEAR(origin.x, 50.75, 1e-12);
  EXPECT_NEAR(std::remainder(origin.y - 18, 360), 0, 1e-12);
  // sin(rlat) = sin(lat) sin(pole) + cos(lat) cos(pole) cos(lon - pole's).
  for (const double lat : {-20.0, 45.0, 70.0})
    for (const double lon : {-30.0, 10.0, 60.0}) {
      const glm::dvec2 rotated = map.map_m({lat, lon});
      EXPECT_NEAR(
          std::sin(rotated.y * kDegree),
          std::sin(lat * kDegree) * std::sin(39.25 * kDegree) +
              std::cos(lat * kDegree) * std::cos(39.25 * kDegree) * std::cos((lon + 162) * kDegree),
          1e-14);
      const glm::dvec2 back = map.lat_lon_deg(rotated);
      EXPECT_NEAR(back.x, lat, 1e-11);
      EXPECT_NEAR(std::remainder(back.y - lon, 360), 0, 1e-11);
    }
}

}  // namespace
}  // namespace nepho::forecast::test
