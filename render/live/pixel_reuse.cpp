#include "live/pixel_reuse.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "gl/pixel_plan.h"

namespace nepho {
namespace {

using gl::kNoGround_m;

constexpr float kReach_pixels = 1.25f;   // of a point
constexpr float kBilinearWeight = 0.1f;  // beside a point's 1, where there is none,
constexpr float kEnough = 0.5f;          // to nothing with so much of them
constexpr float kSameDistance = 0.1f;    // relative: where two points are one surface
constexpr float kBeyondRange = 0.25f;    // of the range of radiance around
constexpr int kRing = 1;                 // of grid pixels around a cell

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

}  // namespace

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
  if (!same_view) view_begin_ = frame_;
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
  if (shares.whole()) return shares.picture();
  const auto [x, y] = shares.last_offset();
  const GridLines finest(shares.finest_grid(), width_, height_);
  find_ranges(finest);
  const GridLines newest({shares.each(), x, y}, width_, height_);
  centre_changes(finest, newest);
  age(finest, newest);
  return fill(finest);
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
      const glm::vec2 corner = at + 0.5f;
      if (!(corner.x >= 0 && corner.y >= 0 && corner.x < float(width_) &&
            corner.y < float(height_)))
        continue;
      const int column = int(corner.x), row = int(corner.y);
      point.at = at - glm::vec2(column, row);
      targets_[p] = row * width_ + column;
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
  changes_at_.resize(distance_m.size());
  unexpected_.resize(distance_m.size());
  each_row(height_ / each, [&](int row) {
    for (int column = 0; column < columns; ++column) {
      const int x = column * each + first_x, y = row * each + first_y;
      const std::size_t p = at(x, y);
      Point& point = points_[p];
      const std::size_t n = std::size_t(row) * std::size_t(columns) + std::size_t(column);
      const Around around = points_around(x, y);
      changes_[n] = glm::vec3(0.0f);
      changes_at_[n] = glm::vec2(0.0f);
      if (around.old_weight > kEnough) {
        for (int c = 0; c < 3; ++c)
          changes_[n][c] = marched.rgb[3 * p + std::size_t(c)] - around.old[c] / around.old_weight;
        changes_at_[n] = around.apart / around.old_weight;
      }
      unexpected_[n] = !expected(x, y, each / 2, near_of(distance_m[n]));
      point.distance_m = distance_m[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
      point.place_m = view.direction(x, y);
      if (point.distance_m < kNoGround_m) point.place_m *= point.distance_m;
      for (int c = 0; c < 3; ++c) point.radiance[c] = marched.rgb[3 * p + std::size_t(c)];
      point.optical_depth = marched.optical_depth[p];
      point.at = {0, 0};
      point.frame = frame_;
    }
  });
}

// Of the pixels of the finest grid around each of its cells; those before the first and behind the
// last of a row are cells too.
void PixelReuse::find_ranges(const GridLines& finest) {
  const auto& [grid, columns, rows, across, down] = finest;
  range_columns_ = columns + 1;
  ranges_.resize(std::size_t(range_columns_) * std::size_t(rows + 1));
  each_row(rows + 1, [&, grid = grid, columns = columns, rows = rows](int row) {
    for (int column = 0; column <= columns; ++column) {
      Range range{glm::vec3(1e30f), glm::vec3(-1e30f), 1e30f, 0, {}, {}};
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
#if !defined(NEPHO_MUTANT_REUSE_LEVEL)
      find_rise(finest, column, row, range);
#endif
      ranges_[std::size_t(row) * std::size_t(range_columns_) + std::size_t(column)] = range;
    }
  });
}

// Of gradients, not of edges: the least of what both sides of a cell and of those beside it have.
void PixelReuse::find_rise(const GridLines& finest, int column, int row, Range& range) const {
  const auto radiance = [&](int i, int j) -> const glm::vec3& {
    return points_[at(finest.pixel_x(std::clamp(i, 0, finest.columns - 1)),
                      finest.pixel_y(std::clamp(j, 0, finest.rows - 1)))]
        .radiance;
  };
  const auto least = [&](const auto& rise, int cell, int count) {
    const int first = -cell, last = count - 2 - cell;
    if (first > last) return glm::vec3(0.0f);
    glm::vec3 low(1e30f), high(-1e30f);
    for (int side = -1; side <= 0; ++side)
      for (int beside = -2; beside <= 0; ++beside) {
        if (beside < first || beside > last) continue;  // the picture ends
        const glm::vec3 here = rise(beside, side);
        low = glm::min(low, here);
        high = glm::max(high, here);
      }
    return (glm::max(low, glm::vec3(0.0f)) + glm::min(high, glm::vec3(0.0f))) /
           float(finest.grid.step);
  };
  range.rise_x = least(
      [&](int i, int j) {
        return radiance(column + i + 1, row + j) - radiance(column + i, row + j);
      },
      column, finest.columns);
  range.rise_y = least(
      [&](int i, int j) {
        return radiance(column + j, row + i + 1) - radiance(column + j, row + i);
      },
      row, finest.rows);
}

const PixelReuse::Range& PixelReuse::range_at(const GridLines& finest, int x, int y) const {
  return ranges_[std::size_t(finest.y[std::size_t(y)].cell) * std::size_t(range_columns_) +
                 std::size_t(finest.x[std::size_t(x)].cell)];
}

// Points of earlier views at a distance that nothing around has now are dropped: what they showed
// is hidden, or what hid it is gone. Where the nearest new pixel is at a distance that was not
// expected there, they have to be as far away as that one: of an edge that comes all at once,
// nothing is known yet.
bool PixelReuse::stays(const Point& point, const Range& range, int x, int y,
                       const GridLines& newest) const {
  const float near = near_of(point.distance_m);
  if (!within(near, range.farthest, range.nearest, slack_per_m_)) return false;
  const int column = newest.x[std::size_t(x)].nearest, row = newest.y[std::size_t(y)].nearest;
  if (!unexpected_[newest.number(column, row)]) return true;
  const float there = near_of(points_[at(newest.pixel_x(column), newest.pixel_y(row))].distance_m);
  return within(near, there, there, slack_per_m_);
}

// What all four newly marched pixels around agree on has changed the points between them as well,
// by the least of it: light and glints that go with the eye, the air in front. At edges they do not
// agree.
glm::vec3 PixelReuse::change_at(int x, int y, const GridLines& newest) const {
  const GridLines::Line &across = newest.x[std::size_t(x)], &down = newest.y[std::size_t(y)];
  glm::vec3 low(1e30f), high(-1e30f);
  for (const int row : {down.before, down.after})
    for (const int column : {across.before, across.after}) {
      const glm::vec3& of = changes_[newest.number(column, row)];
      low = glm::min(low, of);
      high = glm::max(high, of);
    }
  return glm::max(low, glm::vec3(0.0f)) + glm::min(high, glm::vec3(0.0f));
}

// The old points around a new pixel lie beside it.
void PixelReuse::centre_changes(const GridLines& finest, const GridLines& newest) {
  each_row(newest.rows, [&](int row) {
    for (int column = 0; column < newest.columns; ++column) {
      const Range& range = range_at(finest, newest.pixel_x(column), newest.pixel_y(row));
      const std::size_t n = newest.number(column, row);
      changes_[n] += range.rise_x * changes_at_[n].x + range.rise_y * changes_at_[n].y;
    }
  });
}

void PixelReuse::age([[maybe_unused]] const GridLines& finest, const GridLines& newest) {
  each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      Point& point = points_[at(x, y)];
      if (point.distance_m < 0 || is_new(point)) continue;
#if !defined(NEPHO_MUTANT_REUSE_ALL)
      if (!stays(point, range_at(finest, x, y), x, y, newest)) {
        point.distance_m = -1;
        continue;
      }
#endif
#if !defined(NEPHO_MUTANT_REUSE_AS_WAS)
      point.radiance = glm::max(point.radiance + change_at(x, y, newest), glm::vec3(0.0f));
#endif
    }
  });
}

PixelReuse::Around PixelReuse::points_around(int x, int y) const {
  constexpr float kPerReach = 1 / (kReach_pixels * kReach_pixels);
  Around around;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height_ - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width_ - 1); ++i) {
      const Point& point = points_[at(i, j)];
      const float right = float(i - x) + point.at.x, down = float(j - y) + point.at.y;
      const float far = (right * right + down * down) * kPerReach;
      if (point.distance_m < 0 || far >= 1) continue;
      const float part = (1 - far) * (1 - far);
      around.apart += part * glm::vec2(right, down);
      const glm::vec4 values = part * values_of(point);
      if (is_new(point)) {
        around.mine += values;
        around.my_weight += part;
      } else {
        around.old += values;
        around.old_weight += part;
      }
    }
  return around;
}

// Radiance and optical depth of the new pixels around.
glm::vec4 PixelReuse::bilinear(const GridLines& finest, int x, int y) const {
  const GridLines::Line &across = finest.x[std::size_t(x)], &down = finest.y[std::size_t(y)];
  const auto row = [&](int j) {
    const auto of = [&](int i) {
      return values_of(points_[at(finest.pixel_x(i), finest.pixel_y(j))]);
    };
    return glm::mix(of(across.before), of(across.after), across.part);
  };
  return glm::mix(row(down.before), row(down.after), down.part);
}

HdrImage PixelReuse::fill(const GridLines& finest) const {
  HdrImage image{width_, height_, {}, {}};
  image.rgb.resize(3 * points_.size());
  image.optical_depth.resize(points_.size());
  each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const Point& own = points_[at(x, y)];
      glm::vec4 values = values_of(own);
      if (own.distance_m < 0 || !is_new(own)) {
        const Around around = points_around(x, y);
        const Range& range = range_at(finest, x, y);
        const glm::vec4 rise(range.rise_x * around.apart.x + range.rise_y * around.apart.y, 0.0f);
        glm::vec4 sum = around.mine - rise;
        float weight = around.my_weight;
        if (around.old_weight > 0) {
          glm::vec4 old = around.old / around.old_weight;
#if !defined(NEPHO_MUTANT_REUSE_UNCLAMPED)
          old = glm::vec4(glm::clamp(glm::vec3(old), range.low, range.high), old.w);
#endif
          sum += around.old_weight * old;
          weight += around.old_weight;
        }
        if (weight < kEnough) {
          const float rest = kBilinearWeight * (1 - weight / kEnough);
          sum += rest * bilinear(finest, x, y);
          weight += rest;
        }
        values = glm::max(sum / weight, glm::vec4(0.0f));
      }
      const std::size_t p = at(x, y);
      for (int c = 0; c < 3; ++c) image.rgb[3 * p + std::size_t(c)] = values[c];
      image.optical_depth[p] = values.w;
    }
  });
  return image;
}

}  // namespace nepho
