#pragma once
#include "orchard/geometry/text_lines.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// The reader behind read_ma() and read_flagged_ma(), on any text. Time and memory grow with the text (n log n).
FlaggedMedialMesh parse_ma(TextLines lines);

}  // namespace orchard::detail
