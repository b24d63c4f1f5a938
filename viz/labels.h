#pragma once
#include <vtkRenderer.h>

#include <vector>

#include "camera.h"
#include "panels.h"

namespace orchard::detail {

// A panel in pixels; labels are above its lowest `below`, in print of the size `print`.
struct LabelRoom {
  int width, height, below;
  double print;
};

// Adds the labels whose places face this eye rather than the opposite one. Each is a word next to its place, with a dot
// on the place and a line between both. No word covers another one.
void add_labels(vtkRenderer* renderer, const std::vector<Label>& labels, const View& view, const View& other,
                const LabelRoom& room);

}  // namespace orchard::detail
