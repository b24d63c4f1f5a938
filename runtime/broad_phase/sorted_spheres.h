#pragma once
#include "broad_phase/body_pool.h"
#include "broad_phase/quantized_grid.h"

namespace orchard::runtime::detail {

// A spatial hash of the spheres of all bodies at one step, which finds those that touch. It is for worlds in which no
// bound lasts longer than a step. The spheres are sorted by the cell of their centre. A cell is as wide as a sphere, so
// spheres that touch are in the same cell or in neighbouring ones. Cells that are far apart may share a line, as in
// SweptGrid, but neighbours along x are neighbours in memory: half of the neighbours of a cell are five runs of
// spheres. A few spheres that are larger than a cell are compared with all others.
class SortedSpheres {
 public:
  // Removes all spheres, and makes room for at most `bodies`. `spacing` is the approximate distance of neighbouring
  // bodies; cells are not much smaller.
  void begin(std::size_t bodies, const Vec3& origin, double spacing);
  // Adds the spheres of at most kBlock bodies, with valid motions.
  void add(std::span<const BodyIndex> bodies, std::span<const Motion> motions);
  // Finds and returns all pairs for which spheres_touch() holds, in any order. They are valid until begin().
  std::span<const BodyPair> find();
  template <typename Goes>
  void drop_pairs(const Goes& goes) {  // removes the pairs for which goes(pair) is true
    std::erase_if(pairs_, goes);
  }
  std::span<const BodyPair> pairs() const noexcept { return pairs_; }

  bool suits() const noexcept;  // after find(): false if too many bodies are in too few cells
  // Appends the bodies whose spheres may meet the box, and perhaps others. Returns false and appends none if the box
  // has more cells than there are bodies.
  bool append_near(const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const;
  void release();  // gives the memory back
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
  double cell_ = 0, per_length_ = 0, spacing_ = 0;  // cell_, the width of a cell, is kept from step to step
  std::uint32_t mask_ = 0;
  std::array<std::uint32_t, 3> factors_{};
  std::vector<Sphere> spheres_;        // in the order of add()
  std::vector<std::uint32_t> begins_;  // by line; the first two lines follow once more after the last one
  struct Columns {                     // the spheres in sorted order, with room for another vector at the end
    std::vector<double> x, y, z, radius;
    std::vector<BodyIndex> body;
  };
  Columns sorted_;
  std::vector<std::uint32_t> large_;  // the indices in spheres_ of those that are larger than a cell
  std::vector<BodyPair> pairs_;
  std::uint64_t tests_ = 0;
};

}  // namespace orchard::runtime::detail
