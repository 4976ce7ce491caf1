#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "forecast/conventions/names.h"
#include "forecast/forecast.h"

namespace nepho::forecast {

enum class Vapour { kNone, kSpecific, kMixingRatio, kRelative };

// The air of one time, [k][j][i] from the ground up.
struct Air {
  std::vector<float> pressure_Pa;           // or, the same for all columns,
  std::vector<double> level_pressure_Pa;    // [k]
  std::vector<float> temperature_K;         // or, the same for all columns,
  std::vector<double> level_temperature_K;  // [k]; both empty: the standard atmosphere's
  bool is_theta = false;                    // potential temperature
  // Of the base state of models that have one: a field or, the same for all columns, [k]. Both
  // empty: by pressure and temperature.
  std::vector<float> density_kg_per_m3;
  std::vector<double> level_density_kg_per_m3;
  std::vector<float> vapour;  // as `vapour_is` says
  Vapour vapour_is = Vapour::kNone;

  struct State {
    double pressure_Pa, temperature_K, specific_humidity;
    double density_kg_per_m3, dry_density_kg_per_m3;
  };
  // Cell n = j * nx + i of `cells`. NaN where something is missing.
  State at(std::size_t k, std::size_t n, std::size_t cells) const;
};

// What a convention makes of a file; ModelForecast turns it into a Forecast. Functions take the
// file's index of the time.
struct Model {
  std::string convention;
  std::shared_ptr<const DataFile> file;
  std::vector<std::int64_t> utc_ns;  // of the file's times, in its order; never empty
  int nx = 0, ny = 0, nz = 0;
  std::vector<WaterVariable> water;
  std::function<std::vector<float>(const FileVariable&, std::size_t time)> field;  // [k][j][i]
  const FileVariable* cloud_fraction = nullptr;  // in [0, 1], or percent
  const FileVariable* droplet_number = nullptr;  // per kg or per m3, as its units say
  const FileVariable *droplet_radius = nullptr, *ice_radius = nullptr;  // effective; a length
  bool has_land_mask = false;
  std::function<std::shared_ptr<const HorizontalGrid>(std::size_t time)> grid;
  std::function<Air(std::size_t time)> air;  // empty where all water is per volume
  // [(j * nx + i) * (nz + 1) + k], rising. The air where it has been read, else null.
  std::function<std::vector<float>(std::size_t time, const Air*)> interfaces_m;
  // Lowest and highest interface of a time, by less reading than interfaces_m; may be absent.
  std::function<glm::dvec2(std::size_t time)> height_range_m;
  bool heights_change = true;         // with time
  bool heights_on_ellipsoid = false;  // rather than over the sea
  std::function<ForecastGround(std::size_t time)> ground;
  std::vector<std::string> assumptions, facts;
};

// Reads the first time that holds water data. Throws Error where none does, and on water out of
// every cloud's range unless forced.
std::unique_ptr<Forecast> make_forecast(Model model, bool force);

}  // namespace nepho::forecast
