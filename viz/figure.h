#pragma once
#include <array>
#include <optional>
#include <string>

namespace orchard::detail {

// What is asked of the picture of a scene (Figure in view.h).
struct FigureOptions {
  std::string color = {};                           // an array; empty: each thing in its own colours
  std::string bar_title = {};                       // beside the bar of its colours; empty: the array's name
  std::string map = "viridis";                      // of kColorMaps
  std::optional<std::array<double, 2>> range = {};  // of its values; nothing: of all that are finite
  std::optional<std::array<double, 4>> clip = {};   // a, b, c, d: what has a x + b y + c z > d is cut away
  std::optional<std::array<double, 6>> room = {};   // two corners of a box that must fit in, beside what is there
  bool edges = false, balls = false, beside = false;
};

}  // namespace orchard::detail
