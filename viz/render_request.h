#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera.h"
#include "figure.h"

namespace orchard::detail {

// What orchard-render is asked for.
struct Request {
  std::filesystem::path vtm;
  std::string png, title;
  int width = 0, height = 0;  // pixels; 0: chosen by what is seen
  Direction direction;
  bool window = false;
  int level = -1;         // that the window begins with
  double opacity = 0.16;  // of meshes beside other things
  bool whole = false;     // Voronoi cells, which their box cuts open
  FigureOptions figure;
  std::optional<std::array<double, 3>> look_at;
  double span = 0;  // of what is seen around it; 0: of everything
  bool captions = true, transparent = false, steady = false;
};

// Throws std::logic_error if an argument makes no sense.
Request parse_request(const std::vector<std::string>& arguments);
const char* usage();

}  // namespace orchard::detail
