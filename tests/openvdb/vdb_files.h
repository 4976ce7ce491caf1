#pragma once

#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bricks/brick_source.h"
#include "bricks/coarsen.h"
#include "bricks/quantise.h"
#include "core/error.h"
#include "host/source_host.h"
#include "test_folder.h"
#include "twins.h"

namespace nepho::test {

namespace fs = std::filesystem;

inline const fs::path& folder() {
  static const TestFolder folder("vdb");
  return folder.path();
}

inline const samples::VdbWriter& writer() {
  static const samples::VdbWriter writer({NEPHO_TEST_MODULES});
  return writer;
}

// Writes the twin and returns what a scene would name.
inline std::string twin(const std::string& name) {
  for (const samples::Twin& twin : samples::twins())
    if (twin.name == name) {
      twin.write(folder(), writer());
      return (folder() / twin.file).string();
    }
  throw std::invalid_argument("no twin " + name);
}

inline SourceParameter number(const std::string& name, double value) {
  return {name, "", value, "", false, {}};
}
inline SourceParameter word(const std::string& name, const std::string& text) {
  return {name, "", 0, text, true, {}};
}

inline std::unique_ptr<BrickSource> open(const std::string& file,
                                         std::vector<SourceParameter> parameters = {}) {
  static const SourceHost host({NEPHO_TEST_MODULES});
  VolumeSpec volume;
  volume.name = "test";
  volume.source = "openvdb";
  volume.files = {file};
  volume.parameters = std::move(parameters);
  return host.open(volume);
}

struct Brick {
  BrickSamples samples{};
  double max_abs_error = 0;
};

inline Brick read(const BrickSource& source, NodeKey key, double time_s) {
  std::array<std::uint16_t, kBrickVolume> codes;
  ChannelView view;
  view.codes = codes.data();
  if (const Status status = source.read(key, time_s, {&view, 1}); status != Status::kOk)
    throw std::runtime_error(to_string(status));
  Brick brick;
  brick.max_abs_error = view.max_abs_error;
  for (std::size_t at = 0; at < codes.size(); ++at)
    brick.samples[at] = double(decode(codes[at], view.scale, view.offset));
  return brick;
}

inline NodeSummary summary(const BrickSource& source, NodeKey key, double time_s) {
  NodeSummary summary;
  if (const Status status = source.summary(key, time_s, summary); status != Status::kOk)
    throw std::runtime_error(to_string(status));
  return summary;
}

// Every node that the children masks lead to, coarse to fine, that is not constant.
template <class Visit>
void descend(const BrickSource& source, double time_s, Visit&& visit,
             NodeKey key = NodeKey(0, 0, 0, 0, 0)) {
  const NodeSummary node = summary(source, key, time_s);
  visit(key, node);
  if (key.level() == source.info().lattice.max_level() || node.constant) return;
  for (SplitMask octant = 0; octant < 8; ++octant)
    if (node.children >> octant & 1) descend(source, time_s, visit, key.child(kSplitXyz, octant));
}

inline bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts)
    if (text.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace nepho::test
