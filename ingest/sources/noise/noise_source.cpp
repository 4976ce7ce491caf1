#include "sources/noise/noise_source.h"

#include <algorithm>
#include <exception>

#include "api/module_support.h"
#include "bricks/quantise.h"
#include "sources/noise/field.h"
#include "sources/noise/options.h"

namespace nepho::noise {
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

class NoiseSource final : public BrickSource {
 public:
  explicit NoiseSource(Planet planet)
      : info_(std::move(planet.info)),
        chart_(planet.chart),
        field_(std::move(planet.layers), planet.chart, info_.lattice) {
    info_.source_bytes = sizeof *this;
  }

  const VolumeInfo& info() const noexcept override { return info_; }

  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    if (const Status status = check_request(info_, key, time_s); status != Status::kOk)
      return refused(status);
    return guarded([&] { summary = summarise(key); });
  }

  Status read(NodeKey key, double time_s, BrickView views) const noexcept override {
    if (const Status status = check_request(info_, key, time_s); status != Status::kOk)
      return refused(status);
    for (const ChannelView& view : views)
      if (std::ranges::find(info_.channels, view.channel, &ChannelInfo::channel) ==
          info_.channels.end())
        return refused(Status::kNoSuchChannel);
    return guarded([&] {
      FieldBrick brick;
      field_.brick(key, brick);
      for (ChannelView& view : views) {
        const bool ice = view.channel == Channel::kIceExtinction;
        const Quantised coded = quantise(ice ? brick.ice : brick.total, {view.codes, kBrickVolume});
        view.scale = coded.scale, view.offset = coded.offset;
        view.max_abs_error = coded.max_abs_error;
      }
    });
  }

  Status point_extinction_per_m(const glm::dvec3& ecef_m, double time_s,
                                double& extinction_per_m) const noexcept override {
    if (std::ranges::find(info_.times_s, time_s) == info_.times_s.end())
      return refused(Status::kNoSuchTime);
    const glm::dvec3 scaled = chart_->to_scaled(ecef_m);
    const double radius_m = std::sqrt(glm::dot(scaled, scaled));
    extinction_per_m = 0;
    if (!(radius_m > 0)) return Status::kOk;
    return guarded([&] {
      extinction_per_m =
          field_.extinction_per_m(scaled / radius_m, radius_m - chart_->body().equatorial_m);
    });
  }

  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  NodeSummary summarise(NodeKey key) const {
    NodeSummary summary;
    const FieldBound bound = field_.bound(key);
    if (!(bound.most_per_m > 0)) return summary;
    FieldBrick brick;
    field_.brick(key, brick);
    const auto [least, most] = std::ranges::minmax(brick.total);
    summary.empty = !(most > 0);
    const bool finest = key.level() == info_.lattice.max_level();
    if (!finest) {
      const SplitMask mask = info_.lattice.split_axes(key.level());
      for (SplitMask octant = 0; octant <= kSplitXyz; ++octant)
        if ((octant & ~mask) == 0 && field_.bound(key.child(mask, octant)).most_per_m > 0)
          summary.children |= std::uint8_t(1u << octant);
    }
    const double below = summary.children ? bound.most_per_m : most;
    summary.constant = summary.empty && !summary.children;
    if (summary.constant) return summary;
    summary.max_extinction_per_m = decoded_bound(below);
    if (!summary.children && finest && least > 0)
      summary.min_extinction_per_m = float(least * (1 - 1e-6));
    summary.unresolved_variance_per_m2 = brick.variance_per_m2;
    summary.error_bound_per_m = finest ? 0 : bound.error_per_m;
    return summary;
  }

  VolumeInfo info_;
  std::shared_ptr<const ShellChart> chart_;
  Field field_;
};

}  // namespace

std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  return std::make_unique<NoiseSource>(make_planet(request));
}

}  // namespace nepho::noise
