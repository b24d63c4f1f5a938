#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"

namespace orchard::construction_methods {

// A sphere that touches the surface at a point from inside, and has shrunk until it holds no other point.
struct ShrunkSphere {
  Sphere sphere;
  Index anchor = kNone;  // the point that it touches
  Index stop = kNone;    // the last point that made it smaller, which lies on it; kNone: it has its first size
  int steps = 0;         // how often it became smaller
};

// Spheres that fit just inside a solid, by the points on its surface (Badler, O'Rourke and Toltzis 1979; dissertation
// 6.3.5): at each anchor a sphere of the bounding radius touches the surface from inside, and shrinks, still touching,
// at each of the points that is inside it. As the smaller sphere lies within the larger one, points need to be looked
// at once. The points alone hold it back: between them it may reach out of the solid. O(points * anchors).
std::vector<ShrunkSphere> shrunk_spheres(const Surface& surface, const SurfaceSampling& sampling,
                                         std::span<const Index> anchors);

// `count` of the points, each the farthest from those before; the first one is point 0. O(points * count).
std::vector<Index> spread_anchors(const SurfaceSampling& sampling, Index count);

}  // namespace orchard::construction_methods
