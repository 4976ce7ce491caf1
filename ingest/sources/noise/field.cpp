#include "sources/noise/field.h"

#include <algorithm>
#include <cmath>

#include "sources/noise/lattice_noise.h"
#include "sources/noise/normal.h"

namespace nepho::noise {
namespace {

// A rotation with rational entries, so that no octave's lattice lies along the globe's axes or
// another's; applied once more for each seed's low bits.
glm::dvec3 turned(const glm::dvec3& p, std::uint32_t seed) {
  glm::dvec3 t = p;
  for (std::uint32_t n = 0; n <= (seed >> 30); ++n)
    t = glm::dvec3{2 * t.x - 2 * t.y + t.z, 2 * t.x + t.y - 2 * t.z, t.x + 2 * t.y + 2 * t.z} / 3.0;
  return t;
}
glm::dvec2 turned(const glm::dvec2& p) {
  return {0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y};
}

std::uint32_t sheet_seed(const Octave& octave, int sheet) {
  return octave.seed + std::uint32_t(sheet) * 0x68bc21ebu;
}

double shaped(Shape shape, double normal) {
  if (shape == Shape::kBillow) return billow(normal);
  if (shape == Shape::kRidge) return -billow(normal);
  return normal;
}
Range shaped(Shape shape, Range n) {
  if (shape == Shape::kPlain || shape == Shape::kCells) return n;
  const double far = std::max(std::abs(n.low), std::abs(n.high));
  const double near = n.low <= 0 && n.high >= 0 ? 0 : std::min(std::abs(n.low), std::abs(n.high));
  if (shape == Shape::kBillow) return {billow(near), billow(far)};
  return {-billow(far), -billow(near)};
}

glm::dvec3 globe_position(const Octave& octave, const glm::dvec3& wound, double radius_m) {
  return turned(wound * (radius_m / octave.cell_m), octave.seed);
}
glm::dvec2 sheet_position(const Octave& octave, glm::dvec2 uv) {
  const glm::dvec2 p = {uv.x / (octave.cell_m * octave.stretch), uv.y / octave.cell_m};
  return octave.stretch == 1 ? turned(p) : p;
}
glm::dvec3 volume_position(const Layer& layer, const Octave& octave, const glm::dvec3& direction,
                           const glm::dvec3& downwind, double radius_m, double height_m) {
  const double lag_m = layer.lean * (height_m - layer.spec.base_m);
  return turned((direction * (radius_m + height_m) - downwind * lag_m) / octave.cell_m,
                octave.seed);
}

// Closed cells in some regions, open ones in others, between them less of either: by a field of its
// own, so that the mixture stays standard normal.
constexpr double kRegimeCell_m = 6e5;
double regime(const glm::dvec3& direction, double radius_m, std::uint32_t seed) {
  const double n = value_noise(turned(direction * (radius_m / kRegimeCell_m), seed), seed + 77);
  return std::clamp(1.2 + 1.6 * n, -1.0, 1.0);
}
double mixed_cells(double cell, double plain, double regime) {
  return regime * cell + std::sqrt(1 - regime * regime) * plain;
}

}  // namespace

Field::Field(std::vector<LayerSpec> layers, std::shared_ptr<const ShellChart> chart,
             const Lattice& lattice)
    : chart_(std::move(chart)),
      lattice_(lattice),
      radius_m_(chart_->body().equatorial_m),
      directions_(*chart_) {
  const Index3& cells = lattice.cells(lattice.max_level());
  finest_m_ = std::max(radius_m_ * 1.5707963267948966 / cells[0], chart_->thickness_m() / cells[2]);
  storms_.emplace_back(layers.empty() ? 0 : layers.front().seed);
  for (const LayerSpec& spec : layers) {
    layers_.push_back(make_layer(spec, finest_m_));
    sheets_.emplace_back(radius_m_, spec.wind_from_rad, spec.seed);
  }
  for (std::size_t n = 0; n < layers_.size() * std::size_t(lattice.max_level() + 1); ++n)
    responses_.push_back(std::make_unique<Lazy>());
}

const LevelResponse& Field::response(std::size_t layer, int level) const {
  Lazy& lazy = *responses_[layer * std::size_t(lattice_.max_level() + 1) + std::size_t(level)];
  std::call_once(lazy.once, [&] {
    lazy.response = std::make_unique<const LevelResponse>(layers_[layer], *chart_, lattice_, level);
  });
  return *lazy.response;
}

// The part of x that a column has in common.
void Field::prepare(std::size_t layer_index, const std::vector<double>& weights,
                    Column& column) const {
  const Layer& layer = layers_[layer_index];
  const glm::dvec3& d = column.direction;
  double x = layer.climate(d.z) - layer.threshold;
  glm::dvec3 wound(0.0);
  bool has_wound = false, has_points = false;
  for (std::size_t o = 0; o < layer.octaves.size(); ++o) {
    const Octave& octave = layer.octaves[o];
    if (!(weights[o] > 0)) continue;
    if (octave.domain == Domain::kGlobe) {
      if (!has_wound) wound = storms_.front().wound(d), has_wound = true;
      const glm::dvec3 p = globe_position(octave, wound, radius_m_);
      x += weights[o] * octave.amplitude * shaped(octave.shape, value_noise(p, octave.seed));
      continue;
    }
    if (!has_points) column.points = sheets_[layer_index].at(d), has_points = true;
    if (octave.domain != Domain::kSheet) continue;
    double n = 0;
    for (const SheetPoint& point : column.points) {
      const std::uint32_t seed = sheet_seed(octave, point.sheet);
      const glm::dvec2 p = sheet_position(octave, point.uv);
      double value = 0;
      if (octave.shape == Shape::kCells) {
        value = cells(p, seed);
        if (layer.regimes)
          value =
              mixed_cells(value, value_noise(p, seed + 1), regime(d, radius_m_, layer.spec.seed));
      } else {
        value = shaped(octave.shape, value_noise(p, seed));
      }
      n += point.weight * value;
    }
    x += weights[o] * octave.amplitude * n;
  }
  column.base_x = x;
}

// One octave that depends on height.
double Field::volume_x(std::size_t layer_index, const Octave& octave, const Column& column,
                       double height_m) const {
  const Layer& layer = layers_[layer_index];
  if (octave.domain == Domain::kVolume) {
    const glm::dvec3& downwind = sheets_[layer_index].downwind(column.points.begin()->sheet);
    const glm::dvec3 p =
        volume_position(layer, octave, column.direction, downwind, radius_m_, height_m);
    return shaped(octave.shape, value_noise(p, octave.seed));
  }
  double n = 0;
  const double trail_m = layer.trail(layer.part(height_m));
  for (const SheetPoint& point : column.points) {
    const glm::dvec2 uv = {point.uv.x + trail_m, point.uv.y};
    n += point.weight * shaped(octave.shape, value_noise(sheet_position(octave, uv),
                                                         sheet_seed(octave, point.sheet)));
  }
  return n;
}

void Field::add_layer(std::size_t layer_index, NodeKey key, std::array<Column, 81>& columns,
                      FieldBrick& brick) const {
  const Layer& layer = layers_[layer_index];
  const LevelResponse& response = this->response(layer_index, key.level());
  const std::uint32_t k0 = kBrickCells * key.k();
  if (response.first() > response.last() || k0 > response.last() ||
      k0 + kBrickCells < response.first())
    return;
  // Octaves that depend on height, and how much the rest of them can still add.
  struct Term {
    const Octave* octave;
    double amplitude, rest_high, rest_low;
  };
  std::vector<Term> terms;
  for (std::size_t o = 0; o < layer.octaves.size(); ++o) {
    const Octave& octave = layer.octaves[o];
    const double a = response.weights()[o] * octave.amplitude;
    if (a > 0 && (octave.domain == Domain::kVolume || octave.domain == Domain::kStreak))
      terms.push_back({&octave, a, 0, 0});
  }
  double high = 0, low = 0;
  for (std::size_t t = terms.size(); t-- > 0;) {
    const Range all = shaped(terms[t].octave->shape, Range{-kTail, kTail});
    high += terms[t].amplitude * all.high, low += terms[t].amplitude * all.low;
    terms[t].rest_high = high, terms[t].rest_low = low;
  }
  const double extinction = layer.spec.extinction_per_m;
  const bool ice = layer.spec.type == LayerType::kCirrus;
  const double dz_m = chart_->thickness_m() / lattice_.cells(key.level())[2];
  double variance = 0;
  for (std::uint32_t c = 0; c < 81; ++c) {
    Column& column = columns[c];
    prepare(layer_index, response.weights(), column);
    for (std::uint32_t s = 0; s < kBrickSamples; ++s) {
      const std::uint32_t k = k0 + s;
      if (k < response.first() || k > response.last()) continue;
      const LevelResponse::Row& row = response.row(k);
      const double height_m = chart_->bottom_m() + k * dz_m;
      double x = column.base_x;
      for (const Term& term : terms) {
        if (x + term.rest_high <= row.foot || x + term.rest_low >= row.full) break;
        x += term.amplitude * volume_x(layer_index, *term.octave, column, height_m);
      }
      const double value = extinction * response.mean(row, x);
      brick.total[c + 81 * s] += value;
      if (ice) brick.ice[c + 81 * s] += value;
      variance += response.variance(row, x);
    }
  }
  brick.variance_per_m2 += extinction * extinction * variance / kBrickVolume;
}

void Field::brick(NodeKey key, FieldBrick& brick) const {
  brick = {};
  std::array<Column, 81> columns;
  const Index3& n = lattice_.cells(key.level());
  const Index3 g = Lattice::global_sample(key, {0, 0, 0});
  for (std::uint32_t j = 0; j < kBrickSamples; ++j)
    for (std::uint32_t i = 0; i < kBrickSamples; ++i)
      columns[i + 9 * j].direction =
          directions_.at(chart_->names({key.root(), g[0] + i, g[1] + j}, n).owner(), n[0]);
  for (std::size_t layer = 0; layer < layers_.size(); ++layer)
    add_layer(layer, key, columns, brick);
}

double Field::full_x(std::size_t layer_index, const glm::dvec3& direction, double height_m) const {
  const Layer& layer = layers_[layer_index];
  const std::vector<double> full(layer.octaves.size(), 1.0);
  Column column{direction, 0, {}};
  prepare(layer_index, full, column);
  double x = column.base_x;
  for (const Octave& octave : layer.octaves)
    if (octave.domain == Domain::kVolume || octave.domain == Domain::kStreak)
      x += octave.amplitude * volume_x(layer_index, octave, column, height_m);
  return x;
}

double Field::extinction_per_m(const glm::dvec3& direction, double height_m) const {
  double sum = 0;
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const Layer& layer = layers_[l];
    const double part = layer.part(height_m), profile = layer.profile(part);
    if (!(profile > 0)) continue;
    sum += layer.spec.extinction_per_m * profile *
           rise(layer, full_x(l, direction, height_m) - layer.lift(part));
  }
  return sum;
}

// Bound of x, and of x + kTail s on this and all finer levels, within `radius_m` of a direction
// (along the sphere) and between two heights.
double Field::highest_x(std::size_t layer_index, int level, const glm::dvec3& d, double radius_m,
                        double low_m, double high_m) const {
  const Layer& layer = layers_[layer_index];
  const double reach = radius_m / radius_m_;
  double climate = -1e9;
  constexpr int kSteps = 8;  // climate is smooth: its slope is below 30
  for (int s = -kSteps; s <= kSteps; ++s)
    climate = std::max(climate, layer.climate(std::clamp(d.z + reach * s / kSteps, -1.0, 1.0)));
  double x = climate + 30 * reach / kSteps - layer.threshold;
  const SheetPoints points = sheets_[layer_index].at(d);
  // One sheet all over the node, or else no better than the clip.
  const bool one_sheet = points.size == 1 && radius_m < 2e4;
  const glm::dvec3 wound = storms_.front().wound(d);
  const double stretch = storms_.front().stretch(d, reach);
  const auto box = [](auto middle, auto half) { return std::pair{middle - half, middle + half}; };
  const std::vector<double>& weights = response(layer_index, level).weights();
  double left_out = 0;
  for (std::size_t o = 0; o < layer.octaves.size(); ++o) {
    const Octave& octave = layer.octaves[o];
    double high = shaped(octave.shape, Range{-kTail, kTail}).high;
    if (octave.domain == Domain::kGlobe) {
      const auto [a, b] = box(globe_position(octave, wound, radius_m_),
                              glm::dvec3(stretch * radius_m / octave.cell_m));
      high = shaped(octave.shape, value_noise_range(a, b, octave.seed)).high;
    } else if (octave.domain == Domain::kVolume) {
      const double middle_m = 0.5 * (low_m + high_m), half_m = 0.5 * (high_m - low_m);
      const double r = (radius_m * 1.01 + half_m * (1 + layer.lean)) / octave.cell_m;
      if (one_sheet && r < 1.5) {
        const glm::dvec3 p =
            volume_position(layer, octave, d, sheets_[layer_index].downwind(points.begin()->sheet),
                            radius_m_, middle_m);
        high = shaped(octave.shape,
                      value_noise_range(p - glm::dvec3(r), p + glm::dvec3(r), octave.seed))
                   .high;
      }
    } else if (one_sheet) {
      const SheetPoint& point = *points.begin();
      const double r = radius_m * Sheets::kScaleAtRim;
      const bool streak = octave.domain == Domain::kStreak;
      const double t0 = streak ? layer.trail(std::clamp(layer.part(high_m), 0.0, 1.0)) : 0;
      const double t1 = streak ? layer.trail(std::clamp(layer.part(low_m), 0.0, 1.0)) : 0;
      const glm::dvec2 uv = {point.uv.x + 0.5 * (t0 + t1), point.uv.y};
      const glm::dvec2 p = sheet_position(octave, uv);
      const glm::dvec2 half = {(r + 0.5 * std::abs(t1 - t0)) / (octave.cell_m * octave.stretch),
                               r / octave.cell_m};
      const double turn = octave.stretch == 1 ? half.x + half.y : 0;  // the lattice is turned
      const glm::dvec2 grown = {std::max(half.x, turn), std::max(half.y, turn)};
      const std::uint32_t seed = sheet_seed(octave, point.sheet);
      const Range plain = value_noise_range(p - grown, p + grown, seed);
      if (octave.shape != Shape::kCells) {
        high = shaped(octave.shape, plain).high;
      } else if (!layer.regimes) {
        high = cells_range(p, 1.4143 * std::max(grown.x, grown.y), seed).high;
      }
    }
    // What this level holds in full, all finer ones do. Of the rest some level holds any part.
    const bool whole = weights[o] == 1;
    x += octave.amplitude * (whole ? high : std::max(high, 0.0));
    if (!whole) left_out += octave.amplitude * octave.amplitude;
  }
  return x + kTail * std::sqrt(left_out);
}

FieldBound Field::bound(NodeKey key) const {
  FieldBound bound;
  const Index3& n = lattice_.cells(key.level());
  const Index3 g = Lattice::global_sample(key, {0, 0, 0});
  const glm::dvec3 middle = directions_.at({key.root(), g[0] + 4, g[1] + 4}, n[0]);
  double chord = 0;
  for (const std::uint32_t i : {0u, 8u})
    for (const std::uint32_t j : {0u, 8u}) {
      const glm::dvec3 d = directions_.at({key.root(), g[0] + i, g[1] + j}, n[0]) - middle;
      chord = std::max(chord, std::sqrt(glm::dot(d, d)));
    }
  // Walls are great circles: a node's farthest point from its middle is a corner. In space, samples
  // lie up to the shell's top higher.
  const double radius_m = chord * 1.01 * (radius_m_ + chart_->bottom_m() + chart_->thickness_m());
  const double dz_m = chart_->thickness_m() / n[2];
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const Layer& layer = layers_[l];
    // A coarser sample's hat reaches a voxel beyond the node.
    const double low_m = chart_->bottom_m() + (double(g[2]) - 1) * dz_m;
    const double high_m = chart_->bottom_m() + (double(g[2]) + kBrickCells + 1) * dz_m;
    const double from_m = std::max(low_m, layer.spec.base_m);
    const double to_m = std::min(high_m, layer.spec.top_m);
    if (!(from_m < to_m)) continue;
    const double x = highest_x(l, key.level(), middle, radius_m, from_m, to_m);
    double most = 0;
    constexpr int kSteps = 32;
    const double steepest = 4 * (layer.part(to_m) - layer.part(from_m)) / kSteps;  // |lift'| < 8
    for (int s = 0; s <= kSteps; ++s) {
      const double part = layer.part(from_m + (to_m - from_m) * s / kSteps);
      if (x + steepest > layer.lift(part)) most = std::max(most, layer.profile(part));
    }
    // The profile's peak may be between two steps; where it only rises or falls, its ends are
    // steps.
    most = std::min(1.0, most * 1.25);
    bound.most_per_m += layer.spec.extinction_per_m * most;
  }
  bound.error_per_m = key.level() == lattice_.max_level() ? 0 : bound.most_per_m;
  return bound;
}

}  // namespace nepho::noise
