#pragma once

#include <vector>

#include "renderer.h"

namespace nepho {

// All of a request that a picture depends on, as numbers: two requests of the same show the same.
// Sources count by where they are.
std::vector<double> fingerprint(const RenderRequest& request);
// Of all but the camera and the picture's size: where they are the same, what was seen from another
// place may be seen again.
std::vector<double> look_fingerprint(const RenderRequest& request);
// Of volumes and times: where they differ, nothing of the one tree is in the other.
std::vector<double> contents_fingerprint(const RenderRequest& request);

}  // namespace nepho
