#pragma once

#include <memory>

#include "api/source_module.h"

namespace nepho::noise {

// The procedural planet: layers of cloud around WGS84. Parameters, all optional:
//
//   weather            0.8   0..1: synoptic systems, regions of open and closed cells, clear skies
//   climate            1     0..1: how much of it follows the latitude (rain belt, clear
//   subtropics) seed               1     of the weather and the land, and of layers without a seed
//   of their own finest_resolution  100 m finest voxel, at most land               0.3   0..1, the
//   part of the planet that is dry
//
//   layer1.type        cumulus | stratocumulus | stratus | cirrus;   up to layer8; where no layer
//   is
//                      named, the sky has one of each
//   layer1.coverage    0..1, the part of the planet under it, optical depth 0.1 or more
//   layer1.base, .top  heights over the ellipsoid, m
//   layer1.scale       m: from cloud to cloud, cell to cell, streak to streak
//   layer1.wind        m/s: streets and streaks lie along it, towers and fallstreaks lean by it
//   layer1.wind_from   where it blows from, by the compass
//   layer1.extinction  1/m in the densest part
//   layer1.seed        whole number
//
// Defaults of the types: layer.cpp. Heights are the chart's (r' - a of docs/lattice.md 5): within
// 0.34 % of the height over the ellipsoid. Samples are `point`; coarser levels are the closure of
// docs/lattice.md 2. A cirrus layer adds the channel kIceExtinction.
std::unique_ptr<BrickSource> open_source(const SourceRequest& request);

}  // namespace nepho::noise
