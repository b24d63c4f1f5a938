#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// A tree of balls to cover a triangle with: children come after their parent, leaves have no children. What a leaf
// covers is its path region, the intersection of the balls from the root down to it.
struct PathBall {
  Point center;
  double radius = 0;
  Index parent = kNone;  // into the same array, lower than the own index; kNone for a root
  bool leaf = false;
};

// An arc of a ball's circle in the triangle's plane that is not certified to be covered by other path regions.
struct UncoveredArc {
  Index ball = kNone;        // whose boundary it is
  Point begin, middle, end;  // in space, on the triangle's plane
};

struct TriangleCover {
  bool covered = false;            // certified: every point of the triangle lies in some path region
  Point witness = Point::Zero();   // if not: a point that no path region is certified to hold
  std::vector<UncoveredArc> arcs;  // if not, and any circle meets the triangle
  std::vector<Index> coverers;     // if covered: leaves that are enough to certify it, ascending; few, not the fewest
};

// The boundary lemma (dissertation 5.3.3, Appendix B) for the union of path regions, made sound for closed sets: the
// triangle is covered if (i) one of its interior points lies in a path region and (ii) every circle's arc inside it
// lies, but for finitely many points, in the interior of path regions of other balls. Needed arcs are rounded outward,
// covering arcs inward, by a few roundings of the balls' and the triangle's extent, so "covered" is a proof and tangent
// balls are not covered. Any triangle, degenerate ones included. O(n log n + k) for n balls of which k pairs have boxes
// that meet.
TriangleCover cover_of_triangle(const std::array<Point, 3>& triangle, std::span<const PathBall> balls);

// The same for the part of the triangle inside the closed ball `clip`; covered if there is none. Witness and arcs lie
// in that part, up to roundings.
TriangleCover cover_of_triangle(const std::array<Point, 3>& triangle, const Sphere& clip,
                                std::span<const PathBall> balls);

// Whether cover_of_triangle() says "covered"; faster where it does not.
bool triangle_covered(const std::array<Point, 3>& triangle, std::span<const PathBall> balls);

// How far a point is outside every path region: the least growth of all balls that would put it into one; <= 0 inside,
// infinite without a leaf.
double path_distance(const Point& point, std::span<const PathBall> balls);

}  // namespace orchard
