#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Charts as the text of an SVG file.
namespace orchard::plot {

// Values that are not finite, or not positive on a logarithmic axis, leave a gap.
struct Series {
  enum class Kind { points, line, bars };  // bars: x are their left edges, all as wide as the first two are apart
  std::string name;                        // for the legend; empty: none
  std::vector<double> x, y;
  Kind kind = Kind::points;
  bool dashed = false;                // of a line: for what others are compared with; its marks are hollow
  std::optional<std::size_t> look{};  // which colour, dashes and mark, for the same in all pictures; else by its place
  std::vector<std::string> labels{};  // of a line: what is written beside its first marks; empty: nothing
};

struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  bool log_y_if_wide = false;  // so if no value is 0 or below, and the largest is many times the smallest
  std::vector<Series> series;
  std::vector<double> levels;        // y of dashed horizontal lines
  std::vector<std::string> x_names;  // not empty: x counts these
};

// The plots side by side, `columns` in a row; where the last row has fewer, they are wider.
std::string to_svg(const std::vector<Plot>& plots, int columns = 1);

// Throws std::runtime_error if the file cannot be written.
void write_svg(const std::filesystem::path& file, const std::vector<Plot>& plots, int columns = 1);

}  // namespace orchard::plot
