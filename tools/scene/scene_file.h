#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "api/source_module.h"
#include "scene/scene.h"

namespace nepho {

// Scenes as JSON (docs/scene.schema.json). Angles are in degrees, lengths in metres; local points
// are metres east, north and up of `place`, else of the first volume's place, else of the point
// that the camera looks at, else of the ECEF origin. read(write(scene)) has the same bits.

// Relative file names are resolved against `folder`. Throws Error that names line, column, field.
Scene parse_scene(std::string_view text, const std::string& source_name,
                  const std::filesystem::path& folder);
Scene read_scene_file(const std::filesystem::path& path);

// One line of JSON. File names below `folder`, or up to two folders beside it, become relative to
// it, so that a picture and its data can move together; others become absolute.
std::string write_scene(const Scene& scene, const std::filesystem::path& folder);

// Whether a scene says where it stands; without, its frame is that of the world.
bool has_frame(const Scene& scene);
// The frame of local points, for a scene that has been read.
Placement scene_frame(const Scene& scene);
glm::dvec3 to_ecef(const Placement& frame, const glm::dvec3& local_m);
glm::dvec3 to_local(const Placement& frame, const glm::dvec3& ecef_m);
glm::dvec3 axis(const Placement& frame, int index);  // 0 east, 1 north, 2 up
// Unit vector to the sun; azimuth clockwise from the frame's north (its y).
glm::dvec3 sun_direction(const Placement& frame, double azimuth_rad, double elevation_rad);

}  // namespace nepho
