#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "orchard/runtime/narrow_phase.h"

// The distance between two bodies, by bounds.
namespace orchard::runtime {

class DistanceSearch;

// The distance between the surfaces of two bodies, by bounds that converge to it: lower() <= distance <= upper() always
// holds. The distance is 0 if the surfaces touch; a solid wholly inside another has a positive distance. Both bounds
// are certain for the trees' meshes: they include the trees' vertex errors and all rounding.
//
//   DistanceQuery query(a, b);
//   query.start(pose_a, pose_b, {.relative = 0.01});
//   while (!query.finished()) query.refine({.work = 1000});   // or refine() at once
//
// Preconditions, threads, determinism and allocation (none after construction) are those of NarrowPhase. Without
// triangles, or without memory for them, finished() is true at once and the bounds are those of the roots. For poses
// that NarrowPhase refuses, the bounds are 0 and infinity.
class DistanceQuery {
 public:
  // The query is finished once upper <= (1 + relative) * lower + absolute, up to rounding.
  struct Tolerance {
    double relative = 0.01;
    double absolute = 0;  // In world units.
  };

  DistanceQuery() noexcept;  // Without bodies; call bind() before start().
  // Constructs the query of a pair. The prepared trees must outlive the query or its next bind().
  DistanceQuery(const PreparedTree& a, const PreparedTree& b) noexcept : DistanceQuery() { bind(a, b); }
  // Rebinds the query to another pair, as NarrowPhase::bind() does.
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;

  void start(const Pose& a, const Pose& b, const Tolerance& tolerance) noexcept;
  void start(const Pose& a, const Pose& b) noexcept { start(a, b, Tolerance{}); }
  // Starts a query whether the surfaces are within `limit` (world units, at least 0) of each other. It is finished once
  // lower() > limit or upper() <= limit, up to rounding. The bounds are no better than that, and there may be no
  // points().
  void start_within(const Pose& a, const Pose& b, double limit) noexcept;
  void refine(const Budget& budget = {}) noexcept;

  bool finished() const noexcept;
  double lower() const noexcept;
  double upper() const noexcept;
  std::uint64_t work() const noexcept;  // Since start(), in units of a budget.

  // A point of each surface in world coordinates, at the distance upper() up to rounding. There are none before the
  // first triangles were compared.
  struct Points {
    std::array<double, 3> on_a{}, on_b{};
    std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
  };
  Points points() const noexcept;

  DistanceQuery(DistanceQuery&&) noexcept;
  DistanceQuery& operator=(DistanceQuery&&) noexcept;
  ~DistanceQuery();

 private:
  friend DistanceSearch& search_of(DistanceQuery& query) noexcept;
  const DistanceSearch& search() const noexcept;
  DistanceSearch& search() noexcept;

  // The DistanceSearch (a private header) lies here and not on the heap, so that its construction cannot fail.
  static constexpr std::size_t kSize = 832, kAlignment = 32;
  alignas(kAlignment) std::array<std::byte, kSize> storage_;
};

}  // namespace orchard::runtime
