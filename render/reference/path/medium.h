#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "reference/path/leaves.h"
#include "reference/path/random.h"

namespace nepho {

// All volumes of a forest as one medium, for null-collision tracking (Woodcock et al. 1965; Novak
// et al. 2014, doi:10.1145/2661229.2661292): exact in expectation, whatever the field is, with one
// bound of extinction for each leaf and jumps through empty and constant ones. Volumes overlap as
// independent Poisson processes: the first of their collisions is the medium's. Thread-safe.
class PathMedium {
 public:
  explicit PathMedium(const Forest& forest);  // which outlives this

  struct Collision {
    double t_m = kNoDistance_m;
    int volume = -1;  // none
    bool ice = false;
  };
  // The first before t_max_m. Real: null collisions are passed over.
  Collision collide(const Ray& ray, double t_max_m, Random& random) const;

  // An unbiased estimate of the transmittance up to t_max_m, in [0, 1], by ratio tracking with
  // roulette below 1/8.
  double transmittance(const Ray& ray, double t_max_m, Random& random) const;

  std::size_t size() const { return volumes_.size(); }
  // Collisions whose extinction was above its bound by more than rounding; 0, or a bug.
  std::uint64_t violations() const { return violations_; }

 private:
  template <class Kind>
  Collision collide_in(std::size_t volume, const Kind& ray, double t_max_m, Random& random) const;
  template <class Kind>
  double pass(std::size_t volume, const Kind& ray, double t_max_m, double passed,
              Random& random) const;
  // fn(ray in the volume's own chart)
  template <class Fn>
  auto with_ray(std::size_t volume, const Ray& ray, Fn&& fn) const;

  std::vector<std::unique_ptr<Leaves>> volumes_;
  mutable std::atomic<std::uint64_t> violations_ = 0;
};

}  // namespace nepho
