#pragma once
#include "actors.h"

namespace orchard::detail {

// The sheets of a medial axis (the faces of write_medial_axis()) as they are drawn: without the faces that run into
// every shallow edge, whose two surface points are seen at less than `angle` (degrees); without specks, which hang
// together with nothing; and with their borders drawn straight, which as the diagram has them are rows of teeth as long
// as points are apart.
Data drawn_sheets(vtkPolyData* faces, double angle);

}  // namespace orchard::detail
