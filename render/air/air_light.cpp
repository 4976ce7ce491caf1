#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "air/air_depth.h"
#include "air/air_lookup.h"
#include "air/air_path.h"
#include "air/gauss.h"
#include "physics/physics_cpp.h"

// Successive orders of scattering on the grid of the tables. From each height the same bundle of
// rays leaves for all suns, so that air along them is integrated once. Order 1 (sunlit air and
// ground) and order 2 are integrated; the rest is a geometric series, as in Hillaire 2020, whose
// ratio is that of orders 2 and 1, or what a uniform field would keep where that is less (in
// twilight order 2 is larger than order 1).
namespace nepho {
namespace {

using std::numbers::pi;

constexpr int kSuns = 64, kHeights = 32;
// Texels of the tables between two suns: light falls off by half an e-fold from one to the next in
// twilight, and shaders interpolate linearly.
#if defined(NEPHO_MUTANT_COARSE_TWILIGHT)
constexpr int kBetween = 1;
#else
constexpr int kBetween = 4;
#endif
constexpr int kDepthWidth = 256, kDepthHeight = 208;
constexpr int kSteepNodes = 3, kSideNodes = 8, kAzimuths = 6, kPanelNodes = 3;
constexpr double kSteep = std::numbers::sqrt2 / 2;  // 45 degrees

enum Band { kUp, kLow, kUnder, kDown, kBands };

struct Sample {
  double height_m, along_m;      // from the origin of the ray
  double p2;                     // P2 of the ray's zenith cosine there
  glm::dvec3 rayleigh, aerosol;  // scattering * transmittance to the origin * length
};
struct Bundle {  // rays of one zenith angle from one height
  Band band;
  double mu, weight;  // of the sphere
  std::vector<Sample> samples;
  double ground_m = -1;    // along the ray; < 0: none
  glm::dvec3 ground{0.0};  // transmittance from there
  glm::dvec3 space{0.0};   // transmittance to the sky beyond the air
};
struct Field {  // of one order, at one height, for one sun
  glm::dvec3 mean{0.0}, p2{0.0}, irradiance{0.0};
  std::array<glm::dvec3, kBands> band{};
};
using Fields = std::vector<Field>;  // [height][sun]

double second_legendre(double mu) {
  return 1.5 * mu * mu - 0.5;
}

class Solver {
 public:
  Solver(const Air& air, double radius_m, const glm::dvec3& albedo, AirTables& tables)
      : air_(air),
        radius_m_(radius_m),
        albedo_(albedo),
        tables_(tables),
        depth_(air, radius_m),
        lookup_(air_, radius_m, tables),
        fields_(kSuns * kHeights) {
    bundles_.resize(kHeights);
    kept_.resize(kHeights);
    for (std::size_t a = 0; a < kAzimuths; ++a)
      azimuth_cosine_[a] = std::cos(pi * (double(a) + 0.5) / kAzimuths);
    cuts_m_ = {0,
               air.aerosol_scale_m,
               air.rayleigh_scale_m / 2,
               1.5 * air.rayleigh_scale_m,
               3 * air.rayleigh_scale_m,
               5 * air.rayleigh_scale_m,
               air.top_m};
    std::erase_if(cuts_m_, [&](double h_m) { return h_m > air.top_m; });
    std::ranges::sort(cuts_m_);
  }

  void run() {
    make_depth();
    tbb::parallel_for(0, kHeights, [&](int row) { make_bundles(row); });
    const Fields first = order<Sunlit>();
    fields_ = first;
    set_light();
    const Fields second = order<Relit>();
    for (std::size_t f = 0; f < fields_.size(); ++f)
      fields_[f] = closed(first[f], second[f], kept_[f / kSuns]);
    set_light();
#if defined(NEPHO_MUTANT_TABLE)
    for (float& v : tables_.NEPHO_MUTANT_TABLE.rgb) v *= NEPHO_MUTANT_FACTOR;
#endif
    set_sky();
  }

 private:
  void make_depth() {
    AirTable& table = tables_.depth;
    table = {kDepthWidth, kDepthHeight, {}};
    table.rgb.resize(3 * kDepthWidth * kDepthHeight);
    tbb::parallel_for(0, kDepthHeight, [&](int j) {
      for (int i = 0; i < kDepthWidth; ++i) {
        double height_m = 0, mu = 0;
        f64::air_depth_place(radius_m_, air_.top_m, i / (kDepthWidth - 1.0),
                             j / (kDepthHeight - 1.0), height_m, mu);
        const glm::dvec3 depth = depth_(height_m, mu, 1e30);
        for (int c = 0; c < 3; ++c)
          table.rgb[std::size_t(3 * (j * kDepthWidth + i) + c)] = float(depth[c]);
      }
    });
  }

  void make_bundles(int row) {
    static const GaussRule steep(kSteepNodes), side(kSideNodes);
    const auto add = [&](Band band, const GaussRule& rule, double low, double high) {
      for (std::size_t n = 0; n < rule.node.size(); ++n)
        bundles_[std::size_t(row)].push_back(make_bundle(
            row, band, low + (high - low) * rule.node[n], rule.weight[n] * (high - low) / 2));
    };
    add(kUp, steep, kSteep, 1);
    add(kLow, side, 0, kSteep);
    add(kUnder, side, -kSteep, 0);
    add(kDown, steep, -1, -kSteep);
    glm::dvec3& kept = kept_[std::size_t(row)];
    for (const Bundle& b : bundles_[std::size_t(row)]) {
      kept += b.weight * b.ground * albedo_;
      for (const Sample& s : b.samples) kept += b.weight * (s.rayleigh + s.aerosol);
    }
  }

  Bundle make_bundle(int row, Band band, double mu, double weight) const {
    static const GaussRule rule(kPanelNodes);
    const double height_m = row_height_m(row);
    const AirPath path(radius_m_, height_m, mu);
    Bundle bundle{band, mu, weight, {}};
    double end_m = path.top_m(air_);
    if (path.meets_ground()) {
      end_m = std::max(path.ground_m(), path.start_m());
      bundle.ground_m = end_m - path.start_m();
      bundle.ground = glm::exp(-depth_(height_m, mu, bundle.ground_m));
    } else {
      bundle.space = glm::exp(-depth_(height_m, mu, 1e30));
    }
    const std::vector<double> cuts = path.cuts(path.start_m(), end_m, cuts_m_);
    for (std::size_t p = 1; p < cuts.size(); ++p)
      for (std::size_t n = 0; n < rule.node.size(); ++n) {
        const double length_m = cuts[p] - cuts[p - 1], u_m = cuts[p - 1] + rule.node[n] * length_m;
        Sample s{path.height_m(u_m), u_m - path.start_m(), 0, {}, {}};
        s.p2 = second_legendre(u_m / (radius_m_ + s.height_m));
        const AirDensity density = air_density(air_, s.height_m);
        const glm::dvec3 seen =
            rule.weight[n] * length_m * glm::exp(-depth_(height_m, mu, s.along_m));
        s.rayleigh = density.rayleigh_per_m * seen;
        s.aerosol = density.aerosol_per_m * seen;
        bundle.samples.push_back(s);
      }
    return bundle;
  }

  double row_height_m(int row) const {
    double height_m = 0, mu = 0;
    f64::air_light_place(air_.top_m, 0, row / (kHeights - 1.0), height_m, mu);
    return height_m;
  }

  // Irradiance of the sun at a height, perpendicular to the beam.
  glm::dvec3 sun(double height_m, double mu_sun) const {
    const double part = f64::sun_above_horizon(radius_m_, height_m, mu_sun);
    return part > 0 ? part * glm::exp(-lookup_.depth(height_m, mu_sun)) : glm::dvec3{0.0};
  }
  glm::dvec3 sunlit_ground(double mu_sun) const {
    return mu_sun > 0 ? mu_sun * albedo_ / pi * sun(0, mu_sun) : glm::dvec3{0.0};
  }
  glm::dvec3 relit_ground(double mu_sun) const {
    double x = 0, y = 0;
    f64::air_light_coordinates(air_.top_m, 0, mu_sun, x, y);
    const double place = x * (kSuns - 1);
    const auto i = std::size_t(std::min(int(place), kSuns - 2));
    const glm::dvec3 &a = fields_[i].irradiance, &b = fields_[i + 1].irradiance;
    return albedo_ / pi * (a + (place - double(i)) * (b - a));
  }

  // One sample as the sun itself lights it.
  class Sunlit {
   public:
    static double night() { return f64::night_sky; }
    Sunlit(const Solver& solver, const Sample& sample) : solver_(solver), sample_(sample) {
      // Sines of the sun's elevation between which its disc is cut, and a little more.
      const double up_m = std::max(sample.height_m, 0.0);
      const double dip =
          std::atan(std::sqrt(up_m * (2 * solver.radius_m_ + up_m)) / solver.radius_m_);
      dark_ = std::sin(-dip - kDisc_rad);
      bright_ = std::sin(-dip + kDisc_rad);
    }
    // `rayleigh`, `aerosol`: phase functions, 1/sr.
    glm::dvec3 operator()(double mu_sun, double rayleigh, double aerosol) const {
      if (mu_sun < dark_) return glm::dvec3{0.0};
      const glm::dvec3 sun = mu_sun > bright_
                                 ? glm::exp(-solver_.lookup_.depth(sample_.height_m, mu_sun))
                                 : solver_.sun(sample_.height_m, mu_sun);
      return sun * (rayleigh * sample_.rayleigh + aerosol * sample_.aerosol);
    }
    static glm::dvec3 ground(const Solver& solver, double mu_sun) {
      return solver.sunlit_ground(mu_sun);
    }

   private:
    static constexpr double kDisc_rad = 0.005;
    const Solver& solver_;
    const Sample& sample_;
    double dark_, bright_;
  };
  // The same as the light of the tables lights it.
  class Relit {
   public:
    static double night() { return 0; }
    Relit(const Solver& solver, const Sample& sample)
        : sample_(sample), row_(solver.lookup_.light_row(sample.height_m)) {}
    glm::dvec3 operator()(double mu_sun, double, double) const {
      const AirLight light = row_(mu_sun);
      return (light.multiple + sample_.p2 * light.multiple_p2) * sample_.rayleigh +
             light.multiple * sample_.aerosol;
    }
    static glm::dvec3 ground(const Solver& solver, double mu_sun) {
      return solver.relit_ground(mu_sun);
    }

   private:
    const Sample& sample_;
    AirLightRow row_;
  };

  template <class Light>
  Fields order() const {
    Fields fields(kSuns * kHeights);
    tbb::parallel_for(0, kHeights,
                      [&](int row) { add_row<Light>(row, &fields[std::size_t(row * kSuns)]); });
    return fields;
  }

  // Sample by sample, each for all suns and azimuths.
  template <class Light>
  void add_row(int row, Field* fields) const {
    const double r_m = radius_m_ + row_height_m(row), g = air_.aerosol_asymmetry;
    std::array<double, kSuns> mu_sun{};
    for (int sun = 0; sun < kSuns; ++sun) {
      double height_m = 0;
      f64::air_light_place(air_.top_m, sun / (kSuns - 1.0), row / (kHeights - 1.0), height_m,
                           mu_sun[std::size_t(sun)]);
    }
    struct Way {  // to one sun, one azimuth off
      double cosine, rayleigh, aerosol;
    };
    std::array<std::array<Way, kAzimuths>, kSuns> ways;
    std::array<double, kBands> weights{};
    for (const Bundle& bundle : bundles_[std::size_t(row)]) {
      const double sine = std::sqrt((1 - bundle.mu) * (1 + bundle.mu));
      std::array<glm::dvec3, kSuns> radiance;
      radiance.fill(kAzimuths * Light::night() * bundle.space);
      for (std::size_t sun = 0; sun < kSuns; ++sun) {
        const double mu = mu_sun[sun], sun_sine = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu)));
        for (std::size_t a = 0; a < kAzimuths; ++a) {
          const double cosine = bundle.mu * mu + sine * sun_sine * azimuth_cosine_[a];
          ways[sun][a] = {cosine, f64::rayleigh_phase(1 - cosine),
                          f64::cornette_shanks_phase(1 - cosine, g)};
          if (bundle.ground_m >= 0)
            radiance[sun] +=
                bundle.ground *
                Light::ground(*this, (r_m * mu + bundle.ground_m * cosine) / radius_m_);
        }
      }
      for (const Sample& s : bundle.samples) {
        const Light light(*this, s);
        const double along = s.along_m / (radius_m_ + s.height_m),
                     across = r_m / (radius_m_ + s.height_m);
        for (std::size_t sun = 0; sun < kSuns; ++sun)
          for (const Way& way : ways[sun])
            radiance[sun] +=
                light(across * mu_sun[sun] + along * way.cosine, way.rayleigh, way.aerosol);
      }
      weights[bundle.band] += bundle.weight;
      for (std::size_t sun = 0; sun < kSuns; ++sun) {
        Field& field = fields[sun];
        const glm::dvec3 part = bundle.weight / kAzimuths * radiance[sun];
        field.mean += part;
        field.p2 += 0.5 * second_legendre(bundle.mu) * part;
        field.band[bundle.band] += part;
        if (bundle.mu > 0) field.irradiance += 4 * pi * bundle.mu * part;
      }
    }
    for (std::size_t sun = 0; sun < kSuns; ++sun)
      for (std::size_t b = 0; b < kBands; ++b) fields[sun].band[b] /= weights[b];
  }

  static Field closed(const Field& first, const Field& second, const glm::dvec3& kept) {
    Field all;
    for (int c = 0; c < 3; ++c) {
      const double grown = first.mean[c] > 0 ? second.mean[c] / first.mean[c] : 1;
      const double rest = 1 / (1 - std::min({grown, kept[c], 0.95}));
      const auto sum = [&](const glm::dvec3& a, const glm::dvec3& b) { return a[c] + rest * b[c]; };
      all.mean[c] = sum(first.mean, second.mean);
      all.p2[c] = sum(first.p2, second.p2);
      for (std::size_t b = 0; b < kBands; ++b) all.band[b][c] = sum(first.band[b], second.band[b]);
    }
    return all;
  }

  // Between suns a cubic of the logarithm (Catmull-Rom).
  template <class Value>
  AirTable finer(Value&& value) const {
    AirTable table{kBetween * (kSuns - 1) + 1, kHeights, {}};
    std::array<glm::dvec3, kSuns> values;
    for (std::size_t row = 0; row < kHeights; ++row) {
      for (std::size_t sun = 0; sun < kSuns; ++sun) values[sun] = value(fields_[row * kSuns + sun]);
      for (int i = 0; i < table.width; ++i)
        for (int c = 0; c < 3; ++c) {
          const auto at = [&](int sun) {
            return values[std::size_t(std::clamp(sun, 0, kSuns - 1))][c];
          };
          table.rgb.push_back(float(cubic(at, i)));
        }
    }
    return table;
  }
  template <class At>
  static double cubic(At&& at, int texel) {
    const int sun = texel / kBetween;
    const double f = double(texel % kBetween) / kBetween;
    const double a = at(sun - 1), b = at(sun), c = at(sun + 1), d = at(sun + 2);
    return b + 0.5 * f * (c - a + f * (2 * a - 5 * b + 4 * c - d + f * (3 * (b - c) + d - a)));
  }
  template <class Value>
  AirTable finer_light(Value&& value) const {
    AirTable table =
        finer([&](const Field& f) { return glm::log(glm::max(value(f), glm::dvec3{1e-30})); });
    for (float& v : table.rgb) v = std::exp(v);
    return table;
  }
  void set_light() {
    tables_.multiple = finer_light([](const Field& f) { return f.mean; });
    tables_.multiple_p2 =
        finer([](const Field& f) { return f.p2 / glm::max(f.mean, glm::dvec3{1e-30}); });
    for (std::size_t v = 0; v < tables_.multiple.rgb.size(); ++v)
      tables_.multiple_p2.rgb[v] *= tables_.multiple.rgb[v];
  }
  void set_sky() {
    const auto side = [](const Field& f) { return 0.5 * (f.band[kLow] + f.band[kUnder]); };
    tables_.sky_up = finer_light([](const Field& f) { return f.band[kUp]; });
    tables_.sky_low = finer_light([](const Field& f) { return f.band[kLow]; });
    tables_.sky_side = finer_light(side);
    tables_.sky_down = finer_light([](const Field& f) { return f.band[kDown]; });
  }

  const Air& air_;
  double radius_m_;
  glm::dvec3 albedo_;
  AirTables& tables_;
  AirDepth depth_;
  AirLookup lookup_;
  Fields fields_;
  std::vector<std::vector<Bundle>> bundles_;  // [height]
  std::vector<glm::dvec3> kept_;              // [height], of a uniform field, by one scattering
  std::vector<double> cuts_m_;
  std::array<double, kAzimuths> azimuth_cosine_{};
};

}  // namespace

AirTables make_air_tables(const Air& air, double radius_m, const glm::dvec3& ground_albedo) {
  AirTables tables;
  Solver(air, radius_m, ground_albedo, tables).run();
  return tables;
}

}  // namespace nepho
