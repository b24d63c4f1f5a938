#pragma once
#include <span>
#include <string>

#include "orchard/geometry/mesh.h"

namespace orchard::apps {

// A point a line, every coordinate in the fewest digits that read back as the same double.
std::string to_xyz(std::span<const Point> points);

}  // namespace orchard::apps
