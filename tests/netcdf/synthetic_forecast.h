#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "forecast/forecast.h"

namespace nepho::test {

// Forecasts in closed form on grids as models have them, for tests of what comes after the files.

inline constexpr double kDegree = std::numbers::pi / 180;

// Regular in latitude and longitude. Rows run south where step_lat < 0.
class LatLonGrid final : public forecast::HorizontalGrid {
 public:
  LatLonGrid(int nx, int ny, double lon0_deg, double step_lon_deg, double lat0_deg,
             double step_lat_deg)
      : nx_(nx), ny_(ny), low_(lat0_deg, lon0_deg), step_(step_lat_deg, step_lon_deg) {}
  int nx() const override { return nx_; }
  int ny() const override { return ny_; }
  bool around() const override { return std::abs(nx_ * step_.y - 360) < 1e-9; }
  glm::dvec2 lat_lon_deg(double x, double y) const override {
    return {std::clamp(low_.x + y * step_.x, -90.0, 90.0), low_.y + x * step_.y};
  }

 private:
  int nx_, ny_;
  glm::dvec2 low_, step_;
};

// Mercator on a sphere, as WRF's MAP_PROJ 3: square cells in the projection.
class MercatorGrid final : public forecast::HorizontalGrid {
 public:
  MercatorGrid(int nx, int ny, glm::dvec2 centre_deg, double cell_deg)
      : nx_(nx), ny_(ny), centre_(centre_deg), cell_(cell_deg) {}
  int nx() const override { return nx_; }
  int ny() const override { return ny_; }
  bool around() const override { return false; }
  glm::dvec2 lat_lon_deg(double x, double y) const override {
    const double y0 = std::asinh(std::tan(centre_.x * kDegree));
    return {std::atan(std::sinh(y0 + (y - ny_ / 2.0) * cell_ * kDegree)) / kDegree,
            centre_.y + (x - nx_ / 2.0) * cell_};
  }

 private:
  int nx_, ny_;
  glm::dvec2 centre_;
  double cell_;
};

// A rotated pole: regular about the rotated equator, whose (0, 0) is at `centre`. Over a pole too.
class RotatedGrid final : public forecast::HorizontalGrid {
 public:
  RotatedGrid(int nx, int ny, glm::dvec2 centre_deg, double turn_deg, double cell_deg)
      : nx_(nx), ny_(ny), cell_(cell_deg) {
    const double lat = centre_deg.x * kDegree, lon = centre_deg.y * kDegree;
    const glm::dvec3 up = {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon),
                           std::sin(lat)};
    const glm::dvec3 east = {-std::sin(lon), std::cos(lon), 0};
    const glm::dvec3 north = glm::cross(up, east);
    const double c = std::cos(turn_deg * kDegree), s = std::sin(turn_deg * kDegree);
    axes_ = {up, c * east + s * north, c * north - s * east};
  }
  int nx() const override { return nx_; }
  int ny() const override { return ny_; }
  bool around() const override { return false; }
  glm::dvec2 lat_lon_deg(double x, double y) const override {
    const double lon = (x - nx_ / 2.0) * cell_ * kDegree, lat = (y - ny_ / 2.0) * cell_ * kDegree;
    const glm::dvec3 u = axes_ * glm::dvec3(std::cos(lat) * std::cos(lon),
                                            std::cos(lat) * std::sin(lon), std::sin(lat));
    return {std::atan2(u.z, std::hypot(u.x, u.y)) / kDegree, std::atan2(u.y, u.x) / kDegree};
  }

 private:
  int nx_, ny_;
  double cell_;
  glm::dmat3 axes_{1.0};
};

struct SyntheticForecast final : forecast::Forecast {
  std::shared_ptr<const forecast::HorizontalGrid> cells;
  std::vector<std::shared_ptr<const forecast::HorizontalGrid>> moving;  // one a time; empty: cells
  int nz = 0;
  // Height (m) of the ground, and of interface k of nz above it, at latitude and longitude (deg).
  std::function<double(glm::dvec2)> ground_m = [](glm::dvec2) { return 0.0; };
  std::function<double(double)> level_m;  // k / nz -> m above the ground at sea level
  // Extinction and its ice part (1/m) at latitude, longitude (deg) and height (m), and time (s).
  std::function<double(glm::dvec2, double, double)> extinction_per_m;
  std::function<double(glm::dvec2, double, double)> ice_per_m;
  std::vector<double> times = {0.0};

  std::int64_t time_origin_ns() const override { return 0; }
  const std::vector<double>& times_s() const override { return times; }
  bool has_ice() const override { return bool(ice_per_m); }
  std::shared_ptr<const forecast::HorizontalGrid> grid(std::size_t time) const override {
    return moving.empty() ? cells : moving[time];
  }
  glm::dvec2 middle(int i, int j, std::size_t time = 0) const {
    return grid(time)->lat_lon_deg(i + 0.5, j + 0.5);
  }
  double interface_m(double ground, int k) const {
    const double top_m = level_m(1);  // flat, as terrain-following levels are
    return ground + level_m(double(k) / nz) * (1 - ground / top_m);
  }
  forecast::ForecastColumns columns(std::size_t time) const override {
    forecast::ForecastColumns c;
    c.nx = cells->nx(), c.ny = cells->ny(), c.nz = nz;
    for (int j = 0; j < c.ny; ++j)
      for (int i = 0; i < c.nx; ++i) {
        const double ground = ground_m(middle(i, j, time));
        for (int k = 0; k <= nz; ++k) c.interface_m.push_back(float(interface_m(ground, k)));
        for (int k = 0; k < nz; ++k) {
          const double z = (interface_m(ground, k) + interface_m(ground, k + 1)) / 2;
          const auto ice = float(ice_per_m ? ice_per_m(middle(i, j, time), z, times[time]) : 0);
          c.extinction_per_m.push_back(
              std::max(ice, float(extinction_per_m(middle(i, j, time), z, times[time]))));
          if (ice_per_m) c.ice_extinction_per_m.push_back(ice);
        }
      }
    return c;
  }
  forecast::ForecastGround ground(std::size_t time) const override {
    forecast::ForecastGround g;
    for (int j = 0; j < cells->ny(); ++j)
      for (int i = 0; i < cells->nx(); ++i) {
        g.height_m.push_back(float(ground_m(middle(i, j, time))));
        g.water.push_back(ground_m(middle(i, j, time)) <= 0 ? 1.0f : 0.0f);
      }
    return g;
  }
  glm::dvec2 height_range_m() const override {
    double low = 1e9, high = -1e9;
    for (int j = 0; j < cells->ny(); ++j)
      for (int i = 0; i < cells->nx(); ++i) {
        low = std::min(low, interface_m(ground_m(middle(i, j)), 0));
        high = std::max(high, interface_m(ground_m(middle(i, j)), nz));
      }
    return {low, high};
  }
  double thinnest_layer_m() const override {
    double thinnest = 1e9;
    for (int k = 0; k < nz; ++k)
      thinnest = std::min(thinnest, level_m(double(k + 1) / nz) - level_m(double(k) / nz));
    return thinnest;
  }
  double liquid_radius_m() const override { return 10e-6; }
  std::vector<std::string> assumptions() const override { return {"The field is synthetic."}; }
  std::vector<std::string> facts() const override { return {}; }
};

// Blobs of several sizes: smooth, with clear air between them.
inline double blobs(glm::dvec2 lat_lon_deg, double height_m, double size_deg) {
  const double lat = lat_lon_deg.x / size_deg, lon = lat_lon_deg.y / size_deg;
  const double cover = std::sin(lat * 2 + 0.7) * std::cos(lon * 1.7) +
                       0.6 * std::sin(3.1 * lon + 1.3 * lat) + 0.4 * std::cos(4.3 * lat - lon);
  const double middle_m = 2500 + 1500 * std::sin(lat + lon);
  const double layer = 1 - std::abs(height_m - middle_m) / 1800;
  return 0.02 * std::max(0.0, cover) * std::max(0.0, layer);
}

// Named cases; throws std::invalid_argument on others.
//   mercator   48 x 48 cells of 0.09 deg over terrain, 20 layers, two times, water only
//   globe      2.5 deg, rows running south, longitudes 0..360, 24 layers with ice above 4 km
//   globe_mirror  the same turned by 180 deg of longitude
//   rotated    60 x 50 cells of 0.1 deg over the north pole
//   corner     40 x 40 cells of 0.2 deg over a corner of three cube faces, with ice
//   fog        cloud in the lowest layer only, over hills
//   layer      one value from 1 to 3 km over 30 x 30 cells
inline std::shared_ptr<SyntheticForecast> synthetic_forecast(const std::string& name) {
  auto f = std::make_shared<SyntheticForecast>();
  f->nz = 20;
  f->level_m = [](double t) { return 9000 * (0.4 * t + 0.6 * t * t); };
  const auto hills = [](glm::dvec2 p) {
    return std::max(0.0, 700 * std::sin(3 * p.x) * std::cos(2.3 * p.y));
  };
  const auto field = [&](double size_deg, double turn_deg) {
    f->extinction_per_m = [=](glm::dvec2 p, double z, double t) {
      return blobs({p.x, p.y + turn_deg + 3e-5 * t}, z, size_deg);
    };
  };
  const auto globe = [&](double turn_deg) {
    f->cells = std::make_shared<LatLonGrid>(144, 73, -1.25 - turn_deg, 2.5, 91.25, -2.5);
    f->nz = 24;
    f->extinction_per_m = [=](glm::dvec2 p, double z, double) {
      const double lon = (p.y + turn_deg) * kDegree, lat = p.x * kDegree;
      const double waves = std::sin(3 * lat) + 0.8 * std::cos(lat) * std::cos(lon) * 2 +
                           0.7 * std::cos(lat) * std::cos(lat) * std::sin(2 * lon);
      return 2e-3 * std::max(0.0, waves) * std::max(0.0, 1 - std::abs(z - 3500) / 3000);
    };
  };
  if (name == "mercator") {
    f->cells = std::make_shared<MercatorGrid>(48, 48, glm::dvec2(24, -88), 0.09);
    f->ground_m = hills;
    f->times = {0, 3600};
    field(1.2, 0);
  } else if (name == "globe" || name == "globe_mirror") {
    globe(name == "globe" ? 0 : 180);
    const auto total = f->extinction_per_m;
    f->ice_per_m = [=](glm::dvec2 p, double z, double t) {
      return std::clamp((z - 3000) / 2000, 0.0, 1.0) * total(p, z, t);
    };
  } else if (name == "rotated") {
    f->cells = std::make_shared<RotatedGrid>(60, 50, glm::dvec2(89, 20), 25, 0.1);
    f->extinction_per_m = [](glm::dvec2 p, double z, double) {
      const double c = (90 - p.x), x = c * std::cos(p.y * kDegree), y = c * std::sin(p.y * kDegree);
      return blobs({x, y}, z, 1.1);
    };
  } else if (name == "corner") {
    f->cells = std::make_shared<RotatedGrid>(40, 40, glm::dvec2(35.2644, 45), 10, 0.2);
    field(2.5, 0);
    const auto total = f->extinction_per_m;
    f->ice_per_m = [=](glm::dvec2 p, double z, double t) { return z > 3000 ? total(p, z, t) : 0; };
  } else if (name == "fog") {
    f->cells = std::make_shared<MercatorGrid>(30, 30, glm::dvec2(47, 9), 0.05);
    f->ground_m = hills;
    f->extinction_per_m = [](glm::dvec2, double, double) { return 0.01; };
    const auto all = f->extinction_per_m;
    f->nz = 16;
    f->level_m = [](double t) { return 4000 * t; };
    f->extinction_per_m = [hills, all](glm::dvec2 p, double z, double t) {
      return z < hills(p) + 250 ? all(p, z, t) : 0.0;
    };
  } else if (name == "layer") {
    f->cells = std::make_shared<MercatorGrid>(30, 30, glm::dvec2(-30, 179.9), 0.1);
    f->nz = 16;
    f->level_m = [](double t) { return 8000 * t; };
    f->extinction_per_m = [](glm::dvec2, double z, double) {
      return z > 1000 && z < 3000 ? 5e-3 : 0.0;
    };
  } else {
    throw std::invalid_argument("no synthetic forecast " + name);
  }
  return f;
}

}  // namespace nepho::test
