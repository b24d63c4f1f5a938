#pragma once
#include "broad_phase/body_pool.h"
#include "broad_phase/quantized_grid.h"

namespace orchard::runtime::detail {

// The spheres of all bodies at one step, sorted by the cell that their centres are in, and which of them touch at that
// step: a spatial hash, for worlds in which no bound lasts for longer than a step. A cell is as wide as a sphere, so
// what touches is in the same cell or a neighbour of it. Cells far apart may share a line, as in SweptGrid, but
// neighbours along x are neighbours in memory: half of the neighbours are five runs of spheres. A few spheres that are
// larger than a cell are compared with all others.
class SortedSpheres {
 public:
  // Empties it, for so many bodies at most. spacing: of bodies, about; cells are not much smaller.
  void begin(std::size_t bodies, const Vec3& origin, double spacing);
  // At most kBlock of them, with valid motions.
  void add(std::span<const BodyIndex> bodies, std::span<const Motion> motions);
  // All pairs that touch, in any order: spheres_touch() holds. Valid until begin().
  std::span<const BodyPair> find();
  template <typename Goes>
  void drop_pairs(const Goes& goes) {  // as if they did not touch
    std::erase_if(pairs_, goes);
  }
  std::span<const BodyPair> pairs() const noexcept { return pairs_; }

  bool suits() const noexcept;  // after find(); false: too many bodies are in too few cells
  // Appends the bodies whose spheres may meet the box, and others, unless it has more cells than there are bodies:
  // false then.
  bool append_near(const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const;
  void release();  // its memory, too
  std::size_t memory_bytes() const noexcept;

 private:
  using Cell = std::array<std::uint32_t, 3>;
  struct Sphere {
    Vec3 center;
    double radius;
    BodyIndex body;
    std::uint32_t line;
  };
  struct Run {
    std::uint32_t begin, end;
  };

  std::uint32_t coordinate(double x, std::size_t axis) const noexcept;
  std::uint32_t line_of(const Vec3& center) const noexcept;
  void enter(Sphere& sphere);
  void choose_cell();
  void sort();
  std::array<std::uint32_t, 4> neighbour_rows() const noexcept;
  template <typename Kind>
  void find_all();
  template <typename Kind>
  void compare(std::uint32_t i, Run run);
  void compare_large();

  Vec3 origin_{};
  double cell_ = 0, per_length_ = 0, spacing_ = 0;  // cell_ lasts from step to step
  std::uint32_t mask_ = 0;
  std::array<std::uint32_t, 3> factors_{};
  std::vector<Sphere> spheres_;        // as they came
  std::vector<std::uint32_t> begins_;  // by line, and two more: the first two follow the last one again
  struct Columns {                     // the spheres in order, and room for a vector more
    std::vector<double> x, y, z, radius;
    std::vector<BodyIndex> body;
  };
  Columns sorted_;
  std::vector<std::uint32_t> large_;  // in spheres_
  std::vector<BodyPair> pairs_;
  std::uint64_t tests_ = 0;
};

}  // namespace orchard::runtime::detail
