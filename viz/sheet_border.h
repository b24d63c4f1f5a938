#pragma once
#include "actors.h"

namespace orchard::detail {

// Returns the sheets of a medial axis (the faces of write_medial_axis()) as they are drawn: without the faces that run
// into every shallow edge, whose two surface points are seen at less than `angle` (degrees); without specks, which are
// not connected to anything; and with smooth borders, because the borders of the diagram are zigzag lines as coarse as
// the point spacing.
Data drawn_sheets(vtkPolyData* faces, double angle);

}  // namespace orchard::detail
