#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera.h"
#include "figure.h"

namespace orchard::detail {

// The options of orchard-render.
struct Request {
  std::filesystem::path vtm;
  std::string png, title;
  int width = 0, height = 0;  // in pixels; 0 to choose it by the contents
  Direction direction;
  bool window = false;
  int level = -1;         // the first level that the window shows
  double opacity = 0.16;  // of meshes next to other things
  bool whole = false;     // for Voronoi cells that are cut by their box
  FigureOptions figure;
  std::optional<std::array<double, 3>> look_at;
  double span = 0;  // the extent of the view around it; 0 for everything
  bool captions = true, transparent = false, steady = false;
};

// Throws std::logic_error if an argument is invalid.
Request parse_request(const std::vector<std::string>& arguments);
const char* usage();

}  // namespace orchard::detail
