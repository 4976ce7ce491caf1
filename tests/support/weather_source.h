#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bricks/shell_chart.h"
#include "field_source.h"

namespace nepho::test {

// Weather of a planet: a FieldSource with dates, times without cloud, and a ground.
class WeatherSource final : public BrickSource {
 public:
  explicit WeatherSource(std::shared_ptr<const FieldSource> field)
      : field_(std::move(field)), info_(field_->info()) {
    info_.on_planet = true;
  }
  VolumeInfo& edit() { return info_; }
  std::vector<double> empty_times_s;
  double point_factor = 1;  // the source's own field over the bricks' middle value

  const VolumeInfo& info() const noexcept override { return info_; }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    if (const Status s = check_request(info_, key, time_s); s != Status::kOk) return s;
    if (!is_empty(time_s)) return field_->summary(key, 0, summary);
    summary = {};
    return Status::kOk;
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    if (const Status s = check_request(info_, key, time_s); s != Status::kOk) return s;
    return field_->read(key, 0, brick);
  }
  Status point_extinction_per_m(const glm::dvec3& ecef_m, double,
                                double& value) const noexcept override {
    const auto* shell = static_cast<const ShellChart*>(info_.chart.get());
    if (point_factor == 0) return Status::kUnsupported;
    value = point_factor * point_value(shell->locate(ecef_m));
    return Status::kOk;
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  bool is_empty(double time_s) const {
    for (const double t : empty_times_s)
      if (t == time_s) return true;
    return false;
  }
  // The finest samples, interpolated as a brick's are.
  double point_value(const RootPosition& p) const {
    const Lattice& lattice = info_.lattice;
    const Index3& n = lattice.cells(lattice.max_level());
    const NodeKey key = lattice.node_at(p.root, p.q, lattice.max_level());
    glm::dvec3 cell, f;
    for (int a = 0; a < 3; ++a) {
      const double at = p.q[a] * n[std::size_t(a)];
      cell[a] = std::min(std::floor(at), n[std::size_t(a)] - 1.0);
      f[a] = at - cell[a];
    }
    double sum = 0;
    for (std::uint32_t c = 0; c < 8; ++c) {
      const std::uint32_t x = c & 1, y = c >> 1 & 1, z = c >> 2;
      sum += (x ? f.x : 1 - f.x) * (y ? f.y : 1 - f.y) * (z ? f.z : 1 - f.z) *
             field_->sample(key, {std::uint32_t(cell.x) + x, std::uint32_t(cell.y) + y,
                                  std::uint32_t(cell.z) + z});
    }
    return sum;
  }

  std::shared_ptr<const FieldSource> field_;
  VolumeInfo info_;
};

// Gaussian blobs of cloud on the Earth, with no cloud beyond 3 widths.
struct Blob {
  double latitude_deg, longitude_deg, width_m, middle_m, half_height_m, extinction_per_m;
};

inline std::shared_ptr<const FieldSource> blobs(const std::vector<Blob>& all, int levels,
                                                double top_m = 16000) {
  const Ellipsoid earth = Ellipsoid::wgs84();
  const auto field = [=](const glm::dvec3& ecef_m) {
    const double height_m = geodetic_height_m(earth, ecef_m);
    double sum = 0;
    for (const Blob& b : all) {
      const glm::dvec3 middle =
          geodetic_to_ecef_m(earth, b.latitude_deg * 0.017453292519943295,
                             b.longitude_deg * 0.017453292519943295, height_m);
      const double away = glm::length(ecef_m - middle) / b.width_m;
      if (away > 3 || std::abs(height_m - b.middle_m) > b.half_height_m) continue;
      sum += b.extinction_per_m * std::exp(-0.5 * away * away);
    }
    return sum;
  };
  std::vector<SplitMask> splits{kSplitXyz};
  while (int(splits.size()) < levels) splits.push_back(0b011);
  return std::make_shared<FieldSource>(std::make_shared<ShellChart>(earth, 0.0, top_m),
                                       Lattice(splits), field);
}

}  // namespace nepho::test
