#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "orchard/viz/render.h"

// How orchard-render is run: with files in a folder that is gone afterwards.
namespace orchard::detail {

using WriteScene = std::function<void(const std::filesystem::path& prefix)>;  // files, and prefix.vtm to open them

// A picture; `more`: further options of orchard-render.
PictureStatus draw(const std::filesystem::path& png, const PipelinePicture& picture,
                   const std::vector<std::string>& more, const WriteScene& write);

// A window on $DISPLAY, until it is closed. What it prints goes where this program's output goes.
PictureStatus show(const std::filesystem::path& png, const PipelinePicture& picture,
                   const std::vector<std::string>& more, const WriteScene& write);

}  // namespace orchard::detail
