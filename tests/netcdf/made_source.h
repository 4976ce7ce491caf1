#pragma once

#include <string>
#include <vector>

#include "bricks/coarsen.h"
#include "bricks/quantise.h"
#include "forecast/bricks/forecast_source.h"
#include "synthetic_forecast.h"

namespace nepho::test {

// A source made from a forecast in memory, without files and modules.
inline std::unique_ptr<BrickSource> made_source(std::shared_ptr<const forecast::Forecast> forecast,
                                                std::vector<RequestParameter> values = {}) {
  SourceRequest request{};
  request.volume_name = "made";
  request.parameters = values.data();
  request.parameter_count = values.size();
  Parameters parameters(request);
  return forecast::make_source("made", std::move(forecast), parameters);
}

inline BrickSamples read_samples(const BrickSource& source, NodeKey key, double time_s = 0,
                                 Channel channel = Channel::kExtinction) {
  std::array<std::uint16_t, kBrickVolume> codes;
  ChannelView view;
  view.channel = channel;
  view.codes = codes.data();
  if (const Status status = source.read(key, time_s, {&view, 1}); status != Status::kOk)
    throw std::runtime_error(to_string(status));
  BrickSamples samples;
  for (std::size_t at = 0; at < samples.size(); ++at)
    samples[at] = double(decode(codes[at], view.scale, view.offset));
  return samples;
}

// Finest nodes that hold something, and those beside them.
inline std::vector<NodeKey> finest_nodes(const BrickSource& source, double time_s = 0) {
  const VolumeInfo& info = source.info();
  std::vector<NodeKey> nodes;
  for (int root = 0; root < info.chart->roots(); ++root) nodes.emplace_back(root, 0, 0, 0, 0);
  for (int level = 0; level < info.lattice.max_level(); ++level) {
    std::vector<NodeKey> finer;
    for (const NodeKey key : nodes) {
      NodeSummary summary;
      source.summary(key, time_s, summary);
      const SplitMask mask = info.lattice.split_axes(level);
      for (SplitMask octant = 0; octant <= kSplitXyz; ++octant)
        if (!(octant & ~mask) && (summary.children >> octant & 1))
          finer.push_back(key.child(mask, octant));
    }
    nodes = std::move(finer);
  }
  return nodes;
}

}  // namespace nepho::test
