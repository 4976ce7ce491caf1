#pragma once

#include <filesystem>

#include "cli/commands.h"
#include "image/picture_file.h"
#include "scene/scene.h"

namespace nepho {

// The scene that a command line means: read from a scene file or a picture's metadata, or made of
// data files, with every option laid over it. Throws Error.
Scene scene_from(const RenderOptions& options, const PictureFiles& pictures);

// What one input is, by its name; throws Error where there is no such file.
enum class InputKind { kScene, kPicture, kData };
InputKind input_kind(const std::string& input);
// The scene in a picture's metadata; throws Error where there is none.
Scene scene_in_picture(const std::filesystem::path& path, const PictureFiles& pictures);
// One volume of one data file (or name.####.vdb): NetCDF and GRIB by their first bytes, all else by
// its ending. Throws Error for what is known to be something else.
VolumeSpec data_volume(const std::string& file);

// Lays an option over every volume that has files.
void set_parameter(Scene& scene, const char* parameter, const std::string& option,
                   const std::optional<std::string>& value);
// "2005-08-28T15:00Z" or seconds, for every volume with files; for all where none has any.
void set_time(Scene& scene, const std::optional<std::string>& value);
// --force, for every volume with files.
void set_force(Scene& scene, bool force);
// --region SOUTH,WEST,NORTH,EAST, for every volume with files.
void set_raster(Scene& scene, const RasterWords& words);
void set_region(Scene& scene, const std::optional<std::string>& value);

}  // namespace nepho
