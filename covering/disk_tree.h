#pragma once
#include <span>
#include <vector>

#include "triangle_plane.h"

namespace orchard::detail {

// A tree of boxes over disks (dissertation, Appendix B: compare only shapes whose bounding rectangles meet). Disks of
// radius <= 0 are left out. O(n log n) to build.
class DiskTree {
 public:
  explicit DiskTree(std::span<const Disk> disks);
  // The disks whose box meets `box`, ascending; `out` is cleared first.
  void meeting(const Eigen::AlignedBox2d& box, std::vector<Index>& out) const;

 private:
  struct Node {
    Eigen::AlignedBox2d box;
    Index begin, end;  // into order_
    Index after;       // the next node that is not below this one; the left child follows its parent
    bool leaf = false;
  };
  void build(Index begin, Index end);

  std::vector<Eigen::AlignedBox2d> boxes_;  // of all disks
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

Eigen::AlignedBox2d box_of(const Disk& disk);

}  // namespace orchard::detail
