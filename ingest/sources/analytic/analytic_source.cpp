#include "sources/analytic/analytic_source.h"

#include <algorithm>

#include "api/module_support.h"
#include "bricks/coarsen.h"
#include "pyramid/serve.h"
#include "sources/analytic/options.h"

// Mistakes for the conformance suite to find.
#if defined(NEPHO_MUTANT_UNITS)
#define NEPHO_MUTATION_FACTOR 1000.0
#elif defined(NEPHO_MUTANT_HALF)
#define NEPHO_MUTATION_FACTOR 0.5
#else
#define NEPHO_MUTATION_FACTOR 1.0
#endif

namespace nepho::analytic {
namespace {

// Finest nodes that may vary, above which a max_level is a mistake: about 300 MB of coarse levels.
constexpr std::size_t kMostNodes = 400'000;

class AnalyticSource final : public BrickSource {
 public:
  explicit AnalyticSource(Volume volume)
      : info_(std::move(volume.info)), kind_(std::move(volume.kind)), pyramid_(make_pyramid()) {
    info_.source_bytes = sizeof *this + pyramid_.bytes();
    info_.channels[0].max_abs_error = largest_code_error(pyramid_, info_.chart->roots());
  }

  const VolumeInfo& info() const noexcept override { return info_; }
  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return serve_summary(info_, pyramid_, key, time_s, summary);
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    return serve_read(info_, pyramid_, key, time_s, brick);
  }
  Status point_extinction_per_m(const glm::dvec3& ecef_m, double time_s,
                                double& extinction_per_m) const noexcept override {
    if (std::ranges::find(info_.times_s, time_s) == info_.times_s.end()) {
      set_last_error(to_string(Status::kNoSuchTime));
      return Status::kNoSuchTime;
    }
    RootPosition position = info_.chart->locate(ecef_m);
    // A sample on the chart's face is inside, though its position is a rounding off.
    const glm::dvec3 inside = glm::clamp(position.q, 0.0, 1.0);
    const glm::dvec3 off = glm::abs(inside - position.q);
    const bool outside = std::max({off.x, off.y, off.z}) > 1e-9;
    position.q = inside;
    extinction_per_m = outside ? 0 : kind_->extinction_per_m(position);
    return Status::kOk;
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  SparsePyramid make_pyramid() const {
    SparsePyramid::Field field;
    field.region = [this](NodeKey key) { return region(key); };
    field.samples = [this](NodeKey key, double* samples) { sample(key, samples); };
    field.most_nodes = kMostNodes;
    return {*info_.chart, info_.lattice, std::move(field)};
  }

  SparsePyramid::Region region(NodeKey key) const {
    // Half a voxel more where cells are curved: a neighbour's voxels across the cube's edge do not
    // continue this face's.
    const double grown = info_.chart->kind() == ChartKind::kShell ? 1.5 : 1;
    const Index3& n = info_.lattice.cells(key.level());
    RootBox box{key.root()};
    for (int a = 0; a < 3; ++a) {
      const double first = double(kBrickCells) * key.ijk()[std::size_t(a)];
      box.low[a] = (first - grown) / n[std::size_t(a)];
      box.high[a] = (first + kBrickCells + grown) / n[std::size_t(a)];
    }
    SparsePyramid::Region region;
    if (const std::optional<double> value = kind_->constant_in(box)) {
      region.constant = true;
      region.value = *value * NEPHO_MUTATION_FACTOR;
    }
    return region;
  }

  void sample(NodeKey key, double* samples) const {
    const Index3 g = Lattice::global_sample(key, {0, 0, 0});
    const Index3& n = info_.lattice.cells(key.level());
    for (std::uint32_t j = 0; j < kBrickSamples; ++j)
      for (std::uint32_t i = 0; i < kBrickSamples; ++i) {
        const Column owner = info_.chart->names({key.root(), g[0] + i, g[1] + j}, n).owner();
        for (std::uint32_t k = 0; k < kBrickSamples; ++k)
          samples[brick_offset(i, j, k)] =
              kind_->extinction_per_m(
                  {owner.root, info_.lattice.q(key.level(), {owner.i, owner.j, g[2] + k})}) *
              NEPHO_MUTATION_FACTOR;
      }
  }

  VolumeInfo info_;
  std::unique_ptr<Kind> kind_;
  SparsePyramid pyramid_;
};

}  // namespace

std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  return std::make_unique<AnalyticSource>(make_volume(request));
}

}  // namespace nepho::analytic

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      nepho::this_abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] { return nepho::analytic::open_source(*request); });
      }};
  return &module;
}
