#pragma once

#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "field_source.h"
#include "renderer.h"

namespace nepho::test {

inline constexpr double kPi = std::numbers::pi;

inline std::shared_ptr<const Chart> box(double size_m, double height_m, Periodic periodic = {}) {
  return std::make_shared<BoxChart>(glm::dvec3(-0.5 * size_m, -0.5 * size_m, 0),
                                    glm::dmat3(size_m, 0., 0., 0., size_m, 0., 0., 0., height_m),
                                    periodic);
}

// Small, black sky, no error probe: a test adds what it is about.
inline RenderRequest request_of(std::initializer_list<const BrickSource*> sources) {
  RenderRequest request;
  for (const BrickSource* source : sources)
    request.volumes.push_back(
        {.source = source, .phase = Phase{PhaseKind::kHenyeyGreenstein, 10e-6, 0.85}});
  request.settings.width = 32;
  request.settings.height = 18;
  request.settings.probe_pixels = 0;
  request.settings.light = Light::kSingle;
  return request;
}

inline glm::dvec3 pixel_direction(const RenderRequest& request, int x, int y) {
  const Camera& camera = request.camera;
  const glm::dvec3 forward = glm::normalize(camera.target_m - camera.eye_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const double half = std::tan(0.5 * camera.vertical_fov_rad);
  const double w = request.settings.width, h = request.settings.height;
  return glm::normalize(forward + half * w / h * ((2 * x + 1) / w - 1) * right +
                        half * (1 - (2 * y + 1) / h) * up);
}

inline float tau_at(const HdrImage& image, int x, int y) {
  return image.optical_depth[std::size_t(y * image.width + x)];
}
inline float green_at(const HdrImage& image, int x, int y) {
  return image.rgb[3 * std::size_t(y * image.width + x) + 1];
}

}  // namespace nepho::test
