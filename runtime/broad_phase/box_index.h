#pragma once
#include "broad_phase/broad_phase_algorithm.h"
#include "broad_phase/swept_grid.h"

namespace orchard::runtime::detail {

// The boxes of all bodies, where other boxes and queries find them. The box of a body contains all that its motion
// bound allows until its window ends. Boxes are in the grid, except those that are as large as several cells
// ("oversized"), which are in a list.
class BoxIndex {
 public:
  void make_room(std::size_t slots) { grow(places_, slots); }
  void make_room_for_boxes(std::size_t slots) { grow(boxes_, slots); }
  const void* at(BodyIndex body) const noexcept { return &places_[body]; }  // for prefetching

  // Removes all boxes, and makes room for `slots` bodies and a grid of `lines` lines. If `lines` is 0, it can have no
  // boxes until it is rebuilt again.
  void rebuild(std::size_t slots, std::size_t lines, const Executor& executor);
  void take_away(BodyIndex body) noexcept { take_away({&body, 1}); }
  void take_away(std::span<const BodyIndex> bodies) noexcept;
  // Stores the boxes of bodies, which fit the grid, and extends `extent` by them. The caller then has to insert them
  // into lines(), with packed() as the boxes, to pass the extent to include(), and to call meet_oversized().
  void note(std::span<const BodyIndex> bodies, const BoxBlock& boxes, QuantizedAabb& extent) noexcept;
  SweptGrid& lines() noexcept { return grid_; }
  std::span<const PackedAabb> packed() const noexcept { return boxes_; }
  void include(const QuantizedAabb& extent) noexcept { extent_.include(extent); }
  // Appends the pairs of these bodies, which are in the grid, with the oversized boxes that they meet.
  void meet_oversized(std::span<const BodyIndex> bodies, std::vector<BodyPair>& pairs) const;
  // Does all of that for one body, whether its box fits the grid or not, and appends its pairs.
  void insert_one(BodyIndex body, const QuantizedAabb& box, SweptGrid::Visits& room, std::vector<BodyPair>& pairs,
                  GridCounts& counts);

  // These are the queries of BroadPhaseAlgorithm. `grid` is the quantized grid of the step.
  Near near_box(const QuantizedGrid& grid, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const;
  bool along(const QuantizedGrid& grid, const Vec3& origin, const Vec3& way, double length,
             std::vector<BodyIndex>& portion, const VisitPortion& visit) const;
  std::size_t memory_bytes() const noexcept { return bytes_of(places_, boxes_, oversized_) + grid_.memory_bytes(); }

 private:
  enum class Place : std::uint8_t { nowhere, inside, oversized };
  struct GridRay;
  void append_in_cells(const QuantizedAabb& box, std::vector<BodyIndex>& bodies) const;
  bool walk_slabs(const QuantizedGrid& grid, const GridRay& ray, std::vector<BodyIndex>& portion,
                  const VisitPortion& visit) const;
  std::size_t fewest_cells() const noexcept;  // if a query would read more cells than this, it reads all boxes instead

  std::vector<Place> places_;      // by body
  std::vector<PackedAabb> boxes_;  // by body; set for those in the grid
  struct Oversized {
    BodyIndex body;
    QuantizedAabb box;
  };
  std::vector<Oversized> oversized_;
  SweptGrid grid_;
  QuantizedAabb extent_ = kNoBox;  // contains all boxes that have been in the grid since it was rebuilt
};

}  // namespace orchard::runtime::detail
