#pragma once
#include "broad_phase/broad_phase_algorithm.h"
#include "broad_phase/swept_grid.h"

namespace orchard::runtime::detail {

// The boxes around all that bodies' bounds allow until their windows end, where other boxes and queries find them: in
// the grid, or by themselves where they are larger than several cells.
class BoxIndex {
 public:
  void make_room(std::size_t slots) { grow(places_, slots); }
  void make_room_for_boxes(std::size_t slots) { grow(boxes_, slots); }
  const void* at(BodyIndex body) const noexcept { return &places_[body]; }  // to load it ahead

  // Empties it, and makes it for so many slots, or lines; `lines` 0: for none, until it is rebuilt.
  void rebuild(std::size_t slots, std::size_t lines, const Executor& executor);
  void take_away(BodyIndex body) noexcept { take_away({&body, 1}); }
  void take_away(std::span<const BodyIndex> bodies) noexcept;
  // Takes note of bodies' boxes, which fit, and has `extent` include them. What remains is to put them into lines(),
  // with packed(), to include the extent, and meet_oversized().
  void note(std::span<const BodyIndex> bodies, const BoxBlock& boxes, QuantizedAabb& extent) noexcept;
  SweptGrid& lines() noexcept { return grid_; }
  std::span<const PackedAabb> packed() const noexcept { return boxes_; }
  void include(const QuantizedAabb& extent) noexcept { extent_.include(extent); }
  void meet_oversized(std::span<const BodyIndex> bodies, std::vector<BodyPair>& pairs) const;
  // All of that for one body, whether or not its box fits.
  void insert_one(BodyIndex body, const QuantizedAabb& box, SweptGrid::Visits& room, std::vector<BodyPair>& pairs,
                  GridCounts& counts);

  // As in BroadPhaseAlgorithm, with the quantized grid of the step.
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
  std::size_t fewest_cells() const noexcept;  // that are worth reading rather than all boxes

  std::vector<Place> places_;      // by body
  std::vector<PackedAabb> boxes_;  // of those in the grid
  struct Oversized {
    BodyIndex body;
    QuantizedAabb box;
  };
  std::vector<Oversized> oversized_;
  SweptGrid grid_;
  QuantizedAabb extent_ = kNoBox;  // around all boxes that are in the grid, or have been since it was rebuilt
};

}  // namespace orchard::runtime::detail
