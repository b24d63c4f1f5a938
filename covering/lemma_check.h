#pragma once
#include <span>
#include <vector>

#include "disk_grid.h"
#include "orchard/covering/boundary_lemma.h"
#include "triangle_plane.h"

namespace orchard::detail {

// Whether a ball certainly holds a triangle: since balls are convex, it is enough to test the corners, with a margin
// for rounding.
bool surely_holds(const PathBall& ball, const std::array<Point, 3>& triangle);

// What the check of a triangle computes for one ball: lines 4 and 5 of the dissertation's Figure 5.17. It does not
// depend on other balls, so it can be kept while those change (5.3.3).
struct CircleInPlane {
  Disk disk;
  CircleIntervals needed;  // of its circle, inside the region; once `clipped`
  bool clipped = false;
};

// The lists that a check works in. They are kept from one triangle to the next to save allocations.
struct LemmaScratch {
  std::vector<CircleInPlane> circles;  // where the caller keeps none
  std::vector<CircleInPlane*> pointers;
  std::vector<char> sound, holds, inside;
  std::vector<char> useful;  // the disk and all above it are certain to be disks, and a leaf hangs on it
  std::vector<char> rests_on;
  std::vector<Index> all, near;
  std::vector<Disk> disks;
  DiskGrid grid;  // of disks
  CircleIntervals needed;
  std::vector<CircleIntervals> covering;  // of the present circle, by each ball's path region
  std::vector<Index> made_for;            // the circle that covering[i] was made for

  static LemmaScratch& of_this_thread();
};

// The boundary lemma for one triangle. `circles` are the intersections of `balls` with its plane; parts that are
// missing are computed. A thread may run only one check at a time, because all its checks share one scratch.
class LemmaCheck {
 public:
  enum class Want { all_arcs, answer };  // answer: stop at the first arc that is not covered
  LemmaCheck(const TrianglePlane& plane, std::span<const PathBall> balls, std::span<CircleInPlane* const> circles,
             Want want);
  TriangleCover run();

 private:
  bool find_useful(TriangleCover& result);
  void check_named_point(TriangleCover& result);
  bool check_circle(Index ball);
  void subtract_covered(Index ball);
  void report_arcs(Index ball, TriangleCover& result) const;
  std::span<const Index> candidates(Index ball);
  const Disk& disk(Index ball) const { return circles_[ball]->disk; }

  const TrianglePlane& plane_;
  std::span<const PathBall> balls_;
  std::span<CircleInPlane* const> circles_;
  Want want_;
  LemmaScratch& own_;
  bool uses_grid_ = false;  // where there are many
};

}  // namespace orchard::detail
