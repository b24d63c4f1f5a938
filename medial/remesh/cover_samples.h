#pragma once
#include <span>
#include <vector>

#include "sheet_mesh.h"

namespace orchard::detail {

// Places of the surface and, of each, the cell of a mesh whose balls are nearest to it: what says, of a change to some
// cells, whether what they cover stays covered. Losses add up, for the same places are asked each time.
class CoverSamples {
 public:
  // `limit` (mesh units): how far from the balls a place may be, or as far as it is before. O(n log n).
  CoverSamples(const SheetMesh& mesh, std::span<const Point> places, double limit);

  // Whether the places of `old` cells, which may be gone, stay covered by `made` ones, which are in the mesh, or by
  // others at `touched` vertices. If so, settle() takes over which of them cover what.
  bool stay_covered(const SheetMesh& mesh, std::span<const Index> old, std::span<const Index> made,
                    std::span<const Index> touched);
  void settle();

  // How far a place was from the balls when it was last asked, mesh units.
  double distance(Index place) const { return distance_[place]; }
  Index size() const { return static_cast<Index>(places_.size()); }

 private:
  struct Move {
    Index place, cell;
    double distance;
  };
  void find_around(const SheetMesh& mesh, std::span<const Index> made, std::span<const Index> touched);

  std::span<const Point> places_;
  const double limit_;
  std::vector<double> distance_;
  std::vector<std::vector<Index>> places_of_;  // of each cell
  std::vector<Move> moves_;
  std::vector<Index> old_, around_;
};

}  // namespace orchard::detail
