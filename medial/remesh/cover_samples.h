#pragma once
#include <span>
#include <vector>

#include "sheet_mesh.h"

namespace orchard::detail {

// Places of the surface, each with the cell of a mesh whose balls are nearest to it. They show whether a change of some
// cells leaves uncovered what these cells covered. The same places are checked each time, so that losses add up.
class CoverSamples {
 public:
  // `limit` (mesh units) is the distance that a place may have from the balls; a place that is farther at the beginning
  // may stay that far. O(n log n).
  CoverSamples(const SheetMesh& mesh, std::span<const Point> places, double limit);

  // Whether the places of the `old` cells, which may be gone, stay covered by the cells `made`, which have to be in the
  // mesh, or by others at the vertices `touched`. If so, settle() records which of them cover which places.
  bool stay_covered(const SheetMesh& mesh, std::span<const Index> old, std::span<const Index> made,
                    std::span<const Index> touched);
  void settle();

  // Returns how far a place was from the balls when it was last measured, in mesh units.
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
