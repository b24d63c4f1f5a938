#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The triangles of a mesh with their areas and the lengths of the edges that they share.
class PatchMesh {
 public:
  explicit PatchMesh(const TriangleMesh& mesh);

  const std::vector<double>& areas() const { return areas_; }

  // Gives each triangle the label with which it shares more of its border than with its own, `rounds` times at most.
  // Triangles are visited in their order.
  void smooth(std::vector<Index>& labels, int rounds) const;
  // Gives connected patches below `min_area` the label with which they share most of their border.
  void join_small(std::vector<Index>& labels, double min_area) const;
  // Returns the patch of each triangle, numbered by their first triangles. Patches are triangles of one label that are
  // joined across edges.
  std::vector<Index> patches(const std::vector<Index>& labels, Index& count) const;

 private:
  struct Side {
    Index triangle = kNone;  // on the other side; kNone at a border
    double length = 0;
  };
  std::vector<std::array<Side, 3>> sides_;
  std::vector<double> areas_;
};

}  // namespace orchard::detail
