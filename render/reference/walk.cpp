#include "reference/walk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "bricks/coarsen.h"
#include "bricks/quantise.h"

namespace nepho {
namespace {

constexpr std::size_t kMaxPieces = 50'000'000;

}  // namespace

VolumeWalk::VolumeWalk(const LevelSet& levels, std::size_t volume, const Ray& ray, double t_max_m,
                       bool whole_constants)
    : levels_(levels),
      volume_(volume),
      ray_(chart_ray(levels.info(volume), ray)),
      whole_constants_(whole_constants),
      steps_(levels.steps_in_cell()),
      own_field_(levels.is_own_field()),
      noisy_(levels.has_noise()),
      start_(ray_->start(t_max_m)),
      root_(start_.root),
      cell_(start_.cell),
      t1_m_(start_.t_m),
      resume_m_(start_.t_m) {
  endless_ = whole_constants && start_.level_end_m < start_.end_m;
  if (endless_) start_.end_m = start_.level_end_m;
  done_ = !(start_.end_m > start_.t_m);
}

bool VolumeWalk::in_leaf() const {
  if (!found_ || leaf_root_ != root_) return false;
  for (std::size_t a = 0; a < 3; ++a)
    if (cell_[a] < node_.low[a] || cell_[a] >= node_.high[a]) return false;
  return true;
}

void VolumeWalk::find_leaf() {
  const Lattice& lattice = levels_.info(volume_).lattice;
  const Index3 inside = ray_->wrapped(cell_);
  leaf_ = levels_.leaf(volume_, root_, inside);
  leaf_root_ = root_;
  found_ = true;
  const Index3 &finest = lattice.cells(lattice.max_level()),
               &own = lattice.cells(leaf_.key.level());
  const Index3 at = leaf_.key.ijk();
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t size = finest[a] / own[a];
    size_bits_[a] = std::countr_zero(std::uint64_t(size));
    period_[a] = cell_[a] - std::int64_t(inside[a]);
    node_.low[a] = period_[a] + std::int64_t(at[a]) * kBrickCells * size;
    node_.high[a] = node_.low[a] + kBrickCells * size;
  }
}

void VolumeWalk::load_corners() {
  const LeafBrick& brick = *leaf_.brick;
  const IceCodes* ice = brick.ice.get();
  for (std::uint32_t c = 0; c < 8; ++c) {
    const Index3 corner = {sample_[0] + (c & 1), sample_[1] + (c >> 1 & 1), sample_[2] + (c >> 2)};
    const std::size_t at = brick_offset(corner[0], corner[1], corner[2]);
    const std::uint16_t code = brick.codes[at];
    corners_[c] = double(decode(code, brick.scale, brick.offset));
    if (ice) ice_corners_[c] = double(decode(ice->codes[at], ice->scale, ice->offset));
    if (code == 0 && brick.offset == 0) continue;  // 0 exactly: what coding did to it is nothing
    if (noisy_)
      corners_[c] += levels_.noise_per_m(volume_, leaf_, Lattice::global_sample(leaf_.key, corner));
    corners_[c] = std::max(0.0, corners_[c]);
  }
}

bool VolumeWalk::next() {
  if (done_) return false;
  if (++pieces_ > kMaxPieces) throw std::logic_error("VolumeWalk: does not end");
  t0_m_ = resume_m_;
  begin_ = end_;
  if (!in_leaf()) find_leaf();
  block_ = node_;
  const bool cells =
      kind() == NodeKind::kBrick || (leaf_.kind == NodeKind::kConstant && !whole_constants_);
  if (cells)
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t sample = (cell_[a] - node_.low[a]) >> size_bits_[a];
      sample_[a] = std::uint32_t(sample);
      block_.low[a] += sample << size_bits_[a];
      block_.high[a] = block_.low[a] + (std::int64_t(1) << size_bits_[a]);
    }
  if (leaf_.kind == NodeKind::kBrick) load_corners();

  const ChartRay::Exit exit = ray_->exit(root_, block_, t0_m_);
  t1_m_ = std::min(exit.t_m, start_.end_m);
  resume_m_ = t1_m_;
  done_ = !(exit.t_m < start_.end_m);
  if (done_) return true;
  const glm::dvec3 at = ray_->cells_at(root_, exit.t_m);
  end_ = {exit.t_m, root_, at};
  for (int a = 0; a < 3; ++a) {
    const auto i = std::size_t(a);
    if (a == exit.axis)
      cell_[i] = exit.side > 0 ? block_.high[i] : block_.low[i] - 1;
    else
      cell_[i] = std::int64_t(
          std::clamp(std::floor(at[a]), double(block_.low[i]), double(block_.high[i] - 1)));
  }
  const Lattice& lattice = levels_.info(volume_).lattice;
  const auto axis = std::size_t(exit.axis);
  if (cell_[axis] < 0 || cell_[axis] >= lattice.cells(lattice.max_level())[axis])
    done_ = !ray_->cross_end(exit, resume_m_, root_, cell_) || resume_m_ >= start_.end_m;
  return true;
}

double VolumeWalk::extinction_per_m(double t_m) const {
  if (leaf_.kind == NodeKind::kEmpty) return 0;
#if defined(NEPHO_MUTANT_OWN_IS_BRICKS)
  return brick_extinction_per_m(t_m);
#endif
  return own_field_ ? own_extinction_per_m(t_m) : brick_extinction_per_m(t_m);
}

glm::dvec3 VolumeWalk::cells_at(double t_m) const {
  if (begin_.t_m == t_m && begin_.root == leaf_root_) return begin_.at;
  if (end_.t_m == t_m && end_.root == leaf_root_) return end_.at;
  return ray_->cells_at(leaf_root_, t_m);
}

double VolumeWalk::own_extinction_per_m(double t_m) const {
  const Lattice& lattice = levels_.info(volume_).lattice;
  const Index3& n = lattice.cells(lattice.max_level());
  const glm::dvec3 at = cells_at(t_m);
  RootPosition position{leaf_root_, glm::dvec3{0.0}};
  for (int a = 0; a < 3; ++a) {
    const auto i = std::size_t(a);
    position.q[a] = std::clamp((at[a] - double(period_[i])) / double(n[i]), 0.0, 1.0);
  }
  return levels_.own_extinction_per_m(volume_, position);
}

double VolumeWalk::brick_extinction_per_m(double t_m) const {
  if (leaf_.kind == NodeKind::kConstant) return leaf_.constant_per_m;
#if defined(NEPHO_MUTANT_MARCH_HALF_BRICKS)
  return 0.5 * interpolated(corners_, t_m);
#endif
  return interpolated(corners_, t_m);
}

glm::dvec3 VolumeWalk::fraction(double t_m) const {
  const glm::dvec3 at = cells_at(t_m);
  glm::dvec3 f;
  for (int a = 0; a < 3; ++a) {
    const auto i = std::size_t(a);
    f[a] = std::clamp((at[a] - double(block_.low[i])) / double(std::int64_t(1) << size_bits_[i]),
                      0.0, 1.0);
  }
  return f;
}

namespace {

template <class Value>
Value trilinear(const std::array<Value, 8>& corners, const glm::dvec3& f) {
  const auto along_x = [&](std::size_t c) {
    return corners[c] + f.x * (corners[c + 1] - corners[c]);
  };
  const Value near = along_x(0) + f.y * (along_x(2) - along_x(0));
  const Value far = along_x(4) + f.y * (along_x(6) - along_x(4));
  return near + f.z * (far - near);
}

}  // namespace

double VolumeWalk::interpolated(const std::array<double, 8>& corners, double t_m) const {
  return trilinear(corners, fraction(t_m));
}

glm::dvec4 VolumeWalk::light(const LightTiles& tiles, double t_m) const {
  const float* tile = tiles.tile(volume_, leaf_.lit);
  const Index3& s = sample_;
  std::array<glm::dvec4, 8> corners;
  corners.fill(glm::dvec4(0, 1, 1, 1));
  for (std::uint32_t c = 0; c < 8; ++c) {
    const std::size_t at = brick_offset(s[0] + (c & 1), s[1] + (c >> 1 & 1), s[2] + (c >> 2));
    for (int i = 0; i < tiles.channels; ++i)
      corners[c][i] = double(tile[at * std::size_t(tiles.channels) + std::size_t(i)]);
  }
  return trilinear(corners, fraction(t_m));
}

double VolumeWalk::ice_part(double t_m) const {
  if (leaf_.kind != NodeKind::kBrick || !leaf_.brick->ice) return 0;
  const auto greatest = [](const auto& codes) {
    return double(codes.scale) * 65535 + double(codes.offset);
  };
  const double most = greatest(*leaf_.brick), least = 1e-5 * most;
  if (!(most > 0)) return 0;
  const double whole = std::clamp(greatest(*leaf_.brick->ice) / most, 0.0, 1.0);
  return std::clamp(
      (interpolated(ice_corners_, t_m) + least * whole) / (brick_extinction_per_m(t_m) + least),
      0.0, 1.0);
}

int VolumeWalk::sub_steps(double length_m) const {
  if (kind() != NodeKind::kBrick) return 1;
  return std::max(steps_, ray_->sub_steps(length_m, double(std::int64_t(1) << size_bits_[2])));
}

}  // namespace nepho
