// WRF-ARW output (wrfout_d0*): the WRF Users' Guide, chapter 5 and appendix; mass-coordinate
// columns between staggered geopotentials, Arakawa C grid.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>

#include "core/error.h"
#include "forecast/conventions/convention.h"
#include "forecast/conventions/field_reader.h"
#include "forecast/conventions/horizontal.h"
#include "forecast/conventions/levels.h"
#include "forecast/conventions/model.h"
#include "forecast/conventions/particle_sizes.h"
#include "forecast/conventions/wrf_grid.h"
#include "forecast/files/file_time.h"
#include "forecast/water/air.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

// WRF's own constants (share/module_model_constants.F).
constexpr double kGravity_m_per_s2 = 9.81;
constexpr double kThetaBase_K = 300;
constexpr int kWsm3 = 3;  // MP_PHYSICS of the scheme with one condensate

int dimension(const DataFile& file, const std::string& name) {
  const auto& all = file.dimensions();
  const auto at = std::ranges::find(all, name, &FileDimension::name);
  return at == all.end() ? -1 : int(at - all.begin());
}

// Reads of one file that all hooks of the Model share.
class WrfFile {
 public:
  explicit WrfFile(std::shared_ptr<const DataFile> file);

  // Hooks hold `self`.
  static Model model(const std::shared_ptr<WrfFile>& self, const std::optional<Region>& region);

 private:
  const FileVariable& need(const char* name) const;
  std::vector<float> sum(const char* base, const char* rest, int z, std::size_t time, int first,
                         int count) const;
  std::vector<float> interfaces_m(std::size_t time) const;
  glm::dvec2 height_range_m(std::size_t time) const;
  Air air(std::size_t time) const;
  ForecastGround ground(std::size_t time) const;
  std::shared_ptr<const HorizontalGrid> grid(std::size_t time) const;
  bool moves() const;
  void restrict_to(const Region& region, Model& model);
  std::vector<std::int64_t> times_ns(Model& model) const;
  void find_condensate(Model& model) const;
  double interface_m(double geopotential, double surface_geopotential) const;

  std::shared_ptr<const DataFile> file_;
  FieldReader reader_, whole_;  // of the region, of the whole domain
  int z_ = -1, z_staggered_ = -1;
  mutable std::mutex mutex_;
  mutable std::map<std::size_t, WrfGrid> grids_;
};

WrfFile::WrfFile(std::shared_ptr<const DataFile> file) : file_(std::move(file)) {
  reader_.file = file_;
  reader_.time = dimension(*file_, "Time");
  reader_.x = dimension(*file_, "west_east");
  reader_.y = dimension(*file_, "south_north");
  z_ = dimension(*file_, "bottom_top");
  z_staggered_ = dimension(*file_, "bottom_top_stag");
  for (const auto& [id, name] : {std::pair{reader_.x, "west_east"},
                                 {reader_.y, "south_north"},
                                 {z_, "bottom_top"},
                                 {z_staggered_, "bottom_top_stag"}})
    if (id < 0)
      throw Error({"the WRF file has no grid to put clouds on", file_->path(),
                   std::string("a dimension ") + name, "none of this name", ""});
  reader_.nx = int(file_->size(reader_.x));
  reader_.ny = int(file_->size(reader_.y));
  if (file_->size(z_staggered_) != file_->size(z_) + 1)
    throw Error(
        {"the WRF file's levels do not fit together", file_->path(),
         "bottom_top_stag one more than bottom_top",
         std::to_string(file_->size(z_staggered_)) + " and " + std::to_string(file_->size(z_)),
         ""});
  whole_ = reader_;
}

const FileVariable& WrfFile::need(const char* name) const {
  const FileVariable* variable = file_->find(name);
  if (!variable)
    throw Error({"the WRF file lacks a variable", file_->path(), name, "no variable of this name",
                 "keep PH, PHB, P, PB, T and QVAPOR beside the water when you cut a file down"});
  return *variable;
}

std::vector<float> WrfFile::sum(const char* base, const char* rest, int z, std::size_t time,
                                int first, int count) const {
  std::vector<float> values = reader_.levels(need(base), z, false, time, first, count);
  const std::vector<float> more = reader_.levels(need(rest), z, false, time, first, count);
  for (std::size_t n = 0; n < values.size(); ++n) values[n] += more[n];
  return values;
}

// The model's ground is at geopotential / 9.81 (its HGT); from there upwards geopotential is
// energy, whatever g the model takes: geometric height by standard gravity that falls with height.
double WrfFile::interface_m(double geopotential, double surface_geopotential) const {
  const auto height_m = [](double phi) {
    return height_of_geopotential_height_m(phi / constants::kStandardGravity_m_per_s2);
  };
  return surface_geopotential / kGravity_m_per_s2 + height_m(geopotential) -
         height_m(surface_geopotential);
}

std::vector<float> WrfFile::interfaces_m(std::size_t time) const {
  const int levels = int(file_->size(z_staggered_));
  const std::vector<float> phi = sum("PHB", "PH", z_staggered_, time, 0, levels);
  const std::size_t cells = std::size_t(reader_.nx) * std::size_t(reader_.ny);
  std::vector<float> result(phi.size());
  for (std::size_t k = 0; k < std::size_t(levels); ++k)
    for (std::size_t n = 0; n < cells; ++n)
      result[n * std::size_t(levels) + k] =
          float(interface_m(double(phi[k * cells + n]), double(phi[n])));
  return rising_interfaces(std::move(result), std::size_t(levels), file_->path() + " [PH, PHB]");
}

glm::dvec2 WrfFile::height_range_m(std::size_t time) const {
  const int top = int(file_->size(z_staggered_)) - 1;
  const std::vector<float> low = sum("PHB", "PH", z_staggered_, time, 0, 1);
  const std::vector<float> high = sum("PHB", "PH", z_staggered_, time, top, 1);
  glm::dvec2 range{1e30, -1e30};
  for (std::size_t n = 0; n < low.size(); ++n) {
    range.x = std::min(range.x, interface_m(double(low[n]), double(low[n])));
    range.y = std::max(range.y, interface_m(double(high[n]), double(low[n])));
  }
  return range;
}

Air WrfFile::air(std::size_t time) const {
  Air air;
  const int levels = int(file_->size(z_));
  air.pressure_Pa = sum("PB", "P", z_, time, 0, levels);
  air.temperature_K = reader_.field(need("T"), z_, false, time);
  for (float& value : air.temperature_K) value += float(kThetaBase_K);
  air.is_theta = true;
  if (const FileVariable* vapour = file_->find("QVAPOR")) {
    air.vapour = reader_.field(*vapour, z_, false, time);
    air.vapour_is = Vapour::kMixingRatio;
  }
  return air;
}

ForecastGround WrfFile::ground(std::size_t time) const {
  ForecastGround ground;
  if (const FileVariable* height = file_->find("HGT"); height && reader_.is_surface(*height))
    ground.height_m = reader_.surface(*height, time);
  if (const FileVariable* land = file_->find("LANDMASK"); land && reader_.is_surface(*land)) {
    ground.water = reader_.surface(*land, time);
    for (float& value : ground.water) value = 1 - value;
  }
  return ground;
}

bool WrfFile::moves() const {
  const FileVariable* latitude = file_->find("XLAT");
  return latitude &&
         std::ranges::find(latitude->dimensions, reader_.time) != latitude->dimensions.end();
}

// Rows and columns that are in the region at any time, so that all times have the same number.
void WrfFile::restrict_to(const Region& region, Model& model) {
  std::vector<std::shared_ptr<const HorizontalGrid>> places;
  for (std::size_t time = 0; time < (moves() ? file_->size(reader_.time) : 1); ++time)
    places.push_back(grid(time));
  const CellWindow window = window_of(places, region, file_->path());
  model.facts.push_back(window_fact(region, window, *places.front()));
  for (auto& [time, place] : grids_) place.cells = windowed(place.cells, window);
  reader_.restrict_to(window, false);
}

// Grids are few and small; a moving nest has one per time.
std::shared_ptr<const HorizontalGrid> WrfFile::grid(std::size_t time) const {
  const std::size_t key = moves() ? time : 0;
  {
    const std::lock_guard guard(mutex_);
    if (const auto at = grids_.find(key); at != grids_.end()) return at->second.cells;
  }
  WrfGrid made = wrf_grid(whole_, key);
  const std::lock_guard guard(mutex_);
  return grids_.emplace(key, std::move(made)).first->second.cells;
}

std::vector<std::int64_t> WrfFile::times_ns(Model& model) const {
  const std::size_t count = reader_.time < 0 ? 1 : file_->size(reader_.time);
  if (count == 0)
    throw Error({"the file has no times", file_->path(), "at least one", "Time = 0", ""});
  std::vector<std::int64_t> times;
  if (const FileVariable* texts = file_->find("Times")) {
    for (const std::string& text : file_->read_texts(*texts))
      if (const auto ns = parse_date_ns(text)) times.push_back(*ns);
    if (times.size() == count) return times;
  }
  const FileVariable* minutes = file_->find("XTIME");
  if (minutes && is_time_unit(minutes->text("units"))) {
    times = read_times_ns(*file_, *minutes);
    if (times.size() == count) return times;
  }
  std::string start = file_->text("SIMULATION_START_DATE");
  if (start.empty()) start = file_->text("START_DATE");
  if (const auto origin = parse_date_ns(start); origin && minutes) {
    times.clear();
    for (const double value : file_->read_all(*minutes))
      times.push_back(*origin + std::llround(value * 60e9));
    if (times.size() == count) return times;
  }
  if (count > 1)
    throw Error({"the WRF file does not say which times it holds", file_->path(),
                 "Times, or XTIME with its start", "neither", ""});
  model.assumptions.push_back("The file has no time: 1970-01-01 00:00 UTC is taken.");
  return {0};
}

// Schemes with one condensate, ice below freezing, do not say so in the variables.
void WrfFile::find_condensate(Model& model) const {
  model.water = find_water(
      *file_, [&](const FileVariable& variable) { return reader_.is_field(variable, z_); });
  require_water(*file_, model.water);
  const bool has_ice = std::ranges::any_of(
      model.water, [](const WaterVariable& water) { return is_ice(water.species); });
  if (file_->number("MP_PHYSICS") == kWsm3 && !has_ice) {
    for (WaterVariable& water : model.water)
      water.freezes_below_K = water.liquid_above_K = constants::kZeroCelsius_K;
    model.facts.push_back(
        "WSM3 (MP_PHYSICS 3) has one condensate: QCLOUD is ice and QRAIN snow below 0 degC.");
  }
  const auto accept = [&](const FileVariable& v) { return reader_.is_field(v, z_); };
  model.cloud_fraction = find_named(*file_, names::kCloudFraction, accept);
  find_sizes(accept, model);
  const FileVariable* land = file_->find("LANDMASK");
  model.has_land_mask = land && reader_.is_surface(*land);
}

Model WrfFile::model(const std::shared_ptr<WrfFile>& self, const std::optional<Region>& region) {
  const DataFile& file = *self->file_;
  Model model;
  model.convention = "WRF-ARW";
  model.file = self->file_;
  model.nz = int(file.size(self->z_));
  self->find_condensate(model);
  for (const char* name : {"PH", "PHB", "P", "PB", "T"}) self->need(name);
  model.utc_ns = self->times_ns(model);
  const auto cells = self->grid(0);
  const WrfGrid& first = self->grids_.at(0);
  model.assumptions = first.assumptions;
  if (!first.placed)
    model.assumptions.push_back(kNoPlace);
  else if (std::string fact = compare_with_map(file, *cells); !fact.empty())
    model.facts.push_back(std::move(fact));
  if (region) self->restrict_to(*region, model);
  model.nx = self->reader_.nx;
  model.ny = self->reader_.ny;
  if (!file.find("QVAPOR"))
    model.assumptions.push_back("There is no QVAPOR: the air is taken as dry (1 % of density).");
  model.field = [self](const FileVariable& variable, std::size_t time) {
    return self->reader_.field(variable, self->z_, false, time);
  };
  model.grid = [self](std::size_t time) { return self->grid(time); };
  model.air = [self](std::size_t time) { return self->air(time); };
  model.interfaces_m = [self](std::size_t time, const Air*) { return self->interfaces_m(time); };
  model.height_range_m = [self](std::size_t time) { return self->height_range_m(time); };
  model.ground = [self](std::size_t time) { return self->ground(time); };
  return model;
}

int recognise(const DataFile& file) {
  if (file.text("TITLE").find("WRF") != std::string::npos) return 100;
  return file.find("PHB") && file.find("PH") && dimension(file, "bottom_top_stag") >= 0 ? 90 : 0;
}

std::unique_ptr<Forecast> open_wrf(std::shared_ptr<const DataFile> file,
                                   const OpenRequest& request) {
  return make_forecast(WrfFile::model(std::make_shared<WrfFile>(std::move(file)), request.region),
                       request.force);
}

}  // namespace

const Convention kWrf = {"WRF-ARW", recognise, open_wrf};

}  // namespace nepho::forecast
