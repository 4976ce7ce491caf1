#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bricks/brick_source.h"
#include "scene/scene.h"

namespace nepho {

// Working out a camera and a sun for data that come without.

// A frame to stand in: a point's east, north and up, all ECEF.
struct LocalAxes {
  glm::dvec3 east{1, 0, 0}, north{0, 1, 0}, up{0, 0, 1};
};

// The verb with its failure as an Error that has the source's own text.
NodeSummary summary_of(const BrickSource& source, NodeKey key, double time_s);

// Corners (ECEF, m) of the nodes that hold extinction, from summaries alone: no brick is read. Goes
// down until there are some ten thousand nodes. Throws Error with the source's own text.
std::vector<glm::dvec3> occupied_points(const BrickSource& source, double time_s);

// A three-quarter view that holds every point with a small margin: from slightly below mid height,
// or from above for a layer that is wide and flat, or that goes on beyond its points (`endless`: a
// periodic box). Given eye or target are kept.
Camera frame_camera(std::span<const glm::dvec3> points, const LocalAxes& axes,
                    const CameraSpec& wish, double aspect, bool endless = false);

// 40 degrees high, 55 degrees to the left of straight behind the camera.
glm::dvec3 sun_over_left_shoulder(const Camera& camera, const glm::dvec3& up);

}  // namespace nepho
