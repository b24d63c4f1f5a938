#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The triangles of a mesh with their areas and the lengths of their shared edges.
class PatchMesh {
 public:
  explicit PatchMesh(const TriangleMesh& mesh);

  const std::vector<double>& areas() const { return areas_; }

  // Gives a triangle another label if it shares more of its border with that label than with its own. Triangles are
  // visited in their order, at most `rounds` times.
  void smooth(std::vector<Index>& labels, int rounds) const;
  // Gives each connected patch below `min_area` the label with which it shares the longest border.
  void join_small(std::vector<Index>& labels, double min_area) const;
  // Returns the patch of each triangle, numbered by their first triangles. Patches are triangles of one label that are
  // joined across edges.
  std::vector<Index> patches(const std::vector<Index>& labels, Index& count) const;

 private:
  struct Side {
    Index triangle = kNone;  // the triangle on the other side; kNone at a border
    double length = 0;
  };
  std::vector<std::array<Side, 3>> sides_;
  std::vector<double> areas_;
};

}  // namespace orchard::detail
