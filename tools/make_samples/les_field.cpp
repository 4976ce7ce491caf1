#include "les_field.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <functional>

#include "hash_noise.h"
#include "rounding.h"

namespace nepho::samples {
namespace {

constexpr double kBase_m = 620;              // the condensation level
constexpr double kCondensed_per_m = 2.1e-6;  // kg/kg per metre of moist ascent at 293 K
constexpr double kBreak_m = 620,
                 kLeast_m = 95;  // radii: of the power law's break, and of the least
constexpr double kSouth_deg = 13.1, kWest_deg = -58.2;
constexpr double kDegree_m = 111.2e3;  // of latitude, nearly

struct Bubble {
  glm::dvec3 centre_m;
  double radius_m;
};

// One cloud in its own frame: bubbles upon bubbles over a foot at (0, 0, kBase_m).
struct Cloud {
  double x_m, y_m, radius_m, top_m;
  std::uint64_t seed;
  std::vector<Bubble> bubbles;

  double reach_m() const { return 2.2 * radius_m + 400; }
};

double smooth_min(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - h * h * blend / 4;
}

void grow(Cloud& cloud, const Bubble& parent, int generations, Dice& dice) {
  cloud.bubbles.push_back(parent);
  if (generations == 0 || parent.radius_m < 80) return;
  for (int child = 0; child < 5; ++child) {
    const double up = dice(-0.15, 1.0), angle = dice(0, 6.283185307179586);
    const double side = std::sqrt(std::max(0.0, 1 - up * up)),
                 r = parent.radius_m * dice(0.38, 0.6);
    const glm::dvec3 way = {side * std::cos(angle), side * std::sin(angle), up};
    grow(cloud, {parent.centre_m + way * (parent.radius_m - 0.35 * r), r}, generations - 1, dice);
  }
}

Cloud make_cloud(const LesShape& shape, std::uint64_t number) {
  Dice dice(shape.seed * 1000 + number);
  Cloud cloud{};
  cloud.seed = shape.seed * 1000 + number;
  // in clusters: where the boundary layer is moister
  for (int again = 0; again < 6; ++again) {
    cloud.x_m = dice(0, double(shape.nx) * shape.cell_m);
    cloud.y_m = dice(0, double(shape.ny) * shape.cell_m);
    if (gradient_noise(glm::dvec3(cloud.x_m, cloud.y_m, 0) / 2600.0, shape.seed) > 0.1) break;
  }
  // N(> r) ~ r^-0.7, so n(r) ~ r^-1.7; cut at the break
  const double low = std::pow(kLeast_m, -0.7), high = std::pow(kBreak_m, -0.7);
  cloud.radius_m = std::pow(high + (low - high) * dice(), -1 / 0.7);
  const double r = cloud.radius_m, height_m = r * dice(1.3, 2.7);
  const int turrets = 1 + int(r / 130);
  for (int turret = 0; turret < turrets; ++turret) {
    // the tallest in the middle, lower ones about it, all leaning with the wind
    const double angle = dice(0, 6.283185307179586), out = turret == 0 ? 0 : r * dice(0.4, 1.0);
    const double tall_m = height_m * (turret == 0 ? 1 : dice(0.3, 0.8));
    const double thick_m = r * (turret == 0 ? 0.62 : dice(0.34, 0.52));
    const int storeys = 2 + int(tall_m / (0.8 * thick_m));
    for (int storey = 0; storey < storeys; ++storey) {
      const double t = double(storey) / (storeys - 1);
      const double z_m = 0.15 * thick_m + t * std::max(tall_m - thick_m, 0.0);
      const glm::dvec3 centre = {out * std::cos(angle) + 0.12 * z_m + dice(-0.1, 0.1) * r,
                                 out * std::sin(angle) + dice(-0.1, 0.1) * r, z_m};
      grow(cloud, {centre, thick_m * (1.05 - 0.25 * t)}, storey == storeys - 1 ? 2 : 1, dice);
    }
  }
  for (const Bubble& b : cloud.bubbles)
    cloud.top_m = std::max(cloud.top_m, b.centre_m.z + b.radius_m);
  return cloud;
}

// Liquid water (kg/kg) of a cloud at a point in its frame.
double water_of(const Cloud& cloud, const glm::dvec3& p_m, double detail_m) {
  const double over_m = p_m.z;
  if (over_m <= 0 || over_m > cloud.top_m + 120) return 0;
  double distance_m = 400;
  glm::dvec3 bent_m = p_m;
  for (int axis = 0; axis < 3; ++axis)
    bent_m[axis] += 75 * gradient_noise(p_m / 380.0, cloud.seed * 3 + std::uint64_t(axis));
  for (const Bubble& b : cloud.bubbles)
    if (std::abs(p_m.z - b.centre_m.z) < b.radius_m + 400)
      distance_m =
          smooth_min(distance_m, glm::length(bent_m - b.centre_m) - b.radius_m, 0.35 * b.radius_m);
  if (distance_m > 130) return 0;
  // rounded cells with creases between: the skin of a cauliflower, as fine as the grid carries
  for (const double size_m : {300.0, 150.0}) {
    if (size_m < 2.5 * detail_m) continue;
    const double cell = cell_distance(p_m / size_m, cloud.seed * 7 + std::uint64_t(size_m));
    distance_m -= 0.34 * size_m * (0.72 - std::min(cell * cell, 1.2));
  }
  const double soft_m = 0.7 * detail_m;
  const double inside = smooth_step(soft_m, -soft_m, distance_m);
  const double diluted = 0.30 + 0.45 * smooth_step(0, -0.5 * cloud.radius_m, distance_m);
  const double patches = 1 + 0.3 * gradient_noise(p_m / 210.0, cloud.seed + 5);
  return inside * diluted * patches * kCondensed_per_m * over_m;
}

double temperature_K(double height_m) {
  const double under = 299.2 - 9.7e-3 * std::min(height_m, kBase_m);
  return under - 5.2e-3 * std::clamp(height_m - kBase_m, 0.0, 1300.0) +
         2.5e-3 * std::max(height_m - kBase_m - 1300, 0.0);
}
double pressure_Pa(double height_m) {
  return 101500 * std::exp(-9.80665 * height_m / (287.05 * (297 - 0.0030 * height_m)));
}
double saturated(double temperature_K, double pressure_Pa) {
  const double t = temperature_K - 273.15;
  const double e = 611.2 * std::exp(17.67 * t / (t + 243.5));
  return 0.622 * e / (pressure_Pa - 0.378 * e);
}

NcLayout layout_of(const LesShape& s) {
  const std::vector<std::string> solid = {"time", "z", "lat", "lon"};
  const auto field = [&](const char* name, const char* standard, const char* units) {
    return NcField{name, NcValue::kFloat, solid, {{"standard_name", standard}, {"units", units}}};
  };
  NcLayout layout;
  layout.axes = {{"time", 1, true}, {"z", s.nz}, {"lat", s.ny}, {"lon", s.nx}};
  layout.fields = {
      {"time",
       NcValue::kDouble,
       {"time"},
       {{"standard_name", "time"},
        {"units", "seconds since 2024-02-02 00:00:00"},
        {"calendar", "standard"},
        {"axis", "T"}}},
      {"z",
       NcValue::kFloat,
       {"z"},
       {{"standard_name", "altitude"}, {"units", "m"}, {"positive", "up"}, {"axis", "Z"}}},
      {"lat",
       NcValue::kDouble,
       {"lat"},
       {{"standard_name", "latitude"}, {"units", "degrees_north"}, {"axis", "Y"}}},
      {"lon",
       NcValue::kDouble,
       {"lon"},
       {{"standard_name", "longitude"}, {"units", "degrees_east"}, {"axis", "X"}}},
      field("ql", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1"),
      field("ta", "air_temperature", "K"),
      field("pa", "air_pressure", "Pa"),
      field("hus", "specific_humidity", "kg kg-1")};
  layout.notes = {{"Conventions", "CF-1.8"},
                  {"title", "trade-wind cumulus in the form of a large-eddy simulation"},
                  {"source", "nephoscope make_samples: made, not simulated"}};
  return layout;
}

}  // namespace

void write_les(const NcWriter& writer, const std::filesystem::path& path, const LesShape& shape) {
  const double width_m = double(shape.nx) * shape.cell_m, depth_m = double(shape.ny) * shape.cell_m;
  std::vector<Cloud> clouds;
  const auto count = std::uint64_t(std::max(1.0, 1.3e-6 * width_m * depth_m));
  for (std::uint64_t number = 0; number < count; ++number)
    clouds.push_back(make_cloud(shape, number));

  NcOutput output(writer, path, layout_of(shape));
  const auto ramp = [](std::size_t size, double first, double step) {
    std::vector<double> values(size);
    for (std::size_t at = 0; at < size; ++at) values[at] = first + step * double(at);
    return values;
  };
  const double lat_step = shape.cell_m / kDegree_m;
  const double lon_step = lat_step / std::cos(kSouth_deg * 3.14159265358979 / 180);
  output.put("time", 0, {13.0 * 3600});
  output.put("z", 0, ramp(shape.nz, 0.5 * shape.level_m, shape.level_m));
  output.put("lat", 0, ramp(shape.ny, kSouth_deg, lat_step));
  output.put("lon", 0, ramp(shape.nx, kWest_deg, lon_step));

  const std::size_t size = shape.nx * shape.ny;
  std::vector<double> water(size), temperature(size), pressure(size), vapour(size);
  for (std::size_t k = 0; k < shape.nz; ++k) {
    const double z_m = (double(k) + 0.5) * shape.level_m, p = pressure_Pa(z_m);
    const double clear_K = temperature_K(z_m);
    const double humidity = z_m < kBase_m + 1300 ? 0.78 + 0.16 * std::min(z_m / kBase_m, 1.0) : 0.3;
    tbb::parallel_for(std::size_t(0), shape.ny, [&](std::size_t j) {
      const double y_m = double(j) * shape.cell_m;
      const auto wrapped = [](double d, double period) {
        return d - period * std::round(d / period);
      };
      std::vector<const Cloud*> near;  // that reach this row
      for (const Cloud& cloud : clouds)
        if (z_m < kBase_m + cloud.top_m + 120 &&
            std::abs(wrapped(y_m - cloud.y_m, depth_m)) < cloud.reach_m())
          near.push_back(&cloud);
      for (std::size_t at = j * shape.nx; at < (j + 1) * shape.nx; ++at) {
        const double x_m = double(at % shape.nx) * shape.cell_m;
        double q = 0;
        for (const Cloud* cloud : near) {
          const glm::dvec3 local = {wrapped(x_m - cloud->x_m, width_m),
                                    wrapped(y_m - cloud->y_m, depth_m), z_m - kBase_m};
          if (std::abs(local.x) < cloud->reach_m())
            q = std::max(q, water_of(*cloud, local, shape.cell_m));
        }
        water[at] = q < 1e-6 ? 0 : kept_bits(q, 6);
        // buoyant by half a degree where it is wettest
        temperature[at] = rounded(clear_K + std::min(400 * q, 0.5), 1.0 / 8);
        pressure[at] = rounded(p, 1);
        vapour[at] = kept_bits(saturated(clear_K, p) * (q > 1e-5 ? 1 : humidity), 6);
      }
    });
    output.put("ql", k, water), output.put("ta", k, temperature);
    output.put("pa", k, pressure), output.put("hus", k, vapour);
  }
  output.finish();
}

}  // namespace nepho::samples
