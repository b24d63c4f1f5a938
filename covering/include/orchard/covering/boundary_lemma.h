#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// Hubbard's boundary lemma: a certified test whether balls cover a triangle.
namespace orchard {

// A ball in a tree of balls that may cover a triangle. Children come after their parent, and leaves have no children. A
// leaf covers its path region, which is the intersection of the balls from the root to the leaf.
struct PathBall {
  Point center;
  double radius = 0;
  Index parent = kNone;  // A lower index into the same array; kNone for a root.
  bool leaf = false;
};

// An arc of a ball's circle in the plane of the triangle that is not certified to be covered by other path regions.
struct UncoveredArc {
  Index ball = kNone;        // The ball with this arc on its boundary.
  Point begin, middle, end;  // Points in space, on the plane of the triangle.
};

// The result of cover_of_triangle().
struct TriangleCover {
  bool covered = false;            // Certified: every point of the triangle lies in some path region.
  Point witness = Point::Zero();   // If not covered: a point that no path region is certified to contain.
  std::vector<UncoveredArc> arcs;  // If not covered, and if a circle meets the triangle.
  // If covered: leaves that suffice to certify it, ascending. They are few but not always the fewest.
  std::vector<Index> coverers;
};

// Decides whether path regions cover a triangle, by the boundary lemma made sound for closed sets. The triangle is
// covered if (i) one of its interior points lies in a path region and (ii) every circle's arc inside it lies, except
// for finitely many points, in the interior of path regions of other balls.
// Arcs that have to be covered are rounded outward, and arcs that cover them inward, by more than the rounding errors
// of lengths as large as the balls and the triangle. So "covered" is a proof, and balls that are merely tangent to each
// other do not cover. The triangle may be degenerate. O(n log n + k) for n balls of which k pairs have boxes that meet.
// Source: dissertation 5.3.3, Appendix B.
TriangleCover cover_of_triangle(const std::array<Point, 3>& triangle, std::span<const PathBall> balls);

// Decides the same for the part of the triangle inside the closed ball `clip`; an empty part is covered. Witness and
// arcs lie in that part, up to roundings.
TriangleCover cover_of_triangle(const std::array<Point, 3>& triangle, const Sphere& clip,
                                std::span<const PathBall> balls);

// Returns whether cover_of_triangle() certifies the cover. It is faster than that function for triangles that are not
// certified, because it stops at the first gap.
bool triangle_covered(const std::array<Point, 3>& triangle, std::span<const PathBall> balls);

// Returns how far a point is outside every path region: the smallest length by which all balls would have to grow so
// that a path region contains it. The value is at most 0 if a path region contains it already, and infinite if there is
// no leaf.
double path_distance(const Point& point, std::span<const PathBall> balls);

}  // namespace orchard
