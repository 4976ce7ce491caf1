#include "made_cells.h"

#include <array>
#include <cmath>

#include "made_maps.h"

namespace nepho::samples {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::size_t kNx = 24, kNy = 20, kI = 6, kJ = 13;  // squares, and the cloud's

// Squares of a turned grid, each cut in two: triangles.
constexpr std::size_t kTriangles = 2 * kNx * kNy;
glm::dvec2 turned(double x, double y) {
  return from_rotated({42, 160}, 0, {0.2 * x - 2.4, 0.2 * y - 2});
}
std::array<glm::dvec2, 3> triangle(std::size_t n) {
  const double x = double(n / 2 % kNx), y = double(n / 2 / kNx);
  if (n % 2) return {glm::dvec2(x + 1, y + 1), {x, y + 1}, {x + 1, y}};
  return {glm::dvec2(x, y), {x + 1, y}, {x, y + 1}};
}

MadeGrid of_cells(const std::string& name, std::size_t cells, std::size_t cloudy,
                  const std::function<MadeCell(std::size_t)>& cell) {
  MadeGrid grid;
  grid.name = name;
  grid.axes = {"ncells"};
  grid.nx = cells, grid.ny = 1;
  grid.cell = cell;
  grid.cloudy = {cloudy};
  return grid;
}

MadeCell triangle_cell(std::size_t n) {
  const auto corner = triangle(n);
  const glm::dvec2 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
  MadeCell cell{turned(middle.x, middle.y), {}};
  for (const glm::dvec2& p : corner) cell.outline_deg.push_back(turned(p.x, p.y));
  return cell;
}

void add_cells(TinyFile& file, const MadeGrid& grid, const char* lat, const char* lon,
               std::vector<NcNote> notes, double to_unit) {
  file.layout.axes.push_back({"ncells", grid.nx});
  std::vector<double> y, x;
  for (std::size_t n = 0; n < grid.nx; ++n) {
    y.push_back(grid.cell(n).centre_deg.x * to_unit);
    x.push_back(grid.cell(n).centre_deg.y * to_unit);
  }
  std::vector<NcNote> lat_notes = notes, lon_notes = notes;
  if (!notes.empty()) {
    lat_notes.push_back(text_note("bounds", std::string(lat) + "_bnds"));
    lon_notes.push_back(text_note("bounds", std::string(lon) + "_bnds"));
  }
  file.add({lat, NcValue::kDouble, {"ncells"}, lat_notes}, y);
  file.add({lon, NcValue::kDouble, {"ncells"}, lon_notes}, x);
}

}  // namespace

MadeGrid made_icon() {  // triangles with their corners, in radians
  MadeGrid grid = of_cells("icon", kTriangles, 2 * (kJ * kNx + kI), triangle_cell);
  grid.notes = {text_note("CDI_grid_type", "unstructured"), text_note("coordinates", "clat clon")};
  grid.write = [grid](TinyFile& file) {
    add_cells(file, grid, "clat", "clon", {text_note("units", "radian")}, kDegree);
    file.layout.axes.push_back({"vertices", 3});
    std::vector<double> y, x;
    for (std::size_t n = 0; n < grid.nx; ++n)
      for (const glm::dvec2& p : grid.cell(n).outline_deg) {
        y.push_back(p.x * kDegree);
        x.push_back(p.y * kDegree);
      }
    file.add({"clat_bnds", NcValue::kDouble, {"ncells", "vertices"}, {}}, y);
    file.add({"clon_bnds", NcValue::kDouble, {"ncells", "vertices"}, {}}, x);
  };
  return grid;
}

// Corners by number, as MPAS and UGRID have them: numbers from 1, and from 0 with a mesh topology.
MadeGrid made_numbers(const std::string& name, bool ugrid) {
  MadeGrid grid = of_cells(name, kTriangles, 2 * (kJ * kNx + kI) + 1, triangle_cell);
  if (ugrid) grid.notes = {text_note("mesh", "mesh"), text_note("location", "face")};
  if (!ugrid) grid.axes = {"ncells"};
  grid.write = [=](TinyFile& file) {
    add_cells(file, grid, ugrid ? "face_lat" : "latCell", ugrid ? "face_lon" : "lonCell", {},
              ugrid ? 1 : kDegree);
    const std::size_t points = (kNx + 1) * (kNy + 1), most = ugrid ? 3 : 6;
    file.layout.axes.insert(file.layout.axes.end(), {{"points", points}, {"corners", most}});
    std::vector<double> lat, lon, number, count(grid.nx, 3);
    for (std::size_t n = 0; n < points; ++n) {
      const glm::dvec2 p = turned(double(n % (kNx + 1)), double(n / (kNx + 1)));
      lat.push_back(p.x * (ugrid ? 1 : kDegree));
      lon.push_back(p.y * (ugrid ? 1 : kDegree));
    }
    for (std::size_t n = 0; n < grid.nx; ++n) {
      for (const glm::dvec2& p : triangle(n))
        number.push_back(p.y * (kNx + 1) + p.x + (ugrid ? 0 : 1));
      for (std::size_t v = 3; v < most; ++v) number.push_back(ugrid ? -1 : number.back());
    }
    const std::vector<NcNote> north = {text_note("units", "degrees_north")},
                              east = {text_note("units", "degrees_east")};
    file.add({ugrid ? "node_lat" : "latVertex",
              NcValue::kDouble,
              {"points"},
              ugrid ? north : std::vector<NcNote>{}},
             lat);
    file.add({ugrid ? "node_lon" : "lonVertex",
              NcValue::kDouble,
              {"points"},
              ugrid ? east : std::vector<NcNote>{}},
             lon);
    file.add({ugrid ? "face_nodes" : "verticesOnCell",
              NcValue::kInt,
              {"ncells", "corners"},
              {{"start_index", "", {0}, NcValue::kInt}}},
             number);
    if (ugrid) {
      file.layout.set_note("face_lat", north[0]), file.layout.set_note("face_lon", east[0]);
      file.add({"mesh",
                NcValue::kInt,
                {},
                {text_note("cf_role", "mesh_topology"),
                 text_note("face_node_connectivity", "face_nodes"),
                 text_note("node_coordinates", "node_lon node_lat")}},
               {0});
    } else {
      file.add({"nEdgesOnCell", NcValue::kInt, {"ncells"}, {}}, count);
    }
  };
  return grid;
}

// Centres alone, six neighbours each: their cells are hexagons.
MadeGrid made_hexagons() {
  constexpr double kSpacing_deg = 0.2;
  const auto place = [](double x, double y) {
    return from_rotated({30, -100}, 0, {kSpacing_deg * x, kSpacing_deg * y});
  };
  MadeGrid grid = of_cells("centres", kNx * kNy, kJ * kNx + kI, [=](std::size_t n) {
    const double row = std::sqrt(0.75), j = double(n / kNx);
    const glm::dvec2 c = {double(n % kNx) - 12 + 0.5 * std::fmod(j, 2.0), (j - 10) * row};
    MadeCell cell{place(c.x, c.y), {}};
    for (int corner = 0; corner < 6; ++corner) {
      const double angle = (60 * corner + 30) * kDegree, out = 1 / std::sqrt(3.0);
      cell.outline_deg.push_back(place(c.x + out * std::cos(angle), c.y + out * std::sin(angle)));
    }
    return cell;
  });
  grid.write = [grid](TinyFile& file) {
    add_cells(file, grid, "lat", "lon", {}, 1);
    file.layout.set_note("lat", text_note("units", "degrees_north"));
    file.layout.set_note("lon", text_note("units", "degrees_east"));
  };
  return grid;
}

}  // namespace nepho::samples
