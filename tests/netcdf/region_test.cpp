// A region of a file: the same cells in the same places, and nothing else read.

#include <map>
#include <random>

#include "accuracy_report.h"
#include "cf_twin.h"
#include "forecast/bricks/grid_search.h"
#include "geo/place.h"
#include "made_source.h"
#include "wrf_twin.h"

namespace nepho::forecast::test {
using nepho::test::report_accuracy;
namespace {

CfTwin globe() {
  CfTwin twin;
  twin.latitude.clear();
  twin.longitude.clear();
  for (double lat = -60; lat <= 60; lat += 5) twin.latitude.push_back(lat);
  for (double lon = 0; lon < 360; lon += 5) twin.longitude.push_back(lon);
  return twin;
}

// A nest of 24 x 20 cells, cloudy everywhere above its lowest layer.
WrfTwin nest() {
  WrfTwin twin;
  twin.nx = 24;
  twin.ny = 20;
  twin.water = [](int t, int k, int j, int i) {
    return k == 0 ? 0 : 1e-4 * (1 + t + k) * (1.2 + std::sin(0.9 * i) * std::cos(0.7 * j));
  };
  return twin;
}

Region region(const char* text) {
  return parse_region(text, "test");
}

// Cells of the window that are not the whole file's cell at the same place, bit for bit.
int differing_cells(const Forecast& whole, const Forecast& part, std::size_t time) {
  const ForecastColumns a = whole.columns(time), b = part.columns(time);
  const auto whole_grid = whole.grid(time), grid = part.grid(time);
  const auto place = [](const HorizontalGrid& g, int i, int j) {
    const glm::dvec2 p = g.lat_lon_deg(i + 0.5, j + 0.5);
    return std::pair{std::lround(p.x * 1e4), std::lround(std::fmod(p.y + 720, 360) * 1e4)};
  };
  std::map<std::pair<long, long>, std::size_t> cell_at;
  for (int j = 0; j < a.ny; ++j)
    for (int i = 0; i < a.nx; ++i) cell_at[place(*whole_grid, i, j)] = std::size_t(j * a.nx + i);
  const auto nz = std::size_t(a.nz);
  const auto same = [](const auto& x, const auto& y, std::size_t m, std::size_t n,
                       std::size_t count) {
    return x.empty() || std::equal(&x[m * count], &x[m * count] + count, &y[n * count]);
  };
  int differing = 0;
  for (int j = 0; j < b.ny; ++j)
    for (int i = 0; i < b.nx; ++i) {
      const auto found = cell_at.find(place(*grid, i, j));
      const auto n = std::size_t(j * b.nx + i);
      differing += found == cell_at.end() ||
                   !same(a.interface_m, b.interface_m, found->second, n, nz + 1) ||
                   !same(a.extinction_per_m, b.extinction_per_m, found->second, n, nz) ||
                   !same(a.ice_extinction_per_m, b.ice_extinction_per_m, found->second, n, nz);
    }
  return differing;
}

struct Size {
  int nx, ny;
};
void expect_window(const CfTwin& twin, const std::string& name, const char* text, Size size) {
  const std::string path = twin.write("region_" + name);
  const auto whole = open(path), part = open(path, false, region(text));
  for (const std::size_t time : {0u, 1u}) {
    EXPECT_EQ(part->grid(time)->nx(), size.nx) << name << " " << text;
    EXPECT_EQ(part->grid(time)->ny(), size.ny) << name << " " << text;
    EXPECT_EQ(differing_cells(*whole, *part, time), 0) << name << " " << text;
  }
}

// Cells are 5 degrees wide about multiples of 5: 10 .. 20 touches three of them, and one more on
// each side.
TEST(Region, CellsAreTheFiles) {
  expect_window(globe(), "plain", "10,100,20,130", {9, 5});
  expect_window(globe(), "thin", "11,101,12,102", {3, 3});
  expect_window(globe(), "file_end", "10,-20,20,20", {11, 5});
  expect_window(globe(), "antimeridian", "-20,170,-10,-170", {7, 5});
  expect_window(globe(), "beyond_rows", "50,100,90,130", {9, 4});
  expect_window(globe(), "all", "-90,-180,90,180", {72, 25});
  CfTwin twin = globe();
  std::ranges::reverse(twin.latitude);
  twin.order = "xyzt";
  expect_window(twin, "rows_run_south", "10,-20,20,20", {11, 5});
  std::ranges::reverse(twin.longitude);
  twin.order = "tyxz";
  expect_window(twin, "columns_run_west", "10,-20,20,20", {11, 5});
  twin = globe();
  for (double& lon : twin.longitude) lon -= 180;
  twin.packed = true;
  twin.type = NC_SHORT;
  std::ranges::reverse(twin.pressure_hPa);
  expect_window(twin, "packed_from_top", "10,170,20,-170", {7, 5});
}

TEST(Region, GoesAroundWithTheWholeTurn) {
  const std::string path = globe().write("region_cap");
  EXPECT_TRUE(open(path, false, region("30,-180,60,180"))->grid(0)->around());
  EXPECT_TRUE(open(path, false, region("30,2,60,358"))->grid(0)->around());
  EXPECT_FALSE(open(path, false, region("30,0,60,300"))->grid(0)->around());
  const auto part = open(path, false, region("30,300,60,20"));
  double last = part->grid(0)->lat_lon_deg(0, 0).y;
  for (double x = 0.25; x <= part->grid(0)->nx(); x += 0.25) {
    const double here = part->grid(0)->lat_lon_deg(x, 0).y;
    EXPECT_NEAR(here - last, 1.25, 1e-9) << x;  // continuous where the file's end is
    last = here;
  }
}

// Cells by points inside them, for random regions on grids of all kinds, one over a pole.
TEST(Region, HoldsEveryCellInsideAndNoMoreThanABorder) {
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int windows = 0, tight = 0;
  for (const char* name : {"mercator", "globe", "rotated", "corner", "layer"}) {
    const std::shared_ptr<const HorizontalGrid> grid =
        nepho::test::synthetic_forecast(name)->grid(0);
    for (int n = 0; n < 40; ++n) {
      const glm::dvec2 middle = grid->lat_lon_deg(uniform(0, grid->nx()), uniform(0, grid->ny()));
      const double high = uniform(0.3, std::string(name) == "globe" ? 40 : 4);
      const double wide = high * uniform(0.5, 3);
      const Region r = {std::max(-90.0, middle.x - high / 2), middle.y - wide / 2,
                        std::min(90.0, middle.x + high / 2), middle.y + wide / 2};
      const CellWindow window = window_of({&grid, 1}, r, "test");
      ++windows;
      int low_row = grid->ny(), high_row = -1;
      for (int j = 0; j < grid->ny(); ++j)
        for (int i = 0; i < grid->nx(); ++i)
          for (int point = 0; point < 25; ++point) {
            const glm::dvec2 at =
                grid->lat_lon_deg(i + (point % 5 + 0.5) / 5, j + (point / 5 + 0.5) / 5);
            const double east = r.west_deg + std::fmod(at.y - r.west_deg + 1080, 360);
            if (at.x < r.south_deg || at.x > r.north_deg || east > r.east_deg) continue;
            low_row = std::min(low_row, j);
            high_row = std::max(high_row, j);
            const int column = (i - window.x0 + grid->nx()) % grid->nx();
            ASSERT_TRUE(column < window.nx && j >= window.y0 && j < window.y0 + window.ny)
                << name << " " << to_text(r) << ": cell " << i << " " << j;
          }
      const int beyond = window.ny - (high_row - low_row + 1);
      EXPECT_GE(beyond, std::min(window.y0, 1)) << name;
      tight += beyond <= 3;  // a cell may overlap between the points
    }
  }
  EXPECT_GE(tight, windows * 8 / 10);
}

// A cell around a pole has all longitudes, and latitudes beyond its corners'.
TEST(Region, FindsTheCellAroundThePole) {
  const std::shared_ptr<const HorizontalGrid> grid =
      nepho::test::synthetic_forecast("rotated")->grid(0);
  const glm::dvec2 pole = GridSearch(grid).find({90, 0}).at;
  const CellWindow window = window_of({&grid, 1}, region("89.99,-180,90,180"), "test");
  EXPECT_EQ(window.x0, int(pole.x) - 1);
  EXPECT_EQ(window.y0, int(pole.y) - 1);
  EXPECT_EQ(window.nx, 3);
  EXPECT_EQ(window.ny, 3);
}

TEST(Region, MovesWithTheNest) {
  const WrfTwin twin = nest();
  const std::string path = twin.write("region_nest");
  const double north = twin.latitude(0, 7), south = twin.latitude(0, 5);
  const Region window = {south, twin.longitude(4), north, twin.longitude(9)};
  const auto whole = open(path), part = open(path, false, window);
  // Rows 5 to 7 at first and 4 to 6 an hour later, columns 4 to 9, and one beyond.
  EXPECT_EQ(part->grid(0)->nx(), 6 + 2);
  EXPECT_EQ(part->grid(0)->ny(), 4 + 2);
  for (const std::size_t time : {0u, 1u}) EXPECT_EQ(differing_cells(*whole, *part, time), 0);
  EXPECT_EQ(part->ground(1).height_m.size(), 8u * 6u);
}

std::uint64_t bytes_of(const Forecast& f, const std::string& variable) {
  for (const VariableBytes& bytes : f.bytes_read())
    if (bytes.name == variable) return bytes.read;
  ADD_FAILURE() << "no variable " << variable;
  return 0;
}

void add_variable(const std::string& path, const char* name, const char* like) {
  int file = 0, old = 0, made = 0, rank = 0, dimensions[NC_MAX_VAR_DIMS];
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &file), NC_NOERR);
  nc_inq_varid(file, like, &old);
  nc_inq_var(file, old, nullptr, nullptr, &rank, dimensions, nullptr);
  ASSERT_EQ(nc_def_var(file, name, NC_FLOAT, rank, dimensions, &made), NC_NOERR);
  nc_close(file);
}

// Of 4 levels, 4 bytes a value.
TEST(Region, OnlyWhatIsNeededIsRead) {
  const std::string path = globe().write("region_bytes");
  add_variable(path, "ua", "clw");
  const auto whole = open(path), part = open(path, false, region("10,100,20,130"));
  for (const auto& [forecast, cells] : {std::pair{&*whole, 72u * 25u}, {&*part, 9u * 5u}}) {
    const std::uint64_t level = 4u * cells;
    EXPECT_EQ(bytes_of(*forecast, "clw"), 4 * level);
    EXPECT_EQ(bytes_of(*forecast, "t"), 4 * level);
    // And two levels for their order, and two at each end for the height of the other time.
    EXPECT_EQ(bytes_of(*forecast, "gh"), (4 + 2 + 4) * level);
    EXPECT_EQ(bytes_of(*forecast, "ua"), 0u);
    forecast->columns(0);  // in memory
    EXPECT_EQ(bytes_of(*forecast, "clw"), 4 * level);
    forecast->columns(1);
    EXPECT_EQ(bytes_of(*forecast, "clw"), 8 * level);
  }
}

TEST(Region, OnlyWhatIsNeededIsReadOfANest) {
  const WrfTwin twin = nest();
  const std::string path = twin.write("region_nest_bytes");
  add_variable(path, "TKE", "QCLOUD");
  const auto part =
      open(path, false,
           Region{twin.latitude(0, 5), twin.longitude(4), twin.latitude(0, 7), twin.longitude(9)});
  const std::uint64_t level = 4u * 8 * 6;
  for (const char* name : {"QCLOUD", "QICE", "T", "P", "PB", "QVAPOR"})
    EXPECT_EQ(bytes_of(*part, name), 4 * level) << name;
  // The other time's lowest and highest interface.
  for (const char* name : {"PH", "PHB"}) EXPECT_EQ(bytes_of(*part, name), (5 + 2) * level) << name;
  EXPECT_EQ(bytes_of(*part, "TKE"), 0u);
  EXPECT_EQ(bytes_of(*part, "XLAT"), 2u * 4 * 24 * 20);  // whole: to find the region in it
}

TEST(Region, TheSourceSaysWhatWasRead) {
  const auto whole = nepho::test::made_source(open(globe().write("region_said")));
  const auto part =
      nepho::test::made_source(open(folder() / "region_said.nc", false, region("10,100,20,130")));
  const auto fact = [](const BrickSource& source, const std::string& start) {
    for (const std::string& text : source.info().facts)
      if (text.starts_with(start)) return text;
    return std::string();
  };
  EXPECT_EQ(fact(*part, "Region"),
            "Region 10 to 20 N, 100 to 130 E: 9 x 5 of 72 x 25 cells, one beyond its edges.");
  EXPECT_EQ(fact(*whole, "Region"), "");
  double read[2];
  ASSERT_EQ(std::sscanf(fact(*whole, "Read").c_str(), "Read: %lf MB", &read[0]), 1);
  ASSERT_EQ(std::sscanf(fact(*part, "Read").c_str(), "Read: %lf MB", &read[1]), 1);
  const double share = 9.0 * 5 / (72 * 25);
  EXPECT_NEAR(read[1] / read[0], share, 0.25 * share);  // axes are read whole
}

// Column optical depth of one column of finest samples: sum of c V over those of a sphere's shell.
double column_depth(const BrickSource& source, const Column& column) {
  const VolumeInfo& info = source.info();
  const int level = info.lattice.max_level();
  const Index3& cells = info.lattice.cells(level);
  const auto node = [](std::uint32_t g, std::uint32_t n) { return std::min(g / 8, n / 8 - 1); };
  const std::uint32_t i = node(column.i, cells[0]), j = node(column.j, cells[1]);
  double sum = 0;
  for (std::uint32_t k = 0; k < cells[2] / 8; ++k) {
    const BrickSamples samples =
        nepho::test::read_samples(source, NodeKey(column.root, level, i, j, k));
    for (std::uint32_t s = 0; s < (k + 1 == cells[2] / 8 ? 9u : 8u); ++s)
      sum += samples[brick_offset(column.i - 8 * i, column.j - 8 * j, s)] *
             info.chart->hat_vertical(8 * k + s, cells);
  }
  const auto& body = dynamic_cast<const ShellChart&>(*info.chart).body();
  return sum / (body.equatorial_m * body.polar_m);
}

// Columns of the shell whose place is inside.
std::vector<Column> columns_in(const BrickSource& source, const Region& inside) {
  const VolumeInfo& info = source.info();
  const int level = info.lattice.max_level();
  const Index3& cells = info.lattice.cells(level);
  std::map<Column, bool> found;
  for (const NodeKey key : nepho::test::finest_nodes(source))
    for (std::uint32_t j = 0; j < 8; ++j)
      for (std::uint32_t i = 0; i < 8; ++i) {
        const Column column{key.root(), 8 * key.i() + i, 8 * key.j() + j};
        const glm::dvec3 q = {double(column.i) / cells[0], double(column.j) / cells[1], 0.5};
        const GeodeticPoint p =
            geodetic_point(Ellipsoid::wgs84(), info.chart->ecef_m({column.root, q}));
        const double east =
            p.longitude_deg + 360 * std::ceil((inside.west_deg - p.longitude_deg) / 360);
        if (p.latitude_deg > inside.south_deg && p.latitude_deg < inside.north_deg &&
            east < inside.east_deg)
          found[column] = true;
      }
  std::vector<Column> columns;
  for (const auto& [column, _] : found) columns.push_back(column);
  return columns;
}

// Largest difference over the largest depth; columns inside by more than `margin_deg`, as far as a
// hat reaches beyond the row of cells that is read around the region.
double worst_depth(const std::string& path, Region window, double margin_deg, double voxel_m) {
  const std::vector<RequestParameter> parameters = {
      {"horizontal_resolution_m", nullptr, voxel_m, "m"}};
  const auto whole = nepho::test::made_source(open(path), parameters);
  const auto part = nepho::test::made_source(open(path, false, window), parameters);
  const auto columns_across = [](const BrickSource& s) {
    return s.info().lattice.cells(s.info().lattice.max_level())[0];
  };
  EXPECT_EQ(columns_across(*whole), columns_across(*part));
  window.south_deg += margin_deg;
  window.north_deg -= margin_deg;
  window.west_deg += margin_deg;
  window.east_deg -= margin_deg;
  const std::vector<Column> columns = columns_in(*part, window);
  EXPECT_GT(columns.size(), 20u);
  double worst = 0, largest = 0;
  for (const Column& column : columns) {
    const double wanted = column_depth(*whole, column);
    worst = std::max(worst, std::abs(column_depth(*part, column) - wanted));
    largest = std::max(largest, wanted);
  }
  EXPECT_GT(largest, 0.1);
  return worst / largest;
}

TEST(Region, OpticalDepthInsideIsTheWholeFiles) {
  const std::string global = globe().write("region_depth");
  const WrfTwin twin = nest();
  const std::string moving = twin.write("region_nest_depth");
  const double worst = std::max({
      worst_depth(global, region("-20,60,30,140"), 2.5, 4e5),
      worst_depth(global, region("-20,160,30,-160"), 2.5, 4e5),
      worst_depth(global, region("-20,-40,30,40"), 2.5, 4e5),
      worst_depth(
          moving,
          {twin.latitude(0, 4), twin.longitude(6), twin.latitude(0, 15), twin.longitude(18)}, 0.1,
          8000),
  });
  report_accuracy("netcdf", "region: column optical depth inside it, against the whole file", worst,
                  5e-3, "1");
  EXPECT_LE(worst, 5e-3);
}

std::string refused(const std::string& path, const char* text) {
  try {
    open(path, false, region(text));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Region, EmptyOnesAreRefusedWithTheFilesBounds) {
  CfTwin twin = globe();
  const std::string path = twin.write("region_empty");
  EXPECT_NE(refused(path, "70,0,80,10").find("-62.5 to 62.5 N, all longitudes"), std::string::npos)
      << refused(path, "70,0,80,10");
  twin = CfTwin{};  // 90 to 210 E
  const std::string part = twin.write("region_empty_part");
  const std::string said = refused(part, "0,0,20,10");
  EXPECT_NE(said.find("no cell of the file lies in the region"), std::string::npos) << said;
  EXPECT_NE(said.find("-40 to 60 N, 90 to 210 E"), std::string::npos) << said;
  EXPECT_NE(said.find(part), std::string::npos) << said;
  EXPECT_EQ(refused(part, "0,-170,20,-160"), "");
}

TEST(Region, TextsAreFourNumbersInOrder) {
  const Region pacific = region("30,160,60,-150");
  EXPECT_EQ(pacific.east_deg, 210);
  EXPECT_EQ(region("-90,0,90,360").east_deg, 360);
  EXPECT_EQ(region("-90,270,90,-180").east_deg, 540);
  for (const char* bad : {"", "1,2,3", "1,2,3,4,5", "1,2,3,4x", "1,2,3,4,", "a,b,c,d", "nan,0,1,1",
                          "10,0,10,1", "20,0,10,1", "-91,0,0,1", "0,0,91,1", "0,5,1,5",
                          "0,-181,1,1", "0,0,1,361", "0,-180,1,181", "inf,0,1,1", " 1,2,3,4"})
    EXPECT_THROW(region(bad), Error) << bad;
}

}  // namespace
}  // namespace nepho::forecast::test
