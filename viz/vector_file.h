#pragma once
#include <string>
#include <vector>

#include "palette.h"

namespace orchard::detail {

// A line through points in a line drawing.
struct VectorLine {
  Color color{};
  double width = 1;  // points
  std::vector<double> places =
      {};  // x, y of each point, in points from the upper left corner, y downward; a single point is a dot
};

// A line of text around a point.
struct VectorText {
  std::string text;     // UTF-8
  double x = 0, y = 0;  // of the middle of its baseline
  double size = 10;     // points
  bool bold = false;
};

// A picture of lines and text without a background. Lengths are in points (1/72 inch).
struct VectorPicture {
  double width = 0, height = 0;
  std::vector<VectorLine> lines = {};  // the first is drawn first
  std::vector<VectorText> texts = {};
};

// Return the picture as the text of an SVG file, and as the bytes of a PDF file of one page. Positions are rounded to
// 0.01 points. Text remains text, in Helvetica or a font that replaces it. In PDF, characters that are not in Latin-1
// become "?".
std::string to_svg(const VectorPicture& picture);
std::string to_pdf(const VectorPicture& picture);

}  // namespace orchard::detail
