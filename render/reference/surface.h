#pragma once

#include <optional>

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
  // Where a ray meets it from above, within a height of 1e-8 m, or kNoDistance_m: also where that
  // is beyond `within_m`. `from_it`: the ray's origin is on it, which is no meeting; where the ray
  // goes below at once, it is met at 0.
  double distance_m(const Ray& ray, bool from_it = false, double within_m = kNoDistance_m) const;
  // Whether it does.
  bool hides(const Ray& ray, bool from_it = false) const;
  // Where a ray meets the ellipsoid, whatever stands on it.
  double sea_m(const Ray& ray) const { return sea_.distance_m(ray); }
  Spot spot(const glm::dvec3& point_m) const;
  double cell_m() const { return cell_m_; }  // the map's smallest
  bool terrain() const { return map_ != nullptr; }

 private:
  glm::dvec2 node(const glm::dvec3& point_m) const;
  // take(values -> the value there) where the map holds the place; beside it all is sea.
  template <class Take>
  void take_at(glm::dvec2 node, const Take& take) const;
  double height_m(glm::dvec2 node) const;
  double gap_m(const glm::dvec3& point_m) const;
  // Of a ray: its surface is met between, beyond the first.
  struct Bracket {
    double above_m, under_m;
    double gap_above_m, gap_under_m;
  };
  std::optional<Bracket> bracket(const Ray& ray, bool from_it, double within_m) const;
  std::optional<Bracket> terrain(const Ray& ray, double begin_m, double end_m) const;
  double meeting_m(const Ray& ray, Bracket bracket) const;

  Ellipsoid body_;
  const SurfaceMap* map_;
  Ground sea_;
  double z_scale_, cell_m_ = 1, slope_ = 0, top_m_ = 0;
};

}  // namespace nepho
