#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "bricks/volume_info.h"
#include "scene/scene.h"

namespace nepho {

// How large a node appears in a picture. Distances are to the nearest of the node's own 27 grid
// points and the eye's clamped coordinates: exact in rectangular boxes, never too short.
class ViewMetric {
 public:
  // `to_sun`: unit; without it any shadow may be seen.
  ViewMetric(const Camera& camera, const RenderSettings& settings,
             const std::optional<glm::dvec3>& to_sun);

  struct NodeView {
    double voxel_pixels;  // of the axes that a split halves; off-screen: a quarter or sixteenth
    double length_m;      // the longest that a ray can be in the node, but for its diagonal
    double path_m;        // of a ray from the eye through its middle
  };
  // Of a node that has a finer level.
  NodeView view(const VolumeInfo& info, NodeKey key) const;
  // Whether a ray through the picture can meet the node: false outside the picture and, on a shell,
  // behind the planet. Errs towards true.
  bool seen(const VolumeInfo& info, NodeKey key) const;

  struct Footprint {
    glm::dvec2 low, high;  // of a rectangle around the node, pixels
    // The least that a row and a column of the picture are in one of its voxels, however it lies.
    glm::dvec2 voxel_pixels;
  };
  // Absent: no ray through the picture meets the node.
  std::optional<Footprint> footprint(const VolumeInfo& info, NodeKey key) const;

 private:
  struct Shape;
  bool on_screen(const glm::dvec3& center_m, double radius_m) const;
  bool seen(const VolumeInfo& info, const Shape& shape) const;
  // Whether its shadow can fall into the picture. Errs towards true.
  bool shadows_seen(const VolumeInfo& info, const Shape& shape) const;

  std::optional<glm::dvec3> to_sun_;
  glm::dvec3 eye_m_, forward_, right_, up_;
  double tan_half_height_, tan_half_width_, pixel_rad_;
  int width_, height_;
};

}  // namespace nepho
