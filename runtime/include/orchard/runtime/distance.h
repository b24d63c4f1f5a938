#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "orchard/runtime/narrow_phase.h"

namespace orchard::runtime {

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
  DistanceQuery() noexcept : pair_(0) {}
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;

  void start(const Pose& a, const Pose& b, const Tolerance& tolerance) noexcept;
  void start(const Pose& a, const Pose& b) noexcept { start(a, b, Tolerance{}); }
  // For whether they are within `limit` of each other, in world units: finished once lower() > limit or upper() <=
  // limit, but for rounding; the bounds are no better than that, and there may be no points(). Precondition: limit >=
  // 0.
  void start_within(const Pose& a, const Pose& b, double limit) noexcept;
  void refine(const Budget& budget = {}) noexcept;

  bool finished() const noexcept { return finished_; }
  double lower() const noexcept { return lower_; }
  double upper() const noexcept { return upper_; }
  std::uint64_t work() const noexcept { return work_; }  // since start(), as a budget counts it

  // A point of each surface, in world coordinates, upper() apart but for rounding; none before the first triangles were
  // compared.
  struct Points {
    std::array<double, 3> on_a{}, on_b{};
    std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
  };
  Points points() const noexcept;

 private:
  struct BallSlabPair {
    float lower;
    std::uint32_t a, b;
  };

  bool make_room() noexcept;
  bool has_room() const noexcept { return pair_.has_triangles() && stack_; }
  void begin(const Pose& a, const Pose& b, double limit) noexcept;
  void leave_the_rest() noexcept;
  bool surely_near(const BallSlabPair& pair) noexcept;
  bool may_be_nearer(double lower) const noexcept;
  void expand(const BallSlabPair& pair, std::uint32_t block, bool second) noexcept;
  void expand_within(const BallSlabPair& pair, std::uint32_t block, bool second) noexcept;
  void compare_leaves(const BallSlabPair& pair) noexcept;
  void find_within(const BallSlabPair& pair, const TriangleBlock& lanes, const TriangleBlock& rows) noexcept;
  void compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row,
                         bool may_meet) noexcept;
  void find_cut() noexcept;
  void report() noexcept;

  NarrowPhase pair_;  // the bodies' order and placement
  std::unique_ptr<BallSlabPair[]> stack_;
  std::size_t stack_size_ = 0;
  std::size_t stack_room_ = 0;
  Tolerance tolerance_;
  double limit_ = std::numeric_limits<double>::infinity();  // what is farther is left out
  float reach_ = std::numeric_limits<float>::infinity();    // it, rounded up
  double cut_ = std::numeric_limits<double>::infinity();    // from nearest_ and limit_, with the tolerance
  bool below_nearest_ = false;                              // what is as far is not looked at, either
  double enough_ = 0;                                       // so near: nothing nearer is looked for
  // In the first tree's units, of the stored triangles.
  double nearest_ = std::numeric_limits<double>::infinity();    // the least distance found
  double min_lower_ = std::numeric_limits<double>::infinity();  // of everything looked at or left out
  std::array<double, 3> on_first_{}, on_second_{};
  std::array<float, 3> direction_{};  // unit, from the nearest point of the first one to that of the second one
  std::uint32_t triangle_first_ = kNoTriangle, triangle_second_ = kNoTriangle;
  double lower_ = 0, upper_ = std::numeric_limits<double>::infinity();
  std::uint64_t work_ = 0;
  bool finished_ = true;
};

}  // namespace orchard::runtime
