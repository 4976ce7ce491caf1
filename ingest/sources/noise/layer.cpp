#include "sources/noise/layer.h"

#include <algorithm>
#include <cmath>

#include "sources/noise/normal.h"

namespace nepho::noise {
namespace {

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
// x^(2/3) on [0, 1] within 0.01: extinction rises as the two thirds' power of adiabatic water.
double two_thirds(double x) {
  return std::sqrt(x) * (1.25 - 0.25 * x) * 0.8 + 0.2 * x;
}
double bump(double x, double middle, double width) {
  const double t = (x - middle) / width;
  return 1 / (1 + t * t * t * t);
}

// Shares of variance; scaled to 1 at the end.
class Octaves {
 public:
  Octaves(const LayerSpec& spec, double finest_m) : spec_(spec), finest_m_(finest_m) {}

  void add(Domain domain, Shape shape, double cell_m, double share, double stretch = 1) {
    if (cell_m * std::min(1.0, stretch) < 1.1 * finest_m_ || !(share > 0)) return;
    list_.push_back({domain, shape, cell_m, stretch, share,
                     (spec_.seed * 64 + std::uint32_t(list_.size()) + 1) * 0x9e3779b9u});
  }
  // `count` octaves, each half as long and with `ratio` of the share.
  void add_many(Domain domain, Shape shape, double cell_m, double share, double ratio, int count,
                double stretch = 1, double stretch_ratio = 1) {
    for (int n = 0; n < count; ++n) {
      add(domain, shape, cell_m, share, stretch);
      cell_m *= 0.51, share *= ratio;
      if (stretch > 1) stretch = std::max(1.0, stretch * stretch_ratio);
    }
  }
  // Weather takes its share of all. Most of the variance, by default: a voxel seen from space holds
  // the mean of its clouds, so that clouds without systems would be an even grey veil.
  void add_weather() {
    const double share = 0.95 * spec_.weather;
    double rest = 0;
    for (const Octave& octave : list_) rest += octave.amplitude;
    // Voxels of a planet's size hold nothing but weather.
    const double w = rest > 0 ? rest * share / (1 - share) : share;
    const auto system = [&](Shape shape, double cell_m, double part) {
      const std::size_t before = list_.size();
      add(Domain::kGlobe, shape, cell_m, part * w);
      if (list_.size() > before)
        list_.back().seed = spec_.weather_seed * 0x9e3779b9u + (shape == Shape::kRidge ? 2u : 1u);
    };
    if (!(w > 0)) return;
    system(Shape::kPlain, 1.9e6, 0.22);
    system(Shape::kRidge, 1.1e6, 0.34);
    add(Domain::kGlobe, Shape::kPlain, 4.7e5, 0.20 * w);
    add(Domain::kGlobe, Shape::kRidge, 2.3e5, 0.12 * w);
    add(Domain::kGlobe, Shape::kPlain, 1.1e5, 0.08 * w);
    add(Domain::kGlobe, Shape::kPlain, 5.3e4, 0.04 * w);
  }
  std::vector<Octave> take() {
    double sum = 0;
    for (const Octave& octave : list_) sum += octave.amplitude;
    for (Octave& octave : list_) octave.amplitude = std::sqrt(octave.amplitude / sum);
    return std::move(list_);
  }

 private:
  const LayerSpec& spec_;
  double finest_m_;
  std::vector<Octave> list_;
};

void cumulus(Octaves& o, Layer& layer) {
  const double s = layer.spec.scale_m, streets = 1 + layer.spec.wind_m_per_s / 10;
  o.add(Domain::kSheet, Shape::kPlain, 7 * s, 0.10, streets);
  o.add(Domain::kSheet, Shape::kPlain, 2.2 * s, 0.16, streets);
  o.add(Domain::kSheet, Shape::kPlain, 0.70 * s, 0.34);
  o.add(Domain::kSheet, Shape::kPlain, 0.36 * s, 0.16);
  o.add_many(Domain::kVolume, Shape::kBillow, 0.26 * s, 0.10, 0.45, 5);
  o.add_weather();
  layer.rise = {{{0.12, 0.5}, {0.8, 0.5}}};
  layer.lean = layer.spec.wind_m_per_s / 40;
}

void stratocumulus(Octaves& o, Layer& layer) {
  const double s = layer.spec.scale_m;
  o.add(Domain::kSheet, Shape::kPlain, 8 * s, 0.08);
  o.add(Domain::kSheet, Shape::kCells, s, 0.52, 1 + layer.spec.wind_m_per_s / 40);
  o.add(Domain::kSheet, Shape::kPlain, 0.55 * s, 0.10);
  o.add(Domain::kSheet, Shape::kCells, 0.31 * s, 0.10);
  o.add_many(Domain::kVolume, Shape::kBillow, 0.14 * s, 0.08, 0.55, 6);
  o.add_weather();
  layer.rise = {{{0.20, 0.4}, {1.2, 0.6}}};
  layer.regimes = layer.spec.weather > 0;
}

void stratus(Octaves& o, Layer& layer) {
  const double s = layer.spec.scale_m;
  o.add_many(Domain::kSheet, Shape::kPlain, 2 * s, 0.4, 0.55, 5, 1 + layer.spec.wind_m_per_s / 10);
  // Cells of a few kilometres, and billows in rows across the wind, as gravity waves leave them.
  o.add(Domain::kSheet, Shape::kCells, 0.23 * s, 0.16);
  o.add_many(Domain::kSheet, Shape::kPlain, 0.17 * s, 0.12, 0.5, 2, 0.3, 1);
  o.add_many(Domain::kVolume, Shape::kBillow, 0.06 * s, 0.07, 0.5, 6);
  o.add_weather();
  layer.rise = {{{0.5, 0.4}, {2.0, 0.6}}};
}

void cirrus(Octaves& o, Layer& layer) {
  const double s = layer.spec.scale_m, thick = layer.spec.top_m - layer.spec.base_m;
  const double wind = layer.spec.wind_m_per_s;
  const double stretch = 1 + wind / 3;
  o.add_many(Domain::kSheet, Shape::kPlain, 20 * s, 0.20, 0.7, 3, 2.5);
  o.add_many(Domain::kStreak, Shape::kPlain, 1.6 * s, 0.22, 0.62, 7, stretch, 0.85);
  o.add_weather();
  layer.rise = {{{1.0, 0.3}, {3.0, 0.7}}};
  layer.trail_m = wind / 5 * thick;
}

// Mean over the planet of the covered part, less the coverage asked for.
double surplus(const Layer& layer, double threshold) {
  double covered = 0;
  constexpr int kBands = 64;
  for (int band = 0; band < kBands; ++band)
    covered += normal_cdf(layer.climate((band + 0.5) * 2 / kBands - 1) - threshold);
  return covered / kBands - layer.spec.coverage;
}

// A column is cloudy where its most favourable height is, and thin edges count for nothing. How far
// that moves the threshold from the one of a plain field: measured with the types' own extinction
// (tests/noise, Coverage).
double column_surplus(LayerType type) {
  switch (type) {
    case LayerType::kStratus:
      return -0.10;
    case LayerType::kStratocumulus:
      return -0.09;
    case LayerType::kCumulus:
      return 0.07;
    case LayerType::kCirrus:
      return -0.26;
  }
  return 0;
}

}  // namespace

LayerSpec default_layer(LayerType type) {
  LayerSpec s;
  s.type = type;
  constexpr double deg = 0.017453292519943295;
  switch (type) {
    case LayerType::kStratus:
      s.coverage = 0.9, s.base_m = 400, s.top_m = 800, s.scale_m = 12e3, s.wind_m_per_s = 6;
      s.wind_from_rad = 200 * deg, s.extinction_per_m = 0.02;
      break;
    case LayerType::kStratocumulus:
      s.coverage = 0.8, s.base_m = 900, s.top_m = 1400, s.scale_m = 5e3, s.wind_m_per_s = 8;
      s.wind_from_rad = 320 * deg, s.extinction_per_m = 0.03;
      break;
    case LayerType::kCumulus:
      s.coverage = 0.3, s.base_m = 900, s.top_m = 2800, s.scale_m = 2e3, s.wind_m_per_s = 5;
      s.wind_from_rad = 250 * deg, s.extinction_per_m = 0.04;
      break;
    case LayerType::kCirrus:
      s.coverage = 0.4, s.base_m = 8200, s.top_m = 10000, s.scale_m = 2e3, s.wind_m_per_s = 30;
      s.wind_from_rad = 270 * deg, s.extinction_per_m = 6e-4;
      break;
  }
  return s;
}

double Layer::profile(double t) const {
  if (t < 0 || t > 1) return 0;
  const double thick_m = spec.top_m - spec.base_m;
  const double base = smooth_step(0, std::min(0.25, 40 / thick_m), t);
  switch (spec.type) {
    case LayerType::kStratus:
      return base * (0.5 + 0.5 * t) * (1 - smooth_step(0.9, 1, t));
    case LayerType::kStratocumulus:
      return base * (0.35 + 0.65 * two_thirds(t)) * (1 - smooth_step(0.95, 1, t));
    case LayerType::kCumulus:
      return base * (0.35 + 0.65 * two_thirds(t)) * (1 - smooth_step(0.97, 1, t));
    case LayerType::kCirrus:
      return smooth_step(0, 0.5, t) * (1 - smooth_step(0.8, 1, t));
  }
  return 0;
}

double Layer::lift(double t) const {
  switch (spec.type) {
    case LayerType::kStratus: {  // hanging undulations below, long waves on top
      const double foot = std::max(0.0, 0.35 - t) / 0.35;
      return 1.2 * foot * foot + 1.8 * t * t * t;
    }
    case LayerType::kStratocumulus: {
      const double foot = std::max(0.0, 0.25 - t) / 0.25;
      return 0.5 * foot * foot + 1.3 * t * t;
    }
    case LayerType::kCumulus:
      return 2.4 * t * t;
    case LayerType::kCirrus:
      return 1.0 * (t - 0.7) * (t - 0.7);
  }
  return 0;
}

double Layer::climate(double s) const {
  const double a = std::abs(s), w = spec.weather * spec.climate;
  switch (spec.type) {
    case LayerType::kStratus:
      return w * (0.9 * bump(a, 0.85, 0.25) - 0.7 * bump(a, 0.2, 0.3));
    case LayerType::kStratocumulus:
      return w * (0.6 * bump(a, 0.75, 0.3) - 0.8 * bump(s, 0.08, 0.15) - 0.8 * bump(a, 1, 0.06));
    case LayerType::kCumulus:
      return w * (0.6 * bump(s, 0.09, 0.09) - 0.5 * bump(a, 0.4, 0.12) + 0.2 * bump(a, 0.7, 0.2) -
                  1.5 * bump(a, 1, 0.1));
    case LayerType::kCirrus:
      return w * (0.6 * bump(s, 0.09, 0.12) - 0.7 * bump(a, 0.38, 0.12) + 0.5 * bump(a, 0.72, 0.2));
  }
  return 0;
}

Layer make_layer(const LayerSpec& spec, double finest_m) {
  Layer layer{.spec = spec, .octaves = {}, .rise = {}, .threshold = 0};
  Octaves octaves(spec, finest_m);
  switch (spec.type) {
    case LayerType::kStratus:
      stratus(octaves, layer);
      break;
    case LayerType::kStratocumulus:
      stratocumulus(octaves, layer);
      break;
    case LayerType::kCumulus:
      cumulus(octaves, layer);
      break;
    case LayerType::kCirrus:
      cirrus(octaves, layer);
      break;
  }
  layer.octaves = octaves.take();
  double low = -8, high = 8;
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    (surplus(layer, middle) > 0 ? low : high) = middle;
  }
  layer.threshold = 0.5 * (low + high) + column_surplus(spec.type);
  return layer;
}

}  // namespace nepho::noise
