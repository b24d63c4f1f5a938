#include "svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace orchard::plot {
namespace {

constexpr double kWidth = 420, kHeight = 300, kLeft = 58, kRight = 20, kTop = 28, kBottom = 42;  // of a plot, in pixels
constexpr double kLegendRow = 14;
constexpr std::size_t kMaxMarks = 40;  // on a line
constexpr const char* kColors[] = {"#1f6fb4", "#d9581c", "#2e8b4f", "#8c4fa8", "#b8860b", "#555555", "#c2417c"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

class Axis {
 public:
  Axis(bool log, double from, double to) : log_(log), from_(from), to_(to) {}

  bool shows(double v) const { return std::isfinite(v) && (!log_ || v > 0); }
  void see(double v) {
    if (!shows(v)) return;
    low_ = std::min(low_, scaled(v));
    high_ = std::max(high_, scaled(v));
  }
  void settle() {
    if (!(low_ <= high_)) low_ = 0, high_ = 1;
    if (log_) low_ = std::floor(low_ + 1e-9), high_ = std::ceil(high_ - 1e-9);
    if (high_ == low_) high_ = low_ + std::max(1.0, std::fabs(low_));
    if (!log_) {
      const double margin = 0.04 * (high_ - low_);
      low_ = low_ >= 0 && low_ < 0.3 * high_ ? 0 : low_ - margin;
      high_ += margin;
    }
  }
  double place(double v) const { return from_ + (scaled(v) - low_) / (high_ - low_) * (to_ - from_); }
  std::vector<double> ticks() const {
    std::vector<double> result;
    double step =
        log_ ? std::max(1.0, std::ceil((high_ - low_) / 8)) : std::pow(10, std::floor(std::log10(high_ - low_)));
    if (!log_ && (high_ - low_) / step < 2.5) step /= 5;
    if (!log_ && (high_ - low_) / step < 5) step /= 2;
    const auto first = static_cast<long>(std::ceil(low_ / step));
    const auto last = static_cast<long>(std::floor(high_ / step + 1e-9));
    for (long i = first; i <= last; ++i) {
      const double v = static_cast<double>(i) * step;
      result.push_back(log_ ? std::pow(10, v) : v);
    }
    return result;
  }

 private:
  double scaled(double v) const { return log_ ? std::log10(v) : v; }
  bool log_;
  double from_, to_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

void text(std::ostream& out, double x, double y, const std::string& what, const char* style) {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" " << style << ">" << escaped(what) << "</text>\n";
}

void line(std::ostream& out, double x1, double y1, double x2, double y2, const char* style) {
  out << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2 << "\" " << style << "/>\n";
}

void rectangle(std::ostream& out, double x, double y, double width, double height, const std::string& style) {
  out << "<rect x=\"" << x << "\" y=\"" << y << "\" width=\"" << width << "\" height=\"" << height << "\" " << style
      << "/>\n";
}

void draw_series(std::ostream& out, const Series& series, const Axis& x, const Axis& y, const char* color) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const std::string paint = color;
  const double width = count > 1 && series.kind == Series::Kind::bars ? x.place(series.x[1]) - x.place(series.x[0]) : 0;
  bool drawing = false;
  if (series.kind == Series::Kind::line)
    out << "<path fill=\"none\" stroke=\"" << color << "\" stroke-width=\"1.5\" d=\"";
  for (std::size_t i = 0; i < count; ++i) {
    if (!x.shows(series.x[i]) || !y.shows(series.y[i])) {
      drawing = false;
      continue;
    }
    const double px = x.place(series.x[i]), py = y.place(series.y[i]);
    if (series.kind == Series::Kind::line) {
      out << (drawing ? 'L' : 'M') << px << ',' << py;
      drawing = true;
    } else if (series.kind == Series::Kind::points) {
      out << "<circle cx=\"" << px << "\" cy=\"" << py << "\" r=\"2\" fill=\"none\" stroke=\"" << color << "\"/>\n";
    } else {
      rectangle(out, px, py, width, std::max(0.0, kHeight - kBottom - py),
                "fill-opacity=\"0.5\" fill=\"" + paint + "\"");
    }
  }
  if (series.kind != Series::Kind::line) return;
  out << "\"/>\n";
  if (count > kMaxMarks) return;
  for (std::size_t i = 0; i < count; ++i)
    if (x.shows(series.x[i]) && y.shows(series.y[i]))
      out << "<circle cx=\"" << x.place(series.x[i]) << "\" cy=\"" << y.place(series.y[i]) << "\" r=\"2.5\" fill=\""
          << color << "\"/>\n";
}

void draw_frame(std::ostream& out, const Plot& plot, const Axis& x, const Axis& y) {
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  std::vector<double> ticks = x.ticks();
  if (!plot.x_names.empty()) {
    ticks.resize(plot.x_names.size());
    for (std::size_t i = 0; i < ticks.size(); ++i) ticks[i] = static_cast<double>(i);
  }
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    line(out, x.place(ticks[i]), kTop, x.place(ticks[i]), bottom, "stroke=\"#e4e4e4\"");
    text(out, x.place(ticks[i]), bottom + 14, plot.x_names.empty() ? number(ticks[i]) : plot.x_names[i],
         "text-anchor=\"middle\"");
  }
  for (const double t : y.ticks()) {
    line(out, kLeft, y.place(t), right, y.place(t), "stroke=\"#e4e4e4\"");
    text(out, kLeft - 5, y.place(t) + 4, number(t), "text-anchor=\"end\"");
  }
  for (const double level : plot.levels) {
    line(out, kLeft, y.place(level), right, y.place(level), "stroke=\"#888\" stroke-dasharray=\"5 4\"");
  }
  rectangle(out, kLeft, kTop, right - kLeft, bottom - kTop, "fill=\"none\" stroke=\"#444\"");
  text(out, (kLeft + right) / 2, kTop - 10, plot.title, "text-anchor=\"middle\" font-weight=\"bold\"");
  text(out, (kLeft + right) / 2, kHeight - 8, plot.x_label, "text-anchor=\"middle\"");
  out << "<g transform=\"translate(13 " << (kTop + bottom) / 2 << ") rotate(-90)\">";
  text(out, 0, 0, plot.y_label, "text-anchor=\"middle\"");
  out << "</g>\n";
}

// Where the last bar ends: it is as wide, as drawn, as the first one.
double end_of_bars(const std::vector<double>& x, bool log) {
  const double last = x[x.size() - 1], before = x[x.size() - 2];
  return log ? last * last / before : last + (last - before);
}

void draw(std::ostream& out, const Plot& plot) {
  Axis x(plot.log_x, kLeft, kWidth - kRight), y(plot.log_y, kHeight - kBottom, kTop);
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (!x.shows(series.x[i]) || !y.shows(series.y[i])) continue;
      x.see(series.x[i]);
      y.see(series.y[i]);
    }
    if (series.kind != Series::Kind::bars) continue;
    if (!plot.log_y) y.see(0);
    if (series.x.size() > 1) x.see(end_of_bars(series.x, plot.log_x));
  }
  for (const double level : plot.levels) y.see(level);
  if (!plot.x_names.empty()) x.see(0), x.see(static_cast<double>(plot.x_names.size() - 1));
  x.settle();
  y.settle();
  draw_frame(out, plot, x, y);
  std::size_t color = 0, named = 0;
  for (const Series& series : plot.series) {
    const char* const paint = kColors[color++ % std::size(kColors)];
    draw_series(out, series, x, y, paint);
    if (series.name.empty()) continue;
    const double row = kHeight + kLegendRow * (static_cast<double>(named++) + 0.5);
    const std::string fill = paint;
    rectangle(out, kLeft, row - 8, 9, 9, "fill=\"" + fill + "\"");
    text(out, kLeft + 15, row, series.name, "");
  }
}

}  // namespace

std::string to_svg(const std::vector<Plot>& plots, int columns) {
  const int count = static_cast<int>(plots.size()), rows = (count + columns - 1) / columns;
  std::ptrdiff_t names = 0;
  for (const Plot& plot : plots) {
    names = std::max(names, std::count_if(plot.series.begin(), plot.series.end(),
                                          [](const Series& series) { return !series.name.empty(); }));
  }
  const double height = kHeight + kLegendRow * static_cast<double>(names);
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kWidth * std::min(columns, count) << "\" height=\""
      << height * rows
      << "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (int i = 0; i < count; ++i) {
    const int row = i / columns;
    out << "<g transform=\"translate(" << kWidth * (i % columns) << " " << height * row << ")\">\n";
    draw(out, plots[static_cast<std::size_t>(i)]);
    out << "</g>\n";
  }
  out << "</svg>\n";
  return out.str();
}

void write_svg(const std::filesystem::path& file, const std::vector<Plot>& plots, int columns) {
  std::ofstream out(file);
  out << to_svg(plots, columns);
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace orchard::plot
