#pragma once

#include <cstdint>
#include <optional>

#include "common/open_scene.h"
#include "common/planet_ground.h"

namespace nepho {

// What a scene on a planet leaves open: its time, its view, its sun. Each is stored in
// `opened.scene` and stated in `opened.assumptions`, with the options that repeat it.

// The rule of scene.h: the Earth, where a volume is weather of a planet and no sky is given. Throws
// Error where the planet of the scene is not the one that its volumes lie on.
void resolve_planet(OpenedScene& opened);
// The body that places are on: the planet's, else that of the weather. Nothing for free clouds.
std::optional<Ellipsoid> body_of(const OpenedScene& opened);

// The source's time at a date; throws Error that lists its dates.
double time_at(const VolumeInfo& info, std::int64_t utc_ns, const std::string& where);
std::int64_t utc_of(const VolumeInfo& info, double time_s);

// Fills times, camera, the sun's direction and its distance (in au).
//
// Time: of the first volume that has a date, the first with cloud that has the sun 15 degrees high
// where the view looks; where there is none, the first with cloud, and then the sun is put 35
// degrees high to the side. Clouds are looked for with summaries and with bricks of a middling
// level.
struct PlanetShot {
  Camera camera;
  double sun_distance_au = 1;
  std::optional<std::int64_t> sun_utc_ns = {};  // the date that the sun stands as at
};
PlanetShot frame_on_planet(OpenedScene& opened, const Ellipsoid& body);

// Luminance of a white matt surface that lies half towards the sun, where an opened scene's camera
// looks: through about as much air as is there. A yardstick for exposures, good to a third.
double white_in_the_sun(const OpenedScene& opened);

}  // namespace nepho
