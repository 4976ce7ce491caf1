#pragma once

#include <vector>

#include "scene/scene.h"

namespace nepho {

// A straight ray through the air of a sphere, cut where its height passes the kinks and scales of
// the profiles: inside a panel everything is smooth, for Gauss's rule.
//
// Distances u along the ray count from its lowest point, where u = 0: at u the ray is
// u^2 / (r + sqrt(r^2 + u^2)) higher than there (r: of the lowest point from the centre). All of
// this is stable from 1 m to 1e9 m of radius.
class AirPath {
 public:
  // From `height_m` along a zenith cosine mu.
  AirPath(double radius_m, double height_m, double mu);

  double start_m() const { return start_m_; }  // u of the ray's origin
  double height_m(double u_m) const;
  // The positive u where the ray is so high; 0 below its lowest point.
  double rise_m(double height_m) const;
  // u of the top of the air above the lowest point, ahead of the origin or behind it.
  double top_m(const Air& air) const { return rise_m(air.top_m); }
  bool meets_ground() const { return lowest_m_ < 0 && start_m_ < 0; }
  double ground_m() const { return -rise_m(0); }  // its u
  // Ascending u from u0 to u1, cut at `heights_m`.
  std::vector<double> cuts(double u0_m, double u1_m, const std::vector<double>& heights_m) const;

 private:
  double radius_m_, start_m_, lowest_m_, lowest_radius_m_;
};

// Heights at which to cut: fractions and multiples of the scales, the tent's corners, the top.
std::vector<double> air_cut_heights(const Air& air);

}  // namespace nepho
