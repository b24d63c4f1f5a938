#pragma once
#include <span>
#include <vector>

#include "insertion/cavity.h"
#include "insertion/patch.h"
#include "workspace/workspace.h"

namespace orchard::detail {

// Two neighbours whose spheres, or planes at an edge of the hull, contradict each other: the point that one has instead
// of a shared one lies in the sphere of the other, or beyond its plane.
struct Doubt {
  Index vertex, neighbor;
};

// Mends a finished diagram where its certificate is in doubt and leaves the rest alone: the point that lies in a sphere
// next to its own is inserted again. Deleted are all vertices that it forms and, connected with these, those in whose
// spheres it is deeper than does harm, until it sees all of the boundary, exactly, and no new sphere holds the point
// beyond its facet. Whether all is well then is for the certificate to say.
class Repairer {
 public:
  explicit Repairer(Workspace& workspace) : workspace_(workspace), cavity_(workspace), patch_(workspace) {}

  // The vertices that are new, those whose spheres have become their own, and those of doubts that could not be mended;
  // some may be free again. Each round is stricter than the last, lest one insertion undo another.
  std::vector<Index> mend(std::span<const Doubt> doubts, int round);
  // Rebuilds these vertices, which may be free, with exact signs, with so many layers around them, and others that
  // have to go with them (see Patch). The new ones; none where that takes too many.
  std::vector<Index> patch(std::vector<Index> vertices, int layers = 0);
  // Whether none took too many: where one did, what insertions do not mend stays in doubt.
  bool may_patch() const { return may_patch_; }
  // Facets that were looked at so far, each as often as it was: the time that mending has taken.
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
  bool is_folded(const Cavity::Facet& facet, const Point& q) const;

  Workspace& workspace_;
  Cavity cavity_;
  Patch patch_;
  bool may_patch_ = true;
  double harmless_ = 0;
  std::size_t max_deleted_ = 0, work_ = 0;
  std::vector<Index> changed_;
};

}  // namespace orchard::detail
