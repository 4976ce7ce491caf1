#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "bricks/brick_source.h"
#include "bricks/shell_chart.h"
#include "common/planet_ground.h"

namespace nepho {

// Where over a planet there is cloud, as columns of a middling level: enough to point a camera.

struct CloudColumn {
  glm::dvec3 direction{0, 0, 1};  // from the planet's centre
  double area_m2 = 0;
  double optical_depth = 0;      // from below to above; > 0
  double base_m = 0, top_m = 0;  // over the ellipsoid
  double middle_m() const { return 0.5 * (base_m + top_m); }
  // 0 .. 1: about what the column reflects; the two-stream form for g = 0.85.
  double cloudiness() const { return optical_depth / (optical_depth + 13); }
};

// A cap of the planet.
struct Cap {
  glm::dvec3 direction{0, 0, 1};
  double radius_rad = 0;
};

struct CloudMap {
  std::vector<CloudColumn> columns;  // those with cloud
  double cell_m = 0;                 // side of a column, the median
  double finest_cell_m = 0;          // of the source's finest level

  bool empty() const { return columns.empty(); }
  // The smallest cap about the clouds' middle; radius pi where they are all around.
  Cap extent() const;
  // Where most of what hides the ground is: about its middle, as far as 2.4 times the rms distance
  // from there (a square's corners are at 1.73). Single columns far off count for little.
  Cap bulk() const;
};

// Reads bricks of the first level that has some hundred nodes with cloud (all, or those that touch
// the cap), and sums extinction along their columns. Throws Error with the source's own text.
CloudMap cloud_map(const BrickSource& source, double time_s, const Ellipsoid& body,
                   const std::optional<Cap>& cap = std::nullopt);
void append(CloudMap& map, const CloudMap& more);

// The direction with the most cloud around it: cloudiness times area under a Gaussian of this
// half width. The map must not be empty.
glm::dvec3 cloudiest(const CloudMap& map, double width_rad);
// The one where cloudiness varies most under the same Gaussian, clear sky counted as 0: edges and
// gaps rather than an overcast. Not where the data end, as far as their ground tells.
glm::dvec3 most_varied(const CloudMap& map, double width_rad, const PlanetGround& ground);

}  // namespace nepho
