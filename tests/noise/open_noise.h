#pragma once

#include <memory>
#include <string>
#include <vector>

#include "api/source_module.h"
#include "bricks/coarsen.h"
#include "bricks/quantise.h"
#include "random.h"
#include "sources/noise/noise_source.h"
#include "sources/noise/options.h"

namespace nepho::test {

// A parameter of the source, in SI.
struct Given {
  std::string name;
  double number = 0;
  std::string text = {};
};

// Calls `use` with the request that a host would make of them.
template <class Use>
auto with_request(const std::vector<Given>& given, Use&& use) {
  std::vector<RequestParameter> parameters;
  for (const Given& g : given)
    parameters.push_back({g.name.c_str(), g.text.empty() ? nullptr : g.text.c_str(), g.number, ""});
  SourceRequest request{};
  request.volume_name = "sky";
  request.parameters = parameters.data(), request.parameter_count = parameters.size();
  return use(request);
}
inline std::unique_ptr<BrickSource> open_noise(const std::vector<Given>& given) {
  return with_request(given, [](const SourceRequest& r) { return noise::open_source(r); });
}
inline noise::Planet noise_planet(const std::vector<Given>& given) {
  return with_request(given, [](const SourceRequest& r) { return noise::make_planet(r); });
}

inline const std::vector<std::string>& layer_types() {
  static const std::vector<std::string> types = {"stratus", "stratocumulus", "cumulus", "cirrus"};
  return types;
}
// One layer of a type, with its defaults.
inline std::vector<Given> one_layer(const std::string& type, std::vector<Given> more = {}) {
  more.push_back({"layer1.type", 0, type});
  return more;
}

// Extinction of a node as `read` delivers it.
inline BrickSamples read_noise(const BrickSource& source, NodeKey key) {
  std::array<std::uint16_t, kBrickVolume> codes;
  ChannelView view;
  view.codes = codes.data();
  if (const Status status = source.read(key, 0, {&view, 1}); status != Status::kOk)
    throw std::runtime_error(to_string(status));
  BrickSamples samples;
  for (std::size_t at = 0; at < samples.size(); ++at)
    samples[at] = double(decode(codes[at], view.scale, view.offset));
  return samples;
}
inline NodeSummary summary_noise(const BrickSource& source, NodeKey key) {
  NodeSummary summary;
  if (const Status status = source.summary(key, 0, summary); status != Status::kOk)
    throw std::runtime_error(to_string(status));
  return summary;
}

// A node of a level under an even draw of directions and heights.
inline NodeKey draw_node(const VolumeInfo& info, int level, Random& random) {
  const RootPosition at = info.chart->locate(6.4e6 * random.direction());
  return info.lattice.node_at(at.root, {at.q.x, at.q.y, random.uniform(0, 1)}, level);
}

}  // namespace nepho::test
