#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "orchard/runtime/narrow_phase.h"

namespace orchard::runtime {

class DistanceSearch;

// The distance between the surfaces of two bodies, by bounds that close in on it: at every moment
// lower() <= distance <= upper(). 0 if they touch; a solid wholly inside another has a positive distance.
// Both are certain for the trees' meshes: the trees' vertex errors and all rounding are in them.
//
//   DistanceQuery query(a, b);
//   query.start(pose_a, pose_b, {.relative = 0.01});
//   while (!query.finished()) query.refine({.work = 1000});   // or refine() at once
//
// Preconditions, threads, determinism, allocation (none after construction): as for NarrowPhase. Without triangles, or
// without memory for them, finished() is true at once and the bounds are those of the roots; for poses that NarrowPhase
// refuses they are 0 and infinity.
class DistanceQuery {
 public:
  struct Tolerance {
    double relative = 0.01;  // finished once upper <= (1 + relative) * lower + absolute, but for rounding
    double absolute = 0;     // in world units
  };

  DistanceQuery(const TreeView& a, const TreeView& b) noexcept;
  // Of no bodies yet, and of others from now on: as NarrowPhase::bind().
  DistanceQuery() noexcept;
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;

  void start(const Pose& a, const Pose& b, const Tolerance& tolerance) noexcept;
  void start(const Pose& a, const Pose& b) noexcept { start(a, b, Tolerance{}); }
  // For whether they are within `limit` of each other, in world units: finished once lower() > limit or upper() <=
  // limit, but for rounding; the bounds are no better than that, and there may be no points(). Precondition: limit >=
  // 0.
  void start_within(const Pose& a, const Pose& b, double limit) noexcept;
  void refine(const Budget& budget = {}) noexcept;

  bool finished() const noexcept;
  double lower() const noexcept;
  double upper() const noexcept;
  std::uint64_t work() const noexcept;  // since start(), as a budget counts it

  // A point of each surface, in world coordinates, upper() apart but for rounding; none before the first triangles were
  // compared.
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
  static constexpr std::size_t kSize = 1856, kAlignment = 32;
  alignas(kAlignment) std::array<std::byte, kSize> storage_;
};

}  // namespace orchard::runtime
