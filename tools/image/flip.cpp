#include "image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "image/colour.h"

namespace nepho {
namespace {

constexpr double kPi = std::numbers::pi;

using Plane = Pixels<double>;  // one channel
// Weights of -radius to radius.
using Kernel = std::vector<double>;

// Colour pipeline: contrast sensitivity of achromatic, red-green and blue-yellow patterns as
// sums of Gaussians; in space a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Gaussian {
  double a, b;
};
constexpr Gaussian kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053};
constexpr Gaussian kBlueYellow{34.1, 0.04}, kBlueYellow2{13.5, 0.025};
// Colour pipeline: the exponent of differences, and the point where they bend towards 1.
constexpr double kColourExponent = 0.7, kBend = 0.4, kBendValue = 0.95;
// Feature pipeline: width of the eye's feature detectors in degrees, and the exponent of features.
constexpr double kFeatureWidth_deg = 0.082, kFeatureExponent = 0.5;

template <typename Weight>
Kernel kernel(int radius, const Weight& weight) {
  Kernel out;
  for (int x = -radius; x <= radius; ++x) out.push_back(weight(double(x)));
  return out;
}

double sum_of(const Kernel& kernel) {
  double sum = 0;
  for (const double weight : kernel) sum += weight;
  return sum;
}

// Positive weights sum up to 1, negative ones to -1.
void balance(Kernel& kernel) {
  double positive = 0, negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
  for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
}

// All of the filters are products of one along x and one along y.
Plane convolve_x(const Plane& in, const Kernel& kernel) {
  Plane out(in.width, in.height, 1);
  const int radius = int(kernel.size()) / 2;
  std::vector<double> row(std::size_t(in.width + 2 * radius));
  for (int y = 0; y < in.height; ++y) {
    const double* from = in.values.data() + std::size_t(y) * std::size_t(in.width);
    for (int x = -radius; x < in.width + radius; ++x)
      row[std::size_t(x + radius)] = from[std::clamp(x, 0, in.width - 1)];
    double* to = out.values.data() + std::size_t(y) * std::size_t(in.width);
    for (std::size_t k = 0; k < kernel.size(); ++k)
      for (std::size_t x = 0; x < std::size_t(in.width); ++x) to[x] += kernel[k] * row[x + k];
  }
  return out;
}

Plane convolve_y(const Plane& in, const Kernel& kernel) {
  Plane out(in.width, in.height, 1);
  const int radius = int(kernel.size()) / 2;
  const auto width = std::size_t(in.width);
  for (int y = 0; y < in.height; ++y) {
    double* to = out.values.data() + std::size_t(y) * width;
    for (int k = -radius; k <= radius; ++k) {
      const int line = std::clamp(y + k, 0, in.height - 1);
      const double* from = in.values.data() + std::size_t(line) * width;
      const double weight = kernel[std::size_t(k + radius)];
      for (std::size_t x = 0; x < width; ++x) to[x] += weight * from[x];
    }
  }
  return out;
}

// Opponent colours that are linear in light, Y Cx Cz (linearised CIELAB).
std::array<Plane, 3> opponent_colours(const ByteImage& image) {
  std::array<double, 256> light;
  for (std::size_t i = 0; i < light.size(); ++i) light[i] = srgb_decode(double(i) / 255);
  std::array<Plane, 3> out;
  out.fill(Plane(image.width, image.height, 1));
  for (std::size_t p = 0; p < image.count(); ++p) {
    const std::uint8_t* in = image.values.data() + 3 * p;
    const glm::dvec3 xyz = xyz_of({light[in[0]], light[in[1]], light[in[2]]});
    out[0].values[p] = 116 * xyz.y - 16;
    out[1].values[p] = 500 * (xyz.x - xyz.y);
    out[2].values[p] = 200 * (xyz.y - xyz.z);
  }
  return out;
}

// What the eye resolves: each opponent colour through its contrast sensitivity.
Plane seen(const Plane& plane, std::initializer_list<Gaussian> gaussians, double per_degree) {
  const double widest = std::sqrt(kBlueYellow.b / (2 * kPi * kPi));
  const int radius = int(std::ceil(3 * widest * per_degree));
  Plane out(plane.width, plane.height, 1);
  double total = 0;
  for (const auto& [a, b] : gaussians) {
    const Kernel line = kernel(radius, [&, b = b](double x) {
      return std::exp(-kPi * kPi * x * x / (per_degree * per_degree * b));
    });
    const double weight = a * std::sqrt(kPi / b);
    total += weight * sum_of(line) * sum_of(line);
    const Plane part = convolve_y(convolve_x(plane, line), line);
    for (std::size_t p = 0; p < out.values.size(); ++p) out.values[p] += weight * part.values[p];
  }
  for (double& value : out.values) value /= total;
  return out;
}

// CIELAB, with a* and b* scaled by 0.01 L*: colours seem stronger where it is brighter (Hunt 1952).
glm::dvec3 hunt(const glm::dvec3& linear) {
  const glm::dvec3 lab = lab_of(linear);
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

// The distance HyAB (Abasi et al. 2020, doi:10.1002/col.22451), to the power of 0.7.
double colour_distance(const glm::dvec3& a, const glm::dvec3& b) {
  return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), kColourExponent);
}

std::vector<glm::dvec3> seen_colours(const std::array<Plane, 3>& colours, double per_degree) {
  const Plane y = seen(colours[0], {kAchromatic}, per_degree);
  const Plane cx = seen(colours[1], {kRedGreen}, per_degree);
  const Plane cz = seen(colours[2], {kBlueYellow, kBlueYellow2}, per_degree);
  std::vector<glm::dvec3> out(y.count());
  for (std::size_t p = 0; p < out.size(); ++p) {
    const double light = (y.values[p] + 16) / 116;
    const glm::dvec3 xyz(light + cx.values[p] / 500, light, light - cz.values[p] / 200);
    out[p] = hunt(glm::clamp(linear_of_xyz(xyz), 0.0, 1.0));
  }
  return out;
}

// Strength of edges or of points: first or second derivatives of a Gaussian along x and y.
std::vector<double> strength(const Plane& along_x, const Plane& along_y, const Kernel& derivative) {
  const Plane dx = convolve_x(along_y, derivative), dy = convolve_y(along_x, derivative);
  std::vector<double> out(dx.count());
  for (std::size_t p = 0; p < out.size(); ++p) out[p] = std::hypot(dx.values[p], dy.values[p]);
  return out;
}

// What an eye takes in of one picture, for each pixel.
struct Look {
  std::vector<glm::dvec3> colours;
  std::vector<double> edges, points;
};
Look look_at(const ByteImage& image, double per_degree) {
  std::array<Plane, 3> opponents = opponent_colours(image);
  Look out{seen_colours(opponents, per_degree), {}, {}};
  Plane& y = opponents[0];
  for (double& value : y.values) value = (value + 16) / 116;
  const double sigma = 0.5 * kFeatureWidth_deg * per_degree;
  const int radius = int(std::ceil(3 * sigma));
  const auto bell = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  Kernel smooth = kernel(radius, bell);
  Kernel edge = kernel(radius, [&](double x) { return -x * bell(x); });
  Kernel point = kernel(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * bell(x); });
  const double sum = sum_of(smooth);
  for (double& weight : smooth) weight /= sum;
  balance(edge);
  balance(point);
  const Plane along_x = convolve_x(y, smooth), along_y = convolve_y(y, smooth);
  out.edges = strength(along_x, along_y, edge);
  out.points = strength(along_x, along_y, point);
  return out;
}

void check(const ByteImage& picture, const ByteImage& truth, double pixels_per_degree) {
  if (picture.width != truth.width || picture.height != truth.height || picture.channels != 3 ||
      truth.channels != 3 || truth.count() == 0)
    throw std::invalid_argument("flip_map: pictures of one size and 3 channels");
  if (!(pixels_per_degree > 0)) throw std::invalid_argument("flip_map: pixels per degree");
}

}  // namespace

FloatImage flip_map(const ByteImage& picture, const ByteImage& truth, double pixels_per_degree) {
  check(picture, truth, pixels_per_degree);
#ifdef NEPHO_MUTANT_FLIP_WITHOUT_DEGREES
  pixels_per_degree = 1;
#endif
  const Look a = look_at(picture, pixels_per_degree), b = look_at(truth, pixels_per_degree);
  const double most = colour_distance(hunt({0, 1, 0}), hunt({0, 0, 1}));
  const double bend = kBend * most;
  FloatImage out(truth.width, truth.height, 1);
  for (std::size_t p = 0; p < out.count(); ++p) {
    // The rest of the range goes to differences that hardly ever are.
    const double distance = colour_distance(a.colours[p], b.colours[p]);
    const double colour = distance < bend
                              ? kBendValue / bend * distance
                              : kBendValue + (distance - bend) / (most - bend) * (1 - kBendValue);
    // Features that only one picture has.
    const double feature =
        std::max(std::abs(a.edges[p] - b.edges[p]), std::abs(a.points[p] - b.points[p]));
    // They make a difference in colour larger, and none out of nothing.
    const double exponent = 1 - std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
    out.values[p] = float(std::clamp(std::pow(colour, exponent), 0.0, 1.0));
  }
  return out;
}

}  // namespace nepho
