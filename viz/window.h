#pragma once
#include <filesystem>
#include <string>

#include "camera.h"

namespace orchard::detail {

struct WindowRequest {
  std::filesystem::path vtm;  // a scene of view.h
  std::string png, title;     // png: where s saves to; empty: nowhere
  int width = 0, height = 0;  // pixels; 0: 1000 x 800
  Direction direction;
  int level = -1;  // to begin with; below 0: the last
  double opacity = 0.16;
};

// Until it is closed. Keys and clicks: view.h. Throws std::runtime_error if there is nothing to show.
void show_window(const WindowRequest& request);

}  // namespace orchard::detail
