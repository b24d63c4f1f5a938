#pragma once
#include <filesystem>

#include "render_request.h"

namespace orchard::detail {

// Whether the name is that of a line drawing: .svg or .pdf.
bool is_vector_file(const std::filesystem::path& picture);

// Draws the visible lines of a scene of view.h, panel by panel as in other pictures, with captions as text. Its pixels
// are points. Throws std::runtime_error if the file cannot be written or if the scene contains nothing that has lines.
void draw_vector_picture(const Request& request);

}  // namespace orchard::detail
