#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "orchard/voronoi/diagram.h"

namespace orchard::test {

// The forming points of every vertex, those at infinity included: what two diagrams of the same points are compared by.
inline std::vector<std::array<Index, 4>> quadruples(const VoronoiDiagram& diagram) {
  std::vector<std::array<Index, 4>> all;
  for (const VoronoiVertex& vertex : diagram.vertices) {
    all.push_back(vertex.forming_points);
    std::sort(all.back().begin(), all.back().end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

inline double bounding_radius(const std::vector<Point>& points) {
  Box box;
  for (const Point& p : points) box.extend(p);
  return box.isEmpty() ? 0 : box.diagonal().norm() / 2;
}

}  // namespace orchard::test
