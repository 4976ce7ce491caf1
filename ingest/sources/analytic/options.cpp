#include "sources/analytic/options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace nepho::analytic {
namespace {

std::string metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g m", value);
  return text;
}

// Extinction in the middle, from either way to say it; `length_m` turns depth into extinction.
double extinction(Parameters& p, double length_m, double default_depth,
                  const std::string& side = "") {
  const std::string depth_name = "optical_depth" + side, name = "extinction" + side + "_per_m";
  const std::optional<double> depth = p.number(depth_name), given = p.number(name);
  if (depth && given)
    throw Error({"two ways to say one thing", p.where(name),
                 "one of " + name + " and " + depth_name, "both", ""});
  for (const auto& [value, which] : {std::pair{depth, depth_name}, std::pair{given, name}})
    if (value && *value < 0)
      throw Error({"out of range", p.where(which), "0 or more", std::to_string(*value), ""});
  return given ? *given : depth.value_or(default_depth) / length_m;
}

void set_optics(Parameters& p, VolumeInfo& info) {
  if (p.number("asymmetry"))
    info.phase = {PhaseKind::kHenyeyGreenstein, info.phase.effective_radius_m,
                  p.number_in("asymmetry", 0, -0.999, 0.999)};
  else
    info.phase.effective_radius_m = p.positive("effective_radius_m", info.phase.effective_radius_m);
  info.co_albedo = glm::dvec3(p.number_in("co_albedo", 0, 0, 1));
}

// Masks that split x and y until a cell is no wider than `aspect` times its height.
std::vector<SplitMask> flat_first(double width_m, double height_m, double aspect, int levels) {
  std::vector<SplitMask> masks;
  for (int level = 0; level < levels; ++level) {
    const bool flat = width_m > aspect * height_m;
    masks.push_back(flat ? kSplitXy : kSplitXyz);
    width_m /= 2;
    if (!flat) height_m /= 2;
  }
  return masks;
}

// `natural` is what "auto" stands for.
Lattice make_lattice(Parameters& p, const std::string& natural, double width_m, double height_m,
                     int default_level) {
  const int levels = p.integer("max_level", default_level, 0, NodeKey::kMaxSplitsZ);
  const double aspect = p.positive("aspect", 4);
  std::string axes = p.choice("split_axes", {"auto", "xyz", "xy", "z", "x", "xy_xyz"});
  if (axes == "auto") axes = natural;
  if (axes == "xy_xyz") return Lattice(flat_first(width_m, height_m, aspect, levels));
  const SplitMask mask = axes == "xyz"  ? kSplitXyz
                         : axes == "xy" ? kSplitXy
                         : axes == "z"  ? kSplitZ
                                        : SplitMask{0b001};
  return Lattice(std::vector<SplitMask>(std::size_t(levels), mask));
}

double exponential_depth_m(double scale_m, double thickness_m) {
  return -scale_m * std::expm1(-thickness_m / scale_m);
}

// Integral of the lowered Gaussian along a line through its middle, over sigma.
double gaussian_length(double cutoff) {
  const double foot = std::exp(-cutoff * cutoff / 2);
  return (std::sqrt(2 * std::numbers::pi) * std::erf(cutoff / std::numbers::sqrt2) -
          2 * cutoff * foot) /
         (1 - foot);
}

std::string exponential_fact(double scale_m, double thickness_m) {
  char text[120];
  std::snprintf(text, sizeof text, "the exponential ends at the top, at %.2g of its bottom value",
                std::exp(-thickness_m / scale_m));
  return text;
}

// The box's walls in the local frame, and where they stand in the world.
class BoxMaker {
 public:
  BoxMaker(Parameters& p, const Placement& placement)
      : p_(p), shear_x_(p.number("shear_xz", 0)), shear_y_(p.number("shear_yz", 0)) {
    for (int c = 0; c < 3; ++c) {
      origin_[c] = placement.origin_ecef_m[c];
      for (int r = 0; r < 3; ++r) axes_[c][r] = placement.axes[3 * c + r];
    }
  }

  std::shared_ptr<const BoxChart> make(glm::dvec3 size_m, Periodic periodic) {
    const glm::dmat3 edges = shape(size_m);
    const std::optional<double> middle_z = p_.number("center_z_m"), base_z = p_.number("base_z_m");
    if (middle_z && base_z)
      throw Error({"two ways to say one thing", p_.where("base_z_m"),
                   "one of base_z_m and center_z_m", "both", ""});
    const double bottom_z = middle_z ? *middle_z - size_m.z / 2 : base_z.value_or(0);
    const glm::dvec3 foot = {p_.number("center_x_m", 0), p_.number("center_y_m", 0), bottom_z};
    // The middle of the box stands over `foot`, sheared or not.
    const glm::dvec3 corner = foot + glm::dvec3{0, 0, size_m.z / 2} - edges * glm::dvec3(0.5);
    return std::make_shared<BoxChart>(origin_ + axes_ * corner, axes_ * edges, periodic);
  }
  // A box whose walls are at least `reach_m` from its middle.
  std::shared_ptr<const BoxChart> around(double reach_m) {
    const glm::dmat3 inverse = glm::transpose(glm::inverse(shape(glm::dvec3(1))));
    double grow = 1;  // walls of a leaning box are nearer than half an edge
    for (int a = 0; a < 3; ++a) grow = std::max(grow, glm::length(inverse[a]));
    return make(glm::dvec3(2 * reach_m * grow), {});
  }

 private:
  glm::dmat3 shape(glm::dvec3 s) const {
    return {{s.x, 0, 0}, {0, s.y, 0}, {shear_x_ * s.z, shear_y_ * s.z, s.z}};
  }
  Parameters& p_;
  double shear_x_, shear_y_;
  glm::dvec3 origin_{0.0};
  glm::dmat3 axes_{1.0};
};

void make_step_cloud(Parameters& p, BoxMaker& boxes, Volume& v) {
  const glm::dvec3 size = {p.positive("size_x_m", 500), p.positive("size_y_m", 500),
                           p.positive("size_z_m", 250)};
  v.info.chart = boxes.make(size, {true, true});
  v.info.lattice = make_lattice(p, "x", size.x, size.z, 5);
  v.kind = step_cloud(extinction(p, size.z, 2, "_left"), extinction(p, size.z, 18, "_right"));
}

void make_layer(Parameters& p, const std::string& kind, BoxMaker& boxes, Volume& v) {
  if (kind == "cube") {
    const double size_m = p.positive("size_m", 1000);
    v.info.chart = boxes.make(glm::dvec3(size_m), {});
    v.info.lattice = make_lattice(p, "xyz", size_m, size_m, 5);
    v.kind = uniform(extinction(p, size_m, 10));
    return;
  }
  const glm::dvec3 size = {p.positive("size_x_m", 1000), p.positive("size_y_m", 1000),
                           p.positive("size_z_m", 1000)};
  const bool open = kind == "constant";
  v.info.chart = boxes.make(size, {!open, !open});
  const bool varies = kind == "exponential";
  v.info.lattice = make_lattice(p, varies ? "z" : "xyz", size.x, size.z, 5);
  if (varies) {
    const double scale_m = p.positive("scale_height_m", size.z / 8);
    v.kind = exponential(extinction(p, exponential_depth_m(scale_m, size.z), 10), scale_m / size.z);
    v.info.facts.push_back(exponential_fact(scale_m, size.z));
  } else {
    v.kind = uniform(extinction(p, size.z, kind == "half_space" ? 1000 : 10));
    if (kind == "half_space")
      v.info.facts.push_back("the half space is " + metres(size.z) + " thick");
  }
}

void make_ball(Parameters& p, const std::string& kind, BoxMaker& boxes, Volume& v) {
  v.info.lattice = make_lattice(p, "xyz", 1, 1, 5);
  const Index3& n = v.info.lattice.cells(v.info.lattice.max_level());
  // One voxel of zeros to each wall, on the coarsest axis.
  const double cells = std::min({n[0], n[1], n[2]});
  if (kind == "gaussian") {
    const double sigma_m = p.positive("sigma_m", 200);
    const double cutoff = p.number_in("cutoff_sigmas", 5, 1, 20);
    const auto chart = boxes.around(cutoff * sigma_m / (1 - 2 / cells));
    v.info.chart = chart;
    v.kind =
        gaussian(*chart, extinction(p, gaussian_length(cutoff) * sigma_m, 10), sigma_m, cutoff);
    v.info.facts.push_back("the Gaussian is lowered to reach zero at " + metres(cutoff * sigma_m));
    return;
  }
  const double radius_m = p.positive("radius_m", 500);
  const std::optional<double> given_edge = p.positive("edge_m");
  const double reach_m =
      given_edge ? (radius_m + *given_edge / 2) / (1 - 2 / cells) : radius_m / (1 - 3 / cells);
  const auto chart = boxes.around(reach_m);
  const double edge_m = given_edge.value_or(2 * (reach_m - radius_m) / 3);
  if (edge_m > 2 * radius_m)
    throw Error({"out of range", p.where("edge_m"), "at most the diameter", metres(edge_m), ""});
  v.info.chart = chart;
  v.kind = sphere(*chart, extinction(p, 2 * radius_m, 10), radius_m, edge_m);
  v.info.facts.push_back("the sphere's rim is " + metres(edge_m) + " wide");
}

void make_shell(Parameters& p, const std::string& kind, const SourceRequest& request, Volume& v) {
  const std::optional<double> radius_m = p.positive("body_radius_m");
  const Ellipsoid body = radius_m ? Ellipsoid::sphere(*radius_m) : Ellipsoid::wgs84();
  const double bottom_m = p.number("bottom_m", 0), top_m = p.number("top_m", 16000);
  const double thickness_m = top_m - bottom_m;
  if (!(thickness_m > 0) || !(body.polar_m + bottom_m > 0))
    throw Error({"out of range", p.where("top_m"), "above bottom_m, which is above the centre",
                 metres(bottom_m) + " to " + metres(top_m), ""});
  const auto chart = std::make_shared<ShellChart>(body, bottom_m, top_m);
  v.info.chart = chart;
  const double width_m = std::numbers::pi / 2 * body.equatorial_m;
  const std::string natural = kind == "gaussian" ? "xy_xyz" : kind == "exponential" ? "z" : "xyz";
  v.info.lattice = make_lattice(p, natural, width_m, thickness_m, 6);
  chart->check(v.info.lattice);
  if (kind == "exponential") {
    const double scale_m = p.positive("scale_height_m", thickness_m / 8);
    v.kind = exponential(extinction(p, exponential_depth_m(scale_m, thickness_m), 10),
                         scale_m / thickness_m);
    v.info.facts.push_back(exponential_fact(scale_m, thickness_m));
  } else if (kind == "gaussian") {
    const double* origin = request.placement.origin_ecef_m;
    const glm::dvec3 centre = {origin[0], origin[1], origin[2]};
    if (!(glm::length(centre) > 0))
      throw Error(
          {"a Gaussian on the shell needs a place", p.where("kind"), "a place", "none", ""});
    const ShellBlob blob = {centre, p.positive("sigma_m", 3e5),
                            p.positive("sigma_z_m", thickness_m / 12),
                            p.number_in("cutoff_sigmas", 5, 1, 20)};
    v.kind = shell_gaussian(
        *chart, extinction(p, gaussian_length(blob.cutoff) * blob.vertical_m, 10), blob);
    const double height_m = glm::length(chart->to_scaled(centre)) - body.equatorial_m;
    const double reach_m = blob.cutoff * blob.vertical_m;
    if (height_m - reach_m < bottom_m || height_m + reach_m > top_m)
      v.info.facts.push_back("the Gaussian is cut off at the shell's bottom or top");
  } else {
    v.kind = uniform(extinction(p, thickness_m, 10));
  }
}

}  // namespace

Volume make_volume(const SourceRequest& request) {
  Parameters p(request);
  if (request.file_count > 0)
    throw Error({"the analytic source reads no files", request.files[0], "no file", "", ""});
  Volume v;
  v.info.name = request.volume_name;
  const std::string kind = p.choice("kind", {"constant", "slab", "sphere", "gaussian",
                                             "exponential", "step_cloud", "cube", "half_space"});
  set_optics(p, v.info);
  if (p.choice("chart", {"box", "shell"}) == "shell") {
    if (kind != "constant" && kind != "slab" && kind != "exponential" && kind != "gaussian")
      throw Error({"no such kind on a shell", p.where("kind"),
                   "one of constant, slab, exponential, gaussian", kind, ""});
    make_shell(p, kind, request, v);
  } else {
    BoxMaker boxes(p, request.placement);
    if (kind == "step_cloud")
      make_step_cloud(p, boxes, v);
    else if (kind == "sphere" || kind == "gaussian")
      make_ball(p, kind, boxes, v);
    else
      make_layer(p, kind, boxes, v);
  }
  p.finish();
  return v;
}

}  // namespace nepho::analytic
