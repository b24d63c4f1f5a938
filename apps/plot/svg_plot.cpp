// One drawing: axes, curves, bars and legend share its margins and scales, hence more than 300 lines.
#include "svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "orchard/geometry/xml_escaped.h"

namespace orchard::plot {
namespace {

constexpr double kWidth = 420, kHeight = 300, kRight = 20, kTop = 30, kBottom = 44;  // of a plot, in pixels
constexpr double kLegendRow = 15;
constexpr double kLetter = 6.2;  // the approximate width of a letter, at the size of all print
// If the largest value is this many times the smallest, a scale becomes logarithmic if that is allowed.
constexpr double kWide = 8;
constexpr std::size_t kMaxMarks = 40;  // on a line
constexpr const char* kColors[] = {"#1f6fb4", "#d9581c", "#2e8b4f", "#8c4fa8", "#b8860b", "#555555", "#c2417c"};
// Lines differ by their dashes as well as by colour, for printers and readers that do not distinguish colours.
constexpr const char* kDashes[] = {"", "7 3", "2 3", "8 3 2 3", "12 4", "4 2", "1 2"};
constexpr const char* kDashed = "6 4";

// Digits where they are few, else a power of ten.
std::string number(double value) {
  char text[32];
  const double size = std::fabs(value);
  if (value == 0 || (size >= 1e-4 && size < 1e6)) {
    std::snprintf(text, sizeof text, "%.7g", value);
    return text;
  }
  std::snprintf(text, sizeof text, "%.3e", value);
  const std::string all = text, digits = all.substr(0, all.find('e'));
  const int power = std::atoi(all.c_str() + all.find('e') + 1);
  std::string result = digits.substr(0, digits.find_last_not_of('0') + 1);
  if (result.ends_with('.')) result.pop_back();
  result = result == "1" ? "" : result == "-1" ? "-" : result + "·";
  static constexpr const char* kSuperscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  result += power < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(power))) result += kSuperscripts[digit - '0'];
  return result;
}

// Letters, not bytes.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
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
    if (high_ == low_) high_ = low_ + (log_ ? 0.5 : std::max(1.0, std::fabs(low_)));
    if (log_) {
      const double margin = 0.05 * (high_ - low_);
      low_ -= margin;
      high_ += margin;
    } else {
      const double margin = 0.04 * (high_ - low_);
      low_ = low_ >= 0 && low_ < 0.3 * high_ ? 0 : low_ - margin;
      high_ += margin;
    }
  }
  double place(double v) const { return from_ + (scaled(v) - low_) / (high_ - low_) * (to_ - from_); }
  std::vector<double> ticks() const { return log_ ? log_ticks() : even_ticks(); }
  bool log() const { return log_; }

 private:
  // Powers of ten; between few of them 2 and 5 as well, between none every digit that is not crowded.
  std::vector<double> log_ticks() const {
    const double decades = high_ - low_;
    std::vector<double> factors{1};
    if (decades < 3) factors = {1, 2, 5};
    if (decades < 1) factors = {1, 1.5, 2, 3, 4, 5, 7};
    if (decades < 0.35) factors = {1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9};
    const int step = std::max(1, static_cast<int>(std::ceil(decades / 8)));
    std::vector<double> result;
    for (int power = static_cast<int>(std::floor(low_)); power <= static_cast<int>(std::floor(high_)); ++power) {
      if (power % step != 0) continue;
      for (const double factor : factors) {
        const double place = power + std::log10(factor);
        if (place >= low_ && place <= high_) result.push_back(factor * std::pow(10, power));
      }
    }
    return result;
  }
  std::vector<double> even_ticks() const {
    double step = std::pow(10, std::floor(std::log10(high_ - low_)));
    if ((high_ - low_) / step < 2.5) step /= 5;
    if ((high_ - low_) / step < 5) step /= 2;
    const auto first = static_cast<long>(std::ceil(low_ / step));
    const auto last = static_cast<long>(std::floor(high_ / step + 1e-9));
    std::vector<double> result;
    for (long k = first; k <= last; ++k) result.push_back(static_cast<double>(k) * step);
    return result;
  }
  double scaled(double v) const { return log_ ? std::log10(v) : v; }
  bool log_;
  double from_, to_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

void text(std::ostream& out, double x, double y, const std::string& what, const char* style) {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" " << style << ">" << xml_escaped(what) << "</text>\n";
}

void line(std::ostream& out, double x1, double y1, double x2, double y2, const char* style) {
  out << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2 << "\" " << style << "/>\n";
}

void rectangle(std::ostream& out, double x, double y, double width, double height, const std::string& style) {
  out << "<rect x=\"" << x << "\" y=\"" << y << "\" width=\"" << width << "\" height=\"" << height << "\" " << style
      << "/>\n";
}

// When the colours repeat, the dashes change.
const char* dashes_of_line(std::size_t line) {
  return kDashes[(line + line / std::size(kColors)) % std::size(kDashes)];
}

// The marks of different lines, as coordinates of corners in units of a mark's size, so that overlapping points can be
// distinguished; an empty one is a circle.
constexpr std::array<std::string_view, 6> kMarks{"",
                                                 "-.9,-.9 .9,-.9 .9,.9 -.9,.9",
                                                 "0,-1.25 1.1,.75 -1.1,.75",
                                                 "0,-1.3 1.3,0 0,1.3 -1.3,0",
                                                 "0,1.25 1.1,-.75 -1.1,-.75",
                                                 "-.4,-1.2 .4,-1.2 .4,-.4 1.2,-.4 1.2,.4 .4,.4 .4,1.2 -.4,1.2 -.4,.4 "
                                                 "-1.2,.4 -1.2,-.4 -.4,-.4"};
constexpr double kMarkSize = 3;

struct Look {
  const char *color, *dashes;
  std::size_t mark = 0;
  bool hollow = false;
};

// Draws a mark on a line. The line's other dots keep their distance from it.
void draw_mark(std::ostream& out, double x, double y, const Look& look) {
  const std::string style = std::string("fill=\"") + (look.hollow ? "white" : look.color) + "\" stroke=\"" +
                            (look.hollow ? look.color : "white") + "\"";
  if (kMarks[look.mark].empty()) {
    out << "<circle cx=\"" << x << "\" cy=\"" << y << "\" r=\"" << kMarkSize << "\" " << style << "/>\n";
    return;
  }
  out << "<polygon transform=\"translate(" << x << ' ' << y << ") scale(" << kMarkSize << ")\" points=\""
      << kMarks[look.mark] << "\" stroke-width=\"" << 1 / kMarkSize << "\" " << style << "/>\n";
}

std::string dashes_of(const Look& look) {
  return *look.dashes == 0 ? std::string() : " stroke-dasharray=\"" + std::string(look.dashes) + "\"";
}

// Draws labels above the marks, or to the left of marks in the right half of the frame. A label that would overlap an
// earlier one of the same line is left out.
void draw_labels(std::ostream& out, const Series& series, const Axis& x, const Axis& y, const Look& look) {
  const std::string style = std::string("font-size=\"10\" fill=\"") + look.color + "\"";
  double last_x = -1e9, last_y = -1e9;
  for (std::size_t i = 0; i < std::min({series.labels.size(), series.x.size(), series.y.size()}); ++i) {
    if (!x.shows(series.x[i]) || !y.shows(series.y[i])) continue;
    const double px = x.place(series.x[i]), py = y.place(series.y[i]);
    const double width = kLetter * static_cast<double>(letters(series.labels[i]) + 1);
    if (std::fabs(px - last_x) < width && std::fabs(py - last_y) < kLegendRow) continue;
    last_x = px, last_y = py;
    const bool right = px > kWidth / 2;
    text(out, px + (right ? -5 : 5), py - 5, series.labels[i], (style + (right ? " text-anchor=\"end\"" : "")).c_str());
  }
}

void draw_series(std::ostream& out, const Series& series, const Axis& x, const Axis& y, const Look& look) {
  const char* const color = look.color;
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const std::string paint = color;
  const double width = count > 1 && series.kind == Series::Kind::bars ? x.place(series.x[1]) - x.place(series.x[0]) : 0;
  bool drawing = false;
  if (series.kind == Series::Kind::line)
    out << "<path fill=\"none\" stroke=\"" << color << "\" stroke-width=\"1.8\"" << dashes_of(look) << " d=\"";
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
    if (x.shows(series.x[i]) && y.shows(series.y[i])) draw_mark(out, x.place(series.x[i]), y.place(series.y[i]), look);
  draw_labels(out, series, x, y, look);
}

// Where a plot's frame is.
struct Frame {
  double left, right;
};

void draw_frame(std::ostream& out, const Plot& plot, const Axis& x, const Axis& y, const Frame& frame) {
  const double bottom = kHeight - kBottom, left = frame.left, right = frame.right;
  std::vector<double> ticks = x.ticks();
  if (!plot.x_names.empty()) {
    ticks.resize(plot.x_names.size());
    for (std::size_t i = 0; i < ticks.size(); ++i) ticks[i] = static_cast<double>(i);
  }
  double written = -1e9;  // the right end of the text below the frame
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    line(out, x.place(ticks[i]), kTop, x.place(ticks[i]), bottom, "stroke=\"#e4e4e4\"");
    const std::string name = plot.x_names.empty() ? number(ticks[i]) : plot.x_names[i];
    const double half = 0.5 * kLetter * static_cast<double>(letters(name));
    if (x.place(ticks[i]) - half < written + kLetter) continue;
    written = x.place(ticks[i]) + half;
    text(out, x.place(ticks[i]), bottom + 15, name, "text-anchor=\"middle\"");
  }
  for (const double t : y.ticks()) {
    line(out, left, y.place(t), right, y.place(t), "stroke=\"#e4e4e4\"");
    text(out, left - 5, y.place(t) + 4, number(t), "text-anchor=\"end\"");
  }
  for (const double level : plot.levels) {
    if (!y.shows(level)) continue;
    line(out, left, y.place(level), right, y.place(level), "stroke=\"#888\" stroke-dasharray=\"5 4\"");
  }
  rectangle(out, left, kTop, right - left, bottom - kTop, "fill=\"none\" stroke=\"#444\"");
  text(out, (left + right) / 2, kTop - 10, plot.title, "text-anchor=\"middle\" font-weight=\"bold\"");
  text(out, (left + right) / 2, kHeight - 8, plot.x_label, "text-anchor=\"middle\"");
  out << "<g transform=\"translate(14 " << (kTop + bottom) / 2 << ") rotate(-90)\">";
  text(out, 0, 0, plot.y_label, "text-anchor=\"middle\"");
  out << "</g>\n";
}

// The last bar is drawn as wide as the first one.
double end_of_bars(const std::vector<double>& x, bool log) {
  const double last = x[x.size() - 1], before = x[x.size() - 2];
  return log ? last * last / before : last + (last - before);
}

bool wide(const Plot& plot) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Series& series : plot.series)
    for (const double y : series.y) {
      if (!std::isfinite(y)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  return low > 0 && high > kWide * low;
}

// What the axes must span.
void see_all(const Plot& plot, Axis& x, Axis& y) {
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (!x.shows(series.x[i]) || !y.shows(series.y[i])) continue;
      x.see(series.x[i]);
      y.see(series.y[i]);
    }
    if (series.kind != Series::Kind::bars) continue;
    if (!y.log()) y.see(0);
    if (series.x.size() > 1) x.see(end_of_bars(series.x, plot.log_x));
  }
  for (const double level : plot.levels) y.see(level);
  if (plot.x_names.empty()) return;
  constexpr double kBeside = 0.12;  // so that no mark lies on the frame
  x.see(-kBeside);
  x.see(static_cast<double>(plot.x_names.size() - 1) + kBeside);
}

// Room for the widest number of the scale, and for what it counts.
double left_of_frame(const Plot& plot, const Axis& y) {
  std::size_t longest = 0;
  for (const double tick : y.ticks()) longest = std::max(longest, letters(number(tick)));
  return 12 + kLetter * static_cast<double>(longest) + (plot.y_label.empty() ? 0 : 16);
}

void draw_legend(std::ostream& out, const Series& series, const Look& look, double left, double row) {
  const std::string color = look.color;
  if (series.kind == Series::Kind::line) {
    const std::string style = "stroke-width=\"1.8\" stroke=\"" + color + "\"" + dashes_of(look);
    line(out, left, row - 4, left + 26, row - 4, style.c_str());
    if (series.x.size() <= kMaxMarks) draw_mark(out, left + 13, row - 4, look);
  } else {
    rectangle(out, left + 8, row - 8, 9, 9, "fill=\"" + color + "\"");
  }
  text(out, left + 33, row, series.name, "");
}

// What the lines of a plot look like, by series.
std::vector<Look> looks_of(const Plot& plot) {
  const bool compared = std::any_of(plot.series.begin(), plot.series.end(), [](const Series& s) { return s.dashed; });
  std::vector<Look> looks;
  std::size_t lines = 0;
  for (const Series& series : plot.series) {
    const bool line = series.kind == Series::Kind::line;
    const std::size_t place = series.look.value_or(looks.size()), nth = series.look.value_or(lines);
    const char* dashes = series.dashed ? kDashed : line && !compared ? dashes_of_line(nth) : "";
    lines += line && !series.dashed;
    looks.push_back({kColors[place % std::size(kColors)], dashes, place % kMarks.size(), series.dashed});
  }
  return looks;
}

void draw(std::ostream& out, const Plot& plot, double width, bool with_legend) {
  const bool log_y = plot.log_y || (plot.log_y_if_wide && wide(plot));
  Axis y(log_y, kHeight - kBottom, kTop), unplaced(plot.log_x, 0, 1);
  see_all(plot, unplaced, y);
  y.settle();
  const Frame frame{left_of_frame(plot, y), width - kRight};
  Axis x(plot.log_x, frame.left, frame.right), same(log_y, 0, 1);
  see_all(plot, x, same);
  x.settle();
  draw_frame(out, plot, x, y, frame);
  const std::vector<Look> looks = looks_of(plot);
  std::size_t named = 0;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const Series& series = plot.series[i];
    draw_series(out, series, x, y, looks[i]);
    if (!with_legend || series.name.empty()) continue;
    draw_legend(out, series, looks[i], frame.left, kHeight + kLegendRow * (static_cast<double>(named++) + 0.5));
  }
}

double height_of(const Plot& plot) {
  const auto names =
      std::count_if(plot.series.begin(), plot.series.end(), [](const Series& series) { return !series.name.empty(); });
  return kHeight + kLegendRow * static_cast<double>(names);
}

// Whether one legend serves all plots, so that it need not be repeated.
bool same_legend(const std::vector<Plot>& plots) {
  const auto alike = [](const Series& a, const Series& b) {
    return a.name == b.name && a.kind == b.kind && a.dashed == b.dashed && !a.name.empty();
  };
  const std::vector<Series>& first = plots.front().series;
  return plots.size() > 1 && std::all_of(plots.begin(), plots.end(), [&](const Plot& plot) {
           return std::equal(first.begin(), first.end(), plot.series.begin(), plot.series.end(), alike);
         });
}

// The legend of all plots, in as many rows as its names need; returns its height.
double draw_common_legend(std::ostream& out, const Plot& plot, double top, double width) {
  constexpr double kSample = 33, kBetween = 24;  // a line's sample, and the space between two names
  const std::vector<Look> looks = looks_of(plot);
  double left = kRight, row = top + kLegendRow;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const double taken = kSample + kLetter * static_cast<double>(letters(plot.series[i].name)) + kBetween;
    if (left > kRight && left + taken > width) left = kRight, row += kLegendRow;
    draw_legend(out, plot.series[i], looks[i], left, row);
    left += taken;
  }
  return row + 0.6 * kLegendRow - top;
}

}  // namespace

std::string to_svg(const std::vector<Plot>& plots, int columns) {
  const int count = static_cast<int>(plots.size()), max_in_row = std::min(columns, count);
  const bool common = count > 0 && same_legend(plots);
  std::ostringstream drawn;
  double top = 0;
  for (int first = 0; first < count; first += max_in_row) {
    const int in_row = std::min(max_in_row, count - first);
    const double width = kWidth * max_in_row / in_row;
    double height = 0;
    for (int i = first; i < first + in_row; ++i) {
      const Plot& plot = plots[static_cast<std::size_t>(i)];
      height = std::max(height, common ? kHeight : height_of(plot));
      drawn << "<g transform=\"translate(" << width * (i - first) << " " << top << ")\">\n";
      draw(drawn, plot, width, !common);
      drawn << "</g>\n";
    }
    top += height;
  }
  if (common) top += draw_common_legend(drawn, plots.front(), top, kWidth * max_in_row);
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kWidth * max_in_row << "\" height=\"" << top
      << "\" viewBox=\"0 0 " << kWidth * max_in_row << ' ' << top
      << "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      << drawn.str() << "</svg>\n";
  return out.str();
}

void write_svg(const std::filesystem::path& file, const std::vector<Plot>& plots, int columns) {
  std::ofstream out(file);
  out << to_svg(plots, columns);
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace orchard::plot
