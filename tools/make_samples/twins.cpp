#include "twins.h"

#include <cmath>
#include <fstream>
#include <limits>

#include "hash_noise.h"

namespace nepho::samples {
namespace {

namespace fs = std::filesystem;
using Grids = std::vector<SampleGrid>;

SampleGrid with(SampleGrid grid, const std::function<void(SampleGrid&)>& change) {
  change(grid);
  return grid;
}

SampleBlock tile(const Voxel& origin, std::int32_t size, double value) {
  return {origin, size, {}, value};
}

// Ends on leaf walls and inside them, and leans.
glm::dmat3 sheared() {
  return {{1.2, 0.4, -0.3}, {-0.5, 0.9, 0.2}, {0.35, 0.15, 1.6}};
}

Twin single(const std::string& name, const std::string& what, std::function<Grids()> grids,
            const std::string& creator = "nephoscope", bool statistics = true) {
  return {name, what,
          [=](const fs::path& folder, const VdbWriter& writer) {
            writer.write(folder / (name + ".vdb"), grids(), creator, statistics);
          },
          name + ".vdb"};
}

Twin raw(const std::string& name, const std::string& what,
         std::function<std::string(const std::string& intact)> damage) {
  return {name, what,
          [=](const fs::path& folder, const VdbWriter& writer) {
            const fs::path path = folder / (name + ".vdb");
            writer.write(path, {puff_grid()});
            std::ifstream in(path, std::ios::binary);
            const std::string intact((std::istreambuf_iterator<char>(in)), {});
            in.close();
            std::ofstream(path, std::ios::binary) << damage(intact);
          },
          name + ".vdb"};
}

SampleGrid with_box(const Voxel& low, const Voxel& high, std::vector<SampleBlock> blocks) {
  return with(puff_grid(), [&](SampleGrid& g) {
    g.blocks = std::move(blocks);
    g.metadata = {{"file_bbox_min", "", low, false}, {"file_bbox_max", "", high, false}};
  });
}

// Frame 1 empty, frame 3 missing.
void write_sequence(const fs::path& folder, const VdbWriter& writer) {
  const auto shifted = [](std::int32_t by) {
    return with(puff_grid(), [&](SampleGrid& g) {
      g.blocks = sample({-40, -40, -40}, {60, 60, 60}, [=](const Voxel& v) {
        return puff({v[0], v[1] - by, v[2]});
      });
    });
  };
  const SampleGrid empty = with(puff_grid(), [](SampleGrid& g) { g.blocks.clear(); });
  writer.write(folder / "sequence.0001.vdb", {empty});
  writer.write(folder / "sequence.0002.vdb", {shifted(0)});
  writer.write(folder / "sequence.0004.vdb", {shifted(17)});
}

void write_moving(const fs::path& folder, const VdbWriter& writer) {
  writer.write(folder / "moving.01.vdb", {puff_grid()});
  writer.write(folder / "moving.02.vdb", {with(puff_grid(), [](SampleGrid& g) {
                 g.translation = {0.25, 0, 0};
               })});
}

Grids mixed_tiles() {
  SampleGrid g = puff_grid();
  // beside the puff: tiles of all sizes that touch one another and leaves
  g.blocks.push_back(tile({128, 0, 0}, 128, 0.5));
  g.blocks.push_back(tile({256, 0, 0}, 128, 0.5));
  g.blocks.push_back(tile({128, 128, 0}, 128, 0.125));
  g.blocks.push_back(tile({120, 8, 8}, 8, 0.75));
  g.blocks.push_back(tile({-128, 0, 0}, 8, 0.25));
  return {g};
}

std::vector<Twin> regular() {
  const auto changed = [](const std::function<void(SampleGrid&)>& change) {
    return [=] { return Grids{with(puff_grid(), change)}; };
  };
  return {
      single("plain", "one float fog grid", changed([](SampleGrid&) {})),
      single("half", "half floats", changed([](SampleGrid& g) { g.value = VdbValue::kHalf; })),
      single("double", "a double grid",
             changed([](SampleGrid& g) { g.value = VdbValue::kDouble; })),
      single("non_uniform", "voxels of three different sizes", changed([](SampleGrid& g) {
               g.columns = {{0.1326, 0, 0}, {0, 0.1329, 0}, {0, 0, 0.1317}};
               g.translation = {0.3, -7, 2};
             })),
      single("sheared", "a rotated and sheared grid", changed([](SampleGrid& g) {
               g.columns = sheared();
               g.translation = {100, -3, 8};
             })),
      single("other_name", "a fog grid that is not called density, beside a velocity",
             [] {
               return Grids{with(puff_grid(), [](SampleGrid& g) { g.name = "smoke"; }),
                            with(puff_grid(), [](SampleGrid& g) {
                              g.name = "velocity", g.value = VdbValue::kVec3;
                              g.grid_class = VdbClass::kUnknown;
                            })};
             }),
      single("no_class", "a grid without a class",
             changed([](SampleGrid& g) { g.grid_class = VdbClass::kUnknown; })),
      single("blender", "metadata that name Blender: z is up", changed([](SampleGrid&) {}),
             "Blender/Mantaflow"),
      single("tiles", "active tiles beside leaves", mixed_tiles),
      single("huge_tile", "one active tile of 4096^3 voxels", changed([](SampleGrid& g) {
               g.blocks = {tile({0, 0, 0}, 4096, 0.01)};
             })),
      single("not_finite", "NaN, infinite and negative densities", changed([](SampleGrid& g) {
               g.blocks[0].values[7] = std::numeric_limits<double>::quiet_NaN();
               g.blocks[0].values[8] = std::numeric_limits<double>::infinity();
               g.blocks[0].values[9] = g.blocks[0].values[10] = -0.5;
             })),
      single("background", "inactive values that are not 0",
             changed([](SampleGrid& g) { g.background = 0.25; })),
      single("zeros", "active voxels of value 0",
             changed([](SampleGrid& g) { g.all_active = true; })),
      single("empty", "a grid without active voxels",
             changed([](SampleGrid& g) { g.blocks.clear(); })),
      single(
          "empty_inverted", "a grid without voxels whose box is inverted: legal",
          [] {
            return Grids{with_box({2147483647, 2147483647, 2147483647},
                                  {-2147483647, -2147483647, -2147483647}, {})};
          },
          "nephoscope", false),
      {"sequence", "frame 1 empty, frame 3 missing", write_sequence, "sequence.####.vdb"},
  };
}

std::vector<Twin> refused() {
  const auto changed = [](const std::function<void(SampleGrid&)>& change) {
    return [=] { return Grids{with(puff_grid(), change)}; };
  };
  return {
      single("level_set", "only a level set",
             changed([](SampleGrid& g) { g.grid_class = VdbClass::kLevelSet; })),
      single("vec3_only", "only a vector grid", changed([](SampleGrid& g) {
               g.value = VdbValue::kVec3;
               g.grid_class = VdbClass::kUnknown;
             })),
      single("points", "only points", changed([](SampleGrid& g) {
               g.value = VdbValue::kPoints;
               g.grid_class = VdbClass::kUnknown;
             })),
      single("several", "several fog grids, none called density",
             [] {
               return Grids{with(puff_grid(), [](SampleGrid& g) { g.name = "smoke"; }),
                            with(puff_grid(), [](SampleGrid& g) { g.name = "steam"; })};
             }),
      single(
          "box_inverted", "an inverted bounding box in the metadata",
          [] {
            return Grids{with_box({50, 50, 50}, {-50, -50, -50}, puff_grid().blocks)};
          },
          "nephoscope", false),
      single(
          "box_overflowing", "a bounding box of 2^32 voxels in the metadata",
          [] {
            return Grids{with_box({-2147483647, -2147483647, -2147483647},
                                  {2147483647, 2147483647, 2147483647}, puff_grid().blocks)};
          },
          "nephoscope", false),
      single("singular", "a transform without depth", changed([](SampleGrid& g) {
               g.columns = {{1, 0, 0}, {0, 1, 0}, {1, 1, 1e-12}};
             })),
      single("far_specks", "two voxels too far apart for any lattice", changed([](SampleGrid& g) {
               g.blocks = {tile({-2000000000, 0, 0}, 8, 1), tile({2000000000, 0, 0}, 8, 1)};
             })),
      raw("truncated", "the first half of a file",
          [](const std::string& intact) { return intact.substr(0, intact.size() / 2); }),
      raw("truncated_header", "the first 80 bytes of a file",
          [](const std::string& intact) { return intact.substr(0, 80); }),
      raw("text", "text named .vdb", [](const std::string&) { return "density 0.5\n"; }),
      raw("no_bytes", "an empty file", [](const std::string&) { return ""; }),
      {"moving", "a transform that changes between frames", write_moving, "moving.##.vdb"},
  };
}

}  // namespace

const std::vector<Twin>& twins() {
  static const std::vector<Twin> all = [] {
    std::vector<Twin> list = regular(), bad = refused();
    list.insert(list.end(), bad.begin(), bad.end());
    return list;
  }();
  return all;
}

double puff(const Voxel& v) {
  const glm::dvec3 d = glm::dvec3(v[0] - 12, v[1] - 9, v[2] - 7) / 20.0;
  const double noise = unit(hash(v[0], v[1], v[2], 1));
  return float(std::max(0.0, 1 - glm::dot(d, d)) * (0.5 + 0.5 * noise));
}

SampleGrid puff_grid() {
  SampleGrid grid;
  grid.blocks = sample({-10, -13, -15}, {34, 31, 29}, puff);
  return grid;
}

SampleGrid far_pair(double apart_m, double active) {
  constexpr double kVoxel_m = 3.4;
  const auto apart = std::int32_t(apart_m / kVoxel_m);
  // a ball with about this many voxels, roughened by noise
  const auto radius = std::int32_t(std::cbrt(0.5 * active * 3 / (4 * 3.14159265)));
  SampleGrid grid;
  grid.columns = glm::dmat3(kVoxel_m);
  for (const std::int32_t centre : {0, apart}) {
    const auto ball =
        sample({centre - radius - 8, -radius - 8, -radius - 8},
               {centre + radius + 8, radius + 8, radius + 8}, [=](const Voxel& v) {
                 const glm::dvec3 p = {v[0] - centre, v[1], v[2]};
                 const double skin = radius + 6 * gradient_noise(p / 17.0, 4);
                 return glm::length(p) < skin ? 0.2 + unit(hash(v[0], v[1], v[2], 2)) : 0.0;
               });
    grid.blocks.insert(grid.blocks.end(), ball.begin(), ball.end());
  }
  return grid;
}

}  // namespace nepho::samples
