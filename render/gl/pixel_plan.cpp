#include "gl/pixel_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace nepho::gl {
namespace {

constexpr int kFirstGrid = 8;
constexpr std::size_t kBlock = 4;  // pixels that are marched side by side
#if defined(NEPHO_MUTANT_PIXEL_TOLERANCE)
constexpr double kShare = 10;
#else
constexpr double kShare = 1;  // of the tolerance
#endif
constexpr float kStraightShare = 0.5f;
constexpr double kRareShare = 0.05;  // of what one pixel may be off
constexpr int kMissRounds = 2;
constexpr std::uint32_t kCheckEach = 128;
constexpr double kDarkShare = 0.1;     // of the mean: what is darker counts as that
constexpr float kLeastPassed = 0.25f;  // the same of transmittance
constexpr double kEdge = 0.01;         // second difference of the ground's distance, relative
constexpr double kMostForced = 0.7;
constexpr int kLeastSide = 32;

// Drawn by place alone (constants of C. Wellons' hash prospector, lowbias32).
std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ x >> 16;
}

// The four channels at once.
using Four = float __attribute__((vector_size(16)));
Four four(const PixelTexel& texel) {
  return std::bit_cast<Four>(texel);
}
Four magnitude(Four x) {
  return x < 0 ? -x : x;
}
Four greater(Four a, Four b) {
  return a < b ? b : a;
}

// Four texels in a row; the outer two may lie beyond the grid and are then those of a parabola.
struct Row {
  Four a, b, c, d;
};
Row row_of(const std::vector<PixelTexel>& texels, std::size_t b, std::size_t step, bool first,
           bool last) {
  Row row{{}, four(texels[b]), four(texels[b + step]), {}};
  if (!first) row.a = four(texels[b - step]);
  if (!last) row.d = four(texels[b + 2 * step]);
  if (first) row.a = 3 * row.b - 3 * row.c + row.d;
  if (last) row.d = row.a - 3 * row.b + 3 * row.c;
  return row;
}
// The cubic's middle; `bend` is how far it is from the parabolas through three of the four, which
// grows with what a cubic misses, and at least a part of how far a straight line is: the parabolas
// agree where a kink is just between them.
Four middle_of(const Row& row, Four& bend) {
  const Four b2 = row.a - 2 * row.b + row.c, c2 = row.b - 2 * row.c + row.d;
  bend =
      greater(magnitude(b2 - c2) / 2, kStraightShare * greater(magnitude(b2), magnitude(c2))) / 8;
  return 0.5f * (row.b + row.c) - (b2 + c2) / 16;
}

}  // namespace

float luminance(const PixelTexel& seen) {
  return 0.2126f * seen[0] + 0.7152f * seen[1] + 0.0722f * seen[2];
}

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

PixelPlan::Stage PixelPlan::stage_at(int number) {
  const int grid = kFirstGrid >> number / 2, half = grid / 2;
  const bool along_y = number % 2 == 0;
  return along_y ? Stage{grid, true, grid, grid, 0, half} : Stage{grid, false, grid, half, half, 0};
}

// Beyond the first grid's last column, columns are marched as those of the grid are, at every
// stage; rows likewise.
PixelPlan::Places PixelPlan::places(const Stage& stage) const {
  const auto along = [](int first, int step, int last, int count, bool with_margin) {
    std::vector<int> list;
    for (int i = first; i <= last; i += step) list.push_back(i);
    for (int i = last + 1; with_margin && i < count; ++i) list.push_back(i);
    return list;
  };
  return {along(stage.first_x, stage.step_x, last_x_, settings_.width, stage.along_y),
          along(stage.first_y, stage.step_y, last_y_, settings_.height, !stage.along_y)};
}

// In blocks of neighbours.
template <typename Do>
void PixelPlan::for_each(const Places& places, const Do& act) {
  const auto count_x = places.x.size(), count_y = places.y.size();
  for (std::size_t by = 0; by < count_y; by += kBlock)
    for (std::size_t bx = 0; bx < count_x; bx += kBlock)
      for (std::size_t y = by; y < std::min(by + kBlock, count_y); ++y)
        for (std::size_t x = bx; x < std::min(bx + kBlock, count_x); ++x)
          act(places.x[x], places.y[y]);
}

bool PixelPlan::forced(int x, int y, const Stage& stage) const {
  if (part_seen(at(x, y)) <= 0) return false;
  const int tiles = (settings_.width + kStrideTile - 1) / kStrideTile;
  const auto tile = std::size_t(y / kStrideTile * tiles + x / kStrideTile);
  const PixelStrides& strides = settings_.strides;
  return edges_[at(x, y)] != 0 || (stage.along_y ? strides.y : strides.x)[tile] < stage.grid;
}

bool PixelPlan::saves_little() const {
  if (std::min(settings_.width, settings_.height) < kLeastSide) return true;
  std::size_t count = 0;
  for (int number = 0; number < kStages; ++number) {
    const Stage stage = stage_at(number);
    for_each(places(stage), [&](int x, int y) { count += forced(x, y, stage); });
  }
  return double(count) > kMostForced * double(states_.size());
}

void PixelPlan::add(std::vector<std::uint32_t>& list, int x, int y) {
  states_[at(x, y)] = State::kMarched;
  list.push_back(std::uint32_t(at(x, y)));
}

std::vector<std::uint32_t> PixelPlan::first_grid() {
  std::vector<std::uint32_t> list;
  const Places all{places({kFirstGrid, true, kFirstGrid, kFirstGrid, 0, 0}).x,
                   places({kFirstGrid, false, kFirstGrid, kFirstGrid, 0, 0}).y};
  for_each(all, [&](int x, int y) { add(list, x, y); });
  return list;
}

double PixelPlan::brightness(std::size_t p, const PixelTexel& seen) const {
  const double in_front = settings_.in_front.empty() ? 0.0 : double(settings_.in_front[p]);
  return in_front + part_seen(p) * double(luminance(seen));
}

// Of a place half way; returns how far the neighbours bend, relative.
double PixelPlan::interpolate(PixelValues& values, int x, int y, const Stage& stage) const {
  const int place = stage.along_y ? y : x, last = stage.along_y ? last_y_ : last_x_;
  const int before = place - stage.grid / 2;
  const std::size_t to = at(x, y);
  const std::size_t step =
      std::size_t(stage.grid) * (stage.along_y ? std::size_t(settings_.width) : 1);
  const std::size_t from = to - step / 2;
  const bool first = before<stage.grid, none_behind = before + 2 * stage.grid> last;
  Four light_bend, passed_bend;
  const Four light_here =
      middle_of(row_of(values.seen, from, step, first, none_behind), light_bend);
  const Four passed_here =
      middle_of(row_of(values.met, from, step, first, none_behind), passed_bend);
  const auto seen = std::bit_cast<PixelTexel>(greater(light_here, Four{}));
  const Four positive = greater(passed_here, Four{});
  auto met = std::bit_cast<PixelTexel>(positive > 1 ? Four{1, 1, 1, 1} : positive);
  met[3] = values.met[to][3];
  values.seen[to] = seen;
  values.met[to] = met;
  if (!values.depths.empty()) {
    PixelTexel& depth = values.depths[to];
    for (std::size_t i = 0; i < 3; ++i)
      depth[i] = 0.5f * (values.depths[from][i] + values.depths[from + step][i]);
    depth[3] = met[3];
  }
  const float light = std::max({light_bend[0], light_bend[1], light_bend[2]});
  const float passed = std::max({passed_bend[0], passed_bend[1], passed_bend[2]});
  return std::max(part_seen(to) * double(light) /
                      std::max({brightness(to, seen), kDarkShare * mean_luminance_, 1e-30}),
                  double(passed / std::max({met[0], met[1], met[2], kLeastPassed})));
}

std::vector<std::uint32_t> PixelPlan::between(PixelValues& values) {
  std::vector<std::uint32_t> list;
  const Stage stage = stage_at(stage_);
  const double most = kShare * settings_.tolerance;
  is_check_.clear();
  for_each(places(stage), [&](int x, int y) {
    const double bend = interpolate(values, x, y, stage);
    const bool check = hash(std::uint32_t(at(x, y))) % kCheckEach == 0;
    const bool marched = forced(x, y, stage) || !(bend <= most);
    if (marched || check) {
      add(list, x, y);
      is_check_.push_back(!marched);
    } else {
      states_[at(x, y)] = State::kInterpolated;
    }
  });
  return list;
}

// Neighbours, of this stage, of what was not as it would have been interpolated to.
std::vector<std::uint32_t> PixelPlan::around_misses() {
  std::vector<std::uint32_t> list;
  const Stage stage = stage_at(stage_);
  const auto width = std::uint32_t(settings_.width);
  for (const std::uint32_t p : missed_) {
    const int px = int(p % width), py = int(p / width);
    const int step_x = px > last_x_ ? 1 : stage.step_x, step_y = py > last_y_ ? 1 : stage.step_y;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const int x = px + i * step_x, y = py + j * step_y;
        if (x >= 0 && y >= 0 && x < settings_.width && y < settings_.height &&
            states_[at(x, y)] == State::kInterpolated)
          add(list, x, y);
      }
  }
  is_check_.assign(list.size(), 0);
  return list;
}

// How far what was interpolated is from what was marched, relative.
double PixelPlan::miss(const PixelValues& values, std::uint32_t p, const PixelTexel& seen,
                       const PixelTexel& met) const {
  double lost = 0, passed = double(kLeastPassed), light = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    lost = std::max(lost, std::abs(double(values.met[p][i] - met[i])));
    passed = std::max(passed, double(met[i]));
    light = std::max(light, std::abs(double(values.seen[p][i] - seen[i])));
  }
  const double scale = std::max({brightness(p, seen), kDarkShare * mean_luminance_, 1e-30});
  return std::max(part_seen(p) * light / scale, lost / passed);
}

void PixelPlan::take(const PixelValues& marched, PixelValues& values) {
  missed_.clear();
  for (std::size_t n = 0; n < asked_.size(); ++n) {
    const std::uint32_t p = asked_[n];
    const PixelTexel &seen = marched.seen[n], &met = marched.met[n];
    if (stage_ >= 0) {
      if (is_check_[n]) {
        // Of what is seen in all, the ground as bright as the mean.
        const double change = part_seen(p) * double(luminance(values.seen[p]) - luminance(seen)) +
                              mean_luminance_ * double(luminance(values.met[p]) - luminance(met));
        check_squares_[std::size_t(stage_)] += change * change;
        ++checks_[std::size_t(stage_)];
      }
      if (miss(values, p, seen, met) > kShare * settings_.tolerance) missed_.push_back(p);
    }
    values.seen[p] = seen;
    values.met[p] = met;
    if (!values.depths.empty()) values.depths[p] = marched.depths[n];
  }
  marched_ += asked_.size();
}

std::vector<std::uint32_t> PixelPlan::next(const PixelValues& marched, PixelValues& values) {
  if (stage_ < 0 && asked_.empty()) return asked_ = first_grid();
  take(marched, values);
  if (stage_ < 0)
    for (const std::uint32_t p : asked_)
      mean_luminance_ += brightness(p, values.seen[p]) / double(asked_.size());
  if (stage_ >= 0 && rounds_ < kMissRounds) {
    ++rounds_;
    asked_ = around_misses();
    if (!asked_.empty()) return asked_;
  }
  while (++stage_ < kStages) {
    rounds_ = 0;
    asked_ = between(values);
    if (!asked_.empty()) return asked_;
  }
  return {};
}

double PixelPlan::marched_share() const {
  return double(marched_) / double(states_.size());
}

double PixelPlan::predicted_rms() const {
  double squares = 0;
  for (int number = 0; number < kStages; ++number) {
    const auto i = std::size_t(number);
    if (checks_[i] == 0) continue;
    const Stage stage = stage_at(number);
    std::size_t interpolated = 0;
    for_each(places(stage),
             [&](int x, int y) { interpolated += states_[at(x, y)] == State::kInterpolated; });
    squares +=
        double(interpolated) / double(states_.size()) * check_squares_[i] / double(checks_[i]);
  }
  // The rms of n numbers is itself uncertain, and what is rare falls between them.
  const double doubt = 1 + 3 / std::sqrt(std::max(double(checks()), 1.0));
  const double rare = kRareShare * kShare * settings_.tolerance;
  return mean_luminance_ > 0 ? std::hypot(doubt * std::sqrt(squares) / mean_luminance_, rare)
                             : rare;
}

std::size_t PixelPlan::checks() const {
  return std::accumulate(checks_.begin(), checks_.end(), std::size_t{0});
}

}  // namespace nepho::gl
