// Maps by GeographicLib against the same maps by PROJ, which share no code, on an ellipsoid.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "accuracy_report.h"
#include "core/error.h"
#include "geo/geoid.h"
#include "geo/nearest_places.h"
#include "geo/place.h"
#include "geo/proj_map.h"

namespace nepho::test {
namespace {

// Against looking at all of them.
TEST(NearestPlaces, AreTheNearest) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto any = [&] {
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
  };
  std::vector<glm::dvec3> places;
  for (int n = 0; n < 1000; ++n) places.push_back(any());
  const NearestPlaces tree(places);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 to = any();
    std::vector<std::uint32_t> all(places.size());
    for (std::uint32_t at = 0; at < all.size(); ++at) all[at] = at;
    std::ranges::sort(all, {}, [&](std::uint32_t at) { return glm::length(places[at] - to); });
    all.resize(6);
    EXPECT_EQ(tree.nearest(to, 6), all);
  }
  EXPECT_EQ(tree.nearest(any(), 5000).size(), 1000u);
}

#ifdef NEPHO_HAS_PROJ

// WGS 84's half axes.
MapSpec on_earth(MapKind kind) {
  MapSpec spec;
  spec.kind = kind;
  spec.equatorial_m = 6378137;
  spec.polar_m = 6356752.314245179;
  return spec;
}

struct Pair {
  MapSpec ours;
  std::string theirs;
};
std::vector<Pair> pairs() {
  MapSpec two = on_earth(MapKind::kLambertConformal);
  two.true_latitude1_deg = 33, two.true_latitude2_deg = 45;
  two.origin_latitude_deg = 39, two.central_longitude_deg = -96, two.false_easting_m = 7e5;
  MapSpec one = on_earth(MapKind::kLambertConformal);
  one.true_latitude1_deg = one.true_latitude2_deg = one.origin_latitude_deg = 47;
  one.central_longitude_deg = 3, one.scale = 0.9998;
  MapSpec mercator = on_earth(MapKind::kMercator);
  mercator.true_latitude1_deg = 20, mercator.central_longitude_deg = 175;
  MapSpec north = on_earth(MapKind::kPolarStereographic);
  north.true_latitude1_deg = 70, north.central_longitude_deg = -45;
  MapSpec south = on_earth(MapKind::kPolarStereographic);
  south.true_latitude1_deg = -90, south.central_longitude_deg = 30, south.scale = 0.97;
  MapSpec transverse = on_earth(MapKind::kTransverseMercator);
  transverse.origin_latitude_deg = 40, transverse.central_longitude_deg = 9;
  transverse.scale = 0.9996;
  const std::string earth = " +a=6378137 +b=6356752.314245179";
  return {{two, "+proj=lcc +lat_1=33 +lat_2=45 +lat_0=39 +lon_0=-96 +x_0=700000" + earth},
          {one, "+proj=lcc +lat_1=47 +lat_0=47 +lon_0=3 +k_0=0.9998" + earth},
          {mercator, "+proj=merc +lat_ts=20 +lon_0=175" + earth},
          {north, "+proj=stere +lat_0=90 +lat_ts=70 +lon_0=-45" + earth},
          {south, "+proj=stere +lat_0=-90 +k_0=0.97 +lon_0=30" + earth},
          {transverse, "+proj=tmerc +lat_0=40 +lon_0=9 +k_0=0.9996" + earth}};
}

double apart_deg(glm::dvec2 a, glm::dvec2 b) {
  return glm::length(unit_vector(a) - unit_vector(b)) * 180 / 3.14159265358979323846;
}

TEST(Maps, TwoLibrariesAgree) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> far_m(-2e6, 2e6);
  double worst_deg = 0, back_m = 0;
  for (const Pair& pair : pairs()) {
    const MapProjection ours(pair.ours);
    const MapProjection theirs = proj_map(pair.theirs, "test");
    for (int n = 0; n < 200; ++n) {
      const glm::dvec2 m = {far_m(random), far_m(random)};
      const glm::dvec2 place = ours.lat_lon_deg(m);
      worst_deg = std::max(worst_deg, apart_deg(place, theirs.lat_lon_deg(m)));
      back_m = std::max(
          {back_m, glm::length(ours.map_m(place) - m), glm::length(theirs.map_m(place) - m)});
    }
  }
  report_accuracy("grids", "maps by GeographicLib against PROJ, ellipsoid", worst_deg, 1e-8, "deg");
  EXPECT_LE(worst_deg, 1e-8);
  EXPECT_LE(back_m, 1e-2);
}

TEST(Maps, OffTheMapIsNoPlace) {
  const MapProjection disc = proj_map("+proj=geos +h=35786023 +lon_0=0 +a=6378137 +b=6356752", "");
  EXPECT_TRUE(std::isnan(disc.lat_lon_deg({8e6, 8e6}).x));
  EXPECT_TRUE(std::isnan(disc.map_m({0, 120}).x));
  EXPECT_NEAR(disc.lat_lon_deg({0, 0}).x, 0, 1e-12);
  EXPECT_THROW(proj_map("+proj=nothing", "test"), Error);
  EXPECT_THROW(proj_map("", "test"), Error);
}

// The values that come with the model (Lemoine et al. 1998, NASA/TP-1998-206861: OUTPUT.DAT of its
// harmonic synthesis), by PROJ's grid of 15 minutes.
TEST(Geoid, Egm96AtItsOwnTestPoints) {
  const struct {
    double lat, lon, height_m;
  } points[] = {{38.6281550, 269.7791550, -31.628}, {-14.6212170, 305.0211140, -2.969},
                {46.8743190, 102.4487290, -43.575}, {-23.6174460, 133.8747120, 15.871},
                {38.6254730, 359.9995000, 50.066},  {-0.4667440, 0.0023000, 17.329}};
  const GeoidHeight geoid = egm96_m();
  double worst = 0;
  for (const auto& p : points)
    worst = std::max(worst, std::abs(geoid({p.lat, p.lon}) - p.height_m));
  report_accuracy("grids", "EGM96 at its own test points, by a grid of 15 minutes", worst, 0.5,
                  "m");
  EXPECT_LT(worst, 0.5);
}

#else

TEST(Maps, WithoutProjAreRefused) {
  EXPECT_THROW(proj_map("+proj=longlat", "test"), Error);
  EXPECT_THROW(egm96_m(), Error);
}

#endif

}  // namespace
}  // namespace nepho::test
