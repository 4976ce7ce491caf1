#include "global_forecast.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "hash_noise.h"
#include "rounding.h"

namespace nepho::samples {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::uint64_t kSeed = 5200;
constexpr double kLevels_hPa[] = {100, 150, 200, 250, 300, 350, 400, 500,
                                  600, 700, 800, 850, 900, 925, 950, 1000};
constexpr std::size_t kCount = std::size(kLevels_hPa);

// How values become 16-bit numbers: value = code * scale + offset.
struct Packing {
  double scale, offset;
  double code(double value) const { return std::round((value - offset) / scale); }
};
// The offset is not a multiple of the step in binary: code -32766 is meant as zero and unpacks to
// about -1e-19.
constexpr double kWaterStep = 1e-8;
const Packing kWater = {kWaterStep, std::nextafter(kWaterStep * 32766, 0)};
constexpr Packing kHeight = {2, 32000}, kTemperature = {0.25, 250};
constexpr double kFill = -32767;

double noise(const glm::dvec3& p, double per_radius, int octaves, std::uint64_t seed) {
  return 1.5 * fractal_noise(p * per_radius, octaves, kSeed + seed);
}

glm::dvec3 direction(double lat_rad, double lon_rad) {
  return {std::cos(lat_rad) * std::cos(lon_rad), std::cos(lat_rad) * std::sin(lon_rad),
          std::sin(lat_rad)};
}

glm::dvec3 turned(const glm::dvec3& p, const glm::dvec3& axis, double angle) {
  return p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) +
         axis * (glm::dot(axis, p) * (1 - std::cos(angle)));
}

// Amounts 0..1 of three kinds of cloud, and how low the pressure is.
struct Sky {
  double low, deep, high, storm;
};

Sky sky(double lat_deg, double lon_deg) {
  const double lat = lat_deg * kPi / 180, lon = lon_deg * kPi / 180;
  const glm::dvec3 p = direction(lat, lon);
  // Cyclones wind the air about themselves: bands follow.
  glm::dvec3 wound = p;
  double storm = 0, arms = 0;
  Dice dice(kSeed);
  for (int n = 0; n < 14; ++n) {
    const bool south = n % 2 == 1;
    const double at_lat = (south ? -1 : 1) * dice(44, 60) * kPi / 180;
    const double at_lon = (n / 2 + dice(-0.25, 0.25)) * 2 * kPi / 7, size = dice(0.11, 0.18);
    const glm::dvec3 centre = direction(at_lat, at_lon);
    const double away = std::acos(std::clamp(glm::dot(p, centre), -1.0, 1.0)) / size;
    if (away > 4) continue;
    const double near = std::exp(-away * away);
    wound = turned(wound, centre, (south ? -1 : 1) * 2.0 * near);
    storm += near;
    // a comma: one arm that winds in, from the cold front towards the equator
    const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), centre));
    const glm::dvec3 north = glm::cross(centre, east);
    const double angle = std::atan2((south ? -1 : 1) * glm::dot(p, north), glm::dot(p, east));
    const double spiral = std::cos(angle + 1.3 * std::log(away + 0.1) + 0.9);
    arms = std::max(arms, smooth_step(0.55, 1.0, spiral) * smooth_step(3.4, 1.6, away) *
                              smooth_step(0.05, 0.3, away));
  }
  const double n1 = noise(wound, 4, 3, 1), n2 = noise(wound, 8, 2, 2), n3 = noise(p, 6, 3, 3);
  const double stormy =
      smooth_step(28, 45, std::abs(lat_deg)) * smooth_step(84, 66, std::abs(lat_deg));
  const double itcz_lat = 6 + 4 * std::sin(lon + 0.8) + 2 * noise(p, 3, 2, 6);
  const double itcz = std::exp(-std::pow((lat_deg - itcz_lat) / 5.5, 2));
  const double dry = std::exp(-std::pow((std::abs(lat_deg) - 24) / 9, 2));
  Sky s{};
  s.storm = storm;
  s.deep = std::clamp(arms * (0.75 + 0.5 * n1), 0.0, 1.0) +
           itcz * smooth_step(0.0, 0.7, n3 + 0.45 * n2) + stormy * smooth_step(0.35, 0.9, n1);
  // decks in the east of three oceans, on both sides of the equator
  double decks = 0;
  for (const double deck_lon : {-125.0, -85.0, 2.0}) {
    const double off = std::remainder(lon_deg - deck_lon, 360) / 17;
    const double deck_lat = deck_lon == -125 ? 27 : -19;
    decks += std::exp(-off * off - std::pow((lat_deg - deck_lat) / 9, 2));
  }
  s.low =
      std::clamp(1.2 * decks + 0.6 * n2 * decks, 0.0, 1.0) +
      0.8 * (1 - 0.8 * dry) * smooth_step(0.15, 0.9, n2 + 0.5 * n1 + 0.2 * stormy - 0.3 * itcz) +
      0.5 * smooth_step(62, 78, std::abs(lat_deg)) * smooth_step(-0.3, 0.6, n1);
  s.high = itcz * smooth_step(-0.2, 0.8, n3) + 0.8 * arms +
           0.5 * stormy * smooth_step(0.1, 0.8, noise(wound, 8, 3, 4));
  return s;
}

double bell(double hPa, double centre, double width) {
  const double d = (hPa - centre) / width;
  return std::exp(-d * d);
}

double temperature_K(double lat_deg, double hPa, double storm) {
  const double s = std::sin(lat_deg * kPi / 180), surface = 301 - 48 * s * s - 2 * storm;
  const double height_m = 44330 * (1 - std::pow(hPa / 1013.25, 0.1903));
  return std::max(surface - 6.3e-3 * height_m, 205 + 14 * s * s);
}

struct Point {
  Sky sky;
  double lat_deg, height_m;
};

double water_at(const Point& at, double hPa) {
  // the tropics' towers reach 150 hPa, the storms' 300
  const double top = 150 + 170 * smooth_step(15, 45, std::abs(at.lat_deg));
  return 1.1e-4 * at.sky.low * bell(hPa, 910, 55) +
         1.0e-4 * at.sky.deep * smooth_step(top - 20, top + 130, hPa) * smooth_step(985, 850, hPa) +
         1.5e-5 * at.sky.high * bell(hPa, top + 70, 60);
}

NcLayout layout_of(const GlobalShape& s) {
  const auto packed = [](const char* name, const char* standard, const char* units,
                         const Packing& packing) {
    return NcField{name,
                   NcValue::kShort,
                   {"time", "level", "latitude", "longitude"},
                   {{"scale_factor", "", {packing.scale}, NcValue::kDouble},
                    {"add_offset", "", {packing.offset}, NcValue::kDouble},
                    {"_FillValue", "", {kFill}, NcValue::kShort},
                    {"missing_value", "", {kFill}, NcValue::kShort},
                    {"units", units},
                    {"standard_name", standard}}};
  };
  NcLayout layout;
  layout.axes = {{"longitude", s.nx}, {"latitude", s.ny}, {"level", kCount}, {"time", 1}};
  layout.fields = {
      {"longitude",
       NcValue::kFloat,
       {"longitude"},
       {{"units", "degrees_east"}, {"long_name", "longitude"}}},
      {"latitude",
       NcValue::kFloat,
       {"latitude"},
       {{"units", "degrees_north"}, {"long_name", "latitude"}}},
      {"level",
       NcValue::kInt,
       {"level"},
       {{"units", "millibars"}, {"long_name", "pressure_level"}}},
      {"time",
       NcValue::kInt,
       {"time"},
       {{"units", "hours since 1900-01-01 00:00:00.0"},
        {"long_name", "time"},
        {"calendar", "gregorian"}}},
      packed("gh", "geopotential_height", "gpm", kHeight),
      packed("t", "air_temperature", "K", kTemperature),
      packed("clwmr", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg**-1", kWater),
      packed("icmr", "mass_fraction_of_cloud_ice_in_air", "kg kg**-1", kWater)};
  layout.notes = {{"Conventions", "CF-1.6"},
                  {"history", "nephoscope make_samples: made, not simulated"}};
  return layout;
}

}  // namespace

void write_global(const NcWriter& writer, const std::filesystem::path& path,
                  const GlobalShape& shape) {
  NcOutput output(writer, path, layout_of(shape));
  std::vector<double> lon, lat;
  for (std::size_t i = 0; i < shape.nx; ++i) lon.push_back(360.0 * double(i) / double(shape.nx));
  for (std::size_t j = 0; j < shape.ny; ++j)
    lat.push_back(90 - 180.0 * double(j) / double(shape.ny - 1));
  output.put("longitude", 0, lon), output.put("latitude", 0, lat);
  output.put("level", 0, {std::begin(kLevels_hPa), std::end(kLevels_hPa)});
  output.put("time", 0, {1064964});  // 2021-06-28 12 UTC

  std::vector<Point> points(shape.nx * shape.ny);
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t at) {
    Point& p = points[at];
    p.lat_deg = lat[at / shape.nx];
    p.sky = sky(p.lat_deg, lon[at % shape.nx]);
    p.height_m = 110 - 190 * p.sky.storm;
  });
  const std::size_t size = points.size();
  std::vector<double> height(size), temperature(size), liquid(size), ice(size);
  for (std::size_t step = kCount; step-- > 0;) {  // from the ground up: heights add up
    const double hPa = kLevels_hPa[step];
    tbb::parallel_for(std::size_t(0), size, [&](std::size_t at) {
      Point& p = points[at];
      const double t = temperature_K(p.lat_deg, hPa, p.sky.storm);
      if (step + 1 < kCount) {
        const double below_hPa = kLevels_hPa[step + 1];
        const double mean = 0.5 * (t + temperature_K(p.lat_deg, below_hPa, p.sky.storm));
        p.height_m += 287.05 / 9.80665 * mean * std::log(below_hPa / hPa);
      }
      const double q = water_at(p, hPa), frozen = smooth_step(266, 238, t);
      height[at] = kHeight.code(p.height_m), temperature[at] = kTemperature.code(t);
      const auto water_code = [](double value) {  // 3 % steps, and nothing below 5e-7
        return value < 5e-7 ? -32766.0 : kWater.code(kept_bits(value, 4));
      };
      liquid[at] = water_code(q * (1 - frozen)), ice[at] = water_code(q * frozen);
    });
    output.put("gh", step, height), output.put("t", step, temperature);
    output.put("clwmr", step, liquid), output.put("icmr", step, ice);
  }
  output.finish();
}

}  // namespace nepho::samples
