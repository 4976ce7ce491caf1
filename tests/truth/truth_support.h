#pragma once

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <vector>

#include "bricks/box_chart.h"
#include "field_source.h"
#include "reference/path/path_picture.h"

namespace nepho::test {

// A number measured by histories, with its standard error.
struct Measured {
  double mean = 0, standard_error = 0;
};

// Mean of history(random) over `count` of them, by blocks that run side by side; the same for any
// number of threads.
template <class History>
Measured measure(std::uint64_t seed, std::uint32_t count, History&& history) {
  constexpr std::uint32_t kBlock = 4096;
  struct Sums {
    double value = 0, square = 0;
  };
  std::vector<Sums> blocks((count + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    for (std::uint32_t i = std::uint32_t(b) * kBlock;
         i < std::min(count, (std::uint32_t(b) + 1) * kBlock); ++i) {
      Random random(seed, i, 0);
      const double value = history(random);
      blocks[b].value += value;
      blocks[b].square += value * value;
    }
  });
  Sums all;
  for (const Sums& block : blocks) all.value += block.value, all.square += block.square;
  const double n = count, mean = all.value / n;
  return {mean, std::sqrt(std::max(0.0, all.square / n - mean * mean) / (n - 1))};
}

// A field in a box, all of its levels, with the forest of its finest.
struct Medium {
  FieldSource source;
  RenderRequest request;
  Forest forest;

  template <class Field>
  Medium(std::shared_ptr<const Chart> chart, int levels, const Phase& phase, double co_albedo,
         Field&& field)
      : source(std::move(chart), isotropic(levels), field) {
    RenderVolume volume;
    volume.source = &source;
    volume.phase = phase;
    volume.co_albedo = glm::dvec3{co_albedo};
    request.volumes.push_back(volume);
    forest = finest_forest(request, 4096);
  }
};

}  // namespace nepho::test
