#pragma once
#include <filesystem>
#include <string>

#include "camera.h"

namespace orchard::detail {

struct WindowRequest {
  std::filesystem::path vtm;  // a scene of view.h
  std::string png, title;     // png is where the key s saves a picture to; empty for nowhere
  int width = 0, height = 0;  // in pixels; 0 for 1000 x 800
  Direction direction;
  int level = -1;  // the first level shown; below 0 for the last
  double opacity = 0.16;
};

// Shows a window and returns when it is closed. For keys and clicks, see view.h. Throws std::runtime_error if there is
// nothing to show.
void show_window(const WindowRequest& request);

}  // namespace orchard::detail
