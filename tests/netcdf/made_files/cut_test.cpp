// One row, one column and one cell of a forecast are the whole file's; one level is, or is refused
// with one message that says why.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "../remapped.h"
#include "core/error.h"
#include "cut_file.h"
#include "made_vertical.h"
#include "sources/netcdf/open_netcdf.h"

namespace nepho::test {
namespace {

using namespace samples;

double apart_deg(glm::dvec2 a, glm::dvec2 b) {
  const double turn = std::remainder(a.y - b.y, 360.0) * std::cos(a.x * 0.017453292519943295);
  return std::hypot(a.x - b.x, turn);
}

struct Read {
  std::string refused;  // "" where it is read
  std::shared_ptr<const forecast::HorizontalGrid> grid;
  forecast::ForecastColumns columns;

  explicit Read(const fs::path& path) {
    forecast::OpenRequest request;
    request.files = {path.string()};
    try {
      const auto forecast = netcdf::open_netcdf(request);
      grid = forecast->grid(0);
      columns = forecast->columns(0);
    } catch (const Error& e) {
      refused = e.what();
    }
  }
  // Of the cell (x, y): optical depth, thickness of the cloud, a corner's distance in degrees.
  double depth(int x, int y) const {
    const auto nz = std::size_t(columns.nz);
    const std::size_t cell = std::size_t(y) * std::size_t(columns.nx) + std::size_t(x);
    double sum = 0;
    for (std::size_t k = 0; k < nz; ++k) {
      const float* z = &columns.interface_m[cell * (nz + 1) + k];
      sum += double(columns.extinction_per_m[cell * nz + k]) * double(z[1] - z[0]);
    }
    return sum;
  }
  // Width of the cell (x, y) along x, and height along y (deg of arc).
  glm::dvec2 size_deg(int x, int y) const {
    const auto at = [&](double a, double b) { return grid->lat_lon_deg(x + a, y + b); };
    return {apart_deg(at(0, 0.5), at(1, 0.5)), apart_deg(at(0.5, 0), at(0.5, 1))};
  }
};

// A cloudy cell of the whole, in the file's rows and columns.
std::pair<int, int> cloudy_cell(const Read& whole) {
  for (int y = 0; y < whole.columns.ny; ++y)
    for (int x = 0; x < whole.columns.nx; ++x)
      if (whole.depth(x, y) > 0.1) return {x, y};
  return {0, 0};
}

// Made `up`, so that indices are the file's.
fs::path made(const std::string& grid, const std::string& vertical) {
  const fs::path path = made_folder() / (grid + "_" + vertical + ".nc");
  write_made(path, grid, vertical, "up", nc_writer());
  return path;
}

std::string water_of(const fs::path& path) {
  for (const char* name : {"clw", "qc", "QCLOUD", "clwc", "cloud_water"}) try {
      CutFile::dimensions_of(path, name);
      return name;
    } catch (const std::runtime_error&) {
    }
  throw std::runtime_error("no water in " + path.string());
}

class CutGrids : public testing::TestWithParam<std::string> {};

TEST_P(CutGrids, RowsColumnsAndCellsAreTheWholes) {
  const fs::path path = made(GetParam(), "height");
  const Read whole(path);
  ASSERT_EQ(whole.refused, "");
  const auto [x, y] = cloudy_cell(whole);
  const std::vector<std::string> dims = CutFile::dimensions_of(path, water_of(path));
  const bool in_a_row = whole.columns.ny == 1;
  const std::string along = dims.back(), across = in_a_row ? "" : dims[dims.size() - 2];
  struct {
    const char* name;
    bool row, column;
  } const cases[] = {
      {"one row", true, false}, {"one column", false, true}, {"one cell", true, true}};
  for (const auto& c : cases) {
    if (in_a_row && !(c.row && c.column)) continue;
    Cuts cuts;
    if (c.column) cuts[along] = {std::size_t(x), 1};
    if (c.row && !in_a_row) cuts[across] = {std::size_t(y), 1};
    const fs::path cut = made_folder() / "cut.nc";
    CutFile(path, cut, cuts);
    const Read part(cut);
    ASSERT_EQ(part.refused, "") << c.name;
    const int px = c.column ? 0 : x, py = c.row ? 0 : y;
    EXPECT_EQ(part.columns.nx, c.column ? 1 : whole.columns.nx);
    EXPECT_NEAR(part.depth(px, py) / whole.depth(x, y), 1, 1e-5) << c.name;
    EXPECT_LT(apart_deg(part.grid->lat_lon_deg(px + 0.5, py + 0.5),
                        whole.grid->lat_lon_deg(x + 0.5, y + 0.5)),
              1e-3)
        << c.name;
    if (in_a_row) continue;
    // As large as they were, about square where that is not known, or 10 km.
    const glm::dvec2 now = part.size_deg(px, py), was = whole.size_deg(x, y);
    for (const int axis : {0, 1}) {
      const bool alone = c.row && c.column && now[axis] < 0.5 * was[axis];
      const double wanted = alone ? 10000 / 111195.0 : was[axis];
      EXPECT_GT(now[axis], 0.25 * wanted) << c.name;
      EXPECT_LT(now[axis], 4 * wanted) << c.name;
    }
  }
}

// Through the bricks, too.
TEST(Cuts, BricksHoldTheirOpticalDepth) {
  for (const char* name : {"lonlat", "lambert1", "curvilinear"})
    for (const bool row : {true, false})
      for (const bool column : {true, false}) {
        if (!row && !column) continue;
        const fs::path path = made(name, "height"), cut = made_folder() / "bricks.nc";
        const Read whole(path);
        const auto [x, y] = cloudy_cell(whole);
        const std::vector<std::string> dims = CutFile::dimensions_of(path, water_of(path));
        Cuts cuts;
        if (column) cuts[dims.back()] = {std::size_t(x), 1};
        if (row) cuts[dims[dims.size() - 2]] = {std::size_t(y), 1};
        CutFile(path, cut, cuts);
        forecast::OpenRequest request;
        request.files = {cut.string()};
        const Remapped r(netcdf::open_netcdf(request));
        EXPECT_NEAR(r.total() / file_total(r), 1, 2e-3) << name << row << column;
      }
}

class CutLevels : public testing::TestWithParam<std::string> {};

TEST_P(CutLevels, OneLevelIsTheWholesOrRefused) {
  const fs::path path = made("lonlat", GetParam());
  const Read whole(path);
  ASSERT_EQ(whole.refused, "");
  const std::size_t nz = std::size_t(whole.columns.nz), k = kMadeLowLayer + 1;
  Cuts cuts;
  const std::vector<std::string> dims = CutFile::dimensions_of(path, water_of(path));
  const std::string level = dims[dims.size() - 3];
  for (const auto& [name, size] : CutFile::lengths(path)) {
    if (name == level) cuts[name] = {k, 1};
    if (size == nz + 1) cuts[name] = {k, 2};  // half levels
  }
  const fs::path cut = made_folder() / "level.nc";
  CutFile(path, cut, cuts);
  const Read part(cut);
  std::printf("%s: %s\n", GetParam().c_str(), part.refused.empty() ? "read" : part.refused.c_str());
  if (!part.refused.empty()) {
    EXPECT_NE(part.refused.find(cut.string()), std::string::npos) << part.refused;
    EXPECT_NE(part.refused.find("one level"), std::string::npos) << part.refused;
    return;
  }
  ASSERT_EQ(part.columns.nz, 1);
  const auto [x, y] = cloudy_cell(whole);
  const std::size_t cell = std::size_t(y) * std::size_t(whole.columns.nx) + std::size_t(x);
  // Without the air below its temperature is taken for all of it.
  static const std::set<std::string> kHydrostatic = {
      "pressure_bounds", "sigma", "hybrid_ap", "hybrid_a_p0", "ifs", "ifs_halves", "ln_pressure"};
  const double share = kHydrostatic.contains(GetParam()) ? 0.04 : 1e-4;
  for (const std::size_t wall : {0u, 1u})
    EXPECT_NEAR(part.columns.interface_m[cell * 2 + wall],
                whole.columns.interface_m[cell * (nz + 1) + k + wall],
                share * whole.columns.interface_m[cell * (nz + 1) + k + wall])
        << wall;
  EXPECT_NEAR(part.columns.extinction_per_m[cell] / whole.columns.extinction_per_m[cell * nz + k],
              1, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Made, CutGrids, testing::ValuesIn(made_grid_names()),
                         [](const auto& info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(Made, CutLevels, testing::ValuesIn(made_vertical_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace nepho::test
