#include "svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace orchard::apps {
namespace {

constexpr double kWidth = 720, kHeight = 440, kLeft = 80, kRight = 170, kTop = 44, kBottom = 56;
constexpr const char* kColors[] = {"#1b6ca8", "#d1495b", "#2e933c", "#edae49",
                                   "#6a4c93", "#3a3a3a", "#00a6a6", "#b5651d"};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool logarithmic = false;

  void take(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double place(double value) const {  // 0 to 1
    if (!(high > low)) return 0.5;
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
};

// A round number of steps of 1, 2 or 5 times a power of ten.
double tick_step(double span) {
  const double rough = span / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    y_.low = 0;
    for (const PlotSeries& series : plot.series) {
      for (const auto& [x, y] : series.points) {
        x_.take(x);
        y_.take(y);
      }
    }
    x_.logarithmic = plot.log_x && x_.low > 0;
    if (!(y_.high > 0)) y_.high = 1;
    y_.high = std::ceil(y_.high / tick_step(y_.high)) * tick_step(y_.high);
  }

  std::string run() {
    add("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        kWidth, kHeight);
    text(kLeft, 24, "start", plot_.title, " font-size=\"15\" font-weight=\"bold\"");
    draw_grid();
    for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_series(i);
    return text_ + "</svg>\n";
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }
  void text(double x, double y, const char* anchor, const std::string& words, const char* extra = "") {
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, extra, escaped(words));
  }
  double pixel_x(double x) const { return kLeft + x_.place(x) * (kWidth - kLeft - kRight); }
  double pixel_y(double y) const { return kHeight - kBottom - y_.place(y) * (kHeight - kTop - kBottom); }

  void draw_grid() {
    const double step = tick_step(y_.high);
    for (int i = 0; i * step <= y_.high * 1.0001; ++i) {
      const double y = pixel_y(i * step);
      add("<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n", kLeft, kWidth - kRight, y, y);
      text(kLeft - 8, y + 4, "end", fmt::format("{:.4g}", i * step));
    }
    std::vector<double> places;
    for (const PlotSeries& series : plot_.series) {
      for (const auto& point : series.points) places.push_back(point.first);
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (const double x : places) {
      const auto index = static_cast<std::size_t>(std::max(0.0, x));
      const std::string name = index < plot_.x_names.size() ? plot_.x_names[index] : fmt::format("{:.6g}", x);
      text(pixel_x(x), kHeight - kBottom + 18, "middle", name);
    }
    text((kLeft + kWidth - kRight) / 2, kHeight - 14, "middle", plot_.x_label);
    add("<text transform=\"translate(18,{:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
        (kTop + kHeight - kBottom) / 2, escaped(plot_.y_label));
  }

  void draw_series(std::size_t i) {
    const PlotSeries& series = plot_.series[i];
    const char* color = kColors[i % std::size(kColors)];
    std::string path;
    bool pen_down = false;
    for (const auto& [x, y] : series.points) {
      if (!std::isfinite(y)) {
        pen_down = false;
        continue;
      }
      path += fmt::format("{}{:.1f} {:.1f} ", pen_down ? 'L' : 'M', pixel_x(x), pixel_y(y));
      pen_down = true;
      add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", pixel_x(x), pixel_y(y), color);
    }
    add("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path, color);
    const double y = kTop + 18 * static_cast<double>(i) + 6;
    add("<rect x=\"{}\" y=\"{:.1f}\" width=\"12\" height=\"3\" fill=\"{}\"/>\n", kWidth - kRight + 14, y, color);
    text(kWidth - kRight + 32, y + 6, "start", series.name);
  }

  const Plot& plot_;
  Axis x_, y_;
  std::string text_;
};

}  // namespace

std::string to_svg(const Plot& plot) { return Drawing(plot).run(); }

}  // namespace orchard::apps
