#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace nepho::gl {

// What the view pass finds in a pixel: radiance in front of the ground (W m-2 sr-1 nm-1) and
// optical depth of clouds; transmittance and the distance of the ground (m, kNoGround_m: none).
using PixelTexel = std::array<float, 4>;
inline constexpr float kNoGround_m = 1e30f;
// Where it was asked for (RenderRequest::keep_depths), also how far away what is seen is: over the
// cloud, what each place hides of what is behind it times its distance from the ray's start (all of
// it where half is hidden, if so much is); the sum of these parts; that start's distance from the
// eye; the ground's distance from that start (m).
struct PixelValues {
  std::vector<PixelTexel> seen, met, depths = {};
};

// How far apart marched pixels may be along a row and a column, of tiles of kStrideTile pixels: 4,
// 2, 1.
inline constexpr int kStrideTile = 8;
struct PixelStrides {
  std::vector<std::uint8_t> x, y;
};

struct PixelSettings {
  int width = 0, height = 0;
  double tolerance = 1e-2;  // of the picture's marches
  PixelStrides strides = {};
  // For what is seen behind something else, by pixel; empty: all of it, in front of everything.
  std::vector<float> part_seen = {}, in_front = {};  // part of it; luminance in front
};
float luminance(const PixelTexel& seen);

// Interpolated pixels. Every eighth pixel in both directions is marched. Between them, along
// columns and then along rows, half way, and half way again until all are there, pixels are
// interpolated through the four nearest, but marched where those bend by more than kShare of the
// tolerance (second differences of radiance over luminance, and of transmittance), at edges of the
// ground, and where the tree has voxels finer than the grid. One in kCheckEach of the others is
// marched all the same; where one that is marched is not what it would have been interpolated to,
// its neighbours are marched too.
//
// No OpenGL here: the caller marches what next() names and puts the results in.
class PixelPlan {
 public:
  // `values.met` holds the ground's distances, of all pixels.
  PixelPlan(PixelSettings settings, const PixelValues& values);

  // Whether marching all pixels at once is no dearer: most are too fine, or the picture is small.
  bool saves_little() const;
  // Takes the values of the last pixels named, in their order, and names the next (y width + x).
  // None: `values` is whole.
  std::vector<std::uint32_t> next(const PixelValues& marched, PixelValues& values);

  double marched_share() const;
  // Rms over the picture of what interpolation changes, over its mean luminance, from the checked
  // pixels, and for their number; the ground as bright as the mean.
  double predicted_rms() const;
  std::size_t checks() const;

 private:
  enum class State : std::uint8_t { kUnknown, kMarched, kInterpolated };
  // Pixels half way between those of a grid, along columns (then along rows, of both kinds).
  struct Stage {
    int grid;
    bool along_y;
    int step_x, step_y, first_x, first_y;
  };
  static constexpr int kStages = 6;
  // Columns and rows of a stage's pixels.
  struct Places {
    std::vector<int> x, y;
  };
  static Stage stage_at(int number);

  std::size_t at(int x, int y) const {
    return std::size_t(y) * std::size_t(settings_.width) + std::size_t(x);
  }
  Places places(const Stage& stage) const;
  template <typename Do>
  static void for_each(const Places& places, const Do& act);
  bool forced(int x, int y, const Stage& stage) const;
  void find_edges(const PixelValues& values);
  std::vector<std::uint32_t> first_grid();
  std::vector<std::uint32_t> between(PixelValues& values);
  std::vector<std::uint32_t> around_misses();
  void add(std::vector<std::uint32_t>& list, int x, int y);
  void take(const PixelValues& marched, PixelValues& values);
  double part_seen(std::size_t p) const {
    return settings_.part_seen.empty() ? 1.0 : double(settings_.part_seen[p]);
  }
  // What a change is measured against, for something this bright.
  double brightness(std::size_t p, const PixelTexel& seen) const;
  double interpolate(PixelValues& values, int x, int y, const Stage& stage) const;
  double miss(const PixelValues& values, std::uint32_t p, const PixelTexel& seen,
              const PixelTexel& met) const;

  PixelSettings settings_;
  int last_x_, last_y_;              // of the first grid
  std::vector<std::uint8_t> edges_;  // of the ground, within two pixels
  std::vector<State> states_;
  std::vector<std::uint32_t> asked_;
  std::vector<std::uint8_t> is_check_;  // of asked_
  std::vector<std::uint32_t> missed_;
  double mean_luminance_ = 0;
  int stage_ = -1, rounds_ = 0;
  std::size_t marched_ = 0;
  std::array<double, kStages> check_squares_{};
  std::array<std::size_t, kStages> checks_{};
};

}  // namespace nepho::gl
