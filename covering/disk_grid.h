#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "triangle_plane.h"

namespace orchard::detail {

// A grid over disks (dissertation, Appendix B: compare only shapes whose bounding rectangles meet). Made for one
// triangle after the other: it keeps the room that its lists have.
class DiskGrid {
 public:
  // Disks of radius <= 0 are left out. Only what lies in `box`, or next to nothing outside, will be asked for. O(n).
  void build(std::span<const Disk> disks, const Eigen::AlignedBox2d& box);
  // The disks whose rectangles meet the disk's inside the box, ascending, and perhaps some that nearly do; `out` is
  // cleared first.
  void meeting(const Disk& disk, std::vector<Index>& out);

 private:
  struct Rectangle {
    double left, right, bottom, top;
    bool meets(const Rectangle& other) const {  // without branches: few of those near do
      return (left <= other.right) & (other.left <= right) & (bottom <= other.top) & (other.bottom <= top);
    }
  };
  struct Cells {
    std::size_t left, right, bottom, top;  // all of them inclusive
    std::size_t count() const { return (right - left + 1) * (top - bottom + 1); }
  };
  static Rectangle around(const Disk& disk);
  void lay_out(const Eigen::AlignedBox2d& box, std::size_t count);
  Cells cells_of(const Rectangle& rectangle) const;
  bool is_everywhere(const Cells& cells) const { return 2 * cells.count() > columns_ * rows_; }
  void mark(Index disk) { marks_[disk / 64] |= std::uint64_t{1} << disk % 64; }

  Rectangle box_{};  // with room for roundings
  std::size_t columns_ = 1, rows_ = 1;
  double columns_per_length_ = 0, rows_per_length_ = 0;
  std::vector<Rectangle> rectangles_;      // of all disks
  std::vector<Cells> cells_;               // likewise
  std::vector<Index> begin_, in_cell_;     // of each cell, and one more, row by row, into in_cell_
  std::vector<std::uint64_t> everywhere_;  // a bit for each disk: in most cells, and so in no list
  std::vector<std::uint64_t> marks_;       // likewise, of one question
};

}  // namespace orchard::detail
