#include "pyramid/serve.h"

#include <algorithm>
#include <exception>
#include <limits>

#include "bricks/coarsen.h"
#include "bricks/quantise.h"

namespace nepho {
namespace {

Status refused(Status status) {
  set_last_error(to_string(status));
  return status;
}

template <class Body>
Status guarded(Body&& body) noexcept {
  try {
    body();
    return Status::kOk;
  } catch (const std::exception& e) {
    set_last_error(e.what());
  } catch (...) {
    set_last_error("an exception of unknown type");
  }
  return Status::kReadFailed;
}

}  // namespace

Status serve_summary(const VolumeInfo& info, const ServedPyramids& pyramids, NodeKey key,
                     double time_s, NodeSummary& summary) noexcept {
  if (const Status status = check_request(info, key, time_s); status != Status::kOk)
    return refused(status);
  return guarded([&] {
    summary = pyramids.extinction.summary(key);
    if (!pyramids.ice_extinction) return;
    const NodeSummary ice = pyramids.ice_extinction->summary(key);
    summary.error_bound_per_m = std::max(summary.error_bound_per_m, ice.error_bound_per_m);
    if (summary.constant && ice.max_extinction_per_m > 0) {
      summary.constant = false;
      summary.constant_extinction_per_m = 0;
    }
  });
}

Status serve_read(const VolumeInfo& info, const ServedPyramids& pyramids, NodeKey key,
                  double time_s, BrickView brick) noexcept {
  if (const Status status = check_request(info, key, time_s); status != Status::kOk)
    return refused(status);
  for (const ChannelView& view : brick)
    if (std::ranges::find(info.channels, view.channel, &ChannelInfo::channel) ==
            info.channels.end() ||
        (view.channel != Channel::kExtinction && view.channel != Channel::kIceExtinction))
      return refused(Status::kNoSuchChannel);
  return guarded([&] {
    for (ChannelView& view : brick) {
      BrickSamples samples{};
      if (view.channel == Channel::kExtinction)
        pyramids.extinction.samples(key, samples.data());
      else if (pyramids.ice_extinction)
        pyramids.ice_extinction->samples(key, samples.data());
      const Quantised coded = quantise(samples, {view.codes, kBrickVolume});
      view.scale = coded.scale;
      view.offset = coded.offset;
      view.max_abs_error = coded.max_abs_error;
    }
  });
}

Status serve_summary(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key,
                     double time_s, NodeSummary& summary) noexcept {
  return serve_summary(info, ServedPyramids{pyramid, nullptr}, key, time_s, summary);
}

Status serve_read(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key, double time_s,
                  BrickView brick) noexcept {
  return serve_read(info, ServedPyramids{pyramid, nullptr}, key, time_s, brick);
}

double largest_code_error(const SparsePyramid& pyramid, int roots) {
  double most = 0;
  for (int root = 0; root < roots; ++root)
    most = std::max(most, double(pyramid.summary(NodeKey(root, 0, 0, 0, 0)).max_extinction_per_m));
  return most * (0.5 / kTopCode16 + 2 * double(std::numeric_limits<float>::epsilon()));
}

}  // namespace nepho
