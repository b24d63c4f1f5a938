#pragma once
#include <cstdint>

#include "orchard/runtime/narrow_phase.h"

// A whole question in one call. What NarrowPhase says about the question answered, threads, determinism and memory
// holds here.
namespace orchard::runtime {

// How a budget is spent.
enum class Order : std::uint8_t {
  exact_first,    // straight to the triangles: the fastest way to "yes" or "no"; bounds are those of the roots
  level_by_level  // all levels of spheres, then the triangles: bounds on the separation as good as the budget allows
};

// Answers a pair within a budget. What a budget ends can be gone on with: pair.refine_exactly(), or refine() for level
// by level. The same budget of tests gives the same verdict; Verdict::work of a timed call, given as `work`,
// repeats it.
Verdict collide(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;

}  // namespace orchard::runtime
