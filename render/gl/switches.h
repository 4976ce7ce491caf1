#pragma once

#include <string>

#include "gl/frame_data.h"
#include "renderer.h"

namespace nepho::gl {

// What a scene's shaders are compiled with, and what is decided beside it.

bool cell_exact(const RenderSettings& settings);
bool reads_texels8(const RenderSettings& settings);
// Where the march drops a ray: it can add no more than this share of what lies behind.
float least_transmittance(const RenderSettings& settings);

// Parabolas for the curved coordinates within a leaf, and how far off they are in the widest.
bool uses_parabolas(const RenderRequest& request, const GpuScene& scene);
double parabola_error_cells(const GpuScene& scene);

// Lines of #define; `lit` where the light tiles are read, not filled; `planet`: PlanetPasses' own.
std::string shader_switches(const RenderRequest& request, const GpuScene& scene,
                            const std::string& planet, bool lit);

}  // namespace nepho::gl
