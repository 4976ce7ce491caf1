#include "gl/pixel_plan.h"

#include <algorithm>
#include <cmath>

namespace nepho::gl {
namespace {

constexpr int kFirstGrid = 4, kBlock = 16;  // pixels that are marched side by side
#if defined(NEPHO_MUTANT_PIXEL_TOLERANCE)
constexpr double kShare = 6;
#else
constexpr double kShare = 0.3;  // of the tolerance
#endif
constexpr int kMissRounds = 2;
constexpr std::uint32_t kCheckEach = 64;
constexpr double kDarkShare = 0.1;     // of the mean: what is darker counts as that
constexpr float kLeastPassed = 0.25f;  // the same of transmittance
constexpr double kEdge = 0.01;         // second difference of the ground's distance, relative
constexpr double kMostForced = 0.6;
constexpr int kLeastSide = 32;

float luminance(const PixelTexel& c) {
  return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
}

// Drawn by place alone.
std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ x >> 16;
}

// Four texels in a row; the outer two may lie beyond the grid and are then those of a parabola.
struct Row {
  PixelTexel a, b, c, d;
};
Row row_of(const std::vector<PixelTexel>& texels, std::size_t b, std::size_t step, bool first,
           bool last) {
  Row row{{}, texels[b], texels[b + step], {}};
  if (!first) row.a = texels[b - step];
  if (!last) row.d = texels[b + 2 * step];
  for (std::size_t i = 0; i < 4; ++i) {
    if (first) row.a[i] = 3 * row.b[i] - 3 * row.c[i] + row.d[i];
    if (last) row.d[i] = row.a[i] - 3 * row.b[i] + 3 * row.c[i];
  }
  return row;
}
// The cubic's middle, and how far from it a straight line may be.
void add_middle(const Row& row, float weight, PixelTexel& middle, PixelTexel& bend) {
  for (std::size_t i = 0; i < 4; ++i) {
    const float b2 = row.a[i] - 2 * row.b[i] + row.c[i], c2 = row.b[i] - 2 * row.c[i] + row.d[i];
    middle[i] += weight * (0.5f * (row.b[i] + row.c[i]) - (b2 + c2) / 16);
    bend[i] = std::max(bend[i], std::max(std::abs(b2), std::abs(c2)) / 8);
  }
}

}  // namespace

PixelPlan::PixelPlan(PixelSettings settings, const PixelValues& values)
    : settings_(std::move(settings)),
      last_x_((settings_.width - 1) / kFirstGrid * kFirstGrid),
      last_y_((settings_.height - 1) / kFirstGrid * kFirstGrid) {
  const std::size_t pixels = std::size_t(settings_.width) * std::size_t(settings_.height);
  states_.assign(pixels, State::kUnknown);
  find_edges(values);
}

// Pixels across which the ground's distance jumps or bends, and two more on each side.
void PixelPlan::find_edges(const PixelValues& values) {
  const int width = settings_.width, height = settings_.height;
  std::vector<std::uint8_t> found(states_.size(), 0);
  std::vector<float> near(states_.size());  // 1 / distance: linear on a plane
  for (std::size_t p = 0; p < near.size(); ++p) {
    const float distance_m = values.met[p][3];
    near[p] = distance_m < kNoGround_m ? 1 / std::max(distance_m, 1e-3f) : 0.0f;
  }
  const auto bends = [&](std::size_t p, std::size_t step) {
    const float bend = near[p - step] - 2 * near[p] + near[p + step];
    return std::abs(bend) > float(kEdge) * near[p] && bend != 0;
  };
  const auto row = std::size_t(width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t p = at(x, y);
      if ((x > 0 && x + 1 < width && bends(p, 1)) || (y > 0 && y + 1 < height && bends(p, row)))
        found[p] = 1;
    }
  // Two more on each side, along rows and then columns.
  edges_.assign(states_.size(), 0);
  std::vector<std::uint8_t> wide(states_.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (found[at(x, y)])
        for (int i = std::max(x - 2, 0); i <= std::min(x + 2, width - 1); ++i) wide[at(i, y)] = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (wide[at(x, y)])
        for (int j = std::max(y - 2, 0); j <= std::min(y + 2, height - 1); ++j)
          edges_[at(x, j)] = 1;
}

bool PixelPlan::forced(int x, int y, int grid) const {
  const int tiles = (settings_.width + kStrideTile - 1) / kStrideTile;
  return edges_[at(x, y)] != 0 ||
         settings_.strides[std::size_t(y / kStrideTile * tiles + x / kStrideTile)] < grid;
}

bool PixelPlan::saves_little() const {
  if (std::min(settings_.width, settings_.height) < kLeastSide) return true;
  std::size_t count = 0;
  for (int y = 0; y < settings_.height; ++y)
    for (int x = 0; x < settings_.width; ++x) {
      const int grid = x % 2 == 0 && y % 2 == 0 ? kFirstGrid : 2;
      count += (x % kFirstGrid == 0 && y % kFirstGrid == 0) || forced(x, y, grid);
    }
  return double(count) > kMostForced * double(states_.size());
}

void PixelPlan::add(std::vector<std::uint32_t>& list, int x, int y) {
  states_[at(x, y)] = State::kMarched;
  list.push_back(std::uint32_t(at(x, y)));
}

std::vector<std::uint32_t> PixelPlan::first_grid() {
  std::vector<std::uint32_t> list;
  const int block = kBlock * kFirstGrid / 2;
  for (int by = 0; by < settings_.height; by += block)
    for (int bx = 0; bx < settings_.width; bx += block)
      for (int y = by; y < std::min(by + block, settings_.height); ++y)
        for (int x = bx; x < std::min(bx + block, settings_.width); ++x)
          if ((x % kFirstGrid == 0 && y % kFirstGrid == 0) || x > last_x_ || y > last_y_)
            add(list, x, y);
  return list;
}

// At a place between the points of the grid. Adds how far it bends, relative.
void PixelPlan::interpolate(PixelValues& values, int x, int y, double& bend) const {
  const int g = grid_, x0 = x / g * g, y0 = y / g * g;
  const bool between_x = x != x0, between_y = y != y0;
  const std::size_t p = at(x0, y0), across = std::size_t(g),
                    down = std::size_t(g) * std::size_t(settings_.width);
  PixelTexel texels[2] = {};
  float bends[2] = {}, scale = 0, passed = 0;
  int which = 0;
  for (const std::vector<PixelTexel>* from : {&values.seen, &values.met}) {
    PixelTexel bend_x{}, bend_y{}, middle{};
    const float rows = between_x && between_y ? 0.5f : 1.0f;
    if (between_x)
      for (int j = 0; j <= int(between_y); ++j)
        add_middle(row_of(*from, p + std::size_t(j) * down, across, x0<g, x0 + 2 * g> last_x_),
                   rows, middle, bend_x);
    PixelTexel columns{};
    if (between_y)
      for (int i = 0; i <= int(between_x); ++i)
        add_middle(row_of(*from, p + std::size_t(i) * across, down, y0<g, y0 + 2 * g> last_y_),
                   rows, between_x ? columns : middle, bend_y);
    // The surface through the two rows' and the two columns' middles: their sum less the mean.
    if (between_x && between_y)
      for (std::size_t i = 0; i < 4; ++i)
        middle[i] += columns[i] - 0.25f * ((*from)[p][i] + (*from)[p + across][i] +
                                           (*from)[p + down][i] + (*from)[p + down + across][i]);
    for (std::size_t i = 0; i < 3; ++i)
      bends[which] = std::max(bends[which], bend_x[i] + bend_y[i]);
    (which == 0 ? scale : passed) =
        which == 0 ? luminance(middle) : std::max({middle[0], middle[1], middle[2]});
    texels[which++] = middle;
  }
  for (float& value : texels[0]) value = std::max(value, 0.0f);
  for (float& value : texels[1]) value = std::clamp(value, 0.0f, 1.0f);
  texels[1][3] = values.met[at(x, y)][3];
  values.seen[at(x, y)] = texels[0];
  values.met[at(x, y)] = texels[1];
  bend = std::max(double(bends[0]) / std::max({double(scale), kDarkShare * mean_luminance_, 1e-30}),
                  double(bends[1] / std::max(passed, kLeastPassed)));
}

std::vector<std::uint32_t> PixelPlan::between(PixelValues& values) {
  std::vector<std::uint32_t> list;
  const int half = grid_ / 2, block = kBlock * half;
  const double most = kShare * settings_.tolerance;
  is_check_.clear();
  for (int by = 0; by <= last_y_; by += block)
    for (int bx = 0; bx <= last_x_; bx += block)
      for (int y = by; y <= std::min(by + block - 1, last_y_); y += half)
        for (int x = bx; x <= std::min(bx + block - 1, last_x_); x += half) {
          if (x % grid_ == 0 && y % grid_ == 0) continue;
          double bend = 0;
          interpolate(values, x, y, bend);
          const bool check = hash(std::uint32_t(at(x, y))) % kCheckEach == 0;
          const bool marched = forced(x, y, grid_) || !(bend <= most);
          if (marched || check) {
            add(list, x, y);
            is_check_.push_back(!marched);
          } else {
            states_[at(x, y)] = State::kInterpolated;
          }
        }
  return list;
}

// Neighbours on this grid of what was not as it would have been interpolated to.
std::vector<std::uint32_t> PixelPlan::around_misses() {
  std::vector<std::uint32_t> list;
  const int half = grid_ / 2;
  for (const std::uint32_t p : missed_) {
    const int x = int(p % std::uint32_t(settings_.width)),
              y = int(p / std::uint32_t(settings_.width));
    for (int j = std::max(y - grid_, 0); j <= std::min(y + grid_, last_y_); j += half)
      for (int i = std::max(x - grid_, 0); i <= std::min(x + grid_, last_x_); i += half)
        if (states_[at(i, j)] == State::kInterpolated) add(list, i, j);
  }
  is_check_.assign(list.size(), 0);
  return list;
}

double PixelPlan::miss(const PixelTexel& seen, const PixelTexel& met, const PixelTexel& true_seen,
                       const PixelTexel& true_met) const {
  double worst = 0, passed = 0, light = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    worst = std::max(worst, std::abs(double(met[i] - true_met[i])));
    passed = std::max(passed, double(true_met[i]));
    light = std::max(light, std::abs(double(seen[i] - true_seen[i])));
  }
  return std::max(
      light / std::max({double(luminance(true_seen)), kDarkShare * mean_luminance_, 1e-30}),
      worst / std::max(passed, double(kLeastPassed)));
}

void PixelPlan::take(const PixelValues& marched, PixelValues& values) {
  missed_.clear();
  for (std::size_t n = 0; n < asked_.size(); ++n) {
    const std::uint32_t p = asked_[n];
    const PixelTexel &seen = marched.seen[n], &met = marched.met[n];
    if (grid_ > 0) {
      if (is_check_[n]) {
        // Of what is seen in all, the ground as bright as the mean.
        const double change = double(luminance(values.seen[p]) - luminance(seen)) +
                              mean_luminance_ * double(luminance(values.met[p]) - luminance(met));
        const std::size_t which = grid_ == kFirstGrid ? 0 : 1;
        check_squares_[which] += change * change;
        ++check_counts_[which];
        ++checks_;
      }
      if (miss(values.seen[p], values.met[p], seen, met) > kShare * settings_.tolerance)
        missed_.push_back(p);
    }
    values.seen[p] = seen;
    values.met[p] = met;
  }
  marched_ += asked_.size();
}

std::vector<std::uint32_t> PixelPlan::next(const PixelValues& marched, PixelValues& values) {
  if (asked_.empty() && grid_ == 0) return asked_ = first_grid();
  take(marched, values);
  if (grid_ == 0)
    for (const std::uint32_t p : asked_)
      mean_luminance_ += double(luminance(values.seen[p])) / double(asked_.size());
  if (grid_ > 0 && rounds_ < kMissRounds && !missed_.empty()) {
    ++rounds_;
    asked_ = around_misses();
    if (!asked_.empty()) return asked_;
  }
  while (grid_ != 2) {
    grid_ = grid_ == 0 ? kFirstGrid : grid_ / 2;
    rounds_ = 0;
    asked_ = between(values);
    if (!asked_.empty()) return asked_;
  }
  for (int y = 0; y <= last_y_; ++y)
    for (int x = 0; x <= last_x_; ++x)
      interpolated_[x % 2 == 0 && y % 2 == 0 ? 0 : 1] += states_[at(x, y)] == State::kInterpolated;
  return {};
}

double PixelPlan::marched_share() const {
  return double(marched_) / double(states_.size());
}

double PixelPlan::predicted_rms() const {
  double squares = 0;
  for (std::size_t which = 0; which < 2; ++which)
    if (check_counts_[which] > 0)
      squares += double(interpolated_[which]) / double(states_.size()) * check_squares_[which] /
                 double(check_counts_[which]);
  return mean_luminance_ > 0 ? std::sqrt(squares) / mean_luminance_ : 0;
}

}  // namespace nepho::gl
