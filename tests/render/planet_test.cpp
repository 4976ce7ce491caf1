// Air, ground and ice on the GPU against closed forms and quadrature in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "accuracy_report.h"
#include "dressed_source.h"
#include "gl_fixture.h"
#include "planet_quadrature.h"

namespace nepho::test {
namespace {

using PlanetRenderer = GlFixture;

glm::dvec3 rgb_at(const HdrImage& image, int x, int y) {
  const std::size_t p = 3 * std::size_t(y * image.width + x);
  return {image.rgb[p], image.rgb[p + 1], image.rgb[p + 2]};
}

// Every fourth pixel. Relative to its own radiance, but where that is under 1e-4 of the brightest.
double worst_against(const RenderRequest& request, const Quadrature& truth) {
  const HdrImage image = render(request).image;
  double worst = 0, brightest = 0;
  std::vector<std::pair<glm::dvec3, glm::dvec3>> pairs;
  for (int y = 1; y < image.height; y += 2)
    for (int x = 1; x < image.width; x += 4) {
      const glm::dvec3 d = pixel_direction(request, x, y);
      if (glm::dot(d, request.sun.to_sun) > 0.9998) continue;  // the disc itself
      pairs.emplace_back(rgb_at(image, x, y), truth.radiance(d));
      brightest = std::max(brightest, pairs.back().second.g);
    }
  for (const auto& [got, expected] : pairs)
    for (int c = 0; c < 3; ++c)
      worst =
          std::max(worst, std::abs(got[c] - expected[c]) / std::max(expected[c], 1e-4 * brightest));
  return worst;
}

TEST_F(PlanetRenderer, ClearSkyFromTheGroundToSpace) {
  struct View {
    double height_m, pitch_deg, fov_deg;
  };
  for (const View& view :
       {View{2, 10, 60}, View{12e3, -5, 60}, View{1e6, -38, 60}, View{1e7, -88, 50}})
    for (const double elevation : {60.0, 10.0, 2.0, -6.0}) {
      RenderRequest request = planet_request({});
      request.sun.to_sun = sun_at(elevation, 70);
      look(request, view.height_m, view.pitch_deg, view.fov_deg);
      const double worst = worst_against(request, Quadrature(request));
      char name[96];
      std::snprintf(name, sizeof name, "clear sky from %g m, sun at %g degrees: worst pixel",
                    view.height_m, elevation);
      report_accuracy("air", name, worst, 0.01, "1");
      EXPECT_LE(worst, 0.01) << name;
    }
}

TEST_F(PlanetRenderer, ACloudsShadowLiesWhereTheSunPutsIt) {
  const Slab slab(2000, 3000, 1500, 0.5);
  RenderRequest request = planet_request({&slab.source});
  request.planet->air.reset();
  request.settings.width = request.settings.height = 96;
  request.sun.to_sun = sun_at(40, 65);
  look(request, 20e3, -90, 30);
  const HdrImage image = render(request).image;
  int shaded = 0, lit = 0, wrong = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 d = pixel_direction(request, x, y);
      const double t = (kRadius_m - request.camera.eye_m.z) / d.z;  // flat: 4 m lower at 7 km
      const glm::dvec3 p = request.camera.eye_m + t * d;
      if (slab.shade_m(p, -d) > 0) continue;  // hidden by the cloud itself
      const double in = slab.shade_m(p, request.sun.to_sun);
      if (in > 0 && in < 200) continue;  // thin edge
      // Two pixels of doubt at the edge.
      bool edge = false;
      for (const glm::dvec3& aside : {glm::dvec3(250, 0, 0), glm::dvec3(-250, 0, 0),
                                      glm::dvec3(0, 250, 0), glm::dvec3(0, -250, 0)})
        edge = edge || (slab.shade_m(p + aside, request.sun.to_sun) > 0) != (in > 0);
      if (edge) continue;
      const double light = green_at(image, x, y);
      in > 0 ? ++shaded : ++lit;
      if ((in > 0) != (light < 1e-3)) ++wrong;
    }
  std::printf("measured: shadow on the ground: %d pixels in it, %d beside, %d wrong\n", shaded, lit,
              wrong);
  EXPECT_GT(shaded, 200);
  EXPECT_GT(lit, 2000);
  EXPECT_EQ(wrong, 0);
}

// Beams and shadows: under a thick deck the air is dark, beyond its edge it is not.
TEST_F(PlanetRenderer, CloudsShadowTheAir) {
  const ShadedDeck deck(64, 16);
  const RenderRequest& request = deck.request;
  const Quadrature &truth = *deck.truth, &unshaded = *deck.unshaded;
  const double worst = worst_against(request, truth);
  report_accuracy("air", "air in the shadow of a deck: worst pixel", worst, 0.02, "1");
  EXPECT_LE(worst, 0.02);
  const glm::dvec3 middle = pixel_direction(request, 32, 8);
  const double shade = truth.radiance(middle).g / unshaded.radiance(middle).g;
  std::printf("measured: the shadow takes %.0f %% of this air's light\n", 100 * (1 - shade));
  EXPECT_LT(shade, 0.9);
}

TEST_F(PlanetRenderer, AirThatDoesNothingChangesNothing) {
  const Slab slab(3000, 5000, 4000, 3e-4);
  RenderRequest request = planet_request({&slab.source});
  Air& air = *request.planet->air;
  air.rayleigh_per_m = air.aerosol_extinction_per_m = air.ozone_per_m = glm::dvec3(0.0);
  request.planet->ground.water_albedo = glm::dvec3(0.0);
  request.settings.light = Light::kOctaves;
  look(request, 2, 60, 50);
  const HdrImage with = render(request).image;
  request.planet.reset();
  const HdrImage without = render(request).image;
  double worst = 0, most = 0;
  for (std::size_t i = 0; i < with.rgb.size(); ++i) {
    most = std::max(most, double(without.rgb[i]));
    // Sea that mirrors the sun lights the cloud from below, a little.
    worst = std::max(worst, std::abs(double(with.rgb[i] - without.rgb[i])));
  }
  std::printf("measured: air without effect: %.1e of the brightest\n", worst / most);
  EXPECT_LE(worst / most, 1e-3);
  EXPECT_GT(most, 0.01);
}

// No dark or bright line where ground and sky meet, from where the air hides their difference.
TEST_F(PlanetRenderer, TheHorizonIsNoLine) {
  for (const double height_m : {12e3, 100e3, 1e6}) {
    RenderRequest request = planet_request({});
    request.settings.width = 3;
    request.settings.height = 400;
    const double dip = std::acos(kRadius_m / (kRadius_m + height_m)) * 180 / kPi;
    look(request, height_m, -dip, 1);
    request.sun.to_sun = sun_at(40, 120);
    const HdrImage image = render(request).image;
    double worst = 0;
    for (int y = 1; y < image.height; ++y)
      worst = std::max(worst, std::abs(green_at(image, 1, y) / green_at(image, 1, y - 1) - 1.0));
    std::printf("measured: from %g m, rows of 9 arc seconds at the horizon differ by %.1e\n",
                height_m, worst);
    EXPECT_LE(worst, 0.02) << height_m;
  }
}

// A ridge of known height and distance stands against the sky as high as it should.
TEST_F(PlanetRenderer, TerrainStandsWhereItsMapSays) {
  const Slab slab(15e3, 16e3, 100, 1e-9);
  const double peak_m = 1800, at_m = 20e3, half_m = 5e3;
  const auto map = ridge_map(at_m, peak_m, half_m, 250);
  const DressedSource source(slab.source, [&](VolumeInfo& info) { info.surface = map; });
  RenderRequest request = planet_request({&source});
  request.planet->air.reset();
  request.planet->ground.land_albedo = glm::dvec3(0.3);
  request.settings.width = 9;
  request.settings.height = 300;
  request.sun.to_sun = sun_at(35, 180);  // from behind: the slope that is seen faces it
  for (const double height_m : {2.0, 600.0, 1500.0}) {
    look(request, height_m, 0, 20);
    const HdrImage image = render(request).image;
    const double turn = at_m / kRadius_m, r = kRadius_m + peak_m;
    const double elevation =
        std::atan2(r * std::cos(turn) - kRadius_m - height_m, r * std::sin(turn));
    const double half = std::tan(0.5 * request.camera.vertical_fov_rad);
    const double row = 0.5 * image.height * (1 - std::tan(elevation) / half);
    int first = 0;
    while (first < image.height && green_at(image, 4, first) < 1e-4) ++first;
    std::printf("measured: ridge from %g m: first row %d, expected %.2f\n", height_m, first, row);
    EXPECT_LE(std::abs(first - row), 1.0) << height_m;
    // Lambert on the slope that is seen.
    const double slope = peak_m / half_m;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0, -slope, 1));
    const double truth = 0.3 / kPi * 1.85 * glm::dot(normal, request.sun.to_sun);
    const double got = green_at(image, 4, first + 4);
    EXPECT_NEAR(got / truth, 1, 0.01) << height_m;
  }
}

// The map's end is a wall of its ground over the sea, and no hole is in it.
TEST_F(PlanetRenderer, AMapEndsInAWallOfLand) {
  const Slab slab(15e3, 16e3, 100, 1e-9);
  const auto map = ridge_map(0, 0, 1, 1000);
  std::ranges::fill(map->height_m, 75.0f);
  map->low_rad.y += 32.1e3 / kRadius_m;  // from 2.1 km north of the eye on
  const DressedSource source(slab.source, [&](VolumeInfo& info) { info.surface = map; });
  RenderRequest request = planet_request({&source});
  request.planet->air.reset();
  request.planet->ground.land_albedo = glm::dvec3(0.3);
  request.settings.width = 48;
  request.settings.height = 160;
  request.sun.to_sun = sun_at(60, 180);
  look(request, 700, -17, 10);
  const HdrImage image = render(request).image;
  int torn = 0, walls = 0;
  for (int x = 0; x < image.width; ++x) {
    int changes = 0;
    const auto is_land = [&](int y) { return green_at(image, x, y) > 0.05; };
    for (int y = 1; y < image.height; ++y) changes += is_land(y) != is_land(y - 1);
    ++(changes == 1 ? walls : torn);
  }
  std::printf("measured: %d of %d columns of pixels have more than one edge\n", torn, image.width);
  EXPECT_EQ(walls, image.width);
}

TEST_F(PlanetRenderer, AnEyeInPlacesThatAreNoneSeesFiniteLight) {
  const Slab slab(1000, 2000, 5000, 0.02);
  auto map = std::make_shared<SurfaceMap>();
  map->axes = glm::dmat3(kUp, glm::dvec3(1, 0, 0), kNorth);
  map->nx = map->ny = 3;
  map->low_rad = glm::dvec2(-0.01);
  map->step_rad = glm::dvec2(0.01);
  map->height_m.assign(9, 800);
  map->water.assign(9, 0.5f);
  const DressedSource source(slab.source, [&](VolumeInfo& info) { info.surface = map; });
  // Under the terrain, under the ellipsoid, in the cloud, on its face, far away; the sun overhead.
  for (const double height_m : {400.0, -30.0, 1500.0, 1000.0, 1e9}) {
    RenderRequest request = planet_request({&source});
    look(request, height_m, height_m > 1e6 ? -90 : 20, height_m > 1e6 ? 0.8 : 80);
    for (const double elevation : {90.0, 0.0, -18.0}) {
      request.sun.to_sun = sun_at(elevation);
      const HdrImage image = render(request).image;
      EXPECT_TRUE(
          std::ranges::all_of(image.rgb, [](float v) { return std::isfinite(v) && v >= 0; }))
          << height_m << ' ' << elevation;
    }
  }
}

TEST_F(PlanetRenderer, IceScattersAsIce) {
  const FieldSource plain(box(1000, 1000), isotropic(2), [](glm::dvec3 p) {
    return 0.004 * std::max(0.0, 1 - glm::length(p - glm::dvec3(0, 0, 500)) / 450);
  });
  const Phase ice{PhaseKind::kHenyeyGreenstein, 30e-6, 0.75}, liquid{};
  const auto picture = [&](const BrickSource& source, const Phase& phase) {
    RenderRequest request = request_of({&source});
    request.volumes[0].phase = phase;
    request.volumes[0].ice_phase = ice;
    request.settings.light = Light::kOctaves;
    request.sun.to_sun = glm::normalize(glm::dvec3(-0.6, 0.5, 0.3));
    request.settings.step_voxels = 1;  // the same steps for all: adaptive ones go by the light
    request.camera = {{0, -1800, 600}, {0, 0, 500}, {0, 0, 1}, 0.7};
    return render(request);
  };
  const auto dressed = [&](double part) {
    return DressedSource(
        plain,
        [](VolumeInfo& info) {
          info.channels.push_back({.channel = Channel::kIceExtinction, .name = "ice"});
        },
        part);
  };
  const DressedSource none = dressed(0), half = dressed(0.5), all = dressed(1);
  const HdrImage liquid_only = picture(plain, liquid).image, ice_only = picture(plain, ice).image;
  const RenderResult as_ice = picture(all, liquid);
  double most = 0, off_ice = 0, off_liquid = 0, off_half = 0, apart = 0;
  const HdrImage as_half = picture(half, liquid).image, as_liquid = picture(none, liquid).image;
  for (std::size_t i = 0; i < ice_only.rgb.size(); ++i) {
    const double l = liquid_only.rgb[i], c = ice_only.rgb[i];
    most = std::max(most, std::max(l, c));
    off_ice = std::max(off_ice, std::abs(as_ice.image.rgb[i] - c));
    off_liquid = std::max(off_liquid, std::abs(as_liquid.rgb[i] - l));
    off_half = std::max(off_half, std::abs(as_half.rgb[i] - (l + c) / 2));
    apart = std::max(apart, std::abs(l - c));
  }
  std::printf("measured: ice against its own phase %.1e, no ice %.1e, half %.1e, apart %.1e\n",
              off_ice / most, off_liquid / most, off_half / most, apart / most);
  EXPECT_GT(apart / most, 0.05);
  EXPECT_LE(off_ice / most, 1e-5);
  EXPECT_LE(off_liquid / most, 1e-5);
  EXPECT_LE(off_half / most, 1e-4);
  EXPECT_EQ(as_ice.report.atlas_bytes, 2 * picture(plain, liquid).report.atlas_bytes);
}

// Seen past a small cloud, the sea below it is no brighter than in the open.
TEST_F(PlanetRenderer, NoPalePatchUnderASmallCloud) {
  const Slab slab(1500, 2500, 800, 5e-3);
  RenderRequest request = planet_request({&slab.source});
  const glm::dvec3 eye = (kRadius_m + 500) * kUp - 6000.0 * kNorth;
  request.camera = {eye, kRadius_m * kUp, kUp, 2 * kPi / 180};
  request.sun.to_sun = sun_at(75, 90);
  const double under = green_at(render(request).image, 16, 9);
  request.volumes.clear();
  const double open = green_at(render(request).image, 16, 9);
  std::printf("measured: the sea under a cloud has %.3f of the light of the open sea\n",
              under / open);
  EXPECT_LE(under, 1.03 * open);
  EXPECT_GE(under, 0.3 * open);
}

// An even deck around the planet, from 3e6 m over the place where the sun sets: along lines that
// are equally far from the sun nothing changes, however wide the texels of the shadows' map.
TEST_F(PlanetRenderer, TheTerminatorHasNoTeeth) {
  const FieldSource deck(std::make_shared<ShellChart>(Ellipsoid::sphere(kRadius_m), 0, 16000),
                         Lattice({kSplitXy, kSplitXy, kSplitZ}), [](glm::dvec3 p) {
                           return std::abs(glm::length(p) - kRadius_m - 5000) < 1500 ? 2e-3 : 0;
                         });
  RenderRequest request = planet_request({&deck});
  request.sun.to_sun = sun_at(0, 90);  // to the right of a picture with north above
  request.settings.width = 120;
  request.settings.height = 40;
  look(request, 3e6, -90, 12);
  const HdrImage image = render(request).image;
  double worst = 0;
  for (int x = image.width / 2; x < 100; ++x) {  // beyond, the next of the deck's voxels
    double least = 1e9, most = 0;
    for (int y = 0; y < image.height; ++y) {
      least = std::min(least, double(green_at(image, x, y)));
      most = std::max(most, double(green_at(image, x, y)));
    }
    worst = std::max(worst, most / least - 1);
  }
  std::printf("measured: teeth of the terminator: %.1e\n", worst);
  report_accuracy("air", "an even deck along the terminator, greatest over least", worst, 0.03,
                  "relative");
  EXPECT_LE(worst, 0.03);
}

TEST_F(PlanetRenderer, NothingOfAPlanetIsMadeForASceneWithoutOne) {
  const Slab slab(0, 1000, 500, 1e-3);
  const auto passes = [](const RenderReport& report, const std::string& name) {
    return std::ranges::count(report.passes, name, &PassReport::name);
  };
  RenderRequest request = planet_request({&slab.source});
  look(request, 500, 0);
  const RenderReport with = render(request).report;
  EXPECT_GT(with.planet_bytes, 0u);
  EXPECT_EQ(passes(with, "ground"), 1);
  EXPECT_EQ(passes(with, "sun map"), 1);
  request.planet.reset();
  const RenderReport without = render(request).report;
  EXPECT_EQ(without.planet_bytes, 0u);
  EXPECT_EQ(passes(without, "ground") + passes(without, "sun map"), 0);
  for (const std::string& line : without.shader_switches)
    for (const char* name : {"AIR", "GROUND", "TERRAIN", "SUN_MAP", "ICE"})
      EXPECT_NE(line.substr(0, line.find(' ')), name);
}

}  // namespace
}  // namespace nepho::test
