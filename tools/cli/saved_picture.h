#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/open_scene.h"
#include "image/picture_file.h"
#include "renderer.h"

namespace nepho {

// A drawn scene as a picture file that brings its scene back: what `render` and `view` write.

// r, g, b and optical depth.
FloatImage linear_image(const HdrImage& picture);
// What puts the bright end of its clouds at white, where the scene says nothing.
double find_exposure(const OpenedScene& opened, const FloatImage& linear,
                     const std::vector<float>& optical_depth);
// More bytes than any of the formats needs.
std::uintmax_t largest_size(const RenderSettings& settings, PictureFormat format);
Metadata metadata_of(const OpenedScene& opened, const std::filesystem::path& output,
                     const std::string& error);
// opened.scene.exposure_ev is set.
void write_picture(const PictureFiles& pictures, const std::filesystem::path& temporary,
                   PictureFormat format, const OpenedScene& opened, const FloatImage& linear,
                   const Metadata& metadata);

}  // namespace nepho
