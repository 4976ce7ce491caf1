#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bricks/shell_chart.h"

namespace nepho::noise {

// Where noise is drawn on a planet. Directions are those of the chart's scaled space, a unit
// sphere.

// Directions of a ShellChart's columns with an own tangent: the chart's differs in the last bits
// between C libraries.
class Directions {
 public:
  explicit Directions(const ShellChart& chart);
  glm::dvec3 at(Column owner, std::uint32_t cells) const;

 private:
  std::array<glm::dvec3, 6> normal_, u_, v_;
};

// A point of one plane sheet: stereographic metres (conformal, 7 % larger at the rim), u along the
// wind. Weights of all sheets: sum w^2 = 1, which keeps mixed noise standard normal.
struct SheetPoint {
  int sheet = 0;
  double weight = 0;
  glm::dvec2 uv{0.0};
};
struct SheetPoints {
  std::array<SheetPoint, 6> point;
  int size = 0;
  const SheetPoint* begin() const { return point.data(); }
  const SheetPoint* end() const { return point.data() + size; }
};

// 42 overlapping sheets (the vertices and edge middles of an icosahedron), each with a wind of its
// own around the given one: streaks cannot run along one direction on all of a sphere.
class Sheets {
 public:
  Sheets(double radius_m, double wind_from_rad, std::uint32_t seed);
  SheetPoints at(const glm::dvec3& direction) const;
  // Unit vector to where the wind blows, of the sheet that weighs most; tangent to the sphere
  // at its middle.
  const glm::dvec3& downwind(int sheet) const { return sheets_[std::size_t(sheet)].along; }
  static constexpr double kScaleAtRim = 1.08;  // metres of uv per metre, at most

 private:
  struct Sheet {
    glm::dvec3 middle, along, across;
  };
  std::vector<Sheet> sheets_;
  double radius_m_;
};

// Storms: the sphere is turned about their middles, most at the middle and not at all beyond their
// reach, so that large-scale noise winds up into bands and commas. Turns add up; the result is no
// unit vector, which noise does not mind.
class Storms {
 public:
  explicit Storms(std::uint32_t seed);
  glm::dvec3 wound(glm::dvec3 direction) const;
  // How much longer distances within `radius` (of the unit sphere) can be on the wound sphere.
  double stretch(const glm::dvec3& direction, double radius) const;

 private:
  struct Storm {
    glm::dvec3 middle;
    double reach, turn;  // chord; tan of half the angle at the middle
  };
  std::vector<Storm> storms_;
};

}  // namespace nepho::noise
