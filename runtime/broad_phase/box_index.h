#pragma once
#include "broad_phase/broad_phase_algorithm.h"
#include "broad_phase/swept_grid.h"

namespace orchard::runtime::detail {

// The boxes around all that bodies' bounds allow until their windows end, where other boxes and queries find them: in
// the grid, or by themselves where they are larger than several cells.
class BoxIndex {
 public:
  // Boxes on their way into the grid: finish() before anything else happens to it.
  using Queue = SweptGrid::Queue;

  void make_room(std::size_t slots) { grow(places_, slots); }
  void make_room_for_boxes(std::size_t slots) { grow(boxes_, slots); }
  const void* at(BodyIndex body) const noexcept { return &places_[body]; }  // to load it ahead

  // Empties it, and makes it for so many slots, or lines. `lines` 0: for none, until it is rebuilt.
  // The grid is in order from empty() on, or once jobs have emptied each part, and nothing else happens before.
  void rebuild(std::size_t slots, std::size_t lines);
  void empty(const Executor& executor);  // nothing if it is in order
  // The quantized_grid of all boxes from now on; it moves at `velocity`.
  void set_lattice(const Vec3& origin, const Vec3& velocity, double cell_size, double slack, double time_step,
                   Step now) noexcept;
  QuantizedGrid quantized_grid_at(Step now) const noexcept;
  const Vec3& velocity() const noexcept { return quantized_grid_.velocity(); }
  bool moves() const noexcept { return quantized_grid_.moves(); }

  void take_away(BodyIndex body) noexcept;
  void take_away(std::span<const BodyIndex> bodies) noexcept;
  // Takes note of bodies' boxes, which insert() puts where they belong; false if some do not fit into the grid.
  bool note(std::span<const BodyIndex> bodies, const BoxBlock& boxes);
  bool fits(BodyIndex body) const noexcept { return places_[body] == Place::inside; }
  bool note_again(BodyIndex body, const QuantizedAabb& box);  // of one that does not fit: another box for it
  // `boxes` are those that were noted, or noted again. Appends the pairs whose boxes meet, of each and all before.
  void insert(Queue& queue, std::span<const BodyIndex> bodies, BoxBlock& boxes, std::vector<BodyPair>& pairs);
  void finish(Queue& queue, std::vector<BodyPair>& pairs);

  // The same for many, in jobs that may run at once. They go into the grid, and none but the first of these is to be
  // used meanwhile:
  // Only while none is oversized: of these the grid knows nothing.
  bool shares() const noexcept { return oversized_.empty(); }
  static bool all_fit(const BoxBlock& boxes) noexcept;
  static bool fits(const QuantizedAabb& box) noexcept;
  // takes note of boxes that fit, and has `extent` include them;
  void note_fitting(std::span<const BodyIndex> bodies, const BoxBlock& boxes, QuantizedAabb& extent) noexcept;
  void scatter(std::span<const BodyIndex> bodies, const BoxBlock& boxes, SweptGrid::VisitsByPart& visits) const {
    grid_.scatter(bodies, boxes, boxes_, visits);
  }
  bool in_order() const noexcept { return in_order_; }
  void empty_part(std::size_t part) noexcept { grid_.empty_part(part); }
  void all_parts_emptied() noexcept { in_order_ = true; }
  void insert_part(std::span<const SweptGrid::Visit> visits, std::vector<BodyPair>& pairs, GridCounts& counts) {
    grid_.insert_part(visits, boxes_, pairs, counts);
  }
  // and at the end of all jobs.
  void include(const QuantizedAabb& extent) noexcept { extent_.include(extent); }
  void count(const GridCounts& counts) noexcept { grid_.count(counts); }
  static constexpr QuantizedAabb nothing() noexcept { return kNothing; }

  const GridCounts& counts() const noexcept { return grid_.counts(); }
  void begin_counts() noexcept { grid_.take_counts(); }
  void discount_pairs(std::size_t pairs) noexcept { grid_.discount_pairs(pairs); }

  // As in BroadPhaseAlgorithm.
  Near near_box(Step now, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const;
  bool along(Step now, const Vec3& origin, const Vec3& way, double length, std::vector<BodyIndex>& portion,
             PortionVisitor& visitor) const;
  std::size_t memory_bytes() const noexcept {
    return bytes_of(places_) + bytes_of(boxes_) + bytes_of(oversized_) + bytes_of(noted_) + grid_.memory_bytes();
  }

 private:
  enum class Place : std::uint8_t { nowhere, inside, oversized };
  static constexpr QuantizedAabb kNothing = {{kLastQuantum, kLastQuantum, kLastQuantum}, {0, 0, 0}};

  void meet_oversized(std::span<const BodyIndex> bodies, std::vector<BodyPair>& pairs);
  struct GridRay;
  void append_in_cells(const QuantizedAabb& box, std::vector<BodyIndex>& bodies) const;
  bool walk_slabs(const QuantizedGrid& quantized_grid, const GridRay& ray, std::vector<BodyIndex>& portion,
                  PortionVisitor& visitor) const;
  std::size_t fewest_cells() const noexcept;  // that are worth reading rather than all boxes

  std::vector<Place> places_;      // by body
  UnsetVector<PackedAabb> boxes_;  // of those in the grid
  struct Oversized {
    BodyIndex body;
    QuantizedAabb box;
  };
  std::vector<Oversized> oversized_, noted_;  // the latter are to be inserted
  bool any_oversized_ = false;                // since it was rebuilt
  bool in_order_ = true;
  SweptGrid grid_;
  QuantizedAabb extent_ = kNothing;  // around all boxes that are in the grid, or have been since it was rebuilt
  QuantizedGrid quantized_grid_;
  double time_step_ = 0;
  Step lattice_from_ = 0;  // at which it was made
};

}  // namespace orchard::runtime::detail
