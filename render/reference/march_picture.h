#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "reference/ray_march.h"

namespace nepho {

// Whole pictures, and some pixels of them, by the reference march.

// Told now and then, from one thread at a time, how many pixels are done.
using MarchProgress = std::function<void(std::size_t done)>;

// Of the pixels with these indices (row by row from the top). Same numbers for any number of
// threads. Throws Error where a source fails.
std::vector<MarchResult> march_pixels(const RayMarch& march, const RenderRequest& request,
                                      std::span<const std::size_t> pixels,
                                      const MarchProgress& progress = {});
HdrImage march_picture(const RayMarch& march, const RenderRequest& request,
                       const MarchProgress& progress = {});
HdrImage march_picture(const LevelSet& levels, const RenderRequest& request,
                       MarchSettings settings = {});

}  // namespace nepho
