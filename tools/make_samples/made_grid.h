#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "tiny_file.h"

namespace nepho::samples {

// Horizontal grids for tests of readers, by closed formulas of their own (Snyder 1987, Map
// Projections: A Working Manual; GOES-R Product User Guide 5.1.2.8): nothing here knows a reader.

// Latitude and longitude in degrees; NaN off a satellite's disc.
struct MadeCell {
  glm::dvec2 centre_deg{0.0};
  std::vector<glm::dvec2> outline_deg;  // points around it, corners among them
};

struct MadeGrid {
  std::string name;
  std::vector<std::string> axes;                        // of a field, slowest first
  std::size_t nx = 0, ny = 0;                           // ny is 1 for cells in a row
  std::vector<NcNote> notes;                            // of each field
  std::function<void(TinyFile&)> write;                 // axes, coordinates, mapping
  std::function<glm::dvec2(double x, double y)> place;  // in cells; empty for cells in a row
  std::function<MadeCell(std::size_t cell)> cell;
  std::vector<std::size_t> cloudy;  // cells that hold the cloud: a block, or one
};

const std::vector<std::string>& made_grid_names();
// Throws Error on another name.
MadeGrid made_grid(const std::string& name);

}  // namespace nepho::samples
