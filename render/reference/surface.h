#pragma once

#include "bricks/surface_map.h"
#include "reference/chart_ray.h"
#include "renderer.h"

namespace nepho {

// The ground's map of a request: of the first volume that has one, null where it says no more than
// that all is sea.
const SurfaceMap* surface_of(const RenderRequest& request);
// Of what that map shows, r g b; of water where there is none.
glm::dvec3 mean_ground_albedo(const RenderRequest& request);

// The planet's surface in double: the ellipsoid, or the heights of a map over it (those under it
// count as 0).
class PlanetSurface {
 public:
  struct Spot {
    glm::dvec3 up, normal;  // of the ellipsoid, and of the ground
    double height_m = 0, water = 1;
  };

  // `map` outlives this, or is null.
  PlanetSurface(const Ellipsoid& body, const SurfaceMap* map);
  // Where a ray meets it from above, or kNoDistance_m. `from_it`: the ray's origin is on it, which
  // is no meeting; where the ray goes below at once, it is met at 0.
  double distance_m(const Ray& ray, bool from_it = false) const;
  Spot spot(const glm::dvec3& point_m) const;
  double cell_m() const { return cell_m_; }  // the map's smallest
  bool terrain() const { return map_ != nullptr; }

 private:
  glm::dvec2 node(const glm::dvec3& point_m) const;
  glm::dvec2 at(glm::dvec2 node) const;  // height in m, part of water
  double gap_m(const glm::dvec3& point_m) const;
  double terrain_m(const Ray& ray, double begin_m, double end_m) const;

  Ellipsoid body_;
  const SurfaceMap* map_;
  Ground sea_;
  double z_scale_, cell_m_ = 1, slope_ = 0, top_m_ = 0;
};

}  // namespace nepho
