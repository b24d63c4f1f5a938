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

  void take_away(BodyIndex body) noexcept { take_away({&body, 1}); }
  void take_away(std::span<const BodyIndex> bodies) noexcept;
  // Whether all of these, or one, take few enough cells for the grid.
  static bool all_fit(const BoxBlock& boxes) noexcept { return boxes.more_cells < kMaxCellsPerAxis; }
  static bool fits(const QuantizedAabb& box) noexcept;
  // Bodies' boxes, which fit, in three steps: takes note of them, and has `extent` include them; encodes which visits
  // they make to lines of the grid; and makes these, which finds the pairs whose boxes meet, of each and all before.
  // For many bodies each step may be taken by several threads, the last one by one for each part of the lines.
  using Batch = SweptGrid::Batch;
  static constexpr std::size_t kBatch = SweptGrid::kBatch;
  void note(std::span<const BodyIndex> bodies, const BoxBlock& boxes, QuantizedAabb& extent) noexcept;
  void encode(Batch& batch, std::span<const BodyIndex> bodies, const BoxBlock& boxes,
              std::size_t first) const noexcept {
    grid_.encode(batch, bodies, boxes, first);
    grid_.load(batch);
  }
  void scatter(std::span<const BodyIndex> bodies, const BoxBlock& boxes, SweptGrid::VisitsByPart& visits) const {
    grid_.scatter(bodies, boxes, boxes_, visits);
  }
  template <typename Visits>  // a Batch, or those of a part
  void insert(const Visits& visits, std::vector<BodyPair>& pairs, GridCounts& counts) {
    grid_.insert(visits, boxes_, pairs, counts);
  }
  // The same for one body, whether or not it fits, and what one thread has to do for the others: their pairs with those
  // that do not.
  void insert_one(BodyIndex body, const QuantizedAabb& box, std::vector<BodyPair>& pairs);
  void meet_oversized(std::span<const BodyIndex> bodies, std::vector<BodyPair>& pairs) const;
  void include(const QuantizedAabb& extent) noexcept { extent_.include(extent); }
  void count(const GridCounts& counts) noexcept { grid_.count(counts); }
  bool in_order() const noexcept { return in_order_; }
  void empty_part(std::size_t part) noexcept { grid_.empty_part(part); }
  void all_parts_emptied() noexcept { in_order_ = true; }
  static constexpr QuantizedAabb nothing() noexcept { return kNothing; }

  const GridCounts& counts() const noexcept { return grid_.counts(); }
  void begin_counts() noexcept { grid_.take_counts(); }
  void discount_pairs(std::size_t pairs) noexcept { grid_.discount_pairs(pairs); }

  // As in BroadPhaseAlgorithm.
  Near near_box(Step now, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const;
  bool along(Step now, const Vec3& origin, const Vec3& way, double length, std::vector<BodyIndex>& portion,
             PortionVisitor& visitor) const;
  std::size_t memory_bytes() const noexcept { return bytes_of(places_, boxes_, oversized_) + grid_.memory_bytes(); }

 private:
  enum class Place : std::uint8_t { nowhere, inside, oversized };
  static constexpr QuantizedAabb kNothing = {{kLastQuantum, kLastQuantum, kLastQuantum}, {0, 0, 0}};

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
  std::vector<Oversized> oversized_;
  bool in_order_ = true;
  SweptGrid grid_;
  QuantizedAabb extent_ = kNothing;  // around all boxes that are in the grid, or have been since it was rebuilt
  QuantizedGrid quantized_grid_;
  double time_step_ = 0;
  Step lattice_from_ = 0;  // at which it was made
};

}  // namespace orchard::runtime::detail
