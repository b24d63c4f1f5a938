#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "triangle_plane.h"

namespace orchard::detail {

// A grid over disks (dissertation, Appendix B: compare only shapes whose bounding rectangles meet). It is rebuilt for
// one triangle after another, and keeps the memory of its lists.
class DiskGrid {
 public:
  // Disks of radius <= 0 are left out. Queries are limited to `box`, plus rounding errors. O(n).
  void build(std::span<const Disk> disks, const Eigen::AlignedBox2d& box);
  // Finds the disks whose rectangles meet that of the disk inside the box, ascending, and possibly some that nearly do.
  // Clears `out` first.
  void meeting(const Disk& disk, std::vector<Index>& out);

 private:
  struct Rectangle {
    double left, right, bottom, top;
    bool meets(const Rectangle& other) const {  // without branches: few of those near do
      return (left <= other.right) & (other.left <= right) & (bottom <= other.top) & (other.bottom <= top);
    }
  };
  struct Cells {
    std::size_t left, right, bottom, top;  // the last rows and columns are included
    std::size_t count() const { return (right - left + 1) * (top - bottom + 1); }
  };
  static Rectangle around(const Disk& disk);
  void lay_out(const Eigen::AlignedBox2d& box, std::size_t count);
  Cells cells_of(const Rectangle& rectangle) const;
  bool is_everywhere(const Cells& cells) const { return 2 * cells.count() > columns_ * rows_; }
  void mark(Index disk) { marks_[disk / 64] |= std::uint64_t{1} << disk % 64; }

  Rectangle box_{};  // enlarged by a margin for rounding errors
  std::size_t columns_ = 1, rows_ = 1;
  double columns_per_length_ = 0, rows_per_length_ = 0;
  std::vector<Rectangle> rectangles_;  // of all disks
  std::vector<Cells> cells_;           // likewise
  // In_cell_ has the disks of each cell, row by row; begin_ has where the list of each cell starts, and the end of the
  // last.
  std::vector<Index> begin_, in_cell_;
  std::vector<std::uint64_t> everywhere_;  // a bit for each disk that is in most cells and therefore in no list
  std::vector<std::uint64_t> marks_;       // the same bits for a single query
};

}  // namespace orchard::detail
