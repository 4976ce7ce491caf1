// Placeholder until the tables proper are merged.
#include <cmath>
#include "air/air_tables.h"
#include "physics/physics_cpp.h"
namespace nepho {
namespace {
glm::dvec3 ext(const Air& a, double h) {
  return a.rayleigh_per_m * f64::air_exponential(h, a.rayleigh_scale_m) + a.aerosol_extinction_per_m * f64::air_exponential(h, a.aerosol_scale_m) +
         a.ozone_per_m * f64::air_ozone(h, a.ozone_low_m, a.ozone_peak_m, a.ozone_high_m);
}
glm::dvec3 depth(const Air& a, double R, double h, double mu, double len) {
  glm::dvec3 s(0.0); const int n = 400;
  for (int i = 0; i < n; ++i) { double t = len * (i + .5) / n; s += ext(a, h + f64::height_along_ray(R + h, t, mu)) * (len / n); }
  return s;
}
AirTable table(int w, int h) { return {w, h, std::vector<float>(std::size_t(3 * w * h))}; }
void put(AirTable& t, int i, int j, glm::dvec3 v) { for (int c = 0; c < 3; ++c) t.rgb[std::size_t(3 * (j * t.width + i) + c)] = float(v[c]); }
}
AirTables make_air_tables(const Air& a, double R, const glm::dvec3& albedo) {
  AirTables T; T.depth = table(256, 64);
  for (int j = 0; j < 64; ++j) for (int i = 0; i < 256; ++i) {
    double h, mu; f64::air_depth_place(R, a.top_m, i / 255.0, j / 63.0, h, mu);
    put(T.depth, i, j, depth(a, R, h, mu, f64::air_distance_to_top(R, a.top_m, h, mu)));
  }
  T.multiple = T.multiple_p2 = T.sky_up = T.sky_side = T.sky_down = T.sky_low = table(64, 32);
  for (int j = 0; j < 32; ++j) for (int i = 0; i < 64; ++i) {
    double h, ms; f64::air_light_place(a.top_m, i / 63.0, j / 31.0, h, ms);
    glm::dvec3 mean(0.0), up(0.0), side(0.0), down(0.0), low(0.0); double fms = 0; (void)fms; double nu = 0, ns = 0, nl = 0;
    glm::dvec3 F(0.0);
    for (int k = 0; k < 64; ++k) {
      double mu = (k % 8 + .5) / 4 - 1, az = 2 * 3.14159265 * (k / 8 + .5) / 8; double sn = std::sqrt(1 - mu * mu), ss = std::sqrt(std::max(0.0, 1 - ms * ms));
      double g = f64::air_distance_to_top(R, a.top_m, h, mu); bool ground = false; double disc = std::pow((R + h) * mu, 2) - h * (2 * R + h);
      if (mu < 0 && disc > 0) { g = -(R + h) * mu - std::sqrt(disc); ground = true; }
      glm::dvec3 L(0.0), tr(1.0), f(0.0);
      double cosn = mu * ms + sn * ss * std::cos(az);
      for (int s = 0; s < 24; ++s) {
        double t0 = g * s * s / 576, t1 = g * (s + 1) * (s + 1) / 576, t = (t0 + t1) / 2, d = t1 - t0;
        double hh = h + f64::height_along_ray(R + h, t, mu), m2 = ((R + h) * ms + t * cosn) / (R + hh);
        glm::dvec3 sc = a.rayleigh_per_m * f64::air_exponential(hh, a.rayleigh_scale_m) + a.aerosol_albedo * a.aerosol_extinction_per_m * f64::air_exponential(hh, a.aerosol_scale_m);
        glm::dvec3 e = exp(-ext(a, hh) * d), w = tr * (1.0 - e) / (ext(a, hh) + 1e-30) * sc;
        double part = f64::sun_above_horizon(R, hh, m2); glm::dvec3 sun(0.0);
        if (part > 0) { double x, y; f64::air_depth_coordinates(R, a.top_m, hh, m2, x, y); int ii = int(x * 255 + .5), jj = int(y * 63 + .5);
          for (int c = 0; c < 3; ++c) sun[c] = part * std::exp(-double(T.depth.rgb[std::size_t(3 * (jj * 256 + ii) + c)])); }
        L += w * sun / (4 * 3.14159265); f += w; tr *= e;
      }
      if (ground) { double m2 = ((R + h) * ms + g * cosn) / R; if (m2 > 0) { double x, y; f64::air_depth_coordinates(R, a.top_m, 0.0, m2, x, y); int ii = int(x * 255 + .5);
          for (int c = 0; c < 3; ++c) L[c] += tr[c] * albedo[c] / 3.14159265 * m2 * std::exp(-double(T.depth.rgb[std::size_t(3 * ii + c)])); } }
      mean += L / 64.0; F += f / 64.0;
      if (mu > .707) { up += L; ++nu; } else if (mu > -.707) { side += L; ++ns; if (mu > 0) { low += L; ++nl; } } else down += L;
    }
    glm::dvec3 m = mean / (1.0 - F);
    put(T.multiple, i, j, m);
    put(T.sky_up, i, j, up / nu + F * m); put(T.sky_side, i, j, side / ns + F * m); put(T.sky_low, i, j, low / nl + F * m); put(T.sky_down, i, j, down / nu + F * m);
  }
  return T;
}
glm::dvec3 air_optical_depth(const Air& a, double R, double h, double mu, double len) { return depth(a, R, h, mu, len); }
}
