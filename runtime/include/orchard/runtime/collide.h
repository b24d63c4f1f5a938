#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/runtime/narrow_phase.h"

// Whole questions in one call, and many pairs under one budget. Everything here is made of NarrowPhase: what it says
// about the question answered, threads, determinism and memory holds here.
namespace orchard::runtime {

// How a budget is spent.
enum class Order : std::uint8_t {
  exact_first,    // straight to the triangles: the fastest way to "yes" or "no"; bounds are those of the roots
  level_by_level  // all levels of spheres, then the triangles: bounds on the separation as good as the budget allows
};

// Answers a pair within a budget. What a budget ends can be gone on with: pair.refine_exactly(), or refine() for level
// by level. The same budget of tests gives the same verdict; Verdict::work of a timed call, given as pair_tests,
// repeats it.
Verdict collide(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;

// The same for many poses of one pair, each with its own budget. verdicts.size() >= poses.size().
struct PosePair {
  Pose a, b;
};
void collide(NarrowPhase& pair, std::span<const PosePair> poses, std::span<Verdict> verdicts, const Budget& each = {},
             Order order = Order::exact_first) noexcept;

// Shares one budget among many started pairs, a level each in turn (dissertation 7.3). A call goes on where the one
// before stopped, within a level if need be. The pairs and the array outlive this object.
class RoundRobin {
 public:
  explicit RoundRobin(std::span<NarrowPhase> pairs) noexcept : pairs_(pairs) {}

  bool refine(const Budget& budget) noexcept;  // true once every pair is finished
  void restart() noexcept { next_ = 0; }       // from the first pair; after start() of the pairs

 private:
  std::span<NarrowPhase> pairs_;
  std::size_t next_ = 0;
};

// A rigid part of an articulated body: world = body's pose after `local`.
struct Part {
  TreeView tree;
  Pose local;
};

// Two bodies of several trees each: every part of one against every part of the other. The bodies touch iff two parts
// do; one without parts touches nothing. Parts may move between queries: set_local(). Poses are of bodies and of parts;
// what is composed of two that are rigid is made so again.
class ArticulatedPair {
 public:
  // Throws std::bad_alloc only. `room`: of each pair of parts, see NarrowPhase.
  ArticulatedPair(std::span<const Part> a, std::span<const Part> b, std::size_t room = 1024);

  void set_local_a(std::size_t part, const Pose& local) noexcept { locals_a_[part] = local; }
  void set_local_b(std::size_t part, const Pose& local) noexcept { locals_b_[part] = local; }

  Answer start(const Pose& a, const Pose& b) noexcept;
  Answer refine(const Budget& budget) noexcept;
  bool finished() const noexcept { return finished_; }
  // "No" if every pair of parts says so, "yes" if one does. Bounds: the least ones; the contact: that of the pair that
  // says yes, or that with the least separation bound, and the parts it is of.
  Verdict verdict() const noexcept;
  // 0 where a body has no parts.
  std::size_t contact_part_a() const noexcept { return pairs_.empty() ? 0 : decisive() / locals_b_.size(); }
  std::size_t contact_part_b() const noexcept { return pairs_.empty() ? 0 : decisive() % locals_b_.size(); }

 private:
  std::size_t decisive() const noexcept;
  Answer answer() const noexcept;

  std::vector<Pose> locals_a_, locals_b_, placed_b_;
  std::vector<NarrowPhase> pairs_;  // row by row: part of a, part of b
  RoundRobin round_;
  bool finished_ = true;
};

}  // namespace orchard::runtime
