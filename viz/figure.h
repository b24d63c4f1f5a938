#pragma once
#include <array>
#include <optional>
#include <string>

namespace orchard::detail {

// The options of a picture of a scene (Figure in view.h).
struct FigureOptions {
  std::string color = {};                           // an array; empty for a colour of its own for each part
  std::string bar_title = {};                       // the title of the colour bar; empty for the name of the array
  std::string map = "viridis";                      // of kColorMaps
  std::optional<std::array<double, 2>> range = {};  // of the array's values; nullopt for all finite ones
  std::optional<std::array<double, 4>> clip = {};   // a, b, c, d: the part with a x + b y + c z > d is cut away
  std::optional<std::array<double, 6>> room = {};   // two corners of a box that has to be in view, too
  bool edges = false, balls = false, beside = false;
};

}  // namespace orchard::detail
