#pragma once
#include "blocks.h"
#include "panels.h"

namespace orchard::detail {

// Where a medial axis is bad, from the blocks of draw_medial_errors(), which must be there.
Panels error_panels(const Blocks& blocks, double line_width);

}  // namespace orchard::detail
