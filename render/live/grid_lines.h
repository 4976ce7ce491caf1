#pragma once

#include <vector>

#include "live/pixel_shares.h"

namespace nepho {

// Where the pixels of a picture are between those of a grid.
struct GridLines {
  // Of a row or column of pixels: the lines of the grid before and behind it, the part of the way
  // between them, the nearest one, and the number of the cell that it is in, 0 before the first
  // line.
  struct Line {
    int before, after, nearest, cell;
    float part;
  };

  // The grid has a pixel in each block of grid.step pixels; these divide width and height.
  GridLines(const PixelGrid& grid, int width, int height);

  int pixel_x(int column) const { return column * grid.step + grid.x; }
  int pixel_y(int row) const { return row * grid.step + grid.y; }
  std::size_t number(int column, int row) const {
    return std::size_t(row) * std::size_t(columns) + std::size_t(column);
  }

  PixelGrid grid;
  int columns, rows;
  std::vector<Line> x, y;  // by pixel
};

}  // namespace nepho
