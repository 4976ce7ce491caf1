// One cloud on every grid and on every kind of levels, written by formulas that share nothing with
// the reader: it is read, and drawn, where it is, as high and as thick as it is.

#include <gtest/gtest.h>

#include <cmath>

#include "accuracy_report.h"
#include "bricks/coarsen.h"
#include "core/error.h"
#include "forecast/bricks/grid_search.h"
#include "forecast/bricks/hat_remap.h"
#include "forecast/bricks/layout.h"
#include "made_file.h"
#include "made_vertical.h"
#include "pyramid/level_filter.h"
#include "sources/netcdf/open_netcdf.h"

namespace nepho::test {
namespace {

using namespace samples;
constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kCorner_deg = 1e-5, kTotal = 2e-3, kHeight_m = 1;

struct Case {
  std::string grid, vertical, order;
  std::string name() const { return grid + "_" + vertical + "_" + order; }
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name();
}

// Every grid and every kind of levels, each in both orders: all pairs of a grid with an order and
// of levels with an order, and of grids with levels those that a diagonal meets.
std::vector<Case> covering() {
  const auto &grids = made_grid_names(), &verticals = made_vertical_names();
  std::vector<Case> cases;
  for (std::size_t n = 0; n < std::max(grids.size(), verticals.size()); ++n)
    for (const std::size_t turn : {0, 1})
      cases.push_back({grids[n % grids.size()], verticals[(n + 7 * turn) % verticals.size()],
                       turn == 0 ? "up" : "down"});
  cases.push_back({"mpas", "ifs_halves", "up"});  // z is a geopotential of cells in a row
  return cases;
}

std::unique_ptr<forecast::Forecast> open(const fs::path& path, const std::string& grid_file = "") {
  forecast::OpenRequest request;
  request.files = {path.string()};
  request.grid_file = grid_file;
  return netcdf::open_netcdf(request);
}

double apart_deg(glm::dvec2 a, glm::dvec2 b) {
  return std::hypot(a.x - b.x, std::remainder(a.y - b.y, 360.0) * std::cos(a.x * kDegree));
}

// WGS 84, by the textbook's formula.
glm::dvec3 world_m(glm::dvec2 deg, double height_m) {
  const double f = 1 / 298.257223563, e2 = f * (2 - f), s = std::sin(deg.x * kDegree);
  const double n = 6378137 / std::sqrt(1 - e2 * s * s);
  const double out = (n + height_m) * std::cos(deg.x * kDegree);
  return {out * std::cos(deg.y * kDegree), out * std::sin(deg.y * kDegree),
          (n * (1 - e2) + height_m) * s};
}

double area_m2(const MadeCell& cell, double height_m) {
  glm::dvec3 sum(0.0);
  const glm::dvec3 middle = world_m(cell.centre_deg, height_m);
  for (std::size_t at = 0; at < cell.outline_deg.size(); ++at) {
    const std::size_t next = (at + 1) % cell.outline_deg.size();
    sum += glm::cross(world_m(cell.outline_deg[at], height_m) - middle,
                      world_m(cell.outline_deg[next], height_m) - middle);
  }
  return glm::length(sum) / 2;
}

// Of half a gram of droplets in a cubic metre over the sea: Martin et al. (1994), and the edge term
// of the efficiency, written out again.
double expected_per_m() {
  const double content = kMadeContent_g_per_m3 * 1e-3;
  const double radius = std::cbrt(3 * content / (4 * 3.14159265358979 * 999.84 * 0.77 * 50.575e6));
  return 3 * content * (2 + 2.12 * std::pow(2 * 3.14159265358979 * radius / 550e-9, -2.0 / 3)) /
         (4 * 999.84 * radius);
}

struct Read {
  std::unique_ptr<forecast::Forecast> forecast;
  std::shared_ptr<const forecast::HorizontalGrid> grid;
  forecast::ForecastColumns columns;

  explicit Read(const fs::path& path)
      : forecast(open(path)), grid(forecast->grid(0)), columns(forecast->columns(0)) {}
  // Cells that hold the cloud, by their centres; and the one nearest to a place.
  std::vector<std::size_t> cloudy() const {
    std::vector<std::size_t> list;
    const std::size_t nz = std::size_t(columns.nz);
    for (std::size_t cell = 0; cell * nz < columns.extinction_per_m.size(); ++cell)
      for (std::size_t k = 0; k < nz; ++k)
        if (columns.extinction_per_m[cell * nz + k] > 0) {
          list.push_back(cell);
          break;
        }
    return list;
  }
  glm::dvec2 centre_deg(std::size_t cell) const {
    const std::size_t nx = std::size_t(columns.nx);
    return grid->lat_lon_deg(double(cell % nx) + 0.5, double(cell / nx) + 0.5);
  }
  std::vector<glm::dvec2> corners_deg(std::size_t cell) const {
    std::vector<glm::dvec2> corners;
    if (const auto* polygons = grid->polygons()) {
      for (auto at = polygons->first[cell]; at < polygons->first[cell + 1]; ++at)
        corners.push_back(polygons->corner_deg[at]);
      return corners;
    }
    const double x = double(cell % std::size_t(columns.nx)),
                 y = double(cell / std::size_t(columns.nx));
    for (const glm::dvec2& c : {glm::dvec2(0, 0), {1, 0}, {1, 1}, {0, 1}})
      corners.push_back(grid->lat_lon_deg(x + c.x, y + c.y));
    return corners;
  }
};

// Largest distance from a point of one list to the nearest of another.
double farthest_deg(const std::vector<glm::dvec2>& of, const std::vector<glm::dvec2>& to) {
  double worst = 0;
  for (const glm::dvec2& p : of) {
    double nearest = 360;
    for (const glm::dvec2& q : to) nearest = std::min(nearest, apart_deg(p, q));
    worst = std::max(worst, nearest);
  }
  return worst;
}

class Grids : public testing::TestWithParam<Case> {
 protected:
  fs::path made() const {
    const fs::path path = made_folder() / (GetParam().name() + ".nc");
    write_made(path, GetParam().grid, GetParam().vertical, GetParam().order, nc_writer());
    return path;
  }
};

TEST_P(Grids, CloudIsReadWhereItIs) {
  const fs::path path = made();
  const Read read(path);
  fs::remove(path);
  const MadeGrid grid = made_grid(GetParam().grid);
  const MadeVertical vertical = made_vertical(GetParam().vertical);
  const std::vector<std::size_t> cells = read.cloudy();
  ASSERT_EQ(cells.size(), grid.cloudy.size());
  double corners_deg = 0, heights_m = 0, extinction = 0;
  for (const std::size_t n : grid.cloudy) {
    const MadeCell truth = grid.cell(n);
    const auto ours = std::ranges::min_element(cells, {}, [&](std::size_t cell) {
      return apart_deg(read.centre_deg(cell), truth.centre_deg);
    });
    EXPECT_LT(apart_deg(read.centre_deg(*ours), truth.centre_deg), 0.01);
    corners_deg = std::max(corners_deg, farthest_deg(read.corners_deg(*ours), truth.outline_deg));
    const std::vector<double> walls = vertical.interfaces_m(truth);
    const std::size_t nz = std::size_t(read.columns.nz);
    for (std::size_t k = 0; k < nz; ++k) {
      const double value = double(read.columns.extinction_per_m[*ours * nz + k]);
      const bool cloudy = k >= kMadeLowLayer && k <= kMadeHighLayer;
      if (!cloudy) {
        EXPECT_EQ(value, 0) << k;
        continue;
      }
      const float* z = &read.columns.interface_m[*ours * (nz + 1) + k];
      extinction = std::max(extinction, std::abs(value / expected_per_m() - 1));
      heights_m = std::max(
          {heights_m, std::abs(double(z[0]) - walls[k]), std::abs(double(z[1]) - walls[k + 1])});
    }
  }
  const bool cells_in_a_row = grid.axes.size() == 1;
  report_accuracy("grids",
                  cells_in_a_row ? "corners of triangles and Voronoi's cells"
                                 : "corners of cells on 17 grids of rows and columns",
                  corners_deg, kCorner_deg, "deg");
  EXPECT_LE(corners_deg, kCorner_deg) << "degrees off the corners";
  report_accuracy("grids", "heights of interfaces on 21 kinds of levels", heights_m, kHeight_m,
                  "m");
  EXPECT_LE(heights_m, kHeight_m) << "metres off the heights";
  EXPECT_LE(extinction, 1e-4) << "off the extinction";
}

// sum c V over the finest bricks, and its middle.
TEST_P(Grids, CloudIsDrawnWhereItIs) {
  const fs::path path = made();
  const Read read(path);
  fs::remove(path);
  const MadeGrid grid = made_grid(GetParam().grid);
  const MadeVertical vertical = made_vertical(GetParam().vertical);
  double truth = 0, widest_m = 0;
  glm::dvec3 truth_middle(0.0);
  for (const std::size_t n : grid.cloudy) {
    const MadeCell cell = grid.cell(n);
    const std::vector<double> walls = vertical.interfaces_m(cell);
    const double low = walls[kMadeLowLayer], high = walls[kMadeHighLayer + 1];
    const double area = area_m2(cell, (low + high) / 2);
    const double here = expected_per_m() * area * (high - low);
    truth += here;
    truth_middle += here * world_m(cell.centre_deg, 0);
    widest_m = std::max(widest_m, std::sqrt(area));
  }
  const forecast::Layout layout = choose_layout(*read.forecast, {});
  const forecast::HatRemap remap(
      layout.chart, layout.lattice, *read.grid, read.columns,
      forecast::RemapOptions{layout.extend_below_m, 0, forecast::Layers::kConstant});
  double total = 0;
  glm::dvec3 middle(0.0);
  BrickSamples samples;
  const int level = layout.lattice.max_level();
  for (const NodeKey key : remap.nodes(forecast::HatRemap::Part::kTotal)) {
    const HatWeights hats = owned_hats(*layout.chart, layout.lattice, key);
    remap.samples(key, forecast::HatRemap::Part::kTotal, samples.data());
    for (std::uint32_t at = 0; at < samples.size(); ++at) {
      const double part = samples[at] * hats.horizontal[at % 81] * hats.vertical[at / 81];
      if (part == 0) continue;
      total += part;
      const Index3 g = Lattice::global_sample(key, {at % 9, at / 9 % 9, at / 81});
      middle += part * layout.chart->ecef_m({key.root(), layout.lattice.q(level, g)});
    }
  }
  report_accuracy("grids",
                  grid.axes.size() == 1 ? "optical depth of bricks against one cell in a row's"
                                        : "optical depth of bricks against nine cells'",
                  std::abs(total / truth - 1), kTotal, "1");
  EXPECT_NEAR(total / truth, 1, kTotal) << "of the optical depth";
  const double off_m = 6.371e6 * glm::length(glm::normalize(middle) - glm::normalize(truth_middle));
  EXPECT_LT(off_m, widest_m / 2) << "metres off the cloud's middle";
}

INSTANTIATE_TEST_SUITE_P(Made, Grids, testing::ValuesIn(covering()),
                         [](const auto& made) { return made.param.name(); });

// A whole field on cells in a row: nothing is lost or counted twice between them, and the model's
// own cells are found.
TEST(CellsInARow, AllTogetherKeepTheirOpticalDepth) {
  for (const char* name : {"icon", "mpas", "ugrid", "centres"}) {
    const fs::path path = made_folder() / (std::string(name) + "_all.nc");
    write_made(path, name, "height", "up", nc_writer());
    Read read(path);
    const MadeGrid grid = made_grid(name);
    const std::vector<double> walls = made_vertical("height").interfaces_m(grid.cell(0));
    const std::size_t nz = std::size_t(read.columns.nz);
    double truth = 0, middle_m = (walls[6] + walls[7]) / 2;
    for (std::size_t n = 0; n < grid.nx; ++n) {
      const double value = 1e-3 * (1 + std::sin(0.1 * double(n)));
      std::fill_n(&read.columns.extinction_per_m[n * nz], nz, 0.0f);
      read.columns.extinction_per_m[n * nz + 6] = float(value);
      const std::string cells = name;
      // At the rim Voronoi's cells are no hexagons.
      MadeCell cell = grid.cell(n);
      if (cells == "centres") cell.outline_deg = read.corners_deg(n);
      truth += double(float(value)) * area_m2(cell, middle_m) * (walls[7] - walls[6]);
    }
    const forecast::Layout layout = choose_layout(*read.forecast, {});
    const forecast::HatRemap remap(
        layout.chart, layout.lattice, *read.grid, read.columns,
        forecast::RemapOptions{layout.extend_below_m, 0, forecast::Layers::kConstant});
    double total = 0;
    BrickSamples samples;
    for (const NodeKey key : remap.nodes(forecast::HatRemap::Part::kTotal)) {
      const HatWeights hats = owned_hats(*layout.chart, layout.lattice, key);
      remap.samples(key, forecast::HatRemap::Part::kTotal, samples.data());
      for (std::uint32_t at = 0; at < samples.size(); ++at)
        total += samples[at] * hats.horizontal[at % 81] * hats.vertical[at / 81];
    }
    report_accuracy("grids", "optical depth of a whole field on cells in a row",
                    std::abs(total / truth - 1), 5e-4, "1");
    EXPECT_NEAR(total / truth, 1, 5e-4) << name;

    const forecast::GridSearch search(read.grid);
    for (std::size_t n = 0; n < grid.nx; n += 7) {
      const auto found = search.find(read.centre_deg(n));
      EXPECT_EQ(found.off_cells, 0);
      EXPECT_EQ(std::size_t(found.at.x), n) << name;
    }
    EXPECT_GT(search.find({-70, 3}).off_cells, 100) << name;
  }
}

// The same cells with their places in a file of their own.
TEST(CellsInARow, PlacesMayBeInAnotherFile) {
  const fs::path data = made_folder() / "data.nc", places = made_folder() / "places.nc";
  write_made(data, "icon", "height", "up", nc_writer());
  fs::copy_file(data, places);
  int id = 0, variable = 0;
  ASSERT_EQ(nc_open(data.c_str(), NC_WRITE, &id), NC_NOERR);
  nc_redef(id);
  for (const char* name : {"clat", "clon", "clat_bnds", "clon_bnds"}) {
    ASSERT_EQ(nc_inq_varid(id, name, &variable), NC_NOERR);
    ASSERT_EQ(nc_rename_var(id, variable, (std::string("q") + name).c_str()), NC_NOERR);
  }
  nc_close(id);
  try {
    open(data);
    FAIL() << "cells without places were read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("--grid FILE"), std::string::npos) << e.what();
  }
  const auto forecast = open(data, places.string());
  const auto grid = forecast->grid(0);
  EXPECT_LT(apart_deg(grid->lat_lon_deg(100.5, 0.5), made_grid("icon").cell(100).centre_deg), 1e-9);
}

// A region leaves the cells that lie in it, and those beside them; the others are clear.
TEST(CellsInARow, RegionLeavesItsOwn) {
  const fs::path path = made_folder() / "some.nc";
  write_made(path, "icon", "height", "up", nc_writer());
  const MadeGrid grid = made_grid("icon");
  const glm::dvec2 c = grid.cell(grid.cloudy[0]).centre_deg;
  const auto cloudy_in = [&](double offset_deg) {
    forecast::OpenRequest request;
    request.files = {path.string()};
    request.region =
        forecast::Region{c.x + offset_deg - 0.05, c.y - 0.05, c.x + offset_deg + 0.05, c.y + 0.05};
    const auto forecast = netcdf::open_netcdf(request);
    const forecast::CellPolygons& cells = *forecast->grid(0)->polygons();
    std::size_t places = 0;
    for (std::size_t n = 0; n + 1 < cells.first.size(); ++n)
      places += cells.first[n + 1] > cells.first[n];
    EXPECT_GT(places, 3u);
    EXPECT_LT(places, 60u);
    const auto columns = forecast->columns(0);
    return std::ranges::count_if(columns.extinction_per_m, [](float v) { return v > 0; });
  };
  EXPECT_EQ(cloudy_in(0), 4);
  EXPECT_EQ(cloudy_in(-1), 0);
}

// Beside a satellite's disc there is nothing, whatever the file holds there.
TEST(Views, CellsOffTheDiscAreClear) {
  const fs::path path = made_folder() / "disc.nc";
  write_made(path, "goes", "height", "up", nc_writer());
  int id = 0, variable = 0;
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &id), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(id, "clw", &variable), NC_NOERR);
  const std::vector<double> everywhere(20 * 20 * 24, 0.5);
  ASSERT_EQ(nc_put_var_double(id, variable, everywhere.data()), NC_NOERR);
  nc_close(id);
  const Read read(path);
  const MadeGrid grid = made_grid("goes");
  std::size_t off = 0, on = 0;
  for (std::size_t cell = 0; cell < grid.nx * grid.ny; ++cell) {
    bool whole = true;
    for (const glm::dvec2& p : grid.cell(cell).outline_deg) whole &= !std::isnan(p.x);
    const bool drawn = read.columns.extinction_per_m[cell * 20 + 7] > 0;
    EXPECT_EQ(drawn, whole) << cell;
    (whole ? on : off) += 1;
  }
  EXPECT_GT(off, 50u);
  EXPECT_GT(on, 100u);
  // All that follows does without them.
  const forecast::Layout layout = choose_layout(*read.forecast, {});
  const forecast::HatRemap remap(layout.chart, layout.lattice, *read.grid, read.columns, {});
  EXPECT_GT(remap.nodes(forecast::HatRemap::Part::kTotal).size(), 10u);
  const forecast::GridSearch search(read.grid);
  EXPECT_EQ(search.find(grid.cell(grid.cloudy[4]).centre_deg).off_cells, 0);
}

}  // namespace
}  // namespace nepho::test
