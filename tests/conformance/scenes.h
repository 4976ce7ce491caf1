#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "host/source_host.h"

namespace nepho::test {

// What the conformance suite runs on. Analytic scenes are built in; data files are named by the
// environment variable NEPHO_CONFORMANCE_FILES, separated by ':', and opened by their ending; @2
// after a name takes the third of its times.
struct ConformanceScene {
  std::string name;  // letters, digits and _ only
  VolumeSpec volume;
  std::string source = "analytic";  // module
  std::size_t time = 0;             // which of VolumeInfo::times_s
  // Coarse levels are expectations, not sums (procedural): they have a test of their own.
  bool conserves = true;
  friend void PrintTo(const ConformanceScene& scene, std::ostream* out) { *out << scene.name; }
};
std::vector<ConformanceScene> analytic_scenes();
std::vector<ConformanceScene> noise_scenes();
std::vector<ConformanceScene> file_scenes();

std::unique_ptr<BrickSource> open_scene(const VolumeSpec& volume);

// One node as a source delivers it.
struct DecodedBrick {
  std::vector<double> value;  // 9^3
  double max_abs_error = 0;
  std::uint64_t hash = 0;  // of codes, scale, offset, error
};
DecodedBrick read_decoded(const BrickSource& source, NodeKey key, double time_s = 0);
NodeSummary summary_of(const BrickSource& source, NodeKey key, double time_s = 0);

// Nodes by level, roots first, through the children masks, ascending: everything that is not zero
// and the nodes around it. Stops before a level of more than `most` nodes.
std::vector<std::vector<NodeKey>> nodes_by_level(const BrickSource& source, std::size_t most,
                                                 double time_s = 0);

}  // namespace nepho::test
