#include "wrf_forecast.h"

#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "lambert.h"
#include "rounding.h"
#include "weather.h"

namespace nepho::samples {
namespace {

constexpr double kGravity = 9.81, kGasDry = 287.0, kHeatDry = 1004.5;  // WRF's own
constexpr double kTop_Pa = 14000, kSeaLevel_Pa = 101400;
constexpr double kTruelat1_deg = 42, kTruelat2_deg = 46, kRefLat_deg = 43.6, kStandLon_deg = -122.4;
constexpr double kStartMinutes = 780;  // of the first time since the model's start
constexpr auto kModelStart =
    std::chrono::sys_days(std::chrono::year(2024) / 7 / 19) + std::chrono::hours(12);

std::string date_text(double minutes) {
  using namespace std::chrono;
  const auto at = kModelStart + seconds(std::int64_t(std::llround(minutes * 60)));
  const auto day = floor<days>(at);
  const year_month_day date(day);
  const hh_mm_ss clock(floor<seconds>(at) - day);
  char text[40];
  std::snprintf(text, sizeof text, "%04d-%02u-%02u_%02d:%02d:%02d", int(date.year()),
                unsigned(date.month()), unsigned(date.day()), int(clock.hours().count()),
                int(clock.minutes().count()), int(clock.seconds().count()));
  return text;
}

double saturation_Pa(double temperature_K, double ice) {
  const double t = temperature_K - 273.15;
  return (1 - ice) * 611.2 * std::exp(17.67 * t / (temperature_K - 29.65)) +
         ice * 611.2 * std::exp(21.8745584 * (t - 0.01) / (temperature_K - 7.66));
}

// Levels of the mass coordinate, 1 at the ground to 0 at the top: 70 m thick at the ground and 640
// m at 14 km for 40 of them.
std::vector<double> eta_interfaces(std::size_t count) {
  std::vector<double> eta;
  const auto pressure_Pa = [](double height_m) {
    return 1e5 * std::pow(1 - 0.0065 * std::min(height_m, 11e3) / 288.15, 5.2559) *
           std::exp(-std::max(height_m - 11e3, 0.0) / 6341.6);
  };
  const double top_Pa = pressure_Pa(14.2e3);
  for (std::size_t k = 0; k <= count; ++k) {
    const double z = double(k) / double(count);
    eta.push_back((pressure_Pa(14.2e3 * (0.42 * z + 0.58 * z * z)) - top_Pa) / (1e5 - top_Pa));
  }
  eta.front() = 1, eta.back() = 0;
  return eta;
}

// WRF's reference state (p00 1e5 Pa, 290 K, lapse 50 K per e-fold of pressure, 200 K at least).
double base_surface_Pa(double height_m) {
  const double ratio = 290.0 / 50;
  return 1e5 *
         std::exp(-ratio + std::sqrt(ratio * ratio - 2 * kGravity * height_m / (50 * kGasDry)));
}
double base_temperature_K(double pressure_Pa) {
  return std::max(200.0, 290 + 50 * std::log(pressure_Pa / 1e5));
}

using Put = std::function<void(const char* field, const std::vector<double>& values)>;
using Notes = std::vector<NcNote>;

Notes notes(const char* order, const char* text, const char* units, const char* stagger,
            const char* coordinates = "XLONG XLAT XTIME") {
  Notes list = {{"FieldType", "", {104}, NcValue::kInt},
                {"MemoryOrder", order},
                {"description", text},
                {"units", units},
                {"stagger", stagger}};
  if (*coordinates) list.push_back({"coordinates", coordinates});
  return list;
}

NcField flat(const char* name, const char* text, const char* units) {
  return {
      name, NcValue::kFloat, {"Time", "south_north", "west_east"}, notes("XY ", text, units, "")};
}
NcField solid(const char* name, const char* text, const char* units, const char* stagger = "") {
  const std::string s = stagger;
  return {
      name,
      NcValue::kFloat,
      {"Time", s == "Z" ? "bottom_top_stag" : "bottom_top",
       s == "Y" ? "south_north_stag" : "south_north", s == "X" ? "west_east_stag" : "west_east"},
      notes("XYZ", text, units, stagger,
            s == "X"   ? "XLONG_U XLAT_U XTIME"
            : s == "Y" ? "XLONG_V XLAT_V XTIME"
                       : "XLONG XLAT XTIME")};
}

std::vector<NcField> fields() {
  const std::string since = "minutes since " + [] {
    std::string text = date_text(0);
    text[10] = ' ';
    return text;
  }();
  std::vector<NcField> list = {
      {"Times", NcValue::kChar, {"Time", "DateStrLen"}, {}},
      {"XTIME", NcValue::kFloat, {"Time"}, notes("0  ", since.c_str(), since.c_str(), "", "")},
      {"ZNU",
       NcValue::kFloat,
       {"Time", "bottom_top"},
       notes("Z  ", "eta values on half (mass) levels", "", "", "")},
      {"ZNW",
       NcValue::kFloat,
       {"Time", "bottom_top_stag"},
       notes("Z  ", "eta values on full (w) levels", "", "Z", "")},
      {"P_TOP", NcValue::kFloat, {"Time"}, notes("0  ", "PRESSURE TOP OF THE MODEL", "Pa", "", "")},
      flat("XLAT", "LATITUDE, SOUTH IS NEGATIVE", "degree_north"),
      flat("XLONG", "LONGITUDE, WEST IS NEGATIVE", "degree_east"),
      flat("MAPFAC_M", "Map scale factor on mass grid", ""),
      flat("SINALPHA", "Local sine of map rotation", ""),
      flat("COSALPHA", "Local cosine of map rotation", ""),
      flat("HGT", "Terrain Height", "m"),
      flat("LANDMASK", "LAND MASK (1 FOR LAND, 0 FOR WATER)", ""),
      flat("MU", "perturbation dry air mass in column", "Pa"),
      flat("MUB", "base state dry air mass in column", "Pa"),
      flat("PSFC", "SFC PRESSURE", "Pa"),
      solid("U", "x-wind component", "m s-1", "X"),
      solid("V", "y-wind component", "m s-1", "Y"),
      solid("PH", "perturbation geopotential", "m2 s-2", "Z"),
      solid("PHB", "base-state geopotential", "m2 s-2", "Z"),
      solid("T", "perturbation potential temperature theta-t0", "K"),
      solid("P", "perturbation pressure", "Pa"),
      solid("PB", "BASE STATE PRESSURE", "Pa"),
      solid("QVAPOR", "Water vapor mixing ratio", "kg kg-1"),
      solid("QCLOUD", "Cloud water mixing ratio", "kg kg-1"),
      solid("QRAIN", "Rain water mixing ratio", "kg kg-1"),
      solid("QICE", "Ice mixing ratio", "kg kg-1"),
      solid("QSNOW", "Snow mixing ratio", "kg kg-1"),
      solid("QGRAUP", "Graupel mixing ratio", "kg kg-1")};
  for (NcField& f : list)
    if (f.name == "XLAT" || f.name == "XLONG") f.notes.back().text = "XLONG XLAT";
  return list;
}

NcLayout layout_of(const WrfShape& s, const Lambert& map) {
  const auto number = [](const char* name, double value) {
    return NcNote{name, "", {value}, NcValue::kFloat};
  };
  const auto whole = [](const char* name, std::size_t value) {
    return NcNote{name, "", {double(value)}, NcValue::kInt};
  };
  const glm::dvec2 centre = map.lat_lon_deg(0, 0);
  NcLayout layout;
  layout.axes = {{"Time", s.times, true},      {"DateStrLen", 19},
                 {"west_east", s.nx},          {"south_north", s.ny},
                 {"bottom_top", s.nz},         {"bottom_top_stag", s.nz + 1},
                 {"west_east_stag", s.nx + 1}, {"south_north_stag", s.ny + 1}};
  layout.fields = fields();
  layout.notes = {{"TITLE", " OUTPUT FROM nephoscope make_samples, IN THE FORM OF WRF V4"},
                  {"START_DATE", date_text(0)},
                  {"SIMULATION_START_DATE", date_text(0)},
                  whole("WEST-EAST_GRID_DIMENSION", s.nx + 1),
                  whole("SOUTH-NORTH_GRID_DIMENSION", s.ny + 1),
                  whole("BOTTOM-TOP_GRID_DIMENSION", s.nz + 1),
                  number("DX", s.cell_m),
                  number("DY", s.cell_m),
                  {"GRIDTYPE", "C"},
                  whole("HYBRID_OPT", 0),
                  whole("MP_PHYSICS", 8),
                  number("CEN_LAT", centre.x),
                  number("CEN_LON", centre.y),
                  number("TRUELAT1", kTruelat1_deg),
                  number("TRUELAT2", kTruelat2_deg),
                  number("MOAD_CEN_LAT", kRefLat_deg),
                  number("STAND_LON", kStandLon_deg),
                  number("POLE_LAT", 90),
                  number("POLE_LON", 0),
                  whole("MAP_PROJ", 1),
                  {"MAP_PROJ_CHAR", "Lambert Conformal"}};
  return layout;
}

// What is carried from one level to the next, and the level's values.
class Columns {
 public:
  Columns(const WrfShape& shape, const Lambert& map, std::size_t time);
  void write_flat(const Put& put);
  // Values of level k, and of the interface at its foot.
  void write_level(std::size_t k, const Put& put);
  void write_winds(const Put& put);

 private:
  void raise(std::size_t cell, std::size_t k);
  std::size_t size() const { return shape_.nx * shape_.ny; }
  const WrfShape& shape_;
  const Lambert& map_;
  double east_m_;  // of the domain, where the nest has moved to
  Weather weather_;
  std::vector<double> eta_;
  std::vector<Weather::Column> columns_;
  std::vector<double> surface_Pa_, base_Pa_, geopotential_, base_geopotential_;
  std::vector<double> middle_m_, theta_, pressure_, base_pressure_, vapour_;
  std::vector<Hydrometeors> water_;
};

Columns::Columns(const WrfShape& shape, const Lambert& map, std::size_t time)
    : shape_(shape),
      map_(map),
      east_m_(shape.nest_step_m * double(time)),
      weather_(60 * shape.minutes_between * double(time)),
      eta_(eta_interfaces(shape.nz)),
      columns_(size()) {
  for (std::vector<double>* v : {&surface_Pa_, &base_Pa_, &geopotential_, &base_geopotential_,
                                 &middle_m_, &theta_, &pressure_, &base_pressure_, &vapour_})
    v->resize(size());
  water_.resize(size());
  tbb::parallel_for(std::size_t(0), size(), [&](std::size_t cell) {
    const auto centred = [&](std::size_t at, std::size_t count) {
      return (double(at) - 0.5 * double(count - 1)) * shape_.cell_m + east_m_;
    };
    Weather::Column& c = columns_[cell];
    c = weather_.column(centred(cell % shape_.nx, shape_.nx), centred(cell / shape_.nx, shape_.ny));
    c.ground.height_m = rounded(c.ground.height_m, 0.25);
    const double h = c.ground.height_m;
    double inverse_K = 0;  // mean over the height, of virtual temperature
    for (const double part : {1.0 / 6, 0.5, 5.0 / 6})
      inverse_K += 1 / (3 * 1.006 * Weather::temperature_K(c, part * h));
    surface_Pa_[cell] = rounded(kSeaLevel_Pa * std::exp(-kGravity * h * inverse_K / kGasDry), 1);
    base_Pa_[cell] = rounded(base_surface_Pa(h), 1);
    geopotential_[cell] = base_geopotential_[cell] = kGravity * h;
  });
}

void Columns::write_flat(const Put& put) {
  std::vector<double> lat(size()), lon(size()), factor(size()), sine(size()), cosine(size()),
      height(size()), land(size()), mu(size()), mub(size());
  for (std::size_t at = 0; at < size(); ++at) {
    const Weather::Column& c = columns_[at];
    const glm::dvec2 place = map_.lat_lon_deg(c.x_m, c.y_m);
    lat[at] = place.x, lon[at] = place.y, factor[at] = map_.map_factor(place.x);
    const double turn = map_.turn_rad(place.y);
    sine[at] = std::sin(turn), cosine[at] = std::cos(turn);
    height[at] = c.ground.height_m, land[at] = c.ground.inland_m > 0 ? 1 : 0;
    mu[at] = surface_Pa_[at] - base_Pa_[at], mub[at] = base_Pa_[at] - kTop_Pa;
  }
  put("XLAT", lat), put("XLONG", lon), put("MAPFAC_M", factor);
  put("SINALPHA", sine), put("COSALPHA", cosine), put("HGT", height), put("LANDMASK", land);
  put("MU", mu), put("MUB", mub), put("PSFC", surface_Pa_);
}

// One layer up: its water is the mean over its thickness, and its thickness that of its own air.
void Columns::raise(std::size_t cell, std::size_t k) {
  const Weather::Column& c = columns_[cell];
  const double middle = 0.5 * (eta_[k] + eta_[k + 1]), step = eta_[k] - eta_[k + 1];
  const double p = middle * (surface_Pa_[cell] - kTop_Pa) + kTop_Pa;
  const double pb = middle * (base_Pa_[cell] - kTop_Pa) + kTop_Pa;
  const double foot_m = geopotential_[cell] / kGravity;
  double thick_m = step * (surface_Pa_[cell] - kTop_Pa) / p * kGasDry *
                   Weather::temperature_K(c, foot_m + 50) / kGravity;
  double temperature = 0;
  Hydrometeors water;
  for (int again = 0; again < 2; ++again) {
    const double middle_m = foot_m + 0.5 * thick_m;
    temperature = Weather::temperature_K(c, middle_m);
    water = {};
    for (const double part : {1.0 / 6, 0.5, 5.0 / 6}) {
      const Hydrometeors w = weather_.water(c, foot_m + part * thick_m);
      water.cloud += w.cloud / 3, water.rain += w.rain / 3, water.ice += w.ice / 3;
      water.snow += w.snow / 3, water.graupel += w.graupel / 3;
    }
    const double cold = water.ice + water.snow, all = cold + water.cloud;
    const double cloudy = std::min(1.0, all / 2e-5);
    const double ice = all > 0 ? cold / all : 0;
    const double humidity = Weather::relative_humidity(c, middle_m);
    const double vapour_Pa = (cloudy * saturation_Pa(temperature, ice) +
                              (1 - cloudy) * humidity * saturation_Pa(temperature, 0));
    vapour_[cell] = 0.622 * vapour_Pa / (p - vapour_Pa);
#ifdef NEPHO_MUTANT_WITHOUT_VAPOUR
    const double virtual_K = temperature;
#else
    const double virtual_K = temperature * (1 + 0.608 * vapour_[cell]);
#endif
    thick_m = step * (surface_Pa_[cell] - kTop_Pa) / p * kGasDry * virtual_K / kGravity;
  }
  middle_m_[cell] = foot_m + 0.5 * thick_m;
  theta_[cell] = temperature * std::pow(1e5 / p, kGasDry / kHeatDry) - 300;
  pressure_[cell] = p - pb, base_pressure_[cell] = pb;
  water_[cell] = water;
  geopotential_[cell] += kGravity * thick_m;
  base_geopotential_[cell] +=
      step * (base_Pa_[cell] - kTop_Pa) * kGasDry * base_temperature_K(pb) / pb;
}

void Columns::write_level(std::size_t k, const Put& put) {
  // Rounded to what the fields are good for, so that they pack: 0.1 m, 1 Pa, 0.02 K, 7 bits of
  // water.
  std::vector<double> out(size());
  const auto put_each = [&](const char* name, auto&& value) {
    tbb::parallel_for(std::size_t(0), size(), [&](std::size_t at) { out[at] = value(at); });
    put(name, out);
  };
  put_each("PHB", [&](std::size_t at) { return rounded(base_geopotential_[at], 4); });
  put_each("PH", [&](std::size_t at) {
    return rounded(geopotential_[at], 4) - rounded(base_geopotential_[at], 4);
  });
  if (k == shape_.nz) return;
  tbb::parallel_for(std::size_t(0), size(), [&](std::size_t cell) { raise(cell, k); });
  put_each("P", [&](std::size_t at) {
    return rounded(pressure_[at] + base_pressure_[at], 4) - rounded(base_pressure_[at], 4);
  });
  put_each("PB", [&](std::size_t at) { return rounded(base_pressure_[at], 4); });
  put_each("T", [&](std::size_t at) { return rounded(theta_[at], 1.0 / 32); });
  put_each("QVAPOR", [&](std::size_t at) { return kept_bits(vapour_[at], 6); });
  const auto put_water = [&](const char* name, double Hydrometeors::*part) {
    put_each(name, [&](std::size_t at) {
      const double q = water_[at].*part;
      return q < 1e-7 ? 0 : kept_bits(q, 7);
    });
  };
  put_water("QCLOUD", &Hydrometeors::cloud), put_water("QRAIN", &Hydrometeors::rain);
  put_water("QICE", &Hydrometeors::ice), put_water("QSNOW", &Hydrometeors::snow);
  put_water("QGRAUP", &Hydrometeors::graupel);
  write_winds(put);
}

// On the faces between cells; slower and turned along the slope near the ground.
void Columns::write_winds(const Put& put) {
  const auto wind = [&](std::size_t i, std::size_t j, double direction) {
    const std::size_t at = std::min(j, shape_.ny - 1) * shape_.nx + std::min(i, shape_.nx - 1);
    const double over_m = middle_m_[at] - columns_[at].ground.height_m;
    const double drag = 0.4 + 0.6 * std::min(over_m / 800, 1.0);
    return kept_bits(drag * direction * Weather::wind_along_m_per_s(middle_m_[at]), 5);
  };
  std::vector<double> u((shape_.nx + 1) * shape_.ny), v(shape_.nx * (shape_.ny + 1));
  for (std::size_t at = 0; at < u.size(); ++at)
    u[at] = wind(at % (shape_.nx + 1), at / (shape_.nx + 1), std::cos(Weather::kWindTurn_rad));
  for (std::size_t at = 0; at < v.size(); ++at)
    v[at] = wind(at % shape_.nx, at / shape_.nx, std::sin(Weather::kWindTurn_rad));
  put("U", u), put("V", v);
}

}  // namespace

void write_wrf(const NcWriter& writer, const std::filesystem::path& path, const WrfShape& shape,
               const WrfChange& change) {
  const Lambert map(kTruelat1_deg, kTruelat2_deg, kRefLat_deg, kStandLon_deg);
  NcLayout layout = layout_of(shape, map);
  if (change.layout) change.layout(layout);
  NcOutput output(writer, path, layout);
  const auto put = [&](const char* field, std::size_t time, std::size_t slab,
                       std::vector<double> values) {
    if (!output.has(field)) return;
    if (change.slab) change.slab(field, time, values);
    output.put(field, slab, values);
  };
  std::string dates;
  std::vector<double> minutes, half, full;
  const std::vector<double> eta = eta_interfaces(shape.nz);
  for (std::size_t time = 0; time < shape.times; ++time) {
    minutes.push_back(kStartMinutes + shape.minutes_between * double(time));
    dates += date_text(minutes.back());
    full.insert(full.end(), eta.begin(), eta.end());
    for (std::size_t k = 0; k < shape.nz; ++k) half.push_back(0.5 * (eta[k] + eta[k + 1]));
  }
  output.put_text("Times", dates);
  put("XTIME", 0, 0, minutes), put("ZNU", 0, 0, half), put("ZNW", 0, 0, full);
  put("P_TOP", 0, 0, std::vector<double>(shape.times, kTop_Pa));
  for (std::size_t time = 0; time < shape.times; ++time) {
    Columns columns(shape, map, time);
    columns.write_flat([&](const char* field, const std::vector<double>& values) {
      put(field, time, time, values);
    });
    for (std::size_t k = 0; k <= shape.nz; ++k)
      columns.write_level(k, [&](const char* field, const std::vector<double>& values) {
        const bool staggered = std::string(field).starts_with("PH");
        put(field, time, time * (shape.nz + staggered) + k, values);
      });
  }
  output.finish();
}

}  // namespace nepho::samples
