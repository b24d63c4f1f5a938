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

// Adds the labels whose places face this eye more than the other one: each a word beside its place, with a dot there
// and a line from the one to the other. No word covers another one.
void add_labels(vtkRenderer* renderer, const std::vector<Label>& labels, const View& view, const View& other,
                const LabelRoom& room);

}  // namespace orchard::detail
