#pragma once
#include "bound.h"

namespace orchard::broad_phase_methods::detail {

// A set of ordered pairs, by open addressing.
class PairSet {
 public:
  bool insert(std::uint32_t a, std::uint32_t b);  // false if it was there
  bool contains(std::uint32_t a, std::uint32_t b) const noexcept;
  void clear() noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  std::size_t slot_of(std::uint64_t key) const noexcept;
  std::vector<std::uint64_t> slots_;  // 0: free
  std::vector<std::uint64_t> keys_;
};

// The search for the earliest contact of the pairs that do not meet at the start; shared by the methods.
struct Search {
  std::span<const SpaceTimeBound> bounds;
  double duration;
  BoundShape shape;
  PairSet& settled;  // pairs whose contact is known: those that meet at the start, those with planes
  BoundContact& earliest;
  const BoundFilter& filter;  // none: all are compared
  SearchCounts& counts;

  double limit() const noexcept { return earliest.time < duration ? earliest.time : duration; }
  double half(std::uint32_t body, double t) const noexcept {
    return shape == BoundShape::quadratic ? bounds[body].horn_radius(t) : bounds[body].trapezoid_half(t);
  }
  // The pair touches along `axis` at t: compares the squares there (4.2.3), and then the cutting planes.
  void faces_meet(std::uint32_t i, std::uint32_t j, std::size_t axis, double t);
  void settle(std::uint32_t i, std::uint32_t j);
};

// A face's projection into the plane of an axis and time: constant + slope t + bend t^2, t since the sweep's start. It
// is the upper side of `body`'s cubes or the lower one.
struct Face {
  double constant, slope, bend;
  std::uint32_t body;
  bool upper;

  double at(double t) const noexcept { return constant + t * (slope + t * bend); }
};
Face face_of(const SpaceTimeBound& bound, std::uint32_t body, std::size_t axis, bool upper, BoundShape shape) noexcept;

// Bentley and Ottmann's sweep, for curves that all span the whole interval (4.2.3).
class Sweep {
 public:
  // Looks at all crossings of the faces of one axis between begin and end, while they lie before search.limit().
  void run(Search& search, std::size_t axis, std::span<const Face> faces, double begin, double end);
  std::size_t memory_bytes() const noexcept;

 private:
  struct Crossing {
    double time;
    std::uint32_t below, above;  // before the crossing; into curves_
  };
  void expect(std::uint32_t below, std::uint32_t above);
  std::vector<Face> curves_;  // in their order at the start
  std::vector<std::uint32_t> order_, place_;
  std::vector<Crossing> queue_;
  PairSet crossed_;
  double end_ = 0;
};

// 4.2.4, and the hybrid of 8.2.
class Subdivision {
 public:
  void run(Search& search, std::uint32_t base_case, bool hybrid);
  std::size_t memory_bytes() const noexcept { return sweep_.memory_bytes(); }

 private:
  struct Cell;
  void run_axis(Search& search, std::size_t axis, std::uint32_t base_case, bool hybrid);
  void compare(Search& search, std::size_t axis, const Cell& cell, std::span<const Face> faces);
  void divide(const Search& search, std::size_t axis, const Cell& cell, std::span<const Face> faces,
              std::vector<Cell>& queue);
  Sweep sweep_;
  std::vector<Face> some_;
};

}  // namespace orchard::broad_phase_methods::detail
