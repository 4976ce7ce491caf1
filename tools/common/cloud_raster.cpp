#include "common/cloud_raster.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace nepho {
namespace {

constexpr int kMostCells = 256;    // across
constexpr double kRelief = 0.3;    // of what is seen: how high the cloud's top is among the others'
constexpr double kCutCloud = 0.5;  // what a cloud costs that the end of the data cuts off
constexpr double kSomeCloud = 0.2;  // an overcast is better than nothing, by its share of this
constexpr double kVignette = 0.7;   // of the half picture: standard width of the weight

// The lowest and the highest tenth of the tops, by area: what one stands out from.
glm::dvec2 usual_tops_m(const CloudMap& map) {
  std::vector<double> tops_m;
  for (const CloudColumn& c : map.columns) tops_m.push_back(c.top_m);
  if (tops_m.empty()) return {0, 1};
  std::ranges::sort(tops_m);
  const auto at = [&](double part) {
    return tops_m[std::size_t(part * double(tops_m.size() - 1))];
  };
  return {at(0.1), at(0.9)};
}

}  // namespace

CloudRaster::CloudRaster(const CloudMap& map, const glm::dvec3& middle, double radius_m,
                         const PlanetGround& ground)
    : middle_(glm::normalize(middle)), body_m_(ground.body.equatorial_m) {
  const glm::dvec3 aside = std::abs(middle_.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  x_axis_ = glm::normalize(glm::cross(aside, middle_));
  y_axis_ = glm::cross(middle_, x_axis_);
  radius_m_ = std::min(radius_m, glm::two_pi<double>() / 3 * body_m_);
  cell_m_ = std::max(map.cell_m, 2 * radius_m_ / kMostCells);
  cells_ = std::max(1, int(std::ceil(2 * radius_m_ / cell_m_)));
  cell_m_ = 2 * radius_m_ / cells_;
  seen_.assign(std::size_t(cells_) * std::size_t(cells_), 0.0f);
  add_columns(map);
  leave_out_what_has_no_data(ground);
}

glm::dvec2 CloudRaster::plane_m(const glm::dvec3& direction) const {
  const glm::dvec2 aside{glm::dot(direction, x_axis_), glm::dot(direction, y_axis_)};
  const double sine = glm::length(aside);
  if (sine < 1e-15) return {0, 0};
  return aside * (std::atan2(sine, glm::dot(direction, middle_)) / sine * body_m_);
}

glm::dvec3 CloudRaster::direction(const glm::dvec2& plane_m) const {
  const double angle_rad = glm::length(plane_m) / body_m_;
  if (angle_rad < 1e-15) return middle_;
  const glm::dvec2 aside = plane_m * (std::sin(angle_rad) / (angle_rad * body_m_));
  return std::cos(angle_rad) * middle_ + aside.x * x_axis_ + aside.y * y_axis_;
}

// Each column spread over a tent as wide as itself, so that columns side by side leave no gaps.
void CloudRaster::add_columns(const CloudMap& map) {
  const glm::dvec2 tops_m = usual_tops_m(map);
  const double range_m = std::max(tops_m.y - tops_m.x, 300.0);
  for (const CloudColumn& c : map.columns) {
    const double relief = std::clamp((c.top_m - tops_m.x) / range_m, 0.0, 1.0);
    const double value = c.cloudiness() * (1 - kRelief + kRelief * relief);
    const glm::dvec2 at = (plane_m(c.direction) + radius_m_) / cell_m_ - 0.5;
    const double half = std::max(1.0, std::sqrt(c.area_m2) / cell_m_);
    const double share = c.area_m2 / (cell_m_ * cell_m_ * half * half);
    const int last = cells_ - 1;
    for (int j = std::max(0, int(std::ceil(at.y - half))); j <= std::min(last, int(at.y + half));
         ++j)
      for (int i = std::max(0, int(std::ceil(at.x - half))); i <= std::min(last, int(at.x + half));
           ++i)
        seen_[std::size_t(j) * std::size_t(cells_) + std::size_t(i)] +=
            float(value * share * std::max(0.0, 1 - std::abs(i - at.x) / half) *
                  std::max(0.0, 1 - std::abs(j - at.y) / half));
  }
  for (float& seen : seen_) seen = std::min(seen, 1.0f);
}

void CloudRaster::leave_out_what_has_no_data(const PlanetGround& ground) {
  if (ground.maps.empty()) return;
  for (int j = 0; j < cells_; ++j)
    for (int i = 0; i < cells_; ++i) {
      const glm::dvec2 at_m = (glm::dvec2(i, j) + 0.5) * cell_m_ - radius_m_;
      if (!ground.known(direction(at_m) * body_m_))
        seen_[std::size_t(j) * std::size_t(cells_) + std::size_t(i)] = kBeyond;
    }
}

LayerHits layer_hits(double eye_m, double pitch_rad, double layer_m, double body_m,
                     double farthest_m, const Lens& lens) {
  LayerHits hits;
  const double tan_y = std::tan(lens.vertical_fov_rad / 2), tan_x = tan_y * lens.aspect;
  const double eye_r = body_m + eye_m, fall = eye_m - layer_m;
  for (int row = 0; row < LayerHits::kDown; ++row)
    for (int column = 0; column < LayerHits::kAcross; ++column) {
      const double x = (2 * column + 1.0) / LayerHits::kAcross - 1;
      const double y = 1 - (2 * row + 1.0) / LayerHits::kDown;
      const glm::dvec3 ray = glm::normalize(
          glm::dvec3(x * tan_x, std::cos(pitch_rad) - y * tan_y * std::sin(pitch_rad),
                     std::sin(pitch_rad) + y * tan_y * std::cos(pitch_rad)));  // right, ahead, up
      hits.at_m[row][column] = {0, 0};
      hits.weight[row][column] = 0;
      // From above the first of the two crossings, from below the second; only rays that go there.
      const double along = eye_r * ray.z;
      const double inside = along * along - fall * (eye_r + body_m + layer_m);
      if (inside < 0 || (ray.z > 0) == (fall > 0)) continue;
      const double length_m = fall > 0 ? -along - std::sqrt(inside) : -along + std::sqrt(inside);
      const glm::dvec2 aside = glm::dvec2(ray) * length_m;
      const double away = glm::length(aside);
      const double arc_m = body_m * std::atan2(away, eye_r + length_m * ray.z);
      if (arc_m > farthest_m) continue;
      if (away > 0) hits.at_m[row][column] = aside * (arc_m / away);
      hits.weight[row][column] = float(std::exp(-0.5 * (x * x + y * y) / (kVignette * kVignette)));
    }
  return hits;
}

double structure(const CloudRaster& raster, const LayerHits& hits, const glm::dvec2& eye_m,
                 const glm::dvec2& ahead) {
  constexpr int kAcross = LayerHits::kAcross, kDown = LayerHits::kDown;
  float seen[kDown][kAcross];
  const glm::dvec2 right{ahead.y, -ahead.x};
  for (int row = 0; row < kDown; ++row)
    for (int column = 0; column < kAcross; ++column) {
      const glm::dvec2& hit = hits.at_m[row][column];
      seen[row][column] = hits.weight[row][column] > 0
                              ? raster.at(eye_m + hit.x * right + hit.y * ahead)
                              : CloudRaster::kBeyond;
    }
  double sum = 0, weight = 0, cover = 0, all = 0;
  for (const int apart : {1, 3, 9})
    for (int row = 0; row < kDown; ++row)
      for (int column = 0; column < kAcross; ++column) {
        const auto pair = [&](int other_row, int other_column) {
          if (other_row >= kDown || other_column >= kAcross) return;
          const float a = seen[row][column], b = seen[other_row][other_column];
          const double w = std::min(hits.weight[row][column], hits.weight[other_row][other_column]);
          weight += w;
          if (a >= 0 && b >= 0)
            sum += w * std::abs(a - b);
          else
            sum -= kCutCloud * w * std::max({a, b, 0.0f});
        };
        pair(row + apart, column);
        pair(row, column + apart);
      }
  for (int row = 0; row < kDown; ++row)
    for (int column = 0; column < kAcross; ++column) {
      all += hits.weight[row][column];
      cover += hits.weight[row][column] * std::max(0.0f, seen[row][column]);
    }
  return weight > 0 ? std::max(0.0, sum / weight + kSomeCloud * cover / all) : 0;
}

}  // namespace nepho
