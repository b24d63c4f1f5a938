#pragma once
#include "blocks.h"
#include "panels.h"

namespace orchard::detail {

// Draws where a medial axis is worst, from the blocks of draw_medial_errors(), which must exist.
Panels error_panels(const Blocks& blocks, double line_width);

}  // namespace orchard::detail
