#pragma once

#include <memory>
#include <vector>

#include "api/source_module.h"
#include "bricks/shell_chart.h"
#include "sources/noise/layer.h"

namespace nepho::noise {

struct Planet {
  VolumeInfo info;
  std::shared_ptr<const ShellChart> chart;
  std::vector<LayerSpec> layers;
};

// The parameters of noise_source.h. Throws Error.
Planet make_planet(const SourceRequest& request);

}  // namespace nepho::noise
