#pragma once
#include <span>
#include <vector>

#include "insertion/cavity.h"
#include "insertion/patch.h"
#include "workspace/workspace.h"

namespace orchard::detail {

// Two neighbours that contradict each other: the forming point of one that the other does not share lies in the sphere
// of the other (or, at an edge of the convex hull, beyond its plane).
struct Doubt {
  Index vertex, neighbor;
};

// Mends a finished diagram where its certificate is in doubt, and changes nothing elsewhere: the point that lies in a
// neighbouring vertex's sphere is inserted again. This deletes all vertices that it forms and, connected with these,
// the vertices in whose spheres it lies deeper than is harmless. More are deleted until the point sees every facet of
// the boundary, by exact signs, and no new sphere holds the point beyond its facet. The certificate has to check the
// result.
class Repairer {
 public:
  explicit Repairer(Workspace& workspace) : workspace_(workspace), cavity_(workspace), patch_(workspace) {}

  // Mends these doubts. Returns the vertices that have to be checked again: new ones, those that got a sphere of their
  // own, and those of doubts that remain; some may be free by then. Each round allows less intrusion than the one
  // before, so that insertions do not undo each other forever.
  std::vector<Index> mend(std::span<const Doubt> doubts, int round);
  // Rebuilds these vertices (some may be free) with exact signs, together with `layers` layers of vertices around them
  // and others that have to be replaced with them (see Patch). Returns the new vertices; none if too many would be
  // replaced.
  std::vector<Index> patch(std::vector<Index> vertices, int layers = 0);
  // False after a patch would have replaced too many vertices: from then on patch() does nothing.
  bool may_patch() const { return may_patch_; }
  // The number of facets looked at so far, with repetitions: a measure of the time that mending has taken.
  std::size_t work() const { return work_; }

 private:
  unsigned slot_of(Index v, Index neighbor) const;
  bool is_formed_by(Index v, Index point) const;
  void sharpen(Index v);
  double intrusion(Index v, const Point& q);
  bool is_in_sphere(Index v, const Point& q);
  bool insert_again(Index v, Index u);
  bool grow(Index point, const Point& q);
  bool is_facet_good(const Cavity::Facet& facet, const Point& q) const;
  bool would_invert_hull(const Cavity::Facet& facet, const Point& q) const;

  Workspace& workspace_;
  Cavity cavity_;
  Patch patch_;
  bool may_patch_ = true;
  double harmless_ = 0;
  std::size_t max_deleted_ = 0, work_ = 0;
  std::vector<Index> changed_;
};

}  // namespace orchard::detail
