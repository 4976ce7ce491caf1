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

Status serve_summary(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key,
                     double time_s, NodeSummary& summary) noexcept {
  if (const Status status = check_request(info, key, time_s); status != Status::kOk)
    return refused(status);
  return guarded([&] { summary = pyramid.summary(key); });
}

Status serve_read(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key, double time_s,
                  BrickView brick) noexcept {
  if (const Status status = check_request(info, key, time_s); status != Status::kOk)
    return refused(status);
  for (const ChannelView& view : brick)
    if (view.channel != Channel::kExtinction) return refused(Status::kNoSuchChannel);
  return guarded([&] {
    BrickSamples samples;
    pyramid.samples(key, samples.data());
    for (ChannelView& view : brick) {
      const Quantised coded = quantise(samples, {view.codes, kBrickVolume});
      view.scale = coded.scale;
      view.offset = coded.offset;
      view.max_abs_error = coded.max_abs_error;
    }
  });
}

double largest_code_error(const SparsePyramid& pyramid, int roots) {
  double most = 0;
  for (int root = 0; root < roots; ++root)
    most = std::max(most, double(pyramid.summary(NodeKey(root, 0, 0, 0, 0)).max_extinction_per_m));
  return most * (0.5 / kTopCode16 + 2 * double(std::numeric_limits<float>::epsilon()));
}

}  // namespace nepho
