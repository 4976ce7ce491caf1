#include "bench/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "bench/text.h"

namespace nepho::bench {
namespace {

// In pixels of the picture.
constexpr double kWidth = 760, kHeight = 470, kLeft = 74, kRight = 24, kTop = 64, kBottom = 56;
constexpr double kFont = 12, kGlyph = 0.55 * kFont;  // width of a character, on average
// Okabe and Ito's palette, which those who see fewer colours can tell apart.
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#555555"};

__attribute__((format(printf, 2, 3))) void print(std::string& out, const char* format, ...) {
  char line[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out += line;
}

const char* colour_of(std::size_t series) {
  return kColours[series % kColours.size()];
}

struct Box {
  double left, top, right, bottom;
  bool meets(const Box& o) const {
    return left < o.right && o.left < right && top < o.bottom && o.top < bottom;
  }
};

// One axis: values to pixels.
class LogAxis {
 public:
  // With some room at both ends, and never less than a factor of 2 in all.
  LogAxis(double low, double high, double from, double to) : from_(from), to_(to) {
    const double wanted = std::max(std::log(high / low) * 1.16, std::log(2.0));
    const double middle = 0.5 * (std::log(low) + std::log(high));
    low_ = middle - 0.5 * wanted;
    high_ = middle + 0.5 * wanted;
  }
  double at(double value) const {
    return from_ + (to_ - from_) * (std::log(value) - low_) / (high_ - low_);
  }
  std::vector<double> ticks() const { return log_ticks(std::exp(low_), std::exp(high_)); }

 private:
  double from_, to_, low_, high_;
};

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart), x_(x_axis(chart)), y_(y_axis(chart)), front_(front_of(chart.points)) {}

  std::string svg() {
    begin();
    grid();
    levels();
    front();
    points();
    labels();
    legend();
    return out_ + "</svg>\n";
  }

 private:
  static LogAxis x_axis(const Chart& chart) {
    double low = chart.points.front().x, high = low;
    for (const ChartPoint& p : chart.points) {
      low = std::min({low, p.x, p.x_low > 0 ? p.x_low : p.x});
      high = std::max({high, p.x, p.x_high});
    }
    return {low, high, kLeft, kWidth - kRight};
  }
  static LogAxis y_axis(const Chart& chart) {
    double low = chart.points.front().y, high = low;
    for (const ChartPoint& p : chart.points) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
    for (const Level& level : chart.levels) {
      low = std::min(low, level.y);
      high = std::max(high, level.y);
    }
    return {low, high, kHeight - kBottom, kTop};
  }

  void text(double x, double y, const char* style, const std::string& words) {
    print(out_, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, style);
    out_ += xml_text(words) + "</text>\n";
  }

  void begin() {
    print(out_,
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
          "height=\"%.0f\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"%.0f\">\n",
          kWidth, kHeight, kWidth, kHeight, kFont);
    out_ += "<title>" + xml_text(chart_.title) + "</title>\n";
    out_ += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    text(kLeft, 26, "font-size=\"16\" font-weight=\"bold\" fill=\"#111111\"", chart_.title);
    text(kLeft, 45, "fill=\"#555555\"", chart_.subtitle);
  }

  void grid() {
    const double bottom = kHeight - kBottom, right = kWidth - kRight;
    const auto line = [&](double x1, double y1, double x2, double y2) {
      print(out_, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#e4e4e4\"/>\n",
            x1, y1, x2, y2);
    };
    for (const double tick : x_.ticks()) {
      line(x_.at(tick), kTop, x_.at(tick), bottom);
      text(x_.at(tick), bottom + 18, "text-anchor=\"middle\" fill=\"#333333\"", number_text(tick));
    }
    for (const double tick : y_.ticks()) {
      line(kLeft, y_.at(tick), right, y_.at(tick));
      text(kLeft - 8, y_.at(tick) + 4, "text-anchor=\"end\" fill=\"#333333\"",
           chart_.y_is_share ? number_text(100 * tick) + " %" : number_text(tick));
    }
    print(out_, "<path d=\"M%.1f %.1fV%.1fH%.1f\" fill=\"none\" stroke=\"#888888\"/>\n", kLeft,
          kTop, bottom, right);
    text(0.5 * (kLeft + right), kHeight - 14, "text-anchor=\"middle\" fill=\"#111111\"",
         chart_.x_label);
    char turned[120];
    std::snprintf(turned, sizeof turned,
                  "transform=\"rotate(-90 16 %.1f)\" text-anchor=\"middle\" fill=\"#111111\"",
                  0.5 * (kTop + bottom));
    text(16, 0.5 * (kTop + bottom), turned, chart_.y_label);
  }

  void levels() {
    for (const Level& level : chart_.levels) {
      const double y = y_.at(level.y);
      print(out_,
            "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#333333\" "
            "stroke-dasharray=\"6 4\"/>\n",
            kLeft, y, kWidth - kRight, y);
      text(kWidth - kRight - 4, y - 6, "text-anchor=\"end\" fill=\"#333333\"", level.label);
      const double wide = kGlyph * double(level.label.size());
      taken_.push_back({kWidth - kRight - 4 - wide, y - 18, kWidth - kRight, y});
    }
  }

  void front() {
    if (front_.size() < 2) return;
    out_ += "<polyline fill=\"none\" stroke=\"#bbbbbb\" stroke-width=\"2\" points=\"";
    for (const std::size_t p : front_)
      print(out_, "%.1f,%.1f ", x_.at(chart_.points[p].x), y_.at(chart_.points[p].y));
    out_ += "\"/>\n";
  }

  void points() {
    for (std::size_t i = 0; i < chart_.points.size(); ++i) {
      const ChartPoint& p = chart_.points[i];
      const double x = x_.at(p.x), y = y_.at(p.y);
      if (p.x_low > 0 && p.x_high > p.x_low)
        print(out_, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n",
              x_.at(p.x_low), y, x_.at(p.x_high), y, colour_of(p.series));
      const bool best = std::ranges::find(front_, i) != front_.end();
      print(out_,
            "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" stroke=\"%s\" stroke-width=\"2\" fill=\"%s\">",
            x, y, colour_of(p.series), best ? colour_of(p.series) : "#ffffff");
      out_ += "<title>" + xml_text(p.label) + "</title></circle>\n";
      taken_.push_back({x - 6, y - 6, x + 6, y + 6});
    }
  }

  // Beside the point where there is room; what finds none is in the tables, and in its tip.
  void labels() {
    std::vector<std::size_t> order = front_;
    for (std::size_t i = 0; i < chart_.points.size(); ++i)
      if (std::ranges::find(front_, i) == front_.end()) order.push_back(i);
    for (const std::size_t i : order) {
      const ChartPoint& p = chart_.points[i];
      const double x = x_.at(p.x), y = y_.at(p.y), wide = kGlyph * double(p.label.size());
      for (const auto& [dx, dy] : {std::pair{9.0, -5.0}, std::pair{9.0, 14.0},
                                   std::pair{-9.0 - wide, -5.0}, std::pair{-9.0 - wide, 14.0},
                                   std::pair{-0.5 * wide, -11.0}, std::pair{-0.5 * wide, 21.0}}) {
        const Box box{x + dx, y + dy - 0.8 * kFont, x + dx + wide, y + dy + 0.2 * kFont};
        const bool inside = box.left > kLeft && box.right < kWidth - 4 && box.top > kTop - 8 &&
                            box.bottom < kHeight - kBottom;
        if (!inside || std::ranges::any_of(taken_, [&](const Box& b) { return b.meets(box); }))
          continue;
        text(x + dx, y + dy, "fill=\"#222222\"", p.label);
        taken_.push_back(box);
        break;
      }
    }
  }

  void legend() {
    if (chart_.series.size() < 2) return;
    double x = kWidth - kRight;
    for (std::size_t s = chart_.series.size(); s-- > 0;) {
      x -= kGlyph * double(chart_.series[s].size()) + 26;
      print(out_, "<circle cx=\"%.1f\" cy=\"41\" r=\"5\" fill=\"%s\"/>\n", x + 5, colour_of(s));
      text(x + 14, 45, "fill=\"#222222\"", chart_.series[s]);
    }
  }

  const Chart& chart_;
  LogAxis x_, y_;
  std::vector<std::size_t> front_;
  std::vector<Box> taken_;
  std::string out_;
};

}  // namespace

std::vector<double> log_ticks(double low, double high) {
  static const std::vector<std::vector<double>> kSteps = {
      {1}, {1, 3}, {1, 2, 5}, {1, 1.5, 2, 3, 4, 5, 7}, {1,   1.1, 1.2, 1.3, 1.4, 1.5, 1.6,
                                                        1.8, 2,   2.2, 2.5, 2.8, 3,   3.5,
                                                        4,   4.5, 5,   6,   7,   8,   9}};
  std::vector<double> ticks;
  for (const std::vector<double>& steps : kSteps) {
    ticks.clear();
    for (int decade = int(std::floor(std::log10(low))); decade <= int(std::floor(std::log10(high)));
         ++decade)
      for (const double step : steps) {
        const double tick = step * std::pow(10.0, decade);
        if (tick >= low && tick <= high) ticks.push_back(tick);
      }
    if (ticks.size() >= 3) break;
  }
  if (ticks.size() < 2 && high > low) ticks = {low, high};
  return ticks;
}

std::vector<std::size_t> front_of(const std::vector<ChartPoint>& points) {
  std::vector<std::size_t> order(points.size()), front;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(points[a].x, points[a].y) < std::pair(points[b].x, points[b].y);
  });
  double best = INFINITY;
  for (const std::size_t p : order)
    if (points[p].y < best) {
      best = points[p].y;
      front.push_back(p);
    }
  return front;
}

std::string svg_of(const Chart& chart) {
  if (chart.points.empty()) throw std::invalid_argument("a chart without a point");
  const auto good = [](double v) { return v > 0 && std::isfinite(v); };
  for (const ChartPoint& p : chart.points)
    if (!good(p.x) || !good(p.y)) throw std::invalid_argument("a point off a logarithmic axis");
  return Drawing(chart).svg();
}

}  // namespace nepho::bench
