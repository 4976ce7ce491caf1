#include "sources/analytic/kinds.h"

#include <algorithm>
#include <cmath>

namespace nepho::analytic {
namespace {

class Uniform final : public Kind {
 public:
  explicit Uniform(double value) : value_(value) {}
  double extinction_per_m(const RootPosition&) const override { return value_; }
  std::optional<double> constant_in(const RootBox&) const override { return value_; }

 private:
  double value_;
};

class StepCloud final : public Kind {
 public:
  StepCloud(double left, double right) : left_(left), right_(right) {}
  double extinction_per_m(const RootPosition& p) const override {
    // A point located from the world misses the wall by a rounding.
    constexpr double wall = 1e-9;
    const double x = p.q.x - std::floor(p.q.x);
    if (std::min({x, std::abs(x - 0.5), 1 - x}) < wall) return (left_ + right_) / 2;
    return x < 0.5 ? left_ : right_;
  }
  std::optional<double> constant_in(const RootBox& box) const override {
    if (left_ == right_) return left_;
    if (box.low.x > 0 && box.high.x < 0.5) return left_;
    if (box.low.x > 0.5 && box.high.x < 1) return right_;
    return std::nullopt;
  }

 private:
  double left_, right_;
};

class Exponential final : public Kind {
 public:
  Exponential(double bottom, double scale) : bottom_(bottom), scale_(scale) {}
  double extinction_per_m(const RootPosition& p) const override {
    return bottom_ * std::exp(-p.q.z / scale_);
  }
  std::optional<double> constant_in(const RootBox&) const override { return std::nullopt; }

 private:
  double bottom_, scale_;
};

// A function of the distance to the chart's middle, 0 beyond `reach`.
class Ball : public Kind {
 public:
  Ball(const BoxChart& chart, double reach_m, double plateau_m)
      : edges_m_(chart.edges_m()), reach_m_(reach_m), plateau_m_(plateau_m) {}
  double extinction_per_m(const RootPosition& p) const override {
    return profile(glm::length(edges_m_ * (p.q - 0.5)));
  }
  std::optional<double> constant_in(const RootBox& box) const override {
    const glm::dvec3 middle = edges_m_ * (0.5 * (box.low + box.high) - 0.5);
    double reach = 0;  // to the box's corners
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 side = {corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1};
      reach = std::max(reach, glm::length(edges_m_ * (0.5 * side * (box.high - box.low))));
    }
    const double distance = glm::length(middle);
    if (distance - reach > reach_m_) return 0.0;
    if (distance + reach < plateau_m_) return profile(0);
    return std::nullopt;
  }

 protected:
  virtual double profile(double distance_m) const = 0;

 private:
  glm::dmat3 edges_m_;
  double reach_m_, plateau_m_;  // 0 beyond the first, constant within the second
};

class Sphere final : public Ball {
 public:
  Sphere(const BoxChart& chart, double extinction, double radius_m, double edge_m)
      : Ball(chart, radius_m + edge_m / 2, radius_m - edge_m / 2),
        extinction_(extinction),
        radius_m_(radius_m),
        edge_m_(edge_m) {}
  double profile(double distance_m) const override {
    return extinction_ * std::clamp(0.5 + (radius_m_ - distance_m) / edge_m_, 0.0, 1.0);
  }

 private:
  double extinction_, radius_m_, edge_m_;
};

double lowered_gaussian(double square, double cutoff) {
  const double foot = std::exp(-cutoff * cutoff / 2);
  return std::max(0.0, (std::exp(-square / 2) - foot) / (1 - foot));
}

class Gaussian final : public Ball {
 public:
  Gaussian(const BoxChart& chart, double extinction, double sigma_m, double cutoff)
      : Ball(chart, cutoff * sigma_m, 0),
        extinction_(extinction),
        sigma_m_(sigma_m),
        cutoff_(cutoff) {}
  double profile(double distance_m) const override {
    const double r = distance_m / sigma_m_;
    return extinction_ * lowered_gaussian(r * r, cutoff_);
  }

 private:
  double extinction_, sigma_m_, cutoff_;
};

class ShellGaussian final : public Kind {
 public:
  ShellGaussian(const ShellChart& chart, double extinction, const ShellBlob& blob)
      : chart_(chart), extinction_(extinction), blob_(blob) {
    const glm::dvec3 centre = chart.to_scaled(blob.centre_ecef_m);
    direction_ = glm::normalize(centre);
    altitude_m_ = glm::length(centre) - chart.body().equatorial_m;
  }
  double extinction_per_m(const RootPosition& p) const override {
    const double chord_m = radius_m() * glm::length(direction(p.root, p.q) - direction_);
    return extinction_ * lowered_gaussian(square(chord_m, height_m(p.q.z)), blob_.cutoff);
  }
  std::optional<double> constant_in(const RootBox& box) const override {
    // Walls are great circles, so a box's farthest point from its middle is a corner.
    const glm::dvec3 middle = direction(box.root, 0.5 * (box.low + box.high));
    double reach = 0;
    for (const double x : {box.low.x, box.high.x})
      for (const double y : {box.low.y, box.high.y})
        reach = std::max(reach, glm::length(direction(box.root, {x, y, 0}) - middle));
    const double chord_m = radius_m() * std::max(0.0, glm::length(middle - direction_) - reach);
    const double nearest_m =
        std::clamp(altitude_m_, altitude(box.low.z), altitude(box.high.z)) - altitude_m_;
    if (square(chord_m, nearest_m) > blob_.cutoff * blob_.cutoff) return 0.0;
    return std::nullopt;
  }

 private:
  double radius_m() const { return chart_.body().equatorial_m; }
  double altitude(double q) const { return chart_.bottom_m() + q * chart_.thickness_m(); }
  double height_m(double q) const { return altitude(q) - altitude_m_; }
  double square(double chord_m, double above_m) const {
    const double h = chord_m / blob_.horizontal_m, v = above_m / blob_.vertical_m;
    return h * h + v * v;
  }
  glm::dvec3 direction(int root, glm::dvec3 q) const {
    return glm::normalize(chart_.to_scaled(chart_.ecef_m({root, {q.x, q.y, 0.0}})));
  }

  const ShellChart& chart_;
  double extinction_;
  ShellBlob blob_;
  glm::dvec3 direction_{0.0};
  double altitude_m_ = 0;
};

}  // namespace

std::unique_ptr<Kind> uniform(double extinction_per_m) {
  return std::make_unique<Uniform>(extinction_per_m);
}
std::unique_ptr<Kind> step_cloud(double left_per_m, double right_per_m) {
  return std::make_unique<StepCloud>(left_per_m, right_per_m);
}
std::unique_ptr<Kind> exponential(double bottom_per_m, double scale) {
  return std::make_unique<Exponential>(bottom_per_m, scale);
}
std::unique_ptr<Kind> sphere(const BoxChart& chart, double extinction_per_m, double radius_m,
                             double edge_m) {
  return std::make_unique<Sphere>(chart, extinction_per_m, radius_m, edge_m);
}
std::unique_ptr<Kind> gaussian(const BoxChart& chart, double extinction_per_m, double sigma_m,
                               double cutoff) {
  return std::make_unique<Gaussian>(chart, extinction_per_m, sigma_m, cutoff);
}
std::unique_ptr<Kind> shell_gaussian(const ShellChart& chart, double extinction_per_m,
                                     const ShellBlob& blob) {
  return std::make_unique<ShellGaussian>(chart, extinction_per_m, blob);
}

}  // namespace nepho::analytic
