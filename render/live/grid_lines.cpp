#include "live/grid_lines.h"

#include <algorithm>

namespace nepho {
namespace {

std::vector<GridLines::Line> lines_along(int first, int step, int pixels) {
  const int count = pixels / step;
  std::vector<GridLines::Line> lines(static_cast<std::size_t>(pixels));
  for (int pixel = 0; pixel < pixels; ++pixel) {
    const float where = std::clamp(float(pixel - first) / float(step), 0.0f, float(count - 1));
    GridLines::Line& line = lines[std::size_t(pixel)];
    line.before = int(where);
    line.after = std::min(line.before + 1, count - 1);
    line.part = where - float(line.before);
    line.nearest = int(where + 0.5f);
    line.cell = (pixel - first + step) / step;
  }
  return lines;
}

}  // namespace

GridLines::GridLines(const PixelGrid& of, int width, int height)
    : grid(of),
      columns(width / of.step),
      rows(height / of.step),
      x(lines_along(of.x, of.step, width)),
      y(lines_along(of.y, of.step, height)) {}

}  // namespace nepho
