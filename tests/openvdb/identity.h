#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <unordered_map>

#include "accuracy_report.h"
#include "oracle.h"
#include "vdb_files.h"

namespace nepho::test {

struct Identity {
  std::size_t voxels = 0, not_zero = 0, decoded_not_zero = 0, over = 0;
  double worst_of_bound = 0;  // |decoded - value x scale| / max_abs_error
  double worst_position = 0;  // voxels
};

inline glm::dvec3 y_up(const glm::dvec3& p) {
  return {p.x, -p.z, p.y};
}

// Every active voxel against the finest decoded sample at its place, found through the chart, and
// every finest sample that is not 0 counted: those and no others.
inline Identity compare(const BrickSource& source, double time_s, double scale_per_m,
                        const std::vector<OracleVoxel>& voxels,
                        glm::dvec3 (*to_local)(const glm::dvec3&)) {
  const VolumeInfo& info = source.info();
  const int finest = info.lattice.max_level();
  const double cells = info.lattice.cells(finest)[0];
  Identity result;
  std::unordered_map<NodeKey, Brick> bricks;
  std::unordered_map<NodeKey, double> constants;
  descend(source, time_s, [&](NodeKey key, const NodeSummary& s) {
    if (s.constant && !s.empty) constants[key] = double(s.constant_extinction_per_m);
    if (key.level() != finest) return;
    const Brick& brick = bricks.emplace(key, read(source, key, time_s)).first->second;
    for (std::uint32_t k = 0; k < 8; ++k)
      for (std::uint32_t j = 0; j < 8; ++j)
        for (std::uint32_t i = 0; i < 8; ++i)
          result.decoded_not_zero += brick.samples[brick_offset(i, j, k)] != 0;
  });
  for (const OracleVoxel& voxel : voxels) {
    const glm::dvec3 at = cells * info.chart->locate(to_local(voxel.world)).q;
    const glm::dvec3 g = glm::round(at);
    result.worst_position = std::max(result.worst_position, glm::length(at - g));
    const glm::uvec3 sample(g);
    const NodeKey key(0, finest, sample.x / 8, sample.y / 8, sample.z / 8);
    const auto found = bricks.find(key);
    const double value = voxel.value * scale_per_m;
    ++result.voxels;
    result.not_zero += value != 0;
    if (found == bricks.end()) {
      NodeKey above = key;
      while (above.level() > 0 && !constants.contains(above)) above = info.lattice.parent(above);
      const auto constant = constants.find(above);
      const double known = constant == constants.end() ? 0 : constant->second;
      result.over += std::abs(known - value) > 1e-7 * value;
      continue;
    }
    const Brick& brick = found->second;
    const double off =
        std::abs(brick.samples[brick_offset(sample.x % 8, sample.y % 8, sample.z % 8)] - value);
    if (off > 0) result.worst_of_bound = std::max(result.worst_of_bound, off / brick.max_abs_error);
  }
  return result;
}

inline void expect_identity(const char* name, const Identity& found) {
  std::printf("measured: %-22s %8zu voxels, worst error %.3f of the bound, position %.1e voxels\n",
              name, found.voxels, found.worst_of_bound, found.worst_position);
  append_accuracy_row("conformance", "openvdb: voxels off finest samples / code error",
                      found.worst_of_bound, 1, "1");
  EXPECT_EQ(found.over, 0u) << name << ": a voxel in no brick";
  EXPECT_LE(found.worst_of_bound, 1) << name;
  EXPECT_LE(found.worst_position, 1e-6) << name;
  // codes may round a value down to 0, never 0 up
  EXPECT_LE(found.decoded_not_zero, found.not_zero) << name;
}

}  // namespace nepho::test
