// What fills a model's layers: each layer's optical depth is kept, nothing is higher or lower than
// the layers beside it, and clouds that vary over several layers are drawn closer to what they are.

#include <gtest/gtest.h>

#include <random>

#include "accuracy_report.h"
#include "forecast/bricks/layer_profile.h"
#include "forecast/bricks/vertical_hats.h"
#include "made_source.h"
#include "remapped.h"

namespace nepho::test {
namespace {

using forecast::Layers;
using forecast::ModelColumn;
using forecast::Parabola;
using forecast::VerticalHats;

struct RandomColumn {
  std::vector<double> thickness, mean;

  explicit RandomColumn(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto nz = 1 + random() % 40;
    for (std::size_t k = 0; k < nz; ++k) {
      thickness.push_back(std::exp(3 * unit(random)));  // up to 20 times the thinnest
      const double kind = unit(random);                 // clear, as below, or anything
      mean.push_back(kind < 0.3            ? 0.0
                     : kind < 0.4 && k > 0 ? mean.back()
                                           : std::exp(8 * unit(random) - 9));
    }
  }
  std::vector<Parabola> profile() const {
    std::vector<Parabola> list(mean.size());
    forecast::reconstruct(thickness, mean, list);
    return list;
  }
};

TEST(Layers, ParabolasKeepMeansAndBounds) {
  std::mt19937 random(1);
  double off = 0, beyond = 0, turns = 0;
  std::size_t bent = 0, clear_and_not_zero = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const RandomColumn column(random);
    const std::vector<Parabola> profile = column.profile();
    const double most = std::ranges::max(column.mean);
    if (!(most > 0)) continue;
    for (std::size_t k = 0; k < profile.size(); ++k) {
      const Parabola& p = profile[k];
      const double own = column.mean[k];
      // Simpson's rule is exact for a parabola.
      off = std::max(off, std::abs((p(0) + 4 * p(0.5) + p(1)) / 6 - own) / most);
      const auto [least, largest] =
          std::minmax({k > 0 ? column.mean[k - 1] : own, own,
                       k + 1 < profile.size() ? column.mean[k + 1] : own});
      const double sign = p.high < p.low ? -1 : 1;
      for (int step = 0; step <= 32; ++step) {
        const double here = p(step / 32.0), next = p(std::min(step + 1, 32) / 32.0);
        beyond = std::max({beyond, (least - here) / most, (here - largest) / most});
        turns = std::max(turns, sign * (here - next) / most);
        clear_and_not_zero += own == 0 && here != 0;
      }
      bent += p.high != p.low;
    }
  }
  report_accuracy("netcdf",
                  "smooth layers: mean of a layer off the file's, of the column's largest", off,
                  1e-14, "1");
  EXPECT_LE(off, 1e-14);
  EXPECT_LE(beyond, 1e-14);
  EXPECT_LE(turns, 1e-14);
  EXPECT_EQ(clear_and_not_zero, 0u);
  EXPECT_GT(bent, 1000u);
}

// Third order where a field rises smoothly: layers of half the thickness, an eighth of the error.
TEST(Layers, ParabolasConvergeOnUnevenLayers) {
  const auto worst = [](int nz) {
    const auto wall = [&](int k) {
      const double t = double(k) / nz;
      return 3 * (0.4 * t + 0.6 * t * t);
    };
    const auto field = [](double x) { return 2 + std::tanh(2 * (x - 1.5)); };
    const auto integral = [](double x) { return 2 * x + 0.5 * std::log(std::cosh(2 * (x - 1.5))); };
    std::vector<double> thickness, mean;
    for (int k = 0; k < nz; ++k) {
      thickness.push_back(wall(k + 1) - wall(k));
      mean.push_back((integral(wall(k + 1)) - integral(wall(k))) / thickness.back());
    }
    std::vector<Parabola> profile(mean.size());
    forecast::reconstruct(thickness, mean, profile);
    double most = 0;
    for (int k = nz / 4; k < 3 * nz / 4; ++k)  // the lowest and the topmost are flat
      for (int step = 0; step <= 16; ++step) {
        const double u = step / 16.0, x = wall(k) + u * thickness[std::size_t(k)];
        most = std::max(most, std::abs(profile[std::size_t(k)](u) - field(x)));
      }
    return most;
  };
  const double coarse = worst(40), fine = worst(80);
  EXPECT_GT(fine, 0);
  EXPECT_GE(coarse / fine, 7) << coarse << ' ' << fine;
}

struct Column1d {
  ShellChart chart{Ellipsoid::wgs84(), -500, 15000};
  std::uint32_t cells = 64;
  double latitude_deg = 50;
  std::vector<float> interface_m, value_per_m;

  ModelColumn model() const { return {latitude_deg, interface_m, value_per_m}; }
  VerticalHats hats(Layers layers) const { return {chart, cells, {0, 0, layers}}; }
  // sum c V of the hats that one part of the column makes, over a^2 (1).
  double depth(Layers layers, std::span<const float> part_per_m) const {
    const VerticalHats vertical = hats(layers);
    const auto range = vertical.range(model());
    std::vector<float> means(range.count);
    vertical.means(model(), part_per_m, range.first, means);
    const double a = chart.body().equatorial_m, b = chart.body().polar_m;
    double sum = 0;
    for (std::uint32_t k = 0; k < range.count; ++k)
      sum += double(means[k]) * chart.hat_vertical(range.first + k, {cells, cells, cells});
    return sum / (a * b);
  }
  // beta int r^2 dr / a^2, in long double.
  double exact_depth(std::size_t layer) const {
    const long double a = chart.body().equatorial_m;
    const auto cube = [&](float height_m) {
      const long double up =
          1 + forecast::chart_height_m(chart.body(), latitude_deg, double(height_m)) / a;
      return up * up * up / 3;
    };
    return double(value_per_m[layer] * a *
                  (cube(interface_m[layer + 1]) - cube(interface_m[layer])));
  }
};

// Of each layer alone, as a part of the column, and of whole columns, through the hats.
TEST(Layers, HatsKeepEachLayersOpticalDepth) {
  std::mt19937 random(2);
  double of_layer = 0, of_column = 0;
  std::size_t compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const RandomColumn drawn(random);
    Column1d column;
    column.latitude_deg = double(random() % 90);
    double thick = 0, height_m = 20;
    for (const double h : drawn.thickness) thick += h;
    column.interface_m.push_back(20);
    for (std::size_t k = 0; k < drawn.mean.size(); ++k) {
      height_m += drawn.thickness[k] * 14000 / thick;
      column.interface_m.push_back(float(height_m));
      column.value_per_m.push_back(float(drawn.mean[k]));
    }
    double sum = 0;
    for (std::size_t k = 0; k < drawn.mean.size(); ++k) {
      if (!(drawn.mean[k] > 0)) continue;
      std::vector<float> alone(drawn.mean.size(), 0.0f);
      alone[k] = column.value_per_m[k];
      const double exact = column.exact_depth(k);
      sum += exact;
      of_layer = std::max(of_layer, std::abs(column.depth(Layers::kSmooth, alone) / exact - 1));
      ++compared;
    }
    if (sum > 0)
      of_column = std::max(of_column,
                           std::abs(column.depth(Layers::kSmooth, column.value_per_m) / sum - 1));
  }
  report_accuracy("netcdf", "smooth layers: optical depth of each layer, file against hats",
                  of_layer, 1e-6, "1");
  report_accuracy("netcdf", "smooth layers: optical depth of columns, file against hats", of_column,
                  1e-6, "1");
  EXPECT_GT(compared, 1000u);
  EXPECT_LE(of_layer, 1e-6);
  EXPECT_LE(of_column, 1e-6);
}

// A cloud that varies over two kilometres, as means of thick and of thin layers: hats of the first
// against hats of the second.
TEST(Layers, SmoothIsCloserToTheCloudThanSteps) {
  const auto hats_of = [](Layers layers, double layer_m, double base_m) {
    const auto cloud = [&](double z) {
      const double x = (z - base_m) / 2500;
      return x > 0 && x < 1 ? 0.02 * std::pow(std::sin(std::numbers::pi * x), 2) : 0.0;
    };
    Column1d column;
    const int nz = int(12000 / layer_m);
    column.interface_m.push_back(0);
    for (int k = 0; k < nz; ++k) {
      double mean = 0;
      for (int s = 0; s < 64; ++s) mean += cloud((k + (s + 0.5) / 64) * layer_m) / 64;
      column.interface_m.push_back(float((k + 1) * layer_m));
      column.value_per_m.push_back(float(mean));
    }
    const VerticalHats vertical = column.hats(layers);
    const auto range = vertical.range(column.model());
    std::vector<float> means(range.count), all(column.cells + 1, 0.0f);
    vertical.means(column.model(), column.value_per_m, range.first, means);
    std::ranges::copy(means, all.begin() + range.first);
    return all;
  };
  double smooth = 0, steps = 0, square = 0;
  for (double base_m = 2000; base_m < 2500; base_m += 37) {
    const auto truth = hats_of(Layers::kConstant, 5, base_m);
    const auto with = hats_of(Layers::kSmooth, 500, base_m);
    const auto without = hats_of(Layers::kConstant, 500, base_m);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      smooth += std::pow(double(with[k] - truth[k]), 2);
      steps += std::pow(double(without[k] - truth[k]), 2);
      square += std::pow(double(truth[k]), 2);
    }
  }
  smooth = std::sqrt(smooth / square), steps = std::sqrt(steps / square);
  std::printf("measured: steps are off by %.4f, smooth layers by %.4f\n", steps, smooth);
  report_accuracy("netcdf", "smooth layers of 500 m: samples off a cloud over 2.5 km, rms", smooth,
                  0.05, "1");
  report_accuracy("netcdf", "smooth layers: error over that of constant layers, same cloud",
                  smooth / steps, 0.5, "1");
  EXPECT_LE(smooth, 0.05);
  EXPECT_LE(smooth / steps, 0.5);
}

// The part that is ice, where its share jumps between layers.
TEST(Layers, IceNeverExceedsTheTotal) {
  for (const char* name : {"corner", "globe"}) {
    const auto forecast = synthetic_forecast(name);
    const auto all = forecast->extinction_per_m;
    forecast->ice_per_m = [=](glm::dvec2 p, double z, double t) {
      return all(p, z, t) * (std::fmod(z / 700, 2) < 1 ? 1.0 : 0.3);
    };
    const Remapped r(forecast);
    std::size_t more = 0, icy = 0;
    BrickSamples total, ice;
    for (const NodeKey key : r.remap->nodes(Part::kIce)) {
      r.remap->samples(key, Part::kTotal, total.data());
      r.remap->samples(key, Part::kIce, ice.data());
      for (std::size_t at = 0; at < total.size(); ++at) {
        more += ice[at] > total[at] || ice[at] < 0;
        icy += ice[at] > 0 && ice[at] < total[at];
      }
    }
    EXPECT_EQ(more, 0u) << name;
    EXPECT_GT(icy, 1000u) << name;
    EXPECT_NEAR(r.total(Part::kIce) / file_total(r, true), 1, 2e-3) << name;
  }
}

// The parameter reaches the bricks, and what the source says of itself.
TEST(Layers, AreChosenByAParameter) {
  const auto forecast = synthetic_forecast("mercator");
  const RequestParameter constant = {"layers", "constant", 0, ""};
  const RequestParameter smooth = {"layers", "smooth", 0, ""};
  const auto by_default = made_source(forecast), with = made_source(forecast, {smooth}),
             without = made_source(forecast, {constant});
  const auto says = [](const BrickSource& source) {
    return std::ranges::any_of(source.info().assumptions, [](const std::string& text) {
      return text.find("smoothed") != std::string::npos;
    });
  };
  EXPECT_TRUE(says(*by_default) && says(*with));
  EXPECT_FALSE(says(*without));
  const Remapped smooth_hats(forecast, {}, 1e-9), steps(forecast, {}, 1e-9, 0, Layers::kConstant);
  double square = 0, change = 0, off = 0;
  for (const NodeKey key : finest_nodes(*without)) {
    const BrickSamples here = read_samples(*without, key), there = read_samples(*with, key);
    EXPECT_EQ(read_samples(*by_default, key), there);
    BrickSamples of_steps, of_smooth;
    steps.remap->samples(key, Part::kTotal, of_steps.data());
    smooth_hats.remap->samples(key, Part::kTotal, of_smooth.data());
    for (std::size_t at = 0; at < here.size(); ++at) {
      off = std::max({off, std::abs(here[at] - of_steps[at]), std::abs(there[at] - of_smooth[at])});
      square += here[at] * here[at];
      change += (there[at] - here[at]) * (there[at] - here[at]);
    }
  }
  const double rms = std::sqrt(change / square);
  report_accuracy("netcdf", "smooth layers: samples off the file's own steps, rms", rms, 0.1, "1");
  EXPECT_LE(off, 1.01 * without->info().channels[0].max_abs_error);
  EXPECT_GT(rms, 1e-3);
  EXPECT_LE(rms, 0.1);
  EXPECT_THROW(made_source(forecast, {{"layers", "parabolic", 0, ""}}), Error);
}

}  // namespace
}  // namespace nepho::test
