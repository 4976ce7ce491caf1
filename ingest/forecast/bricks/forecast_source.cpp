#include "forecast/bricks/forecast_source.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <utility>

#include "forecast/bricks/box_around.h"
#include "forecast/bricks/grid_search.h"
#include "forecast/bricks/hat_remap.h"
#include "forecast/bricks/layout.h"
#include "forecast/bricks/surface_of.h"
#include "geo/place.h"
#include "pyramid/serve.h"

namespace nepho::forecast {
namespace {

constexpr std::size_t kKept = 2;
constexpr std::size_t kMostNodes = 4'000'000;  // finest; their coarse levels take 3 to 8 GB

std::string text(const char* format, double a, double b = 0) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

using Boxes = std::function<std::shared_ptr<const BoxAround>(const HatRemap&)>;

// The cells of one domain at one of its times.
struct DomainState {
  GridSearch search;
  ForecastColumns columns;

  // Of the cell that holds a place: nothing where none does, or one without data.
  std::optional<double> extinction_per_m(const GeodeticPoint& point, double extend_below_m) const {
    const auto [at, off_cells] = search.find({point.latitude_deg, point.longitude_deg});
    if (off_cells > 0) return {};
    const auto index = [](double x, int n) { return std::size_t(std::min(int(x), n - 1)); };
    const std::size_t nz = std::size_t(columns.nz);
    const std::size_t cell =
        index(at.y, columns.ny) * std::size_t(columns.nx) + index(at.x, columns.nx);
    if (!columns.without_data.empty() && columns.without_data[cell]) return {};
    const float* interface_m = &columns.interface_m[cell * (nz + 1)];
    if (point.height_m < double(interface_m[0]) - extend_below_m) return 0;
    const float* above =
        std::upper_bound(interface_m + 1, interface_m + nz + 1, float(point.height_m));
    if (above == interface_m + nz + 1) return 0;
    return double(columns.extinction_per_m[cell * nz + std::size_t(above - interface_m - 1)]);
  }
};

std::vector<DomainState> states_of(const Forecast& forecast, std::size_t time) {
  std::vector<DomainState> states;
  for (const DomainTime& d : forecast.domains(time))
    states.push_back({GridSearch(d.domain->grid(d.time)), d.domain->columns(d.time)});
  return states;
}

std::vector<HatDomain> hat_domains(const std::vector<DomainState>& states) {
  std::vector<HatDomain> domains;
  for (const DomainState& state : states) domains.push_back({state.search.grid(), state.columns});
  return domains;
}

// One time of a forecast: its hats, their coarse levels, and the model's own cells.
class Moment {
 public:
  // `boxes` gives the cubes to sample in, or null for bricks of the shell.
  Moment(const Forecast& forecast, std::size_t time, const Layout& layout, RemapOptions options,
         const Boxes& boxes)
      : options_(options),
        domains_(states_of(forecast, time)),
        remap_(layout.chart, layout.lattice, hat_domains(domains_), options),
        box_(boxes(remap_)),
        total_(pyramid(layout, HatRemap::Part::kTotal)) {
    for (DomainState& domain : domains_) domain.columns.ice_extinction_per_m = std::vector<float>();
    if (remap_.has_ice()) ice_.emplace(pyramid(layout, HatRemap::Part::kIce));
  }

  const SparsePyramid& total() const { return total_; }
  const SparsePyramid* ice() const { return ice_ ? &*ice_ : nullptr; }
  const std::vector<DomainState>& domains() const { return domains_; }

  // The model's own cells, of the finest domain that has any there; of cubes, what they sample.
  double point_extinction_per_m(const Ellipsoid& body, const glm::dvec3& ecef_m) const {
    if (box_) return remap_.interpolated(ecef_m, HatRemap::Part::kTotal);
    const GeodeticPoint point = geodetic_point(body, ecef_m);
    for (const DomainState& domain : domains_)
      if (const auto value = domain.extinction_per_m(point, options_.extend_below_m)) return *value;
    return 0;
  }

  std::uint64_t bytes() const {
    std::uint64_t bytes =
        sizeof *this + remap_.bytes() + total_.bytes() + (ice_ ? ice_->bytes() : 0);
    for (const DomainState& domain : domains_)
      bytes +=
          (domain.columns.interface_m.capacity() + domain.columns.extinction_per_m.capacity()) *
          sizeof(float);
    return bytes;
  }

 private:
  SparsePyramid pyramid(const Layout& layout, HatRemap::Part part) const {
    SparsePyramid::Field field;
    field.nodes = box_ ? box_->nodes(remap_, part) : remap_.nodes(part);
    if (field.nodes.size() > kMostNodes)
      throw Error({"the forecast has too many bricks at this resolution", "",
                   "at most " + std::to_string(kMostNodes), std::to_string(field.nodes.size()),
                   "choose a coarser vertical_resolution_m or horizontal_resolution_m"});
    field.samples = [this, part](NodeKey key, double* samples) {
      if (box_)
        box_->samples(remap_, part, key, samples);
      else
        remap_.samples(key, part, samples);
    };
    if (box_) return {*box_->chart(), box_->lattice(), std::move(field)};
    return {*layout.chart, layout.lattice, std::move(field)};
  }

  RemapOptions options_;
  std::vector<DomainState> domains_;  // finest first
  HatRemap remap_;
  std::shared_ptr<const BoxAround> box_;
  SparsePyramid total_;
  std::optional<SparsePyramid> ice_;
};

struct SourceOptions {
  LayoutOptions layout;
  double clear_below_per_m;
  Layers layers;
  bool box;
  int max_level;  // of the box; 0: as memory allows
};

class NetcdfSource final : public BrickSource {
 public:
  NetcdfSource(const std::string& name, std::shared_ptr<const Forecast> forecast,
               const SourceOptions& options)
      : options_(options),
        forecast_(std::move(forecast)),
        layout_(choose_layout(*forecast_, options.layout)) {
    remap_options_.extend_below_m = layout_.extend_below_m;
    remap_options_.clear_below_per_m = options.clear_below_per_m;
    remap_options_.layers = options.layers;
    describe(name, *moment(0));
  }

  const VolumeInfo& info() const noexcept override { return info_; }

  Status summary(NodeKey key, double time_s, NodeSummary& summary) const noexcept override {
    return answered(time_s, [&](const Moment& now) {
      return serve_summary(info_, {now.total(), now.ice()}, key, time_s, summary);
    });
  }
  Status read(NodeKey key, double time_s, BrickView brick) const noexcept override {
    return answered(time_s, [&](const Moment& now) {
      return serve_read(info_, {now.total(), now.ice()}, key, time_s, brick);
    });
  }
  Status point_extinction_per_m(const glm::dvec3& ecef_m, double time_s,
                                double& extinction_per_m) const noexcept override {
    return answered(time_s, [&](const Moment& now) {
      extinction_per_m = now.point_extinction_per_m(layout_.chart->body(), ecef_m);
      return Status::kOk;
    });
  }
  std::size_t last_error(char* buffer, std::size_t size) const noexcept override {
    return copy_last_error(buffer, size);
  }

 private:
  template <class Answer>
  Status answered(double time_s, Answer&& answer) const noexcept {
    try {
      const auto at = std::ranges::find(info_.times_s, time_s);
      if (at == info_.times_s.end()) {
        set_last_error(to_string(Status::kNoSuchTime));
        return Status::kNoSuchTime;
      }
      return answer(*moment(std::size_t(at - info_.times_s.begin())));
    } catch (const std::exception& e) {
      set_last_error(e.what());
    } catch (...) {
      set_last_error("an exception of unknown type");
    }
    return Status::kReadFailed;
  }

  std::shared_ptr<const Moment> moment(std::size_t time) const {
    const std::lock_guard lock(mutex_);
    const auto at = std::ranges::find(moments_, time, [](const auto& kept) { return kept.first; });
    if (at != moments_.end()) {
      moments_.splice(moments_.begin(), moments_, at);
      return moments_.front().second;
    }
    while (moments_.size() >= kKept) moments_.pop_back();  // first, so that never three are held
    // Isolated: a stolen task that reads another brick would wait for the lock this thread holds.
    tbb::this_task_arena::isolate([&] {
      moments_.emplace_front(time, std::make_shared<const Moment>(
                                       *forecast_, time, layout_, remap_options_,
                                       [&](const HatRemap& remap) { return box_around(remap); }));
    });
    return moments_.front().second;
  }

  // The same for all times, made for the clouds of the first.
  std::shared_ptr<const BoxAround> box_around(const HatRemap& remap) const {
    if (options_.box && !box_)
      box_ = std::make_shared<BoxAround>(layout_.chart, remap, options_.max_level);
    return box_;
  }

  void describe(const std::string& name, const Moment& first);
  void state_facts(const Moment& first);

  SourceOptions options_;
  std::shared_ptr<const Forecast> forecast_;
  Layout layout_;
  RemapOptions remap_options_;
  VolumeInfo info_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const BoxAround> box_;
  mutable std::list<std::pair<std::size_t, std::shared_ptr<const Moment>>>
      moments_;  // newest first
};

void NetcdfSource::describe(const std::string& name, const Moment& first) {
  info_.name = name;
  info_.chart = layout_.chart;
  info_.lattice = layout_.lattice;
  info_.finest = SampleKind::kHat;
  if (box_) {
    info_.chart = box_->chart();
    info_.lattice = box_->lattice();
    info_.finest = SampleKind::kPoint;
    info_.facts.push_back(text("Cubes of %.4g m around the whole planet.", box_->voxel_m()));
  }
  info_.time_origin_ns = forecast_->time_origin_ns();
  info_.times_s = forecast_->times_s();
  info_.phase = {PhaseKind::kMie, forecast_->liquid_radius_m(), info_.phase.asymmetry};
  info_.on_planet = true;
  const GroundMap ground = ground_map(*forecast_);
  info_.surface = ground.map;
  info_.channels[0].max_abs_error = largest_code_error(first.total(), info_.chart->roots());
  if (forecast_->has_ice()) {
    ChannelInfo ice = info_.channels[0];
    ice.channel = Channel::kIceExtinction;
    ice.name = "ice_extinction";
    ice.max_abs_error = first.ice() ? largest_code_error(*first.ice(), info_.chart->roots()) : 0;
    info_.channels.push_back(ice);
  }
  info_.source_bytes = sizeof *this + first.bytes();
  info_.assumptions = forecast_->assumptions();
  const std::vector<std::string> facts = forecast_->facts();
  info_.facts.insert(info_.facts.begin(), facts.begin(), facts.end());
  if (ground.map && !ground.has_water)
    info_.assumptions.push_back(
        "The data have no land mask: sea is where the ground is at or below 0.5 m.");
  state_facts(first);
}

std::optional<std::string> reading_fact(const Forecast& forecast) {
  double read = 0, held = 0;
  for (const VariableBytes& bytes : forecast.bytes_read()) {
    read += double(bytes.read);
    held += double(bytes.held);
  }
  if (!(held > 0)) return {};
  return text("Read: %.3g MB; all values of the data are %.3g MB.", read / 1e6, held / 1e6);
}

void count_cut(const ForecastColumns& columns, std::size_t& cut, std::size_t& cloudy) {
  const std::size_t nz = std::size_t(columns.nz);
  for (std::size_t top = nz; top <= columns.extinction_per_m.size(); top += nz) {
    const auto begin = columns.extinction_per_m.begin() + std::ptrdiff_t(top);
    const auto is_cloud = [](float value) { return value > 1e-5f; };
    cut += is_cloud(begin[-1]);
    cloudy += std::any_of(begin - std::ptrdiff_t(nz), begin, is_cloud);
  }
}

void NetcdfSource::state_facts(const Moment& first) {
  if (const auto reading = reading_fact(*forecast_)) info_.facts.push_back(*reading);
  info_.facts.push_back(text("Finest voxels are %.4g km wide (at most) and %.4g m high.",
                             layout_.voxel_width_m / 1000, layout_.voxel_height_m));
  if (layout_.coarsened)
    info_.facts.push_back(
        text("Cells of the finest domain, %.4g km wide, are drawn coarser: voxels as narrow "
             "everywhere would not fit memory; horizontal_resolution_m asks for others.",
             layout_.narrowest_cell_m / 1000));
  const glm::dvec2 range_m = forecast_->height_range_m();
  info_.facts.push_back(
      text("The data reach from %.0f m to %.1f km.", range_m.x, range_m.y / 1000));
  // Cloud in the topmost layer is cut, whatever the model had above it.
  std::size_t cut = 0, cloudy = 0;
  for (const DomainState& domain : first.domains()) count_cut(domain.columns, cut, cloudy);
  if (cut > 0)
    info_.facts.push_back(
        text("Clouds are cut off at the top of the data, at %.1f km, in %.0f %% of "
             "the cloudy columns.",
             range_m.y / 1000, 100.0 * double(cut) / double(cloudy)));
  if (options_.layers == Layers::kSmooth)
    info_.assumptions.push_back(
        "Within the model's layers clouds are smoothed, each with its optical depth; the file's "
        "own "
        "steps with layers constant.");
  info_.assumptions.push_back(
      text("The lowest layer is continued %.0f m below the ground.", layout_.extend_below_m));
}

}  // namespace

std::unique_ptr<BrickSource> make_source(const std::string& volume_name,
                                         std::shared_ptr<const Forecast> forecast,
                                         Parameters& parameters) {
  SourceOptions options{};
  options.layout = {parameters.positive("horizontal_resolution_m"),
                    parameters.positive("vertical_resolution_m")};
  options.clear_below_per_m = parameters.number_in("clear_below_per_m", 1e-9, 0, 1e-3);
  options.layers = parameters.choice("layers", {"smooth", "constant"}) == "smooth"
                       ? Layers::kSmooth
                       : Layers::kConstant;
  options.box = parameters.choice("chart", {"shell", "box"}) == "box";
  options.max_level = parameters.integer("max_level", 0, 0, NodeKey::kMaxSplitsZ);
  if (options.max_level > 0 && !options.box)
    throw Error({"a level without a box", parameters.where("max_level"), "chart box", "chart shell",
                 "of the shell, choose vertical_resolution_m and horizontal_resolution_m"});
  parameters.finish();
  return std::make_unique<NetcdfSource>(volume_name, std::move(forecast), options);
}

}  // namespace nepho::forecast
