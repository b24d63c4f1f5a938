#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "orchard/viz/render.h"

// Runs orchard-render with files in a temporary folder.
namespace orchard::detail {

// Writes files, and prefix.vtm, which opens them.
using WriteScene = std::function<void(const std::filesystem::path& prefix)>;

// Draws a picture. `more` has further options of orchard-render.
PictureStatus draw(const std::filesystem::path& png, const PipelinePicture& picture,
                   const std::vector<std::string>& more, const WriteScene& write);

// Opens a window on $DISPLAY and returns when it is closed. Output of the window's program goes to this program's
// output.
PictureStatus show(const std::filesystem::path& png, const PipelinePicture& picture,
                   const std::vector<std::string>& more, const WriteScene& write);

}  // namespace orchard::detail
