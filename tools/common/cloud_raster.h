#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "common/cloud_map.h"
#include "common/planet_ground.h"
#include "common/planet_view.h"

namespace nepho {

// Clouds as one looks down on them: a square grid on a plane about a middle (azimuthal equidistant,
// so that distances from the middle are the sphere's, and no pole or date line is anything
// special). Coordinates are metres along two axes of its own.
class CloudRaster {
 public:
  // `radius_m`: half the side; up to a third of the way round the planet.
  CloudRaster(const CloudMap& map, const glm::dvec3& middle, double radius_m,
              const PlanetGround& ground);

  double radius_m() const { return radius_m_; }
  glm::dvec2 plane_m(const glm::dvec3& direction) const;
  glm::dvec3 direction(const glm::dvec2& plane_m) const;
  // What an eye tells apart: 0 a clear place, up to 1 thick and high cloud (seven tenths of it for
  // thick and low); negative beyond the data, where their ground says how far they reach.
  float at(const glm::dvec2& plane_m) const {
    const int i = int((plane_m.x + radius_m_) / cell_m_),
              j = int((plane_m.y + radius_m_) / cell_m_);
    const bool on = plane_m.x >= -radius_m_ && plane_m.y >= -radius_m_ && i < cells_ && j < cells_;
    return on ? seen_[std::size_t(j) * std::size_t(cells_) + std::size_t(i)] : kBeyond;
  }
  static constexpr float kBeyond = -1;

 private:
  void add_columns(const CloudMap& map);
  void leave_out_what_has_no_data(const PlanetGround& ground);

  glm::dvec3 middle_, x_axis_, y_axis_;
  double body_m_, radius_m_, cell_m_;
  int cells_;
  std::vector<float> seen_;  // cells_ * cells_, x fastest
};

// A coarse picture of a layer of clouds: where its rays meet the height `layer_m`, as metres to the
// right and ahead of the point below the eye. Both heights are over a sphere of `body_m`.
struct LayerHits {
  static constexpr int kAcross = 40, kDown = 24;
  glm::dvec2 at_m[kDown][kAcross];
  float weight[kDown][kAcross];  // 0: sky, or farther than `farthest_m`; most in the middle
};
LayerHits layer_hits(double eye_m, double pitch_rad, double layer_m, double body_m,
                     double farthest_m, const Lens& lens);

// How much there is to see in such a picture, from 0: mean difference between places that are 1, 3
// and 9 of its pixels apart, so that fine and large forms count alike, and neither an overcast nor
// a clear sky counts much. Clouds cut off where the data end are no form, and half as bad as one is
// good. `ahead`: unit vector on the plane.
double structure(const CloudRaster& raster, const LayerHits& hits, const glm::dvec2& eye_m,
                 const glm::dvec2& ahead);

}  // namespace nepho
