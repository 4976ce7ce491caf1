#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"

namespace nepho::analytic {

// A closed box of root coordinates; may reach over the root's ends by a voxel.
struct RootBox {
  int root = 0;
  glm::dvec3 low{0.0}, high{1.0};
};

// A field in closed form over the root coordinates of a chart: plane faces lie on lattice walls, so
// that a sample on a wall is asked for with an exact q.
class Kind {
 public:
  virtual ~Kind() = default;
  virtual double extinction_per_m(const RootPosition& position) const = 0;
  // The one value that the field has in the box, if it surely has one.
  virtual std::optional<double> constant_in(const RootBox& box) const = 0;
};

// The same everywhere: constant, slab, cube, half_space are charts full of it.
std::unique_ptr<Kind> uniform(double extinction_per_m);

// Two halves along x, each a period's half long. On the two walls between them, the mean.
std::unique_ptr<Kind> step_cloud(double left_per_m, double right_per_m);

// Falls by e per `scale` of the root's height, from `bottom_per_m` at q.z = 0.
std::unique_ptr<Kind> exponential(double bottom_per_m, double scale);

// Extinction falls linearly over `edge_m`, centred on the radius: what a lattice of that spacing
// can hold, and its optical depth along a diameter is that of the sharp sphere.
std::unique_ptr<Kind> sphere(const BoxChart& chart, double extinction_per_m, double radius_m,
                             double edge_m);

// exp(-r^2 / 2 sigma^2), lowered and stretched so as to reach 0 at `cutoff` sigmas and 1 in the
// middle: continuous, at most exp(-cutoff^2 / 2) from the Gaussian.
std::unique_ptr<Kind> gaussian(const BoxChart& chart, double extinction_per_m, double sigma_m,
                               double cutoff);

// The same around a point of the shell: r^2 / sigma^2 = chord^2 / horizontal^2 + dz^2 / vertical^2,
// the chord on a sphere of the body's equatorial radius in the chart's scaled space.
struct ShellBlob {
  glm::dvec3 centre_ecef_m;
  double horizontal_m, vertical_m, cutoff;
};
std::unique_ptr<Kind> shell_gaussian(const ShellChart& chart, double extinction_per_m,
                                     const ShellBlob& blob);

}  // namespace nepho::analytic
