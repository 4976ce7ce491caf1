#include "sources/noise/level_response.h"

#include <algorithm>
#include <cmath>

#include "sources/noise/normal.h"

namespace nepho::noise {
namespace {

// 0 where the wavelength is 2 voxels or less, 1 from 4.
double roll_off(double cell_m, double voxel_m) {
  const double t = std::clamp(cell_m / voxel_m - 1, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double kept(const Octave& octave, const Layer& layer, double width_m, double height_m) {
  double weight = roll_off(octave.cell_m * std::min(1.0, octave.stretch), width_m);
  if (octave.domain == Domain::kVolume) weight *= roll_off(octave.cell_m, height_m);
  if (octave.domain == Domain::kStreak && layer.trail_m > 0) {
    // A streak slopes: its foot lies 2 trail / thickness along the wind per metre of height.
    const double slope = 2 * layer.trail_m / (layer.spec.top_m - layer.spec.base_m);
    weight *= roll_off(octave.cell_m * octave.stretch, slope * height_m);
  }
  return weight;
}

// rise() is a sum of hinges (x - t)+, and its square one of (x - t)+^2 and (x - t)+: exact.
Moments expected_rise(const Layer& layer, double x, double spread) {
  const auto& [narrow, wide] = layer.rise;
  const double second = wide.share / wide.width, first = narrow.share / narrow.width + second;
  const double knee = first * narrow.width;  // rise at the narrow ramp's end
  const Moments a = expected_excess(x, spread), b = expected_excess(x - narrow.width, spread),
                c = expected_excess(x - wide.width, spread);
  const double mean = first * a.mean + (second - first) * b.mean - second * c.mean;
  const double square = first * first * a.square + (second * second - first * first) * b.square +
                        2 * knee * (second - first) * b.mean - second * second * c.square -
                        2 * second * c.mean;
  return {std::clamp(mean, 0.0, 1.0), std::clamp(square, 0.0, 1.0)};
}

// A response is linear between knots from `low` to `high`.
struct Curve {
  double low, high;
  std::vector<Moments> knots;
  Moments operator()(double x) const {
    if (x <= low) return {};
    if (x >= high) return knots.back();
    const double at = (x - low) / (high - low) * double(knots.size() - 1);
    const auto knot = std::min(std::size_t(at), knots.size() - 2);
    const double f = at - double(knot);
    const Moments &a = knots[knot], &b = knots[knot + 1];
    return {a.mean + f * (b.mean - a.mean), a.square + f * (b.square - a.square)};
  }
};

}  // namespace

double rise(const Layer& layer, double x) {
  double sum = 0;
  for (const Ramp& ramp : layer.rise) sum += ramp.share * std::clamp(x / ramp.width, 0.0, 1.0);
  return sum;
}

LevelResponse::LevelResponse(const Layer& layer, const ShellChart& chart, const Lattice& lattice,
                             int level)
    : layer_(layer), finest_(level == lattice.max_level()) {
  const Index3& cells = lattice.cells(level);
  const double width_m = chart.body().equatorial_m * 1.5707963267948966 / cells[0];
  const double height_m = chart.thickness_m() / cells[2];
  double left_out = 0;
  for (const Octave& octave : layer.octaves) {
    const double w = finest_ ? 1 : kept(octave, layer, width_m, height_m);
    weights_.push_back(w);
    left_out += (1 - w * w) * octave.amplitude * octave.amplitude;
  }
#ifdef NEPHO_MUTANT_CLOSURE
  left_out = 0;
#endif
  fill(layer, chart, lattice, level, std::sqrt(std::max(0.0, left_out)));
}

void LevelResponse::fill(const Layer& layer, const ShellChart& chart, const Lattice& lattice,
                         int level, double spread) {
  const Index3 &cells = lattice.cells(level), &finest = lattice.cells(lattice.max_level());
  const std::int64_t ratio = finest[2] / cells[2];
  const double step_m = chart.thickness_m() / finest[2];
  // A sample's hat reaches over the finest layers less than `ratio` away.
#ifdef NEPHO_MUTANT_DRIFT
  const double drift = std::pow(1.02, lattice.max_level() - level);
#else
  constexpr double drift = 1;
#endif
  const auto inside = [&](std::int64_t k) {
    return k >= 0 && k <= std::int64_t(finest[2]) &&
           layer.profile(layer.part(chart.bottom_m() + double(k) * step_m)) > 0;
  };
  const double reach = kTail * spread;
  Curve curve = {-reach, std::max(layer.rise[0].width, layer.rise[1].width) + reach, {}};
  if (!finest_)
    for (int knot = 0; knot <= 2048; ++knot)
      curve.knots.push_back(
          expected_rise(layer, curve.low + (curve.high - curve.low) * knot / 2048, spread));
  for (std::uint32_t k = 0; k <= cells[2]; ++k) {
    struct Part {
      double weight, profile, lift;
    };
    std::vector<Part> parts;
    double total = 0, most = 0;
    Row row = {1e9, -1e9, 0, 0};
    for (std::int64_t f = std::int64_t(k) * ratio - ratio + 1; f < (std::int64_t(k) + 1) * ratio;
         ++f) {
      if (f < 0 || f > std::int64_t(finest[2])) continue;
      const double hat = 1 - double(std::abs(f - std::int64_t(k) * ratio)) / double(ratio);
      const double volume = hat * chart.hat_vertical(std::uint32_t(f), finest);
      total += volume;
      if (!inside(f)) continue;
      const double part = layer.part(chart.bottom_m() + double(f) * step_m);
      const double profile = layer.profile(part);
      parts.push_back({volume * profile, profile, layer.lift(part)});
      row.foot = std::min(row.foot, parts.back().lift + curve.low);
      row.full = std::max(row.full, parts.back().lift + curve.high);
      most += parts.back().weight;
    }
    if (parts.empty()) {
      if (first_ <= last_) break;
      continue;
    }
    if (first_ > last_) first_ = k;
    last_ = k;
    row.most = most / total;
    row.lift = parts.front().lift;
    row.begin = mean_.size();
    rows_.push_back(row);
    if (finest_) continue;
    for (int knot = 0; knot <= kKnots; ++knot) {
      const double x = row.foot + (row.full - row.foot) * knot / kKnots;
      double mean = 0, square = 0;
      for (const Part& part : parts) {
        const Moments m = curve(x - part.lift);
        mean += part.weight * m.mean;
        square += part.weight * part.profile * m.square;
      }
      mean_.push_back(drift * mean / total);
      square_.push_back(square / total);
    }
    mean_[row.begin] = 0, square_[row.begin] = 0;
  }
}

double LevelResponse::mean(const Row& row, double x) const {
  return finest_ ? row.most * rise(layer_, x - row.lift) : at(mean_, row, x);
}

double LevelResponse::variance(const Row& row, double x) const {
  if (finest_) return 0;
  const double mean = at(mean_, row, x);
#ifdef NEPHO_MUTANT_VARIANCE
  return at(square_, row, x);
#endif
  return std::max(0.0, at(square_, row, x) - mean * mean);
}

double LevelResponse::at(const std::vector<double>& table, const Row& row, double x) const {
  if (x <= row.foot) return 0;
  if (x >= row.full) return table[row.begin + kKnots];
  const double at = (x - row.foot) / (row.full - row.foot) * kKnots;
  const auto knot = std::min(std::size_t(at), std::size_t(kKnots - 1));
  const double f = at - double(knot), *value = &table[row.begin + knot];
  return value[0] + f * (value[1] - value[0]);
}

}  // namespace nepho::noise
