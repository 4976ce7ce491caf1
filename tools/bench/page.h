#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/run.h"
#include "image/image.h"

namespace nepho::bench {

// The bytes of a PNG file; empty where this build writes none: the page then has no pictures, and
// says so.
using PngOf = std::function<std::string(const ByteImage&)>;

// One HTML page, well-formed XML too, that needs nothing beside itself: a section a scene with its
// chart, its table, its fits, and pictures with maps of FLIP as data: URIs.
std::string page_of(const std::vector<SceneResult>& scenes, const std::string& command,
                    const PngOf& png_of);

}  // namespace nepho::bench
