#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace nepho::forecast {

// A convex polygon, or nearly, in lattice units of one face of the cube, without memory of its own.
// A quadrilateral that is cut by another and by a square has at most 12 corners.
struct FacePolygon {
  std::array<glm::dvec2, 16> point;
  int size = 0;

  void push_back(glm::dvec2 p) {
    if (size < int(point.size())) point[std::size_t(size++)] = p;
  }
  const glm::dvec2& corner(int n) const { return point[std::size_t(n)]; }

  double area() const {  // signed, twice
    double sum = 0;
    for (int at = 2; at < size; ++at) {
      const glm::dvec2 u = corner(at - 1) - corner(0), v = corner(at) - corner(0);
      sum += u.x * v.y - u.y * v.x;
    }
    return sum;
  }

  // The part where `side` of a corner is not negative; side is linear (Sutherland and Hodgman
  // 1974, doi:10.1145/360767.360802).
  template <class Side>
  FacePolygon clipped_by(Side&& side) const {
    FacePolygon part;
    if (size == 0) return part;
    double here = side(corner(0));
    for (int at = 0; at < size; ++at) {
      const glm::dvec2 &p = corner(at), &q = corner((at + 1) % size);
      const double next = side(q);
      if (here >= 0) part.push_back(p);
      if ((here > 0 && next < 0) || (here < 0 && next > 0))
        part.push_back(p + (q - p) * (here / (here - next)));
      here = next;
    }
    return part;
  }

  // The part with point[axis] * sign >= limit * sign; cuts lie on the limit to the bit.
  FacePolygon clipped(int axis, double limit, double sign) const {
    FacePolygon part;
    for (int at = 0; at < size; ++at) {
      const glm::dvec2 &p = corner(at), &q = corner((at + 1) % size);
      const double dp = (p[axis] - limit) * sign, dq = (q[axis] - limit) * sign;
      if (dp >= 0) part.push_back(p);
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
        glm::dvec2 cut = p + (q - p) * (dp / (dp - dq));
        cut[axis] = limit;
        part.push_back(cut);
      }
    }
    return part;
  }

  // The part inside another convex polygon, whose corners run counterclockwise.
  FacePolygon within(const FacePolygon& other) const {
    FacePolygon part = *this;
    for (int at = 0; at < other.size && part.size >= 3; ++at) {
      const glm::dvec2 from = other.corner(at), along = other.corner((at + 1) % other.size) - from;
      part = part.clipped_by(
          [&](const glm::dvec2& p) { return along.x * (p.y - from.y) - along.y * (p.x - from.x); });
    }
    return part;
  }
};

}  // namespace nepho::forecast
