#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/source_host.h"
#include "renderer.h"
#include "scene/scene.h"

namespace nepho {

// A scene with its sources open and nothing left to work out: where sources and renderer meet.
struct OpenedScene {
  Scene scene;  // camera, sun and sky are filled in: what a picture's metadata stores
  std::vector<std::unique_ptr<BrickSource>> sources;
  std::shared_ptr<const SurfaceMap> terrain;  // the request's; null without one
  RenderRequest request;                      // points into `sources` and `terrain`
  std::vector<std::string> assumptions;       // what was not in the data, one sentence each
  // Where the sun was put by a date, and the distance that its irradiance is of (0: as the scene
  // says).
  std::optional<std::int64_t> sun_utc_ns = {};
  double sun_distance_au = 0;
};

std::unique_ptr<BrickSource> open_volume(const SourceHost& host, const VolumeSpec& volume);
// The volume's time; throws Error that lists the times where it has no such one.
double time_of(const VolumeSpec& volume, const VolumeInfo& info);
// The time that the volume names in one of the ways of scene.h; nothing where it names none. Throws
// Error where the source has no such one.
std::optional<double> named_time(const VolumeSpec& volume, const BrickSource& source);
// Of a sequence that begins with an empty frame, a picture of its first cloud. The first time where
// all are empty.
double first_time_with_cloud(const BrickSource& source);
// Throws Error: a source's own reasons (with the scene file's line), or nothing to look at.
OpenedScene open_scene(const SourceHost& host, Scene scene);

}  // namespace nepho
