#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "bricks/shell_chart.h"
#include "forecast/bricks/coverage.h"
#include "forecast/bricks/face_polygon.h"

namespace nepho::forecast {

// How much of each horizontal hat of a ShellChart's level a model cell holds:
//
//   W(cell, g) = int over the cell of Lambda_g dOmega      sr, Lambda_g bilinear in face
//   coordinates
//
// A cell is a polygon on the cube's faces, clipped by the lattice's squares; each piece is
// integrated by a rule that is exact for bilinear hat times bilinear solid angle per square. Pieces
// tile the face, so that nothing is lost or counted twice between cells, squares and faces. What is
// left: cell walls are straight in face coordinates between the given corners (a wall of angle L
// bulges by less than L^2 / 8), and the solid angle per square is bilinear (h^2 / 12 of a square h
// wide).

// Unit vector, in the scaled space in which the body is a sphere, of a point of geodetic latitude
// and longitude at `height_m`.
glm::dvec3 scaled_direction(const Ellipsoid& body, glm::dvec2 lat_lon_deg, double height_m);

// Calls `use` with a quadrilateral, given in scaled space, on each face of the cube that it
// touches; lattice units of `cells` a side. None: a corner is off the planet.
void for_each_face(const ShellChart& chart, const Index3& cells,
                   const std::array<glm::dvec3, 4>& corners,
                   const std::function<void(int root, const FacePolygon& polygon)>& use);

struct HatShare {
  Column column;  // owner name
  double solid_angle_sr;
};

class CellOverlap {
 public:
  // `cells` of the lattice's finest level. What `finer` covers is left out.
  CellOverlap(const ShellChart& chart, const Index3& cells, const Coverage* finer = nullptr)
      : chart_(chart), cells_(cells), finer_(finer) {}

  // Adds the shares of one quadrilateral, corners in order around it, either way round, in scaled
  // space; no side longer than a few degrees. Shares of one column are added up.
  void add(const std::array<glm::dvec3, 4>& corners, std::vector<HatShare>& shares) const;

 private:
  struct Square;
  void add_on_face(int root, const FacePolygon& quad, std::vector<HatShare>& shares) const;
  void add_square(int root, std::uint32_t i, std::uint32_t j, const FacePolygon& piece,
                  std::vector<HatShare>& shares) const;

  const ShellChart& chart_;
  Index3 cells_;
  const Coverage* finer_;
};

}  // namespace nepho::forecast
