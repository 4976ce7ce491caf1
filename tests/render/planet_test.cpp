// Air, ground and ice on the GPU against closed forms and quadrature in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "accuracy_report.h"
#include "air/air_lookup.h"
#include "dressed_source.h"
#include "gl_fixture.h"
#include "physics/physics_cpp.h"
#include "scenes.h"

namespace nepho::test {
namespace {

using PlanetRenderer = GlFixture;

constexpr double kRadius_m = 6.36e6;
constexpr glm::dvec3 kUp{0, 0, 1}, kNorth{0, 1, 0};

glm::dvec3 sun_at(double elevation_deg, double azimuth_deg = 0) {
  const double e = elevation_deg * kPi / 180, a = azimuth_deg * kPi / 180;
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

RenderRequest planet_request(std::initializer_list<const BrickSource*> sources) {
  RenderRequest request = request_of(sources);
  request.planet = Planet{};
  request.planet->body = Ellipsoid::sphere(kRadius_m);
  request.sun = {sun_at(40), {1.6, 1.85, 2.0}};
  return request;
}

void look(RenderRequest& request, double height_m, double pitch_deg, double fov_deg = 60) {
  const double p = pitch_deg * kPi / 180;
  const glm::dvec3 eye = (kRadius_m + height_m) * kUp;
  request.camera = {eye, eye + 1e4 * (std::cos(p) * kNorth + std::sin(p) * kUp),
                    std::abs(pitch_deg) > 80 ? kNorth : kUp, fov_deg * kPi / 180};
}

glm::dvec3 rgb_at(const HdrImage& image, int x, int y) {
  const std::size_t p = 3 * std::size_t(y * image.width + x);
  return {image.rgb[p], image.rgb[p + 1], image.rgb[p + 2]};
}

// The same equations along one ray, in double, with thousands of steps; no cloud but shadows.
class Quadrature {
 public:
  explicit Quadrature(const RenderRequest& request)
      : request_(request),
        air_(*request.planet->air),
        tables_(make_air_tables(air_, kRadius_m, request.planet->ground.water_albedo)),
        lookup_(air_, kRadius_m, tables_) {}

  // Part of the sun's beam that reaches a place.
  std::function<double(glm::dvec3)> lit = [](glm::dvec3) { return 1.0; };
  int steps = 3000;

  glm::dvec3 radiance(const glm::dvec3& direction) const {
    const glm::dvec3 eye = request_.camera.eye_m;
    const double r = glm::length(eye), mu = glm::dot(eye, direction) / r,
                 top = kRadius_m + air_.top_m;
    const auto roots = [&](double sphere, double& near, double& far) {
      const double discriminant = r * r * mu * mu - (r - sphere) * (r + sphere);
      if (discriminant < 0) return false;
      near = -r * mu - std::sqrt(discriminant);
      far = -r * mu + std::sqrt(discriminant);
      return far > 0;
    };
    double begin = 0, end = 0, ground = 0, behind = 0;
    if (!roots(top, begin, end)) return night();
    begin = std::max(begin, 0.0);
    const bool hits = roots(kRadius_m, ground, behind) && ground > 0;
    if (hits) end = ground;
    const glm::dvec3 to_sun = request_.sun.to_sun;
    const double one_minus_cos = 1 - glm::dot(to_sun, direction);
    const double rayleigh = f64::rayleigh_phase(one_minus_cos);
    const double aerosol = f64::cornette_shanks_phase(one_minus_cos, air_.aerosol_asymmetry);
    glm::dvec3 sum(0.0), depth(0.0);
    for (int i = 0; i < steps; ++i) {
      // Dense at both ends.
      const auto at = [&](double u) { return begin + (end - begin) * u * u * (3 - 2 * u); };
      const double t0 = at(double(i) / steps), t1 = at(double(i + 1) / steps), t = (t0 + t1) / 2;
      const glm::dvec3 p = eye + t * direction;
      const double h = glm::length(p) - kRadius_m, m = glm::dot(p, direction) / glm::length(p);
      const double mu_sun = glm::dot(p, to_sun) / glm::length(p);
      const AirDensity density = air_density(air_, h);
      const AirLight light = lookup_.light(h, mu_sun);
      const glm::dvec3 sun = lit(p) * sun_in_air(h, mu_sun);
      const glm::dvec3 step = (t1 - t0) * density.extinction_per_m;
      for (int c = 0; c < 3; ++c) {
        const double e0 = request_.sun.irradiance_W_per_m2_nm[c];
        sum[c] +=
            std::exp(-depth[c] - step[c] / 2) * (t1 - t0) *
            f64::air_emission(density.rayleigh_per_m[c], density.aerosol_per_m[c], sun[c], rayleigh,
                              aerosol, e0 * light.multiple[c], e0 * light.multiple_p2[c], m);
      }
      depth += step;
    }
    return sum + glm::exp(-depth) * (hits ? sea(eye + end * direction, direction) : night());
  }

 private:
  glm::dvec3 night() const { return f64::night_sky * request_.sun.irradiance_W_per_m2_nm; }

  glm::dvec3 sun_in_air(double height_m, double mu_sun) const {
    const double part = f64::sun_above_horizon(kRadius_m, height_m, mu_sun);
    if (part <= 0) return glm::dvec3(0.0);
    const double h = std::max(height_m, 0.0);
    const double horizon = -std::sqrt(h * (2 * kRadius_m + h)) / (kRadius_m + h);
    const glm::dvec3 depth = lookup_.depth(height_m, std::max(mu_sun, horizon));
    return part * request_.sun.irradiance_W_per_m2_nm * glm::exp(-depth);
  }

  glm::dvec3 sea(const glm::dvec3& p, const glm::dvec3& direction) const {
    const glm::dvec3 up = glm::normalize(p), to_sun = request_.sun.to_sun;
    const glm::dvec3 half_way = glm::normalize(to_sun - direction);
    const double mu_sun = glm::dot(up, to_sun);
    const SkyLight sky = lookup_.sky(0, mu_sun);
    const glm::dvec3 sun = lit(p) * sun_in_air(0, mu_sun);
    const double waves = f64::water_slope_variance(request_.planet->ground.wind_m_per_s);
    glm::dvec3 result;
    for (int c = 0; c < 3; ++c) {
      const double e0 = request_.sun.irradiance_W_per_m2_nm[c];
      result[c] = f64::water_radiance(
          request_.planet->ground.water_albedo[c], sun[c], std::max(-glm::dot(up, direction), 1e-5),
          std::max(mu_sun, 0.0), glm::dot(up, half_way), glm::dot(half_way, to_sun), waves,
          e0 * sky.up[c], e0 * sky.low[c]);
    }
    return result;
  }

  const RenderRequest& request_;
  const Air air_;
  AirTables tables_;
  AirLookup lookup_;
};

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

// A box of cloud, by whose edges the ground's and the air's shadows are known.
struct Slab {
  double low_m, high_m, half_width_m;
  FieldSource source;
  Slab(double low, double high, double half_width, double extinction)
      : low_m(low),
        high_m(high),
        half_width_m(half_width),
        source(std::make_shared<BoxChart>(
                   glm::dvec3(-half_width, -half_width, kRadius_m + low),
                   glm::dmat3(2 * half_width, 0., 0., 0., 2 * half_width, 0., 0., 0., high - low)),
               isotropic(1), [=](glm::dvec3) { return extinction; }) {}
  // Metres of the slab between a point and the sun.
  double shade_m(const glm::dvec3& p, const glm::dvec3& to_sun) const {
    double enter = 0, leave = 1e12;
    const glm::dvec3 low(-half_width_m, -half_width_m, kRadius_m + low_m);
    const glm::dvec3 high(half_width_m, half_width_m, kRadius_m + high_m);
    for (int a = 0; a < 3; ++a) {
      const double t0 = (low[a] - p[a]) / to_sun[a], t1 = (high[a] - p[a]) / to_sun[a];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    return std::max(leave - enter, 0.0);
  }
};

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
  const Slab slab(8000, 9000, 20e3, 0.05);
  RenderRequest request = planet_request({&slab.source});
  request.settings.width = 64;
  request.settings.height = 16;
  request.sun.to_sun = sun_at(50, 120);
  look(request, 2, 9, 6);
  Quadrature truth(request);
  const Quadrature unshaded(request);
  truth.steps = 20000;
  truth.lit = [&](const glm::dvec3& p) {
    return std::exp(-0.05 * slab.shade_m(p, request.sun.to_sun));
  };
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
  auto map = std::make_shared<SurfaceMap>();
  // Columns (centre, east, north) of the place under the eye.
  map->axes = glm::dmat3(kUp, glm::dvec3(1, 0, 0), kNorth);
  const double cell_m = 250, peak_m = 1800, at_m = 20e3, half_m = 5e3;
  map->nx = map->ny = 241;
  map->low_rad = glm::dvec2(-30e3 / kRadius_m);
  map->step_rad = glm::dvec2(cell_m / kRadius_m);
  for (int j = 0; j < map->ny; ++j)
    for (int i = 0; i < map->nx; ++i) {
      const double north_m = -30e3 + cell_m * j;
      map->height_m.push_back(float(peak_m * std::max(0.0, 1 - std::abs(north_m - at_m) / half_m)));
      map->water.push_back(0);
    }
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
