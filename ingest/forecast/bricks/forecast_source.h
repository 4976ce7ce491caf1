#pragma once

#include <memory>

#include "api/module_support.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

// A forecast as a source of bricks on a ShellChart. Parameters, all optional:
//
//   horizontal_resolution_m  widest column of the finest level (the model's cells)
//   vertical_resolution_m    highest voxel of the finest level (the thinnest layer that can hold
//                            cloud, at least 50 m)
//   clear_below_per_m        thinner layers count as clear (1e-9; 0 keeps all)
//   layers                   smooth | constant: what fills a model's layers (Layers in
//                            hat_remap.h); point_extinction_per_m is constant in each either way
//   chart                    shell | box: box draws the shell's finest field in cubes, in one box
//                            around the planet, to compare with; a point field then
//   max_level                of the box (the finest that takes no more than 60 000 bricks)
//
// `parameters` are the request's: what the conventions ask of them is looked up before, finish() is
// called here. The first time is remapped at once, so that bad data are refused with their reasons,
// and others when they are asked for; the last two are kept. Throws Error.
std::unique_ptr<BrickSource> make_source(const std::string& volume_name,
                                         std::shared_ptr<const Forecast> forecast,
                                         Parameters& parameters);

}  // namespace nepho::forecast
