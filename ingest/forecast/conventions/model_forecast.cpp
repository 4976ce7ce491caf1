#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "forecast/conventions/model.h"
#include "forecast/conventions/particle_sizes.h"
#include "forecast/conventions/vertical.h"
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
  ModelForecast(Model model, bool force) : model_(std::move(model)), force_(force) {
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
  std::shared_ptr<const HorizontalGrid> grid(std::size_t time) const override {
    return model_.grid(index_.at(time));
  }
  ForecastGround ground(std::size_t time) const override { return ground_of(index_.at(time)); }
  glm::dvec2 height_range_m() const override { return height_range_m_; }
  double thinnest_layer_m() const override { return thinnest_m_; }
  double liquid_radius_m() const override { return radius_m_; }
  std::vector<std::string> assumptions() const override { return model_.assumptions; }
  std::vector<std::string> facts() const override { return model_.facts; }
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
  void say(const WaterStatistics& statistics);
  void check(const WaterStatistics& statistics) const;
  CloudSetting setting(std::size_t index, const HorizontalGrid& grid) const;
  Loaded load(std::size_t time) const;
  ForecastGround ground_of(std::size_t index) const;

  Model model_;
  bool force_;
  std::int64_t origin_ns_ = 0;
  std::vector<double> times_s_;
  std::vector<std::size_t> index_;  // of the file, for each of times_s_
  bool has_ice_ = false;
  glm::dvec2 height_range_m_{0.0};
  double thinnest_m_ = 0, radius_m_ = 10e-6;
  mutable std::mutex mutex_;
  mutable std::optional<Loaded> first_;
};

// Ascending; of two states of one time the later in the file stays.
void ModelForecast::order_times() {
  index_.resize(model_.utc_ns.size());
  std::iota(index_.begin(), index_.end(), std::size_t{0});
  const auto ns = [&](std::size_t i) { return model_.utc_ns[i]; };
  std::ranges::stable_sort(index_, {}, ns);
  std::vector<std::size_t> kept;
  for (const std::size_t i : index_) {
    if (!kept.empty() && ns(kept.back()) == ns(i)) kept.pop_back();
    kept.push_back(i);
  }
  if (kept.size() < index_.size())
    model_.facts.push_back(std::to_string(index_.size() - kept.size()) +
                           " times occur twice; the later state of each is used.");
  index_ = std::move(kept);
  origin_ns_ = ns(index_.front());
  for (const std::size_t i : index_) times_s_.push_back(double(ns(i) - origin_ns_) / 1e9);
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
  return ground;
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

// Cells with a corner off a satellite's disc, or without corners, hold nothing.
void clear_off_planet(const HorizontalGrid& grid, ForecastColumns& columns) {
  const std::size_t nz = std::size_t(columns.nz), nx = std::size_t(columns.nx);
  const auto clear = [&](std::size_t cell) {
    for (std::vector<float>* values : {&columns.extinction_per_m, &columns.ice_extinction_per_m})
      if (!values->empty()) std::fill_n(values->begin() + std::ptrdiff_t(cell * nz), nz, 0.0f);
  };
  if (const CellPolygons* polygons = grid.polygons()) {
    for (std::size_t cell = 0; cell < nx; ++cell)
      if (polygons->first[cell + 1] == polygons->first[cell]) clear(cell);
    return;
  }
  // Each corner once.
  const auto missing_at = [&](int y) {
    std::vector<char> row;
    for (std::size_t x = 0; x <= nx; ++x)
      row.push_back(std::isnan(grid.lat_lon_deg(double(x), y).x));
    return row;
  };
  std::vector<char> low = missing_at(0);
  for (int y = 0; y < columns.ny; ++y) {
    std::vector<char> high = missing_at(y + 1);
    for (std::size_t x = 0; x < nx; ++x)
      if (low[x] || low[x + 1] || high[x] || high[x + 1]) clear(std::size_t(y) * nx + x);
    low = std::move(high);
  }
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
  columns.extinction_per_m.assign(cells * std::size_t(model_.nz), 0.0f);
  if (has_ice_) columns.ice_extinction_per_m = columns.extinction_per_m;
  const CloudSetting cloud = setting(index, *model_.grid(index));
  std::vector<float> cloud_path(cells, 0.0f), rain_path(cells, 0.0f);
  std::vector<char> empty(cells, 1);
  for (const WaterVariable& water : model_.water) {
    const bool is_cloud =
        water.species == Species::kCloudWater || water.species == Species::kCloudIce;
    const std::vector<float> values =
        water.from_fraction ? water_of_fraction(cloud.fraction, air, columns.interface_m, cells)
                            : model_.field(*water.variable, index);
    for (std::size_t n = 0; n < values.size(); ++n)
      if (!std::isnan(values[n])) empty[n % cells] = 0;
    add_water(water, values, air, cloud, columns, is_cloud ? cloud_path : rain_path,
              result.statistics);
  }
  if (std::ranges::find(empty, 1) != empty.end()) columns.without_data = std::move(empty);
  clear_off_planet(*model_.grid(index), columns);
  WaterStatistics& s = result.statistics;
  s.highest_cloud_kg_per_m2 = double(*std::ranges::max_element(cloud_path));
  s.highest_precipitation_kg_per_m2 = double(*std::ranges::max_element(rain_path));
  s.mean_cloud_kg_per_m2 =
      std::accumulate(cloud_path.begin(), cloud_path.end(), 0.0) / double(cells);
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
      model_.facts.push_back("The first " + std::to_string(time) +
                             " times hold fill values only: they are clear.");
    radius_m_ = loaded.statistics.radius_m();
    say(loaded.statistics);
    first_ = std::move(loaded);
    return;
  }
  std::string names;
  for (const WaterVariable& w : model_.water)
    names += (names.empty() ? "" : ", ") + w.variable->name;
  throw Error({"all values of the cloud water are missing",
               model_.file->path() + " [" + names + "]", "numbers",
               "fill values or NaN at all times", "write the file again"});
}

void ModelForecast::say(const WaterStatistics& s) {
  auto& facts = model_.facts;
  // The range of EGM2008: Pavlis et al. (2012), doi:10.1029/2011JB008916.
  if (!model_.heights_on_ellipsoid)
    model_.assumptions.push_back(
        "Heights above sea level are taken as above the ellipsoid: the geoid lies 107 m below to "
        "86 m above it.");
  std::string names;
  for (const WaterVariable& w : model_.water) {
    names += (names.empty() ? "" : ", ") + w.variable->name + " (" + name_of(w.species) +
             (w.freezes_below_K > 0 && w.liquid_above_K <= w.freezes_below_K
                  ? text(", ice below %.0f degC", w.freezes_below_K - constants::kZeroCelsius_K)
              : w.freezes_below_K > 0 ? " and ice"
                                      : std::string()) +
             ")";
    if (std::string note = w.row ? untested(*model_.file, w.row->quantity, *w.variable) : "";
        !note.empty())
      model_.assumptions.push_back(std::move(note));
  }
  facts.push_back("Water: " + names + ".");
  if (const std::string wrote = model_of_file(*model_.file); !wrote.empty())
    facts.push_back("The names are those of " + wrote + ".");
  for (SaidOfSizes& said : said_of_sizes(model_, s))
    model_.assumptions.push_back(std::move(said.how));
  facts.push_back(text("Cloud water of a column: up to %.3g kg/m2, mean %.3g kg/m2.",
                       s.highest_cloud_kg_per_m2, s.mean_cloud_kg_per_m2));
  if (s.highest_precipitation_kg_per_m2 > 0)
    facts.push_back(text("Rain, snow and graupel of a column: up to %.3g kg/m2.",
                         s.highest_precipitation_kg_per_m2));
  if (s.negative > 0)
    facts.push_back(std::to_string(s.negative) +
                    text(" negative water values, down to %.3g, are taken as 0.", s.lowest));
  if (s.missing > 0)
    facts.push_back(std::to_string(s.missing) + text(" of %.0f water values are missing: no cloud "
                                                     "there.",
                                                     double(s.values)));
  if (s.without_air > 0)
    facts.push_back(std::to_string(s.without_air) +
                    " water values have no pressure or temperature: no cloud there.");
}

// The thickness that a tenth of all optical depth is below; of all layers alike without cloud.
double thinnest_cloudy_layer_m(const ForecastColumns& columns) {
  std::map<int, double> depth;  // by thickness in steps of 1 %
  const auto nz = std::size_t(columns.nz);
  double total = 0;
  for (std::size_t cell = 0; nz > 0 && cell * nz < columns.extinction_per_m.size(); ++cell)
    for (std::size_t k = 0; k < nz; ++k) {
      const float* z = &columns.interface_m[cell * (nz + 1) + k];
      const double thick_m = double(z[1]) - double(z[0]);
      const double weight =
          std::max(double(columns.extinction_per_m[cell * nz + k]) * thick_m, 1e-12);
      depth[int(std::lround(std::log(thick_m) * 100))] += weight;
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
  for (std::size_t time = 0; model_.heights_change && time < index_.size(); ++time) {
    if (time == first_->time) continue;
    if (model_.height_range_m) {
      const glm::dvec2 range = model_.height_range_m(index_[time]);
      low = std::min(low, range.x);
      high = std::max(high, range.y);
      continue;
    }
    const std::vector<float> other = model_.interfaces_m(index_[time], nullptr);
    for (std::size_t n = 0; n < cells; ++n) {
      low = std::min(low, double(other[n * (nz + 1)]));
      high = std::max(high, double(other[n * (nz + 1) + nz]));
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

Air::State Air::at(std::size_t k, std::size_t n, std::size_t cells) const {
  State state{};
  const std::size_t at = k * cells + n;
  state.pressure_Pa = pressure_Pa.empty() ? level_pressure_Pa[k] : double(pressure_Pa[at]);
  if (temperature_K.empty() && level_temperature_K.empty()) {
    state.temperature_K = standard_temperature_K(standard_geopotential_height_m(state.pressure_Pa));
  } else {
    state.temperature_K =
        temperature_K.empty() ? level_temperature_K[k] : double(temperature_K[at]);
    if (is_theta)
      state.temperature_K = temperature_of_theta_K(state.temperature_K, state.pressure_Pa);
  }
  double q = vapour.empty() ? 0 : double(vapour[at]);
  if (!(q > 0)) q = 0;  // missing vapour is dry air: 1 % of the density
  if (vapour_is == Vapour::kMixingRatio) q = q / (1 + q);
  if (vapour_is == Vapour::kRelative)
    q = specific_humidity(q, state.temperature_K, state.pressure_Pa);
  state.specific_humidity = q;
  state.density_kg_per_m3 =
      !density_kg_per_m3.empty() ? double(density_kg_per_m3[at])
      : !level_density_kg_per_m3.empty()
          ? level_density_kg_per_m3[k]
          : moist_density_kg_per_m3(state.pressure_Pa, state.temperature_K, q);
  state.dry_density_kg_per_m3 = state.density_kg_per_m3 * (1 - q);
  return state;
}

std::unique_ptr<Forecast> make_forecast(Model model, bool force) {
  return std::make_unique<ModelForecast>(std::move(model), force);
}

}  // namespace nepho::forecast
