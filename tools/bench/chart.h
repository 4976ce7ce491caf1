#pragma once

#include <string>
#include <vector>

namespace nepho::bench {

// A picture of points over two logarithmic axes, as SVG that stands alone: no script, no font, no
// network. Points on the front (none is better in both) are joined by a line.
struct ChartPoint {
  double x = 0, y = 0;           // above 0; lower is better
  double x_low = 0, x_high = 0;  // its spread; 0: none
  std::string label = {};
  std::size_t series = 0;
};
struct Level {
  double y = 0;
  std::string label;
};
struct Chart {
  std::string title, subtitle, x_label, y_label;
  bool y_is_share = true;           // ticks in percent
  std::vector<std::string> series;  // names; one or none: no legend
  std::vector<ChartPoint> points;
  std::vector<Level> levels;  // dashed lines across
};
// Throws std::invalid_argument where a coordinate is not above 0 and finite, or there is no point.
std::string svg_of(const Chart& chart);

// Indices of the points that no other one is as good as in one coordinate and better in the other,
// by ascending x; of equal points the first.
std::vector<std::size_t> front_of(const std::vector<ChartPoint>& points);

// Round numbers for ticks, low to high, all within; at least two where high > low > 0.
std::vector<double> log_ticks(double low, double high);

}  // namespace nepho::bench
