#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/convention.h"
#include "forecast/conventions/model.h"
#include "forecast/conventions/off_planet.h"
#include "forecast/conventions/particle_sizes.h"
#include "forecast/conventions/said.h"
#include "forecast/conventions/vertical.h"
#include "forecast/files/time_order.h"
#include "forecast/water/air.h"
#include "forecast/water/assumed_water.h"
#include "forecast/water/condensate.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

constexpr double kLargestContent_kg_per_m3 = 20e-3;  // four times a hailstorm's
constexpr double kLargestExtinction_per_m = 1;
constexpr float kHighestGround_m = 12000;
constexpr double kColdest_K = 100, kWarmest_K = 400;        // of air anywhere
constexpr double kLowest_m = -15000, kHighest_m = 1000000;  // of a model's layers
constexpr double kWholeTroposphere_m = 15000;  // data that end below may cut clouds off

std::string text(const char* format, double a, double b = 0) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

struct Loaded {
  std::size_t time = 0;
  ForecastColumns columns;
  WaterStatistics statistics;
};

class ModelForecast : public Forecast {
 public:
  ModelForecast(Model model, const OpenRequest& request)
      : model_(std::move(model)), force_(request.force), is_part_(request.is_part) {
    const auto say = [](std::vector<std::string>& to, const std::vector<std::string>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    say(model_.assumptions, model_.file->assumptions());
    say(model_.facts, model_.file->facts());
    order_times();
    has_ice_ = std::ranges::any_of(model_.water, [](const WaterVariable& w) {
      return is_ice(w.species) || w.freezes_below_K > 0;
    });
    open_first_water();
    measure_heights();
  }

  std::int64_t time_origin_ns() const override { return origin_ns_; }
  const std::vector<double>& times_s() const override { return times_s_; }
  bool has_ice() const override { return has_ice_; }
  bool has_data() const override { return has_data_; }
  std::shared_ptr<const HorizontalGrid> grid(std::size_t time) const override {
    return model_.grid(index_.at(time));
  }
  ForecastGround ground(std::size_t time) const override { return ground_of(index_.at(time)); }
  glm::dvec2 height_range_m() const override { return height_range_m_; }
  double thinnest_layer_m() const override { return thinnest_m_; }
  double liquid_radius_m() const override { return radius_m_; }
  std::vector<std::string> assumptions() const override { return model_.assumptions; }
  std::vector<std::string> facts() const override { return model_.facts; }
  std::vector<DataFacts::Recognised> recognised() const override { return model_.recognised; }
  std::vector<VariableBytes> bytes_read() const override {
    std::vector<VariableBytes> all;
    for (const FileVariable& v : model_.file->variables())
      all.push_back(model_.file->bytes_read(v));
    return all;
  }

  // What the opening has read is handed out once, not read again.
  ForecastColumns columns(std::size_t time) const override {
    index_.at(time);
    {
      const std::lock_guard guard(mutex_);
      if (first_ && first_->time == time) {
        ForecastColumns columns = std::move(first_->columns);
        first_.reset();
        return columns;
      }
    }
    return load(time).columns;
  }

 private:
  void order_times();
  void open_first_water();
  void measure_heights();
  void check(const WaterStatistics& statistics) const;
  CloudSetting setting(std::size_t index, const HorizontalGrid& grid) const;
  Loaded load(std::size_t time) const;
  ForecastGround ground_of(std::size_t index) const;
  std::vector<float> sea_level_m(std::size_t index) const;

  Model model_;
  bool force_, is_part_;
  std::int64_t origin_ns_ = 0;
  std::vector<double> times_s_;
  std::vector<std::size_t> index_;  // of the file, for each of times_s_
  bool has_ice_ = false, has_data_ = true;
  glm::dvec2 height_range_m_{0.0};
  double thinnest_m_ = 0, radius_m_ = 10e-6;
  mutable std::mutex mutex_;
  mutable std::optional<Loaded> first_;
};

void ModelForecast::order_times() {
  TimeOrder order = nepho::forecast::order_times(model_.utc_ns);
  index_ = std::move(order.state);
  std::ranges::move(order.facts, std::back_inserter(model_.facts));
  origin_ns_ = model_.utc_ns[index_.front()];
  for (const std::size_t i : index_)
    times_s_.push_back(double(model_.utc_ns[i] - origin_ns_) / 1e9);
}

// Missing places, and heights that no planet's surface has (fill values nobody named), are sea.
ForecastGround ModelForecast::ground_of(std::size_t index) const {
  ForecastGround ground = model_.ground ? model_.ground(index) : ForecastGround{};
  for (float& height : ground.height_m)
    if (!(std::abs(height) < kHighestGround_m)) height = 0;
  for (float& water : ground.water)
    water = water >= 0 && water <= 1 ? water
            : std::abs(water) < 2    ? std::clamp(water, 0.f, 1.f)
                                     : 1;
  const std::vector<float> sea_m = sea_level_m(index);
  if (sea_m.empty() || (ground.height_m.empty() && ground.water.empty())) return ground;
  // Where there is no mask, what lies at sea level is sea: told before that moves.
  const std::vector<float> given = ground.height_m;
  ground.height_m.resize(sea_m.size(), 0.0f);
  for (std::size_t n = 0; n < sea_m.size(); ++n) {
    if (ground.water.size() < sea_m.size() && !given.empty())
      ground.water.push_back(given[n] <= 0.5f ? 1.0f : 0.0f);
    ground.height_m[n] += sea_m[n];
  }
  return ground;
}

// Of each cell, over the ellipsoid; empty where that is 0.
std::vector<float> ModelForecast::sea_level_m(std::size_t index) const {
  std::vector<float> sea_m;
  if (!model_.geoid_m) return sea_m;
  const auto grid = model_.grid(index);
  for (int j = 0; j < model_.ny; ++j)
    for (int i = 0; i < model_.nx; ++i) {
      const double height_m = model_.geoid_m(grid->lat_lon_deg(i + 0.5, j + 0.5));
      sea_m.push_back(std::isfinite(height_m) ? float(height_m) : 0);
    }
  return sea_m;
}

CloudSetting ModelForecast::setting(std::size_t index, const HorizontalGrid& grid) const {
  CloudSetting setting;
  if (const FileVariable* fraction = model_.cloud_fraction) {
    setting.fraction = model_.field(*fraction, index);
    if (const UnitOf unit = unit_of(*fraction, kDimensionless); unit.fits && unit.factor != 1)
      for (float& value : setting.fraction) value = float(double(value) * unit.factor);
  }
  read_sizes(model_, index, setting);
  setting.water = ground_of(index).water;
  if (has_ice_)
    for (int j = 0; j < model_.ny; ++j)
      for (int i = 0; i < model_.nx; ++i) {
        const double latitude_deg = grid.lat_lon_deg(i + 0.5, j + 0.5).x;
        setting.latitude_deg.push_back(std::isnan(latitude_deg) ? 0 : float(latitude_deg));
      }
  return setting;
}

// Of the values as they are in the file.
DataVariable range_of(const WaterVariable& water, const std::vector<float>& values) {
  DataVariable range{.name = water.variable->name,
                     .meaning = name_of(water.species),
                     .unit = water.variable->text("units"),
                     .values = values.size()};
  for (const float value : values) {
    if (!std::isfinite(value)) {
      ++range.missing;
      continue;
    }
    range.negative += value < 0;
    if (!(range.low <= double(value))) range.low = double(value);
    if (!(range.high >= double(value))) range.high = double(value);
  }
  return range;
}

Loaded ModelForecast::load(std::size_t time) const {
  const std::size_t index = index_[time];
  Loaded result;
  result.time = time;
  ForecastColumns& columns = result.columns;
  columns.nx = model_.nx;
  columns.ny = model_.ny;
  columns.nz = model_.nz;
  const std::size_t cells = std::size_t(model_.nx) * std::size_t(model_.ny);
  const Air air = model_.air ? model_.air(index) : Air{};
  columns.interface_m = model_.interfaces_m(index, model_.air ? &air : nullptr);
#ifdef NEPHO_MUTANT_NO_GEOID
  const std::vector<float> sea_m;
#else
  const std::vector<float> sea_m = sea_level_m(index);
#endif
  for (std::size_t n = 0; !sea_m.empty() && n < columns.interface_m.size(); ++n)
    columns.interface_m[n] += sea_m[n / (std::size_t(model_.nz) + 1)];
  columns.extinction_per_m.assign(cells * std::size_t(model_.nz), 0.0f);
  if (has_ice_) columns.ice_extinction_per_m = columns.extinction_per_m;
  const CloudSetting cloud = setting(index, *model_.grid(index));
  std::vector<float>&liquid = columns.liquid_kg_per_m2, &ice = columns.ice_kg_per_m2;
  std::vector<float>& rain = columns.precipitation_kg_per_m2;
  for (std::vector<float>* path : {&liquid, &ice, &rain}) path->assign(cells, 0.0f);
  std::vector<char> empty(cells, 1);
  for (const WaterVariable& water : model_.water) {
    const bool is_cloud =
        water.species == Species::kCloudWater || water.species == Species::kCloudIce;
    const std::vector<float> values =
        water.from_fraction ? water_of_fraction(cloud.fraction, air, columns.interface_m, cells)
                            : model_.field(*water.variable, index);
    columns.variables.push_back(range_of(water, values));
    for (std::size_t n = 0; n < values.size(); n += cells)
      for (std::size_t cell = 0; cell < std::min(cells, values.size() - n); ++cell)
        if (!std::isnan(values[n + cell])) empty[cell] = 0;
    add_water(water, values, air, cloud, columns,
              is_cloud ? WaterPaths{liquid, ice} : WaterPaths{rain, rain}, result.statistics);
  }
  if (std::ranges::find(empty, 1) != empty.end()) columns.without_data = std::move(empty);
  clear_off_planet(*model_.grid(index), columns);
  check(result.statistics);
  return result;
}

void ModelForecast::check(const WaterStatistics& s) const {
  if (s.coldest_K < kColdest_K || s.warmest_K > kWarmest_K) {
    const double found_K = s.coldest_K < kColdest_K ? s.coldest_K : s.warmest_K;
    throw Error({"no cloud is as cold or as warm", model_.file->path(), "air from 100 to 400 K",
                 text("%.4g K where there is water", found_K),
                 "the units may be wrong (degC under the name K)"});
  }
  if (force_) return;
  if (s.highest_content_kg_per_m3 > kLargestContent_kg_per_m3)
    throw Error({"there is more water than any cloud holds",
                 model_.file->path() + " [" + s.highest_variable + "]", "at most 20 g/m3",
                 text("%.4g g/m3", s.highest_content_kg_per_m3 * 1e3),
                 "the units may be wrong (g/kg under the name kg/kg); --force draws it as it is"});
  if (s.highest_extinction_per_m > kLargestExtinction_per_m)
    throw Error({"extinction is higher than any cloud's",
                 model_.file->path() + " [" + s.highest_variable + "]", "at most 1 /m",
                 text("%.4g /m", s.highest_extinction_per_m), "--force draws it as it is"});
}

void ModelForecast::open_first_water() {
  for (std::size_t time = 0; time < times_s_.size(); ++time) {
    Loaded loaded = load(time);
    if (loaded.statistics.missing == loaded.statistics.values) continue;
    if (loaded.statistics.without_air > 0 &&
        loaded.columns.extinction_per_m ==
            std::vector<float>(loaded.columns.extinction_per_m.size()))
      throw Error({"there is water, but no air to go with it", model_.file->path(),
                   "pressure and temperature where there is water", "missing values only", ""});
    if (time > 0)
      model_.facts.push_back((time == 1 ? std::string("The first time holds")
                                        : "The first " + std::to_string(time) + " times hold") +
                             " fill values only and " + (time == 1 ? "is" : "are") +
                             " clear: up to " + time_text(model_.utc_ns[index_[time - 1]]) + ".");
    radius_m_ = loaded.statistics.radius_m();
    say(loaded.statistics, model_);
    first_ = std::move(loaded);
    return;
  }
  if (is_part_) {
    has_data_ = false;
    first_ = load(0);
    return;
  }
  std::string names;
  for (const WaterVariable& w : model_.water)
    names += (names.empty() ? "" : ", ") + w.variable->name;
  throw Error({"all values of the cloud water are missing",
               model_.file->path() + " [" + names + "]", "numbers",
               "fill values or NaN at all times", "write the file again"});
}

// The thickness that a tenth of all optical depth is below; of all layers alike without cloud.
double thinnest_cloudy_layer_m(const ForecastColumns& columns) {
  std::map<int, double> depth;  // by thickness in steps of 1 %
  const auto nz = std::size_t(columns.nz);
  double total = 0;
  struct Last {  // of a layer's columns, which are much alike
    int step = 0;
    double* sum = nullptr;
  };
  std::vector<Last> last(nz);
  for (std::size_t cell = 0; nz > 0 && cell * nz < columns.extinction_per_m.size(); ++cell)
    for (std::size_t k = 0; k < nz; ++k) {
      const float* z = &columns.interface_m[cell * (nz + 1) + k];
      const double thick_m = double(z[1]) - double(z[0]);
      const double weight =
          std::max(double(columns.extinction_per_m[cell * nz + k]) * thick_m, 1e-12);
      const int step = int(std::lround(std::log(thick_m) * 100));
      if (!last[k].sum || last[k].step != step) last[k] = {step, &depth[step]};
      *last[k].sum += weight;
      total += weight;
    }
  double below = 0;
  for (const auto& [step, weight] : depth)
    if ((below += weight) >= 0.1 * total) return std::exp(step / 100.0);
  return 1;
}

// Each time's lowest and highest interface, and the thinnest layer of the first time with water.
void ModelForecast::measure_heights() {
  const ForecastColumns& columns = first_->columns;
  const std::vector<float>& z = columns.interface_m;
  const std::size_t nz = std::size_t(columns.nz), cells = z.size() / (nz + 1);
  double low = 1e30, high = -1e30;
  for (std::size_t n = 0; n < cells; ++n) {
    low = std::min(low, double(z[n * (nz + 1)]));
    high = std::max(high, double(z[n * (nz + 1) + nz]));
  }
  // Of other times the sea's lowest and highest place are added.
  const std::vector<float> sea_m = sea_level_m(index_[first_->time]);
  const auto sea = sea_m.empty() ? std::pair{0.0, 0.0}
                                 : std::pair{double(*std::ranges::min_element(sea_m)),
                                             double(*std::ranges::max_element(sea_m))};
  for (std::size_t time = 0; model_.heights_change && time < index_.size(); ++time) {
    if (time == first_->time) continue;
    if (model_.height_range_m) {
      const glm::dvec2 range = model_.height_range_m(index_[time]);
      low = std::min(low, range.x + sea.first);
      high = std::max(high, range.y + sea.second);
      continue;
    }
    const std::vector<float> other = model_.interfaces_m(index_[time], nullptr);
    for (std::size_t n = 0; n < cells; ++n) {
      low = std::min(low, double(other[n * (nz + 1)]) + sea.first);
      high = std::max(high, double(other[n * (nz + 1) + nz]) + sea.second);
    }
  }
  if (!(low > kLowest_m && high < kHighest_m))
    throw Error({"the layers are in no atmosphere", model_.file->path(),
                 text("heights from %.0f to %.0f m", kLowest_m, kHighest_m),
                 text("%.6g to %.6g m", low, high), "the units of the heights may be wrong"});
  height_range_m_ = {low, high};
  thinnest_m_ = thinnest_cloudy_layer_m(columns);
  if (high < kWholeTroposphere_m)
    model_.facts.push_back(
        text("The data end at %.1f km: clouds that reach higher are cut off flat.", high * 1e-3));
}

}  // namespace

std::unique_ptr<Forecast> make_forecast(Model model, const OpenRequest& request) {
  if (request.geoid && !model.heights_on_ellipsoid) model.geoid_m = egm96_m();
  return std::make_unique<ModelForecast>(std::move(model), request);
}

}  // namespace nepho::forecast
