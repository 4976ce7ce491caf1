#pragma once

#include <cstddef>
#include <cstdint>

#include "air/air_tables.h"
#include "renderer.h"
#include "shaders/planet.layout.h"
#include "tree/forest.h"

namespace nepho::gl {

// A request's planet as the shaders read it.

static_assert(offsetof(PlanetData, surface_axes) == 120 &&
              offsetof(PlanetData, rayleigh_per_m) == 224);
static_assert(sizeof(PlanetData) == 384);

struct PlanetScene {
  PlanetData data{};
  bool air = false, clouds = false, terrain = false, sun_map = false;
  int map_size = 0;           // texels on a side of the sun map
  int map_bands = 1;          // its layers
  double sun_map_change = 0;  // most that leaving it out can change the air's light
  // Of a surface map, left out or not: its highest place, and the largest part of land in a place.
  bool surface_known = false;
  double terrain_top_m = 0, terrain_change = 0;
  const SurfaceMap* surface = nullptr;  // of the first volume that has one
};

// request.planet is set.
PlanetScene make_planet_scene(const RenderRequest& request, const Forest& forest);

}  // namespace nepho::gl
