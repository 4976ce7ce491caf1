#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace nepho::noise {

// One layer of cloud, as a scene describes it and as a sum of octaves.
//
// Extinction is  extinction_per_m * profile(z) * rise(x - lift(z)),  x = climate(latitude) -
// threshold
// + sum of octaves. The octaves are independent and standard normal, their variances sum to 1 over
// the planet; rise() is a sum of ramps. lift() grows with height: it is what makes flat bases,
// domes and towers out of the octaves, whose three-dimensional ones are the cauliflower.

enum class LayerType { kStratus, kStratocumulus, kCumulus, kCirrus };

struct LayerSpec {
  LayerType type = LayerType::kCumulus;
  double coverage = 0.35;  // part of the planet under cloud of optical depth > 0.1
  double base_m = 0, top_m = 0, scale_m = 0;
  double wind_m_per_s = 0, wind_from_rad = 0;
  double extinction_per_m = 0;
  double weather = 0.8;  // 0: the same everywhere; 1: systems of 1000 km, clear and overcast
  double climate = 1;    // how much latitude matters, of what weather makes of it
  std::uint32_t seed = 1;
  std::uint32_t weather_seed = 1;  // of the largest systems, which layers share
};
// What a type has where the scene says nothing.
LayerSpec default_layer(LayerType type);

enum class Domain : std::uint8_t {
  kGlobe,   // on the wound sphere: weather
  kSheet,   // on a sheet, one value per column
  kStreak,  // on a sheet, moved along the wind with height
  kVolume,  // in space
};
enum class Shape : std::uint8_t { kPlain, kBillow, kRidge, kCells };

struct Octave {
  Domain domain;
  Shape shape;
  double cell_m;       // of the noise's lattice, across the wind; a wavelength is about two cells
  double stretch = 1;  // along the wind (kSheet, kStreak); below 1: rows across it
  double amplitude;    // standard deviation
  std::uint32_t seed;
};

struct Ramp {
  double width, share;
};

struct Layer {
  LayerSpec spec;
  std::vector<Octave> octaves;
  std::array<Ramp, 2> rise;
  double threshold;
  double lean = 0;       // kVolume: metres along the wind per metre of height
  double trail_m = 0;    // kStreak: how far the foot lags behind the top
  bool regimes = false;  // kCells: closed here, open there

  // Height as a part of the layer, 0 at the base; outside [0, 1] there is nothing.
  double part(double height_m) const {
    return (height_m - spec.base_m) / (spec.top_m - spec.base_m);
  }
  double profile(double part) const;
  double lift(double part) const;
  // Metres along the wind by which a streak is moved at this height.
  double trail(double part) const { return trail_m * (1 - part) * (1 - part); }
  // Mean of x before the threshold, from the sine of the latitude.
  double climate(double sine) const;
};

// Octaves from the layer's scale down to cells of 1.1 times the finest voxel.
Layer make_layer(const LayerSpec& spec, double finest_m);

}  // namespace nepho::noise
