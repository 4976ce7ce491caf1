#pragma once

#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <vector>

#include "live/grid_lines.h"
#include "live/pixel_shares.h"
#include "renderer.h"
#include "shaders/frame.layout.h"

namespace nepho {

// Whole pictures from a share of their pixels and what was marched for the last ones (a render
// cache: Walter, Drettakis, Parker 1999). Each pixel holds one marched point, with its place in the
// world: relative to the eye, so that floats resolve it at any scale; the eye itself moves in
// double. In the next picture a point is where its place is seen, and the nearest one of a pixel
// stays. Points older than the pixels take to be marched anew are dropped, and so are those whose
// distance is not that of the newly marched pixels around; what is left is clamped to the range of
// their radiance. Pixels are a mean of the points around them, no farther than a pixel, and of the
// new pixels by bilinear interpolation where there are none. Points of this view are as they were
// marched. The approximation is named `pixel reuse`.
//
// No OpenGL here: pixels are read back for the picture in any case.
class PixelReuse {
 public:
  void clear();
  // The picture of `view` (the whole picture's, not the share's) after `shares` took another one,
  // whose distances these are. `same_view`: nothing changed since the last call.
  HdrImage picture(const FrameData& view, const PixelShares& shares,
                   const std::vector<float>& distance_m, bool same_view);

 private:
  struct Point {
    // Relative to the eye; a unit direction where distance_m is kNoGround_m.
    glm::vec3 place_m{0.0f};
    float distance_m = -1;  // less than 0: no point
    glm::vec3 radiance{0.0f};
    float optical_depth = 0;
    glm::vec2 at{0.0f};       // from its pixel's centre, in pixels
    std::uint32_t frame = 0;  // that it was marched in
  };
  // Of the newly marched pixels around a cell of their grid.
  struct Range {
    glm::vec3 low, high;       // radiance
    float farthest, nearest;   // 1 / distance
    glm::vec3 rise_x, rise_y;  // of radiance by pixel, as far as three cells in a row agree
  };
  struct View;
  // Sums of radiance and optical depth by weight: of points of this view, and of earlier ones.
  struct Around {
    glm::vec4 mine{0.0f}, old{0.0f};
    float my_weight = 0, old_weight = 0;
    glm::vec2 apart{0.0f};  // of both, from the pixel's centre
  };

  void carry(const View& from, const View& to, std::uint32_t most_age);
  void take(const View& view, const PixelShares& shares, const std::vector<float>& distance_m);
  void find_ranges(const GridLines& finest);
  void find_rise(const GridLines& finest, int column, int row, Range& range) const;
  bool stays(const Point& point, const Range& range, int x, int y, const GridLines& newest) const;
  glm::vec3 change_at(int x, int y, const GridLines& newest) const;
  void centre_changes(const GridLines& finest, const GridLines& newest);
  void age(const GridLines& finest, const GridLines& newest);
  std::size_t at(int x, int y) const {
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
  }
  bool is_new(const Point& point) const { return point.frame >= view_begin_; }  // of this view
  void find_slack(const View& view, std::uint32_t most_age);
  bool expected(int x, int y, int reach, float near) const;
  Around points_around(int x, int y) const;
  static glm::vec4 values_of(const Point& point) { return {point.radiance, point.optical_depth}; }
  glm::vec4 bilinear(const GridLines& finest, int x, int y) const;
  HdrImage fill(const GridLines& finest) const;
  const Range& range_at(const GridLines& finest, int x, int y) const;

  int width_ = 0, height_ = 0;
  std::uint32_t frame_ = 0, view_begin_ = 0;
  FrameData last_{};
  std::deque<glm::dvec3> eyes_m_;     // of the frames that points may be of
  float slack_per_m_ = 0;             // of 1 / distance
  std::vector<Point> points_, next_;  // by pixel
  std::vector<std::int32_t> targets_;
  // By pixel of the last share: what has changed there, where that was seen, and whether it was at
  // another distance.
  std::vector<glm::vec3> changes_;
  std::vector<glm::vec2> changes_at_;
  std::vector<std::uint8_t> unexpected_;
  std::vector<Range> ranges_;
  int range_columns_ = 0;
};

}  // namespace nepho
