#include "volume_layout.h"

#include <algorithm>
#include <cmath>

#include "bricks/box_chart.h"
#include "core/error.h"

namespace nepho::vdb {
namespace {

constexpr std::int64_t kMostCells = std::int64_t{kBrickCells} << NodeKey::kMaxSplitsZ;
constexpr double kSameTransform = 1e-6;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

// Translations are compared in voxels, so that a domain far from its origin is not let off.
double difference(const VdbHeader& a, const VdbHeader& b) {
  double voxel = 0, most = 0;
  for (int axis = 0; axis < 3; ++axis) voxel = std::max(voxel, glm::length(a.linear[axis]));
  for (int axis = 0; axis < 3; ++axis)
    most = std::max(most, glm::length(a.linear[axis] - b.linear[axis]));
  return std::max(most, glm::length(a.translation - b.translation)) / voxel;
}

// One fact for each run of missing frames: a sequence may lack most of a million.
void report_gaps(VolumeLayout& layout) {
  const std::vector<long>& gaps = layout.sequence.gaps;
  for (std::size_t first = 0, end; first < gaps.size(); first = end) {
    end = first + 1;
    while (end < gaps.size() && gaps[end] == gaps[end - 1] + 1) ++end;
    const std::string which = end - first == 1 ? "Frame " + std::to_string(gaps[first]) + " is"
                                               : "Frames " + std::to_string(gaps[first]) + " to " +
                                                     std::to_string(gaps[end - 1]) + " are";
    layout.facts.push_back(which + " missing: the one before is held.");
  }
}

void read_headers(const Options& options, VolumeLayout& layout) {
  layout.grid = options.grid;
  bool has_first = false;
  std::size_t empty = 0;
  for (const std::string& file : layout.sequence.files) {
    layout.headers.push_back(read_header(file, layout.grid));
    const VdbHeader& header = layout.headers.back();
    if (header.has_grid) layout.grid = header.grid;
    if (header.active.empty()) {
      ++empty;  // legal; its transform places nothing
      continue;
    }
    if (!has_first) layout.first_file = layout.headers.size() - 1, has_first = true;
    const double apart = difference(layout.headers[layout.first_file], header);
    if (apart > kSameTransform)
      throw Error({"the frames' transforms differ", file + " [" + header.grid + "]",
                   "that of " + layout.sequence.files[layout.first_file] + " to 1e-6 voxels",
                   text(apart) + " voxels of difference", "a moving grid is not supported"});
    layout.active.add(header.active);
  }
  if (empty > 0)
    layout.facts.push_back(std::to_string(empty) + " of " + std::to_string(layout.headers.size()) +
                           " files have no active voxel.");
  if (!layout.headers[layout.first_file].has_grid && options.grid.empty())
    layout.facts.push_back("The file has no grid at all: an empty volume.");
  report_gaps(layout);
}

void fit_lattice(VolumeLayout& layout) {
  if (layout.has_voxels()) {
    std::int64_t needed = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      // rounds down for negative indices too
      layout.origin[a] = (layout.active.low[a] - 1) & ~std::int64_t{7};
      needed = std::max(needed, layout.active.high[a] + 1 - layout.origin[a]);
    }
    while (layout.cover < needed) layout.cover *= 2;
    if (layout.cover > kMostCells)
      throw Error({"the active voxels are too far apart",
                   layout.sequence.files[layout.first_file] + " [" + layout.grid + "]",
                   "at most " + std::to_string(kMostCells) + " voxels along an axis",
                   std::to_string(needed), "delete stray voxels, or split the volume"});
  }
  std::vector<SplitMask> splits;
  for (std::int64_t cells = kBrickCells; cells < layout.cover; cells *= 2)
    splits.push_back(kSplitXyz);
  layout.lattice = Lattice(std::move(splits));
  for (std::size_t a = 0; a < 3 && layout.has_voxels(); ++a) {
    const auto axis = int(a);
    layout.bounds.low[axis] =
        double(layout.active.low[a] - 1 - layout.origin[a]) / double(layout.cover);
    layout.bounds.high[axis] =
        double(layout.active.high[a] + 1 - layout.origin[a]) / double(layout.cover);
  }
}

UpAxis up_axis(const Options& options, const VdbHeader& header, VolumeLayout& layout) {
  if (options.up) return *options.up;
  layout.assumptions.push_back(header.from_blender
                                   ? "Up is the z axis: the file's metadata name Blender."
                                   : "Up is the y axis: nothing in the file says otherwise.");
  return header.from_blender ? UpAxis::kZ : UpAxis::kY;
}

void place(const Options& options, const Placement& placement, VolumeLayout& layout) {
  const VdbHeader& header = layout.headers[layout.first_file];
  const UpAxis up = up_axis(options, header, layout);
  if (!options.metres_per_unit) layout.assumptions.push_back("1 unit of the file is 1 m.");
  const double metres = options.metres_per_unit.value_or(1.0);
  const auto local_m = [&](const glm::dvec3& p) {
    return metres * (up == UpAxis::kZ ? p : glm::dvec3(p.x, -p.z, p.y));
  };
  for (int a = 0; a < 3; ++a) layout.voxel_m[a] = local_m(header.linear[a]);
  const glm::dvec3 first = {double(layout.origin[0]), double(layout.origin[1]),
                            double(layout.origin[2])};
  const glm::dvec3 corner_m = layout.voxel_m * first + local_m(header.translation);

  const double* axes = placement.axes;
  const glm::dmat3 to_ecef = {axes[0], axes[1], axes[2], axes[3], axes[4],
                              axes[5], axes[6], axes[7], axes[8]};
  const double* o = placement.origin_ecef_m;
  layout.chart = std::make_shared<BoxChart>(glm::dvec3(o[0], o[1], o[2]) + to_ecef * corner_m,
                                            to_ecef * (double(layout.cover) * layout.voxel_m));
}

}  // namespace

Coord3 VolumeLayout::corner(NodeKey key) const {
  Coord3 result{};
  for (std::size_t a = 0; a < 3; ++a)
    result[a] = std::int32_t(origin[a] + std::int64_t{kBrickCells} * key.ijk()[a]);
  return result;
}

VolumeLayout lay_out(const Options& options, const Placement& placement) {
  VolumeLayout layout;
  layout.sequence = find_sequence(options.file);
  read_headers(options, layout);
  fit_lattice(layout);
  place(options, placement, layout);
  for (const std::string& remark : layout.headers[layout.first_file].remarks)
    layout.facts.push_back(remark);
  return layout;
}

}  // namespace nepho::vdb
