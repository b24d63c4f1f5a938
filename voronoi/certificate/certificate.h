#pragma once
#include <functional>

#include "certificate/mend.h"
#include "workspace/workspace.h"

namespace orchard::detail {

// What the examination of a whole diagram proves about it.
struct Certificate {
  bool holds = false;
  // Over the bounding radius: no point lies deeper in a vertex's sphere or farther beyond the hull.
  double intrusion = 0;
  std::size_t suspects = 0;  // vertices that had to be compared with all points one by one
};

// Delaunay's lemma, with a margin: if all vertices are oriented positively, the hull is convex, and the sphere of no
// vertex holds the point that a neighbour has instead of a shared one, no sphere holds any point. For from a vertex v
// towards a point q, across one facet after the other, the power of q with respect to the spheres only grows, up to
// that of a sphere with q on it, 0. Here a facet may take something off: if the spheres on its two sides contradict
// each other by a rounding, the power of q may shrink by some 2 r d there, r being the radius of v's sphere, and q is
// then up to d deep in it. The certificate bounds d for every facet and adds these bounds up over all facets, more than
// any straight line meets. With exact signs, nothing is taken off anywhere. Likewise for the planes of the hull's
// facets.
//
// It holds if no facet takes off more than a 64th of tolerance::kVoronoiIntrusion, and all of them together no more
// than it, or, for more than 512 points, than a 512th of it for each point: rounding is to be told from what is wrong,
// and a line meets few of many facets; where the sum is more, only those count that one line can meet (see LineSum).
// What is proven is `intrusion`. Where a facet takes off more than its share of that, exact arithmetic may show that it
// takes off nothing.
//
// At edges of the hull that are so short, or facets so thin, that a bound from next to them, carried across all points,
// says nothing, the planes and spheres on both sides are held against all points one by one.
//
// That no two tetrahedra lie on top of each other follows from their orientation, if a point is below all facets of the
// hull and a ray from there meets one of them. For then these fill the solid angle of a sphere once, and as often the
// tetrahedra cover the point. So what is inside is covered once, everywhere, and around an edge of the hull the
// tetrahedra turn by the angle between its two facets: whether the hull is convex there is told by these alone.
//
// All this is said of the spheres that the vertices have: each must be that of its forming points up to a quarter of
// the intrusion. Where doubles do not show that, a vertex is given its own sphere with more digits, but for one that
// has been given a neighbour's, on which its forming points are as far as the input goes (see Workspace::share_sphere).
//
// Only facets of vertices that a point from first_new on forms are looked at: the others are as they were. Doubles
// settle most of them: one distance each. O(1) a vertex, and O(n) for up to 512 of them.
// `points`: how many form vertices if none was lost.
//
// With a mender, facets that spoil it are mended, and what is new is looked at in the same way, until nothing is left;
// what was mended away still counts in the intrusion. Not with exact signs.
//
// For a large set, `report` is called now and then, from the calling thread, with the part done of the first look at
// all vertices, which is nearly all there is to do; what it throws ends the look.
Certificate certify(Workspace& workspace, std::size_t points, Index first_new = 0, Repairer* mender = nullptr,
                    const std::function<void(double)>& report = {});

// Returns the number of points that form vertices.
std::size_t count_forming(const Workspace& workspace);

}  // namespace orchard::detail
