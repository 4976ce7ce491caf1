// Files of OpenVDB: which grid is meant, and reading it.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>

#include "core/error.h"
#include "vdb_archive.h"
#include "vdb_container.h"
#include "vdb_tree.h"

namespace nepho::vdb {
namespace {

using openvdb::GridBase;

std::string where(const std::string& file, const std::string& grid) {
  return grid.empty() ? file : file + " [" + grid + "]";
}

// Whatever OpenVDB throws on a damaged file, as one clear Error.
template <class Action>
auto guarded(const std::string& file, const std::string& grid, Action&& action) {
  const auto damaged = [&](const std::string& found) {
    return Error({"OpenVDB cannot read the file", where(file, grid), "an intact VDB file", found,
                  "write or copy it again"});
  };
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw damaged("a claim of more memory than there is");
  } catch (const std::exception& e) {
    throw damaged(e.what());
  } catch (...) {
    throw damaged("an unknown failure");
  }
}

std::string value_type(const GridBase& grid) {
  const bool is_half = grid.isType<openvdb::FloatGrid>() && grid.saveFloatAsHalf();
  return is_half ? "half" : grid.valueType();
}

std::string describe(const GridBase& grid) {
  return (grid.getName().empty() ? "(no name)" : grid.getName()) + " (" + value_type(grid) + ", " +
         GridBase::gridClassToString(grid.getGridClass()) + ")";
}

std::string list(const std::vector<GridBase::ConstPtr>& grids) {
  std::string text;
  for (const auto& grid : grids) text += (text.empty() ? "" : ", ") + describe(*grid);
  return text;
}

// A missing class counts as fog.
bool is_fog(const GridBase& grid) {
  const bool is_scalar = grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>();
  const auto grid_class = grid.getGridClass();
  return is_scalar &&
         (grid_class == openvdb::GRID_FOG_VOLUME || grid_class == openvdb::GRID_UNKNOWN);
}

const char* refusal(const GridBase& grid) {
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) return "a level set is no density";
  return "this grid is no density";
}

GridBase::ConstPtr choose(const std::string& file, const std::string& wanted,
                          const std::vector<GridBase::ConstPtr>& all) {
  const std::string fog = "a float, half or double fog volume";
  const auto named = [&](const std::string& name, bool fog_only) {
    const auto at = std::ranges::find_if(
        all, [&](const auto& g) { return g->getName() == name && (!fog_only || is_fog(*g)); });
    return at == all.end() ? nullptr : *at;
  };
  if (!wanted.empty()) {
    if (auto grid = named(wanted, true)) return grid;
    if (auto grid = named(wanted, false))
      throw Error({refusal(*grid), where(file, wanted), fog, describe(*grid), ""});
    throw Error(
        {"no grid of this name", where(file, wanted), "one of the file's grids", list(all), ""});
  }
  if (auto grid = named("density", true)) return grid;
  std::vector<GridBase::ConstPtr> fogs;
  std::ranges::copy_if(all, std::back_inserter(fogs), [](const auto& g) { return is_fog(*g); });
  if (fogs.size() == 1) return fogs.front();
  if (fogs.empty())
    throw Error({"no density in this file", file, fog, list(all),
                 "level sets, points and vectors are not drawn"});
  throw Error({"several grids could be the density", file, "one, or one named density", list(fogs),
               "choose with the parameter grid"});
}

bool names_blender(const openvdb::MetaMap& map) {
  for (auto it = map.beginMeta(); it != map.endMeta(); ++it) {
    if (!it->second || it->second->typeName() != openvdb::StringMetadata::staticTypeName())
      continue;
    std::string text = it->second->str();
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    if (text.find("blender") != std::string::npos) return true;
  }
  return false;
}

void read_transform(const std::string& file, const GridBase& grid, VdbHeader& header) {
  const auto refuse = [&](const char* what, const char* found) {
    throw Error({what, where(file, header.grid), "an affine, invertible transform", found, ""});
  };
  if (!grid.transform().isLinear())
    refuse("the grid's transform is not affine", "a frustum or another curved map");
  const openvdb::Mat4d m = grid.transform().baseMap()->getAffineMap()->getMat4();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      if (!std::isfinite(m(row, column)))
        refuse("the grid's transform is not finite", "NaN or infinity");
  for (int a = 0; a < 3; ++a) header.linear[a] = {m(a, 0), m(a, 1), m(a, 2)};
  header.translation = {m(3, 0), m(3, 1), m(3, 2)};
  double lengths = 1;
  for (int a = 0; a < 3; ++a) lengths *= glm::length(header.linear[a]);
  if (!(std::abs(glm::determinant(header.linear)) > 1e-9 * lengths))
    refuse("the grid's transform is singular", "axes that span no volume");
}

// The box in the metadata is never used, but where there are voxels it tells a damaged file: one
// that is inverted, or wider than voxels can be numbered.
void check_metadata_box(const std::string& file, const GridBase& grid,
                        const openvdb::CoordBBox& active) {
  const auto low = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
  const auto high = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
  if (!low || !high || active.empty()) return;
  const openvdb::Vec3i first(active.min().asPointer()), last(active.max().asPointer());
  if (low->value() == first && high->value() == last) return;  // however far the voxels reach
  constexpr std::int64_t kMost = std::int64_t{1} << 31;
  const auto text = [](const openvdb::Vec3i& v) {
    return "(" + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) +
           ")";
  };
  for (int a = 0; a < 3; ++a) {
    const std::int64_t width = std::int64_t(high->value()[a]) - low->value()[a] + 1;
    if (width > 0 && width <= kMost) continue;
    throw Error({width > 0 ? "the bounding box in the metadata is too large: the file is damaged"
                           : "the bounding box in the metadata is inverted: the file is damaged",
                 where(file, grid.getName()),
                 "one around the voxels, " + text(first) + " to " + text(last),
                 text(low->value()) + " to " + text(high->value()), "write or copy it again"});
  }
}

// The first entry of this name.
const VdbArchive::Entry& entry_of(const VdbArchive& archive, const std::string& name) {
  const auto at = std::ranges::find(archive.entries(), name,
                                    [](const auto& entry) { return entry.grid->getName(); });
  if (at == archive.entries().end())
    throw openvdb::LookupError("the file has no grid " + name + " any more");
  return *at;
}

}  // namespace

void IndexBox::add(const IndexBox& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::min(low[a], other.low[a]);
    high[a] = std::max(high[a], other.high[a]);
  }
}

VdbHeader read_header(const std::string& file, const std::string& wanted) {
  check_container(file);
  return guarded(file, wanted, [&] {
    VdbArchive archive(file);
    VdbHeader header;
    std::vector<GridBase::ConstPtr> all;
    for (const auto& entry : archive.entries()) all.push_back(entry.grid);
    if (all.empty()) return header;
    const GridBase::ConstPtr chosen = choose(file, wanted, all);
    header.has_grid = true;
    header.grid = chosen->getName();
    header.value_type = value_type(*chosen);
    const auto same =
        std::ranges::count(all, header.grid, [](const auto& g) { return g->getName(); });
    if (same > 1)
      header.remarks.push_back("The file has " + std::to_string(same) + " grids named " +
                               header.grid + "; the first is used.");
    header.from_blender = names_blender(*chosen) || names_blender(archive.metadata());
    read_transform(file, *chosen, header);
    const openvdb::CoordBBox box =
        archive.topology(entry_of(archive, header.grid))->evalActiveVoxelBoundingBox();
    check_metadata_box(file, *chosen, box);
    if (!box.empty())
      for (int a = 0; a < 3; ++a) {
        header.active.low[std::size_t(a)] = box.min()[a];
        header.active.high[std::size_t(a)] = box.max()[a];
      }
    return header;
  });
}

std::unique_ptr<VdbGrid> read_grid(const std::string& file, const std::string& grid) {
  check_container(file);
  return guarded(file, grid, [&] {
    VdbArchive archive(file);
    std::unique_ptr<VdbGrid> result = make_grid(archive.whole(entry_of(archive, grid)));
    if (!result)
      throw Error({"this grid is no density", where(file, grid),
                   "a float, half or double fog volume", "another type under the same name", ""});
    return result;
  });
}

}  // namespace nepho::vdb
