#include "gl/planet_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bricks/box_chart.h"
#include "bricks/shell_chart.h"
#include "optics/phase_table.h"
#include "physics/physics_cpp.h"

namespace nepho::gl {
namespace {

// Less than this of the air's light is not worth a sun map.
constexpr double kLeastShadow = 1e-3;
// Lower hills, and a smaller part of land in a place, are left out.
constexpr double kLeastTerrain_m = 1, kLeastLand = 1e-3;
constexpr double kLeastWarp_m = 300;
// Bands of height of the sun map: no thinner, and no more.
constexpr double kLeastBand_m = 2000;
constexpr int kMostBands = 4;

template <class Number, std::size_t N, class Vector>
void store(Number (&to)[N], const Vector& from) {
  for (std::size_t i = 0; i < N; ++i) to[i] = Number(from[int(i)]);
}

bool endless(const Chart& chart) {
  const auto* box = dynamic_cast<const BoxChart*>(&chart);
  return box && (box->periodic().x || box->periodic().y);
}

// Where there is extinction, and how much.
struct Clouds {
  std::vector<glm::dvec4> balls;  // around each leaf with extinction: centre, radius
  double top_radius_m = 0;        // scaled
  double bottom_radius_m = 1e30;  // scaled
  double most_per_m = 0;
  bool endless = false;
};

class PlanetBuilder {
 public:
  PlanetBuilder(const RenderRequest& request, const Forest& forest)
      : request_(request), forest_(forest), planet_(*request.planet) {}

  PlanetScene run() {
    PlanetData& data = scene_.data;
    data.radius_m = planet_.body.equatorial_m;
    data.z_scale = planet_.body.equatorial_m / planet_.body.polar_m;
    data.pixel_rad =
        float(2 * std::tan(0.5 * request_.camera.vertical_fov_rad) / request_.settings.height);
    set_air();
    set_ground();
    find_clouds();
    set_outer();
    set_sun_map();
    return scene_;
  }

 private:
  glm::dvec3 scaled(const glm::dvec3& p) const { return {p.x, p.y, p.z * scene_.data.z_scale}; }

  void set_air() {
    if (!planet_.air) return;
    const Air& air = *planet_.air;
    PlanetData& data = scene_.data;
    scene_.air = true;
    store(data.rayleigh_per_m, air.rayleigh_per_m);
    store(data.aerosol_per_m, air.aerosol_extinction_per_m);
    store(data.aerosol_scattering_per_m, air.aerosol_albedo * air.aerosol_extinction_per_m);
    store(data.ozone_per_m, air.ozone_per_m);
    data.rayleigh_scale_m = float(air.rayleigh_scale_m);
    data.aerosol_scale_m = float(air.aerosol_scale_m);
    data.aerosol_asymmetry = float(air.aerosol_asymmetry);
    data.ozone_low_m = float(air.ozone_low_m);
    data.ozone_peak_m = float(air.ozone_peak_m);
    data.ozone_high_m = float(air.ozone_high_m);
    data.air_top_m = float(air.top_m);
  }

  void set_ground() {
    PlanetData& data = scene_.data;
    store(data.land_albedo, planet_.ground.land_albedo);
    store(data.water_albedo, planet_.ground.water_albedo);
    data.slope_variance = f32::water_slope_variance(float(planet_.ground.wind_m_per_s));
    data.cloud_asymmetry = 0.85f;
    if (!request_.volumes.empty())
      data.cloud_asymmetry = float(phase_bulk(request_.volumes[0].phase).asymmetry[1]);
    scene_.surface = request_.terrain;
    for (const RenderVolume& volume : request_.volumes)
      if (!scene_.surface) scene_.surface = volume.source->info().surface.get();
    if (scene_.surface && scene_.surface->nx > 1 && scene_.surface->ny > 1)
      set_surface(*scene_.surface);
    else
      scene_.surface = nullptr;
  }

  void set_surface(const SurfaceMap& map) {
    PlanetData& data = scene_.data;
    scene_.terrain = true;
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) data.surface_axes[3 * row + c] = map.axes[row][c];
    store(data.surface_low_rad, map.low_rad);
    data.surface_per_rad[0] = 1 / map.step_rad.x;
    data.surface_per_rad[1] = 1 / map.step_rad.y;
    data.surface_nx = map.nx;
    data.surface_ny = map.ny;
    data.surface_around = map.around;
    const double north_m = planet_.body.polar_m * map.step_rad.y;
    double least_m = north_m, steepest = 1e-3, top_m = 0;
    const auto height = [&](int i, int j) {
      return std::max(0.0, double(map.height_m[std::size_t(j * map.nx + i)]));
    };
    for (int j = 0; j < map.ny; ++j) {
      const double level = std::cos(map.low_rad.y + j * map.step_rad.y);
      const double east_m = std::max(planet_.body.polar_m * map.step_rad.x * level, 1.0);
      if (level > 0.1) least_m = std::min(least_m, east_m);
      for (int i = 0; i < map.nx; ++i) {
        const double here = height(i, j);
        top_m = std::max(top_m, here);
        const int next = i + 1 < map.nx ? i + 1 : 0;
        double slope = next > i || map.around ? std::abs(height(next, j) - here) / east_m : 0;
        if (j + 1 < map.ny) slope = std::hypot(slope, (height(i, j + 1) - here) / north_m);
        steepest = std::max(steepest, std::min(slope, 10.0));
      }
    }
    data.surface_top_m = float(top_m);
    data.surface_cell_m = float(least_m);
    data.surface_slope = float(steepest);
    double land = 0;
    for (const float water : map.water) land = std::max(land, 1 - double(water));
    scene_.surface_known = true;
    scene_.terrain_top_m = top_m;
    scene_.terrain_change = land;
    scene_.terrain = top_m >= kLeastTerrain_m || land >= kLeastLand || request_.leave_nothing_out;
    if (!scene_.terrain) scene_.surface = nullptr;
  }

  void find_clouds() {
    for (const VolumeTree& tree : forest_.volumes) {
      const VolumeInfo& info = tree.source->info();
      const bool shell = info.chart->kind() == ChartKind::kShell;
      for (const TreeNode& node : tree.nodes) {
        if (node.kind != NodeKind::kConstant && node.kind != NodeKind::kBrick) continue;
        clouds_.endless = clouds_.endless || endless(*info.chart);
        clouds_.most_per_m = std::max(clouds_.most_per_m, double(node.majorant_per_m));
        const Index3 n = info.lattice.nodes(node.key.level());
        const glm::dvec3 count{double(n[0]), double(n[1]), double(n[2])};
        const glm::dvec3 at{double(node.key.i()), double(node.key.j()), double(node.key.k())};
        const auto corner = [&](const glm::dvec3& c) {
          return info.chart->ecef_m({node.key.root(), (at + c) / count});
        };
        const glm::dvec3 low = corner(glm::dvec3(0.0)), high = corner(glm::dvec3(1.0));
        // Arcs bulge over their chords.
        clouds_.balls.emplace_back((low + high) / 2.0,
                                   (shell ? 0.6 : 0.5) * glm::length(high - low));
        for (int c = shell ? 7 : 0; c < 8; ++c)
          clouds_.top_radius_m =
              std::max(clouds_.top_radius_m,
                       glm::length(scaled(corner(glm::dvec3(c & 1, c >> 1 & 1, c >> 2)))));
        for (int c = 0; c < (shell ? 1 : 8); ++c)
          clouds_.bottom_radius_m =
              std::min(clouds_.bottom_radius_m,
                       glm::length(scaled(corner(glm::dvec3(c & 1, c >> 1 & 1, c >> 2)))));
      }
    }
#if defined(NEPHO_MUTANT_CLOUDS_FORGOTTEN)
    clouds_.balls.clear();
#endif
    scene_.clouds = !clouds_.balls.empty() ||
                    ((request_.leave_nothing_out || request_.any_tree) && !forest_.volumes.empty());
    scene_.data.cloud_top_m = float(std::max(0.0, clouds_.top_radius_m - scene_.data.radius_m));
  }

  // Around air, and all charts whatever they hold: walks begin within.
  void set_outer() {
    double outer_m = scene_.data.radius_m + (planet_.air ? planet_.air->top_m : 0.0);
    for (const VolumeTree& tree : forest_.volumes) {
      const Chart& chart = *tree.source->info().chart;
      if (endless(chart)) outer_m = 1e15;  // never outside
      for (int root = 0; root < chart.roots(); ++root)
        for (int p = 0; p < 50; ++p)
          outer_m = std::max(
              outer_m,
              glm::length(scaled(chart.ecef_m({root, {p % 5 / 4.0, p / 5 % 5 / 4.0, p / 25}}))));
    }
    scene_.data.outer_m = outer_m + 100;
  }

  void set_sun_map() {
    if (!scene_.air || clouds_.balls.empty()) return;
    PlanetData& data = scene_.data;
    const double radius_m = data.radius_m;
    const glm::dvec3 eye_m = request_.camera.eye_m;
    const double eye_height_m = std::max(glm::length(scaled(eye_m)) - radius_m, 2.0);
    const double within = std::min(1.0, data.outer_m / glm::length(scaled(eye_m)));
    const glm::dvec3 center_m = within * eye_m;
    const glm::dvec3 to_sun = glm::normalize(request_.sun.to_sun);
    const glm::dvec3 up = glm::normalize(center_m);
    glm::dvec3 u = glm::cross(up, to_sun);
    u = glm::length(u) > 1e-3
            ? glm::normalize(u)
            : glm::normalize(glm::cross(to_sun, glm::dvec3(to_sun.y, to_sun.z, to_sun.x)));
    const glm::dvec3 v = glm::cross(to_sun, u);
    // No farther than clouds are in sight over the horizon.
    const double turn = std::acos(radius_m / (radius_m + eye_height_m)) +
                        std::acos(radius_m / (radius_m + data.cloud_top_m));
    const double sight_m =
        2 * (radius_m + data.cloud_top_m) * std::sin(std::min(turn, std::numbers::pi) / 2) +
        data.cloud_top_m;
    double extent_m = 0;
    for (const glm::dvec4& ball : clouds_.balls) {
      const glm::dvec3 q = glm::dvec3(ball) - center_m;
      extent_m = std::max(
          {extent_m, std::abs(glm::dot(q, u)) + ball.w, std::abs(glm::dot(q, v)) + ball.w});
    }
    if (clouds_.endless) extent_m = sight_m;
    extent_m = std::min(extent_m, sight_m);
    scene_.sun_map_change = -std::expm1(-clouds_.most_per_m * 2 * extent_m);
#if defined(NEPHO_MUTANT_BOLD_PREDICTION)
    scene_.sun_map_change *= 0.01;
#endif
    scene_.sun_map =
        scene_.sun_map_change >= kLeastShadow || request_.leave_nothing_out || request_.any_tree;
    store(data.map_center_m, center_m);
    for (int c = 0; c < 3; ++c) {
      data.map_axes[c] = u[c];
      data.map_axes[3 + c] = v[c];
      data.map_axes[6 + c] = to_sun[c];
    }
    const double warp_m =
        std::clamp(0.1 * eye_height_m, kLeastWarp_m, std::max(extent_m / 3, kLeastWarp_m));
    data.map_warp_m = float(warp_m);
    data.map_range = float(std::asinh(extent_m / warp_m));
    set_bands();
    const double side = std::sqrt(double(request_.settings.width) * request_.settings.height);
    scene_.map_size = std::clamp(16 * int(side / 16), 128, 512);
  }

  // A texel holds what is in one band as one cloud: decks far apart have bands of their own.
  void set_bands() {
    PlanetData& data = scene_.data;
    data.cloud_bottom_m =
        float(std::min(clouds_.bottom_radius_m - data.radius_m, double(data.cloud_top_m)));
    const double thickness_m = double(data.cloud_top_m) - data.cloud_bottom_m;
    scene_.map_bands = request_.any_tree
                           ? kMostBands
                           : std::clamp(int(std::ceil(thickness_m / kLeastBand_m)), 1, kMostBands);
    data.map_band_m = float(thickness_m / scene_.map_bands);
  }

  const RenderRequest& request_;
  const Forest& forest_;
  const Planet& planet_;
  PlanetScene scene_;
  Clouds clouds_;
};

}  // namespace

PlanetScene make_planet_scene(const RenderRequest& request, const Forest& forest) {
  return PlanetBuilder(request, forest).run();
}

}  // namespace nepho::gl
