#include "live/pixel_reuse.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace nepho {
namespace {

using gl::kNoGround_m;

// What a cloud hides of what is behind it, for the pixel to go where the cloud goes: the sky has no
// marks that would be missed.
constexpr float kHidesSky = 0.02f, kHidesGround = 0.3f;
constexpr float kReach_pixels = 1.25f;    // of a point
constexpr float kBilinearWeight = 0.05f;  // beside a point's 1
constexpr float kSameDistance = 0.1f;     // relative: where two points are one surface
constexpr float kBeyondRange = 0.25f;     // of the range of radiance around
constexpr int kRing = 1;                  // of grid pixels around a cell

template <class Row>
void each_row(int rows, const Row& row) {
  tbb::parallel_for(0, rows, [&](int y) { row(y); });
}

// 0 for the sky.
float near_of(float distance_m) {
  return distance_m < kNoGround_m ? 1 / std::max(distance_m, 1e-3f) : 0.0f;
}

// 1 / distance within a range of such.
bool within(float near, float farthest, float nearest, float slack) {
  return near >= farthest * (1 - kSameDistance) - slack &&
         near <= nearest * (1 + kSameDistance) + slack;
}

// The pixels of a grid around a pixel, and where it is between them.
struct Corners {
  Corners(int x, int y, const PixelGrid& grid, int columns, int rows) {
    across = along(x, grid.x, grid.step, columns, column);
    down = along(y, grid.y, grid.step, rows, row);
  }
  static float along(int pixel, int first, int step, int count, int (&between)[2]) {
    const float at = std::clamp(float(pixel - first) / float(step), 0.0f, float(count - 1));
    between[0] = int(at);
    between[1] = std::min(between[0] + 1, count - 1);
    return at - float(between[0]);
  }
  template <class Value>
  Value mix(const Value& a, const Value& b, const Value& c, const Value& d) const {
    return glm::mix(glm::mix(a, b, across), glm::mix(c, d, across), down);
  }
  int column[2], row[2];
  float across, down;
};

int cell_of(int pixel, int first, int step) {
  return (pixel - first + step) / step;  // 0: before the first
}

}  // namespace

std::vector<float> seen_distances(const gl::PixelValues& values, bool planet) {
  std::vector<float> distances_m(values.depths.size());
  for (std::size_t p = 0; p < distances_m.size(); ++p) {
    const auto [moment_m, part, start_m, behind_m] = values.depths[p];
    const float ground_m = planet ? values.met[p][3] : behind_m;
    const bool sky = !(ground_m < kNoGround_m);
    distances_m[p] = part > (sky ? kHidesSky : kHidesGround) ? start_m + moment_m / part
                     : sky                                   ? kNoGround_m
                                                             : start_m + ground_m;
  }
  return distances_m;
}

// As camera.glsl.
struct PixelReuse::View {
  explicit View(const FrameData& frame) : width(frame.width), height(frame.height) {
    for (int c = 0; c < 3; ++c) {
      eye_m[c] = frame.eye_m[c];
      right[c] = float(frame.right[c]);
      up[c] = float(frame.up[c]);
      forward[c] = float(frame.forward[c]);
    }
    across = right / glm::dot(right, right);
    upward = up / glm::dot(up, up);
  }
  glm::vec3 direction(int x, int y) const {
    const float u = (2 * float(x) + 1) / float(width) - 1;
    const float v = 1 - (2 * float(y) + 1) / float(height);
    return glm::normalize(forward + u * right + v * up);
  }
  // In pixels; false behind the eye.
  bool seen_at(const glm::vec3& place, glm::vec2& at) const {
    const float ahead = glm::dot(place, forward);
    if (!(ahead > 0)) return false;
    at.x = 0.5f * (float(width) * (glm::dot(place, across) / ahead + 1) - 1);
    at.y = 0.5f * (float(height) * (1 - glm::dot(place, upward) / ahead) - 1);
    return true;
  }
  int width, height;
  glm::dvec3 eye_m;
  glm::vec3 right, up, forward, across, upward;
};

void PixelReuse::clear() {
  width_ = height_ = 0;
  points_.clear();
  eyes_m_.clear();
}

HdrImage PixelReuse::picture(const FrameData& view, const PixelShares& shares,
                             const std::vector<float>& distance_m, bool same_view) {
  const std::uint32_t most_age = 2 * std::uint32_t(shares.each() * shares.each());
  ++frame_;
  if (!same_view) ++view_;
  if (width_ != view.width || height_ != view.height) {
    width_ = view.width;
    height_ = view.height;
    points_.assign(std::size_t(width_) * std::size_t(height_), {});
  } else if (!same_view) {
    carry(View(last_), View(view), most_age);
  }
  last_ = view;
  find_slack(View(view), most_age);
  take(View(view), shares, distance_m);
  follow(shares);
  find_ranges(shares);
  reject(shares);
  return fill(shares);
}

// Points to where they are seen now. Of several in a pixel the nearest stays, or the newest where
// they are one surface.
void PixelReuse::carry(const View& from, const View& to, std::uint32_t most_age) {
  const glm::vec3 shift(from.eye_m - to.eye_m);
  targets_.assign(points_.size(), -1);
  each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t p = at(x, y);
      Point& point = points_[p];
      if (point.distance_m < 0 || frame_ - point.frame > most_age) continue;
      if (point.distance_m < kNoGround_m) {
        point.place_m += shift;
        point.distance_m = glm::length(point.place_m);
      }
      glm::vec2 at;
      if (!to.seen_at(point.place_m, at)) continue;
      const glm::vec2 pixel = glm::floor(at + 0.5f);
      if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < float(width_) && pixel.y < float(height_)))
        continue;
      point.at = at - pixel;
      targets_[p] = int(pixel.y) * width_ + int(pixel.x);
    }
  });
  next_.assign(points_.size(), {});
  for (std::size_t p = 0; p < points_.size(); ++p) {
    if (targets_[p] < 0) continue;
    const Point& point = points_[p];
    Point& held = next_[std::size_t(targets_[p])];
    const float apart = point.distance_m - held.distance_m;
    const bool same = std::abs(apart) <= kSameDistance * point.distance_m;
    if (held.distance_m < 0 || (same ? point.frame > held.frame : apart < 0)) held = point;
  }
  points_.swap(next_);
}

// Nothing hides anything else, nor stops to, by less of a parallax than that of a pixel: from so
// far apart as the eye was while there have been points.
void PixelReuse::find_slack(const View& view, std::uint32_t most_age) {
  eyes_m_.push_back(view.eye_m);
  while (eyes_m_.size() > most_age + 1) eyes_m_.pop_front();
  double travel_m = 0;
  for (const glm::dvec3& eye_m : eyes_m_)
    travel_m = std::max(travel_m, glm::distance(eye_m, view.eye_m));
  const double pixel_rad = 2 * double(glm::length(view.up)) / view.height;
  slack_per_m_ = float(std::min(pixel_rad / std::max(travel_m, 1e-30), 1e30));
}

// Whether a point no farther than `reach` pixels is as far away.
bool PixelReuse::expected(int x, int y, int reach, float near) const {
  for (int j = std::max(y - reach, 0); j <= std::min(y + reach, height_ - 1); ++j)
    for (int i = std::max(x - reach, 0); i <= std::min(x + reach, width_ - 1); ++i) {
      const Point& point = points_[at(i, j)];
      if (point.distance_m >= 0 && within(near_of(point.distance_m), near, near, slack_per_m_))
        return true;
    }
  return false;
}

// The points of the newest share.
void PixelReuse::take(const View& view, const PixelShares& shares,
                      const std::vector<float>& distance_m) {
  const HdrImage& marched = shares.marched();
  const auto [first_x, first_y] = shares.last_offset();
  const int each = shares.each(), columns = width_ / each;
  changes_.resize(distance_m.size());
  unexpected_.resize(distance_m.size());
  each_row(height_ / each, [&](int row) {
    for (int column = 0; column < columns; ++column) {
      const int x = column * each + first_x, y = row * each + first_y;
      const std::size_t p = at(x, y);
      Point& point = points_[p];
      const std::size_t n = std::size_t(row) * std::size_t(columns) + std::size_t(column);
      const Around around = points_around(x, y);
      changes_[n] = glm::vec3(0.0f);
      for (int c = 0; c < 3 && around.old_weight > 0.5f; ++c)
        changes_[n][c] = marched.rgb[3 * p + std::size_t(c)] - around.old[c] / around.old_weight;
      unexpected_[n] = !expected(x, y, each / 2, near_of(distance_m[n]));
      point.distance_m = distance_m[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
      point.place_m = view.direction(x, y);
      if (point.distance_m < kNoGround_m) point.place_m *= point.distance_m;
      for (int c = 0; c < 3; ++c) point.radiance[c] = marched.rgb[3 * p + std::size_t(c)];
      point.optical_depth = marched.optical_depth[p];
      point.at = {0, 0};
      point.frame = frame_;
      point.view = view_;
    }
  });
}

// What all four newly marched pixels around agree on has changed the points between them as well,
// by the least of it: light and glints that go with the eye, the air in front. At edges they do not
// agree.
void PixelReuse::follow([[maybe_unused]] const PixelShares& shares) {
#if !defined(NEPHO_MUTANT_REUSE_AS_WAS)
  const int each = shares.each(), columns = width_ / each, rows = height_ / each;
  const auto [first_x, first_y] = shares.last_offset();
  each_row(height_, [&, first_x = first_x, first_y = first_y](int y) {
    for (int x = 0; x < width_; ++x) {
      Point& point = points_[at(x, y)];
      if (point.distance_m < 0 || point.view == view_) continue;
      const Corners corners(x, y, {each, first_x, first_y}, columns, rows);
      glm::vec3 of[4];
      for (int n = 0; n < 4; ++n)
        of[n] = changes_[std::size_t(corners.row[n / 2]) * std::size_t(columns) +
                         std::size_t(corners.column[n % 2])];
      const glm::vec3 low = glm::min(glm::min(of[0], of[1]), glm::min(of[2], of[3]));
      const glm::vec3 high = glm::max(glm::max(of[0], of[1]), glm::max(of[2], of[3]));
      for (int c = 0; c < 3; ++c) {
        const float change = low[c] > 0 ? low[c] : std::min(high[c], 0.0f);
        point.radiance[c] = std::max(point.radiance[c] + change, 0.0f);
      }
    }
  });
#endif
}

// Of the pixels of the finest grid around each of its cells; those before the first and behind the
// last of a row are cells too.
void PixelReuse::find_ranges(const PixelShares& shares) {
  const PixelGrid grid = shares.finest_grid();
  const int columns = width_ / grid.step, rows = height_ / grid.step;
  range_columns_ = columns + 1;
  ranges_.resize(std::size_t(range_columns_) * std::size_t(rows + 1));
  each_row(rows + 1, [&](int row) {
    for (int column = 0; column <= columns; ++column) {
      Range range{glm::vec3(1e30f), glm::vec3(-1e30f), 1e30f, 0};
      for (int j = row - 1 - kRing; j <= row + kRing; ++j)
        for (int i = column - 1 - kRing; i <= column + kRing; ++i) {
          const int x = std::clamp(i, 0, columns - 1) * grid.step + grid.x;
          const int y = std::clamp(j, 0, rows - 1) * grid.step + grid.y;
          const Point& point = points_[at(x, y)];
          range.low = glm::min(range.low, point.radiance);
          range.high = glm::max(range.high, point.radiance);
          if (i < column - 1 || i > column || j < row - 1 || j > row) continue;
          const float near = near_of(point.distance_m);
          range.farthest = std::min(range.farthest, near);
          range.nearest = std::max(range.nearest, near);
        }
      if (row == 0 || row == rows || column == 0 || column == columns) {
        range.farthest = 0;
        range.nearest = 1e30f;
      }
      const glm::vec3 beyond = kBeyondRange * (range.high - range.low);
      range.low -= beyond;
      range.high += beyond;
      ranges_[std::size_t(row) * std::size_t(range_columns_) + std::size_t(column)] = range;
    }
  });
}

const PixelReuse::Range& PixelReuse::range_at(const PixelGrid& grid, int x, int y) const {
  return ranges_[std::size_t(cell_of(y, grid.y, grid.step)) * std::size_t(range_columns_) +
                 std::size_t(cell_of(x, grid.x, grid.step))];
}

// Points of earlier views at a distance that nothing around has now: what they showed is hidden, or
// what hid it is gone. Where the nearest new pixel is at a distance that was not expected there,
// they have to be as far away as that one: of an edge that comes all at once, nothing is known yet.
void PixelReuse::reject([[maybe_unused]] const PixelShares& shares) {
#if !defined(NEPHO_MUTANT_REUSE_ALL)
  const PixelGrid grid = shares.finest_grid();
  const int each = shares.each(), columns = width_ / each, rows = height_ / each;
  const std::array<int, 2> first = shares.last_offset();
  each_row(height_, [&](int y) {
    const int row = std::clamp((y - first[1] + each / 2 + each) / each - 1, 0, rows - 1);
    for (int x = 0; x < width_; ++x) {
      Point& point = points_[at(x, y)];
      if (point.distance_m < 0 || point.view == view_) continue;
      const Range& range = range_at(grid, x, y);
      const float near = near_of(point.distance_m);
      const int column = std::clamp((x - first[0] + each / 2 + each) / each - 1, 0, columns - 1);
      bool stays = within(near, range.farthest, range.nearest, slack_per_m_);
      if (unexpected_[std::size_t(row) * std::size_t(columns) + std::size_t(column)]) {
        const Point& newest = points_[at(column * each + first[0], row * each + first[1])];
        const float there = near_of(newest.distance_m);
        stays = stays && within(near, there, there, slack_per_m_);
      }
      if (!stays) point.distance_m = -1;
    }
  });
#endif
}

PixelReuse::Around PixelReuse::points_around(int x, int y) const {
  Around around;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height_ - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width_ - 1); ++i) {
      const Point& point = points_[at(i, j)];
      if (point.distance_m < 0) continue;
      const glm::vec2 apart = glm::vec2(i - x, j - y) + point.at;
      const float far = glm::dot(apart, apart) / (kReach_pixels * kReach_pixels);
      if (far >= 1) continue;
      const float part = (1 - far) * (1 - far);
      const glm::vec4 values(point.radiance, point.optical_depth);
      (point.view == view_ ? around.mine : around.old) += part * values;
      (point.view == view_ ? around.my_weight : around.old_weight) += part;
    }
  return around;
}

HdrImage PixelReuse::fill(const PixelShares& shares) const {
  const PixelGrid grid = shares.finest_grid();
  const int columns = width_ / grid.step, rows = height_ / grid.step;
  HdrImage image{width_, height_, {}, {}};
  image.rgb.resize(3 * points_.size());
  image.optical_depth.resize(points_.size());
  const auto point_at = [&](int x, int y) -> const Point& { return points_[at(x, y)]; };
  // Radiance and optical depth.
  const auto values_of = [](const Point& point) {
    return glm::vec4(point.radiance, point.optical_depth);
  };
  const auto bilinear = [&](int x, int y) {
    const Corners corners(x, y, grid, columns, rows);
    const auto of = [&](int i, int j) {
      return values_of(
          point_at(corners.column[i] * grid.step + grid.x, corners.row[j] * grid.step + grid.y));
    };
    return corners.mix(of(0, 0), of(1, 0), of(0, 1), of(1, 1));
  };
  each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const Point& own = point_at(x, y);
      glm::vec4 values = values_of(own);
      if (own.distance_m < 0 || own.view != view_) {
        const Around around = points_around(x, y);
        glm::vec4 sum = around.mine + kBilinearWeight * bilinear(x, y);
        float weight = around.my_weight + kBilinearWeight;
        if (around.old_weight > 0) {
          glm::vec4 old = around.old / around.old_weight;
#if !defined(NEPHO_MUTANT_REUSE_UNCLAMPED)
          const Range& range = range_at(grid, x, y);
          old = glm::vec4(glm::clamp(glm::vec3(old), range.low, range.high), old.w);
#endif
          sum += around.old_weight * old;
          weight += around.old_weight;
        }
        values = sum / weight;
      }
      const std::size_t p = at(x, y);
      for (int c = 0; c < 3; ++c) image.rgb[3 * p + std::size_t(c)] = values[c];
      image.optical_depth[p] = values.w;
    }
  });
  return image;
}

}  // namespace nepho
