// The renderer's clear air against adding-doubling, over a planet so large that its air is a slab.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "accuracy_report.h"
#include "dressed_source.h"
#include "gl_fixture.h"
#include "rayleigh_slab.h"
#include "scenes.h"

namespace nepho::test {
namespace {

using PlanetSlab = GlFixture;

constexpr int kPixels = 2048;
// Of the line's half width, over its distance: to zenith cosines of 0.17.
constexpr double kReach = 5.8;

// One line of pixels through the zenith (or nadir), along an azimuth: all views of one sun.
class Line {
 public:
  Line(RenderRequest request, double height_m, double azimuth_deg, bool upwards) {
    const double a = azimuth_deg * kPi / 180;
    const glm::dvec3 eye(0, 0, kSlabRadius_m + height_m);
    // Photons that go along the azimuth are seen on the other side.
    along_ = -glm::dvec3(std::cos(a), std::sin(a), 0);
    const glm::dvec3 forward(0, 0, upwards ? 1 : -1);
    request.camera = {eye, eye + 1e3 * forward, glm::cross(along_, forward),
                      2 * std::atan(kReach / kPixels)};
    request.settings.width = kPixels;
    request.settings.height = 1;
    image_ = render(request).image;
  }

  glm::dvec3 radiance(const glm::dvec3& direction) const {
    const double tangent = glm::dot(direction, along_) / std::abs(direction.z);
    const double place = 0.5 * (kPixels * (1 + tangent / kReach) - 1);
    const auto low = std::size_t(place);
    glm::dvec3 sum(0.0);
    for (int c = 0; c < 3; ++c)
      sum[c] = std::lerp(image_.rgb[3 * low + std::size_t(c)],
                         image_.rgb[3 * low + 3 + std::size_t(c)], place - double(low));
    return sum;
  }

 private:
  HdrImage image_;
  glm::dvec3 along_{0.0};
};

// Black land as far as the eye sees.
std::shared_ptr<const SurfaceMap> black_land() {
  auto map = std::make_shared<SurfaceMap>();
  map->axes = glm::dmat3(glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0));
  map->nx = map->ny = 3;
  map->low_rad = glm::dvec2(-1e-2);
  map->step_rad = glm::dvec2(1e-2);
  map->height_m.assign(9, 0);
  map->water.assign(9, 0);
  return map;
}

TEST_F(PlanetSlab, RadiancesAreThoseOfAddingDoubling) {
  const RayleighSlab slab(NEPHO_TRUTH_DIR "/slab_rayleigh.csv");
  const FieldSource nothing(
      std::make_shared<BoxChart>(glm::dvec3(0, 0, kSlabRadius_m + 59e3),
                                 glm::dmat3(10., 0., 0., 0., 10., 0., 0., 0., 10.)),
      isotropic(1), [](glm::dvec3) { return 0.0; });
  const DressedSource source(nothing, [](VolumeInfo& info) { info.surface = black_land(); });
  RenderRequest request = request_of({&source});
  request.planet = Planet{};
  request.planet->body = Ellipsoid::sphere(kSlabRadius_m);
  request.planet->air = slab.air;
  request.planet->ground.land_albedo = glm::dvec3(0.0);
  SlabErrors up, down;
  for (const double mu_sun : {0.2, 0.3, 0.5, 0.8, 1.0})
    for (const double azimuth_deg : {0.0, 90.0}) {
      if (mu_sun == 1 && azimuth_deg > 0) continue;
      request.sun = {SlabRow{.mu_sun = mu_sun}.to_sun(), {1, 1, 1}};
      const Line above(request, slab.air.top_m + 500, azimuth_deg, false);
      const Line below(request, 0.01, azimuth_deg, true);
      for (const SlabRow& row : slab.rows) {
        if (row.mu_sun != mu_sun || (row.azimuth_deg == 90) != (azimuth_deg == 90)) continue;
        up.add(above.radiance(row.from_above()), row.up);
        if (glm::dot(row.from_below(), row.to_sun()) < 0.9999)  // beside the sun's disc
          down.add(below.radiance(row.from_below()), row.down);
      }
    }
  EXPECT_EQ(up.count, 3 * 57);
  EXPECT_EQ(down.count, 3 * (57 - 5));
  const char* section = "clear air against adding-doubling";
  report_accuracy(section, "Rayleigh slabs, renderer, from above: worst", up.worst, 0.03,
                  "relative");
  report_accuracy(section, "Rayleigh slabs, renderer, from below: worst", down.worst, 0.03,
                  "relative");
  report_accuracy(section, "Rayleigh slabs, renderer: rms", std::max(up.rms(), down.rms()), 0.01,
                  "relative");
  EXPECT_LE(up.worst, 0.03);
  EXPECT_LE(down.worst, 0.03);
  EXPECT_LE(std::max(up.rms(), down.rms()), 0.01);
}

}  // namespace
}  // namespace nepho::test
