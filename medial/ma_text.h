#pragma once
#include "orchard/geometry/text_lines.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// Parses the text of a .ma file for read_ma() and read_flagged_ma(). Time and memory are O(n log n) in the size of the
// text.
FlaggedMedialMesh parse_ma(TextLines lines);

}  // namespace orchard::detail
