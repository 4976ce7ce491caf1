#include "vdb_source.h"

#include <algorithm>
#include <cmath>

#include "bricks/box_chart.h"
#include "bricks/quantise.h"
#include "core/error.h"
#include "loaded_frame.h"

namespace nepho::vdb {
namespace {

constexpr double kMeanOpticalDepth = 10;  // of the default density scale
constexpr double kFramesPerSecond = 24;
constexpr double kMostExtinction_per_m = 1e30;  // codes are scaled by floats

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

Status refused(Status status) {
  set_last_error(to_string(status));
  return status;
}

// Mean over index columns of the optical depth along up, for a density scale of 1. The columns are
// those whose cross-section is nearest to horizontal; in a sheared grid their share of a vertical
// line is volume over horizontal area.
struct ColumnMean {
  double depth_m = 0, columns = 0;
};
ColumnMean column_mean(const VdbGrid& grid, const glm::dmat3& voxel_m) {
  std::size_t best = 0;
  double flattest = -1, area_m2 = 0;
  for (int a = 0; a < 3; ++a) {
    const glm::dvec3 normal = glm::cross(voxel_m[(a + 1) % 3], voxel_m[(a + 2) % 3]);
    const double flatness = std::abs(normal.z) / glm::length(normal);
    if (flatness > flattest)
      best = std::size_t(a), flattest = flatness, area_m2 = std::abs(normal.z);
  }
  const ColumnSum sum = grid.columns(best);
  if (!(sum.columns > 0)) return {};
  const double rise_m = std::abs(glm::determinant(voxel_m)) / area_m2;
  return {sum.values * rise_m / sum.columns, sum.columns};
}

class VdbSource final : public BrickSource {
 public:
  explicit VdbSource(const SourceRequest& request)
      : options_(parse_options(request)),
        layout_(lay_out(options_, request.placement)),
        cache_(layout_, [this, log = Log{request.log_sink, request.log_context}](
                            std::size_t file, const Tally& tally) { warn(log, file, tally); }) {
    describe();
    load_first();
  }

  const VolumeInfo& info() const noexcept override { return info_; }

  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return answered(key, time_s, [&](const LoadedFrame& frame) { summary = frame.summary(key); });
  }

  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    for (const ChannelView& view : brick)
      if (view.channel != Channel::kExtinction) return refused(Status::kNoSuchChannel);
    return answered(key, time_s, [&](const LoadedFrame& frame) {
      BrickSamples samples;
      frame.samples(key, samples.data());
      for (ChannelView& view : brick) {
        const Quantised q = quantise(samples, {view.codes, std::size_t(kBrickVolume)});
        view.scale = q.scale, view.offset = q.offset, view.max_abs_error = q.max_abs_error;
      }
    });
  }

  Status point_extinction_per_m(const glm::dvec3& ecef_m, double time_s,
                                double& extinction_per_m) const noexcept override {
    return answered(NodeKey(0, 0, 0, 0, 0), time_s, [&](const LoadedFrame& frame) {
      const glm::dvec3 q = layout_.chart->locate(ecef_m).q;
      const bool inside = glm::all(glm::greaterThanEqual(q, glm::dvec3(0.0))) &&
                          glm::all(glm::lessThanEqual(q, glm::dvec3(1.0)));
      extinction_per_m = inside ? frame.point(double(layout_.cover) * q) : 0;
    });
  }

  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  template <class Answer>
  Status answered(NodeKey key, double time_s, Answer&& answer) const noexcept {
    try {
      if (const Status status = check_request(info_, key, time_s); status != Status::kOk)
        return refused(status);
      const auto at = std::ranges::find(info_.times_s, time_s) - info_.times_s.begin();
      answer(*cache_.get(shown_[std::size_t(at)].file));
      return Status::kOk;
    } catch (const std::exception& e) {
      set_last_error(e.what());
    } catch (...) {
      set_last_error("unknown failure");
    }
    return Status::kReadFailed;
  }

  void describe();
  void choose_frames();
  void load_first();
  double choose_scale(const VdbGrid* grid);
  void report(const LoadedFrame& frame);
  struct Log {
    LogSink sink;
    void* context;
  };
  void warn(const Log& log, std::size_t file, const Tally& tally) const;

  Options options_;
  VolumeLayout layout_;
  VolumeInfo info_;
  std::vector<Frame> shown_;  // one per time
  mutable FrameCache cache_;
};

void VdbSource::describe() {
  info_.name = options_.volume_name;
  info_.chart = layout_.chart;
  info_.lattice = layout_.lattice;
  info_.finest = SampleKind::kPoint;
  info_.bounds = layout_.bounds;
  info_.assumptions = layout_.assumptions;
  info_.facts = layout_.facts;
  choose_frames();
}

void VdbSource::choose_frames() {
  const std::vector<Frame>& all = layout_.sequence.frames;
  const long first = all.front().number;
  shown_ = all;
  if (options_.frames_per_second && !layout_.sequence.is_pattern)
    throw Error({"frames per second of what is no sequence", options_.file,
                 "a pattern such as smoke.####.vdb", "fps " + text(*options_.frames_per_second),
                 ""});
  if (options_.frame) {
    const long wanted = *options_.frame;
    if (!layout_.sequence.is_pattern)
      throw Error({"a frame of what is no sequence", options_.file,
                   "a pattern such as smoke.####.vdb", "frame " + std::to_string(wanted), ""});
    if (wanted < first || wanted > all.back().number)
      throw Error({"no such frame", options_.file,
                   std::to_string(first) + " to " + std::to_string(all.back().number),
                   std::to_string(wanted), ""});
    shown_ = {all[std::size_t(wanted - first)]};
    if (std::ranges::binary_search(layout_.sequence.gaps, wanted))
      info_.assumptions.push_back("Frame " + std::to_string(wanted) + " is missing: " +
                                  layout_.sequence.files[shown_.front().file] + " is drawn.");
  }
  info_.times_s.clear();
  for (const Frame& frame : shown_)
    info_.times_s.push_back(double(frame.number - first) /
                            options_.frames_per_second.value_or(kFramesPerSecond));
}

double VdbSource::choose_scale(const VdbGrid* grid) {
  if (options_.density_scale_per_m) return *options_.density_scale_per_m;
  const ColumnMean mean = grid ? column_mean(*grid, layout_.voxel_m) : ColumnMean{};
  if (!(mean.depth_m > 0)) {
    info_.assumptions.push_back("Extinction = density x 1 1/m: there is no density to go by.");
    return 1;
  }
  const double scale_per_m = kMeanOpticalDepth / mean.depth_m;
  info_.assumptions.push_back(
      "Extinction = density x " + text(scale_per_m) + " 1/m: mean optical depth along up is " +
      text(kMeanOpticalDepth) + " over " + text(mean.columns) + " columns with active voxels" +
      (layout_.sequence.is_pattern ? " of " + layout_.sequence.files[layout_.first_file] + "."
                                   : "."));
  return scale_per_m;
}

void VdbSource::load_first() {
  std::unique_ptr<VdbGrid> grid;
  if (layout_.has_voxels())
    grid = read_grid(layout_.sequence.files[layout_.first_file], layout_.grid);
  const double scale_per_m = choose_scale(grid.get());
  const double most_per_m = grid ? grid->tally().max * scale_per_m : 0;
  if (!(most_per_m <= kMostExtinction_per_m))
    throw Error({"the extinction is out of range", options_.file + " [" + layout_.grid + "]",
                 "at most " + text(kMostExtinction_per_m) + " 1/m", text(most_per_m) + " 1/m", ""});
  cache_.set_scale(scale_per_m);
  report(*cache_.put(layout_.first_file, std::move(grid)));
}

void VdbSource::report(const LoadedFrame& frame) {
  const Tally& tally = frame.grid().tally();
  const VdbHeader& header = layout_.headers[layout_.first_file];
  const std::string of =
      layout_.sequence.is_pattern ? " in " + layout_.sequence.files[layout_.first_file] : "";
  if (header.has_grid)
    info_.facts.push_back("Grid " + header.grid + " (" + header.value_type +
                          "): " + std::to_string(tally.active) + " active voxels, values up to " +
                          text(tally.max) + of + ".");
  const auto count = [&](std::uint64_t number, const char* what) {
    if (number > 0) info_.facts.push_back(std::to_string(number) + what + of + ".");
  };
  if (tally.active > 0)
    info_.facts.push_back("The tree takes " + std::to_string(frame.grid().bytes()) +
                          " bytes, all that is held " + std::to_string(frame.bytes()) + of + ".");
  count(tally.non_finite, " active values are not finite and were set to 0");
  count(tally.negative, " active values are negative and were set to 0");
  count(tally.inactive_not_zero, " inactive values differ from 0 and count as 0");
  info_.source_bytes = frame.bytes();
  // As the quantiser makes it, for the largest value; later frames state theirs in each brick.
  BrickSamples extremes{};
  extremes[0] = tally.max * cache_.scale_per_m();
  std::array<std::uint16_t, kBrickVolume> codes;
  info_.channels[0].max_abs_error = quantise(extremes, codes).max_abs_error;
}

// Each time a frame is loaded, so that no picture is made of changed data without a word.
void VdbSource::warn(const Log& log, std::size_t file, const Tally& tally) const {
  if (!log.sink || tally.non_finite + tally.negative == 0) return;
  const std::string text = layout_.sequence.files[file] + " [" + layout_.grid +
                           "]: " + std::to_string(tally.non_finite) +
                           " active values are not finite and " + std::to_string(tally.negative) +
                           " are negative: they count as 0";
  log.sink(log.context, LogLevel::kWarning, text.c_str());
}

}  // namespace

std::unique_ptr<BrickSource> open_source(const SourceRequest& request) {
  return std::make_unique<VdbSource>(request);
}

}  // namespace nepho::vdb
