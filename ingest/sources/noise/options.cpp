#include "sources/noise/options.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numbers>
#include <span>

#include "api/module_support.h"
#include "bricks/quantise.h"
#include "sources/noise/land.h"

namespace nepho::noise {
namespace {

constexpr int kMostLayers = 8;
constexpr double kHighestTop_m = 100e3;

std::string metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g m", value);
  return text;
}

LayerType layer_type(const std::string& word) {
  if (word == "stratus") return LayerType::kStratus;
  if (word == "stratocumulus") return LayerType::kStratocumulus;
  return word == "cirrus" ? LayerType::kCirrus : LayerType::kCumulus;
}

LayerSpec read_layer(Parameters& p, const std::string& name, std::uint32_t seed) {
  const std::string type =
      p.choice(name + "type", {"cumulus", "stratocumulus", "stratus", "cirrus"});
  LayerSpec layer = default_layer(layer_type(type));
  layer.coverage = p.number_in(name + "coverage", layer.coverage, 0, 1);
  const double thick_m = layer.top_m - layer.base_m;
  const std::optional<double> base_m = p.number(name + "base_m"), top_m = p.number(name + "top_m");
  if (base_m) layer.base_m = *base_m;
  if (top_m) layer.top_m = *top_m;
  // One end given: the layer keeps its thickness.
  if (base_m && !top_m) layer.top_m = layer.base_m + thick_m;
  if (top_m && !base_m) layer.base_m = std::max(0.0, layer.top_m - thick_m);
  if (!(layer.base_m >= 0 && layer.top_m <= kHighestTop_m))
    throw Error({"out of range", p.where(name + (base_m ? "base_m" : "top_m")),
                 "0 m to " + metres(kHighestTop_m),
                 metres(layer.base_m) + " to " + metres(layer.top_m), ""});
  if (!(layer.top_m >= layer.base_m + 10))
    throw Error({"a layer's base is above its top", p.where(name + "base_m"),
                 "at least 10 m below the top, " + metres(layer.top_m), metres(layer.base_m), ""});
  layer.scale_m = p.number_in(name + "scale_m", layer.scale_m, 100, 1e6);
  layer.wind_m_per_s = p.number_in(name + "wind_m_per_s", layer.wind_m_per_s, 0, 150);
  layer.wind_from_rad = p.number_in(name + "wind_from_rad", layer.wind_from_rad, -100, 100);
  layer.extinction_per_m = p.number_in(name + "extinction_per_m", layer.extinction_per_m, 0, 10);
  layer.seed = std::uint32_t(p.integer(name + "seed", int(seed), 0, 1'000'000));
  return layer;
}

std::vector<LayerSpec> read_layers(Parameters& p, const SourceRequest& request, int seed) {
  const std::span given(request.parameters, request.parameter_count);
  std::vector<LayerSpec> layers;
  for (int n = 1; n <= kMostLayers; ++n) {
    const std::string name = "layer" + std::to_string(n) + ".";
    if (std::ranges::any_of(given, [&](const RequestParameter& parameter) {
          return std::strncmp(parameter.name, name.c_str(), name.size()) == 0;
        }))
      layers.push_back(read_layer(p, name, std::uint32_t(seed * 16 + n)));
  }
  return layers;
}

// A sky of a whole planet: less of each than where it is the weather of the day.
std::vector<LayerSpec> default_sky(int seed) {
  std::vector<LayerSpec> layers;
  const std::pair<LayerType, double> parts[] = {{LayerType::kCumulus, 0.13},
                                                {LayerType::kStratocumulus, 0.12},
                                                {LayerType::kStratus, 0.10},
                                                {LayerType::kCirrus, 0.16}};
  for (const auto& [type, coverage] : parts) {
    layers.push_back(default_layer(type));
    layers.back().coverage = coverage;
    layers.back().seed = std::uint32_t(seed * 16 + int(layers.size()));
  }
  return layers;
}

// x and y until voxels are as wide as high, then all three, to `finest_m` at most.
Lattice make_lattice(double width_m, double thickness_m, double finest_m,
                     const std::string& where) {
  int across = 0, up = 0;
  while (width_m / (8 << across) > finest_m && across < NodeKey::kMaxSplitsXy) ++across;
  while (thickness_m / (8 << up) > finest_m && up < NodeKey::kMaxSplitsZ) ++up;
  if (width_m / (8 << across) > finest_m)
    throw Error({"out of range", where, "1.2 m or more", metres(finest_m), ""});
  up = std::min(up, across);
  std::vector<SplitMask> masks(std::size_t(across), kSplitXy);
  for (int n = 0; n < up; ++n) masks[std::size_t(across - 1 - n)] = kSplitXyz;
  return Lattice(std::move(masks));
}

}  // namespace

Planet make_planet(const SourceRequest& request) {
  Parameters p(request);
  if (request.file_count > 0)
    throw Error({"the noise source reads no files", request.files[0], "no file", "", ""});
  Planet planet;
  const double weather = p.number_in("weather", 0.8, 0, 1);
  const double climate = p.number_in("climate", 1, 0, 1);
  const int seed = p.integer("seed", 1, 0, 1'000'000);
  const double finest_m = p.positive("finest_resolution_m", 100);
  const double land = p.number_in("land", 0.3, 0, 1);
  planet.layers = read_layers(p, request, seed);
  p.finish();
  if (planet.layers.empty()) planet.layers = default_sky(seed);
  double bottom_m = kHighestTop_m, top_m = 0, most = 0;
  bool ice = false;
  for (LayerSpec& layer : planet.layers) {
    layer.weather = weather, layer.climate = climate;
    // Fronts are high and low; fair weather lies between them.
    const bool front = layer.type == LayerType::kStratus || layer.type == LayerType::kCirrus;
    layer.weather_seed = std::uint32_t(seed * 2 + front);
    bottom_m = std::min(bottom_m, layer.base_m), top_m = std::max(top_m, layer.top_m);
    most += layer.extinction_per_m;
    ice = ice || layer.type == LayerType::kCirrus;
  }
  // A voxel of zeros above and below, as far as voxels are thin against the sky.
  const double margin_m = std::min(finest_m, 0.05 * (top_m - bottom_m));
  bottom_m -= margin_m, top_m += margin_m;

  VolumeInfo& info = planet.info;
  info.name = request.volume_name;
  planet.chart = std::make_shared<ShellChart>(Ellipsoid::wgs84(), bottom_m, top_m);
  info.chart = planet.chart;
  info.lattice = make_lattice(std::numbers::pi / 2 * planet.chart->body().equatorial_m,
                              top_m - bottom_m, finest_m, p.where("finest_resolution_m"));
  planet.chart->check(info.lattice);
  info.finest = SampleKind::kPoint;
  info.on_planet = true;
  info.refine_by_variance = true;
  info.surface = make_land(land, std::uint32_t(seed) * 0x9e3779b9u + 5);
  const double code_error =
      most * (0.5 / kTopCode16 + 2 * double(std::numeric_limits<float>::epsilon()));
  info.channels[0].max_abs_error = code_error;
  if (ice)
    info.channels.push_back({Channel::kIceExtinction, "ice_extinction", "m-1", 16, code_error});
  info.assumptions.push_back("clouds and land are drawn from noise: no data are behind them");
  for (const LayerSpec& layer : planet.layers) {
    constexpr const char* names[] = {"stratus", "stratocumulus", "cumulus", "cirrus"};
    char text[160];
    std::snprintf(text, sizeof text, "%s over %.2g of the planet, %.0f to %.0f m, up to %.2g /m",
                  names[int(layer.type)], layer.coverage, layer.base_m, layer.top_m,
                  layer.extinction_per_m);
    info.facts.push_back(text);
  }
  return planet;
}

}  // namespace nepho::noise
