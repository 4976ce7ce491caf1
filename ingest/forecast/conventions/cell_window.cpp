#include "forecast/conventions/cell_window.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/error.h"
#include "forecast/conventions/unstructured.h"

namespace nepho::forecast {
namespace {

struct Marks {
  std::vector<char> columns, rows;  // that hold a cell of the region
};

struct Extent {
  double low, high;
};

// Latitudes and longitudes (continuous) of one cell, from its corners in order around it.
struct CellExtent {
  Extent latitude_deg, longitude_deg;
};
CellExtent extent_of(std::span<const glm::dvec2> corner) {
  if (corner.empty()) return {{NAN, NAN}, {NAN, NAN}};
  for (const glm::dvec2& place : corner)
    if (std::isnan(place.x)) return {{NAN, NAN}, {NAN, NAN}};
  CellExtent e{{corner[0].x, corner[0].x}, {corner[0].y, corner[0].y}};
  double longitude = corner[0].y, turned = 0;
  for (std::size_t n = 1; n <= corner.size(); ++n) {
    const glm::dvec2& here = corner[n % corner.size()];
    const double step = std::remainder(here.y - longitude, 360.0);
    longitude += step;
    turned += step;
    e.latitude_deg.low = std::min(e.latitude_deg.low, here.x);
    e.latitude_deg.high = std::max(e.latitude_deg.high, here.x);
    e.longitude_deg.low = std::min(e.longitude_deg.low, longitude);
    e.longitude_deg.high = std::max(e.longitude_deg.high, longitude);
  }
#ifdef NEPHO_MUTANT_POLE_FORGOTTEN
  turned = 0;
#endif
  if (std::abs(turned) > 180) {  // around a pole
    e.longitude_deg = {-180, 180};
    if (corner[0].x > 0)
      e.latitude_deg.high = 90;
    else
      e.latitude_deg.low = -90;
  }
  return e;
}

bool overlap(const CellExtent& cell, const Region& region) {
  if (std::isnan(cell.latitude_deg.low + cell.longitude_deg.low)) return false;
  if (!(cell.latitude_deg.low < region.north_deg && cell.latitude_deg.high > region.south_deg))
    return false;
  // The cell turned to the first place that ends east of the region's western edge.
  const double turn = 360 * (std::floor((region.west_deg - cell.longitude_deg.high) / 360) + 1);
  return cell.longitude_deg.low + turn < region.east_deg;
}

void mark(const HorizontalGrid& grid, const Region& region, Marks& marks) {
  if (const CellPolygons* polygons = grid.polygons()) {
    for (std::size_t cell = 0; cell + 1 < polygons->first.size(); ++cell) {
      CellExtent extent = extent_of({polygons->corner_deg.data() + polygons->first[cell],
                                     polygons->corner_deg.data() + polygons->first[cell + 1]});
      // And those beside them: a cell is about as wide as its neighbours.
      for (Extent* e : {&extent.latitude_deg, &extent.longitude_deg})
        *e = {2 * e->low - e->high, 2 * e->high - e->low};
      if (overlap(extent, region)) marks.rows[0] = marks.columns[cell] = 1;
    }
    return;
  }
  const auto nx = std::size_t(grid.nx());
  const auto row_of = [&](int y) {
    std::vector<glm::dvec2> row;
    for (std::size_t x = 0; x <= nx; ++x) row.push_back(grid.lat_lon_deg(double(x), y));
    return row;
  };
  std::vector<glm::dvec2> low = row_of(0), high;
  for (int y = 0; y < grid.ny(); ++y, low = std::move(high)) {
    high = row_of(y + 1);
    for (std::size_t x = 0; x < nx; ++x)
      if (overlap(extent_of(std::array{low[x], low[x + 1], high[x + 1], high[x]}), region))
        marks.rows[std::size_t(y)] = marks.columns[x] = 1;
  }
}

#ifdef NEPHO_MUTANT_NO_BORDER
constexpr int kBorder = 0;
#else
constexpr int kBorder = 1;
#endif

struct Run {
  int first = 0, count = 0;
};

// From the first mark to the last, and the border at each side.
Run run_of(const std::vector<char>& marks) {
  const int n = int(marks.size());
  const int first = int(std::ranges::find(marks, 1) - marks.begin());
  const int last = n - 1 - int(std::find(marks.rbegin(), marks.rend(), 1) - marks.rbegin());
  const int from = std::max(first - kBorder, 0);
  return {from, std::min(last + kBorder, n - 1) - from + 1};
}

// The same on a circle: all but the longest gap. The whole circle begins at 0.
Run run_around(const std::vector<char>& marks) {
  const int n = int(marks.size());
  int begin = 0, longest = 0, gap = 0;
  for (int at = 0; at < 2 * n; ++at) {
    gap = marks[std::size_t(at % n)] ? 0 : gap + 1;
    if (gap > longest && gap < n) {
      longest = gap;
      begin = (at + 1) % n;
    }
  }
  const int count = n - longest + 2 * kBorder;
  if (count >= n) return {0, n};
  return {(begin - kBorder + n) % n, count};
}

std::string bounds_text(const HorizontalGrid& grid) {
  Extent latitude{90, -90}, longitude{1e9, -1e9};
  for (int y = 0; y <= grid.ny(); ++y)
    for (int x = 0; x <= grid.nx(); ++x) {
      const glm::dvec2 here = grid.lat_lon_deg(x, y);
      latitude = {std::min(latitude.low, here.x), std::max(latitude.high, here.x)};
      longitude = {std::min(longitude.low, here.y), std::max(longitude.high, here.y)};
    }
  const double turn = 360 * std::floor((longitude.low + 180) / 360);
  char text[120];
  if (longitude.high - longitude.low > 359.9)
    std::snprintf(text, sizeof text, "%.4g to %.4g N, all longitudes", latitude.low, latitude.high);
  else
    std::snprintf(text, sizeof text, "%.4g to %.4g N, %.5g to %.5g E", latitude.low, latitude.high,
                  longitude.low - turn, longitude.high - turn);
  return text;
}

class WindowedGrid : public HorizontalGrid {
 public:
  WindowedGrid(std::shared_ptr<const HorizontalGrid> whole, const CellWindow& window)
      : whole_(std::move(whole)), window_(window) {
#ifdef NEPHO_MUTANT_SHIFTED_WINDOW
    ++window_.x0;
#endif
    turn_deg_ = whole_->lat_lon_deg(whole_->nx(), 0).y - whole_->lat_lon_deg(0, 0).y;
  }
  int nx() const override {
    return window_.nx;
  }
  int ny() const override {
    return window_.ny;
  }
  bool around() const override {
    return whole_->around() && window_.nx == whole_->nx();
  }
  glm::dvec2 lat_lon_deg(double x, double y) const override {
    x += window_.x0;
    if (!whole_->around() || x <= whole_->nx()) return whole_->lat_lon_deg(x, y + window_.y0);
    return whole_->lat_lon_deg(x - whole_->nx(), y + window_.y0) + glm::dvec2(0, turn_deg_);
  }
  glm::dvec3 direction(double x, double y) const override {
    x += window_.x0;
    if (whole_->around() && x > whole_->nx()) x -= whole_->nx();
    return whole_->direction(x, y + window_.y0);
  }

 private:
  std::shared_ptr<const HorizontalGrid> whole_;
  CellWindow window_;
  double turn_deg_ = 0;
};

}  // namespace

Region parse_region(const std::string& text, const std::string& where) {
  const auto refuse = [&](const char* expected) {
    throw Error({"bad value", where, expected, "'" + text + "'", "latitude comes first"});
  };
  std::array<double, 4> value{};
  const char *at = text.data(), *end = at + text.size();
  for (std::size_t n = 0; n < value.size(); ++n) {
    const auto [stop, failure] = std::from_chars(at, end, value[n]);
    const bool last = n + 1 == value.size();
    if (failure != std::errc{} || !std::isfinite(value[n]) || (stop == end) != last ||
        (!last && *stop != ','))
      refuse("SOUTH,WEST,NORTH,EAST in degrees");
    at = stop + 1;
  }
  const auto [south, west, north, east] = value;
  if (!(south >= -90 && south < north && north <= 90))
    refuse("a southern latitude below the northern one, both from -90 to 90 degrees");
  if (!(west >= -180 && west <= 360 && east >= -180 && east <= 360 && west != east &&
        east - west <= 360))
    refuse("two longitudes from -180 to 360 degrees, no more than a turn apart");
  return {south, west, north, east > west ? east : east + 360 * std::ceil((west - east) / 360)};
}

std::string to_text(const Region& region) {
  char text[120];
  std::snprintf(text, sizeof text, "%.6g to %.6g N, %.6g to %.6g E", region.south_deg,
                region.north_deg, region.west_deg, region.east_deg);
  return text;
}

CellWindow window_of(std::span<const std::shared_ptr<const HorizontalGrid>> grids,
                     const Region& region, const std::string& file) {
  const HorizontalGrid& first = *grids.front();
  Marks marks{std::vector<char>(std::size_t(first.nx())),
              std::vector<char>(std::size_t(first.ny()))};
  for (const auto& grid : grids) mark(*grid, region, marks);
  if (std::ranges::find(marks.rows, 1) == marks.rows.end())
    throw Error({"no cell of the file lies in the region", file,
                 "a region that overlaps the file's " + bounds_text(first), to_text(region), ""});
  const Run rows = run_of(marks.rows);
  const Run columns = first.around() ? run_around(marks.columns) : run_of(marks.columns);
  CellWindow window{columns.first, rows.first, columns.count, rows.count, {}};
  if (first.polygons())
    window.inside.assign(marks.columns.begin() + columns.first,
                         marks.columns.begin() + columns.first + columns.count);
  return window;
}

std::shared_ptr<const HorizontalGrid> windowed(std::shared_ptr<const HorizontalGrid> grid,
                                               const CellWindow& window) {
  if (grid->polygons()) return some_polygons(*grid, window.x0, window.inside);
  return std::make_shared<WindowedGrid>(std::move(grid), window);
}

std::string window_fact(const Region& region, const CellWindow& window,
                        const HorizontalGrid& grid) {
  const auto size = [](int nx, int ny) { return std::to_string(nx) + " x " + std::to_string(ny); };
  if (!window.inside.empty())
    return "Region " + to_text(region) + ": " +
           std::to_string(std::ranges::count(window.inside, 1)) + " of " +
           std::to_string(grid.nx()) + " cells, those beside it with it.";
  return "Region " + to_text(region) + ": " + size(window.nx, window.ny) + " of " +
         size(grid.nx(), grid.ny()) + " cells, one beyond its edges.";
}

}  // namespace nepho::forecast
