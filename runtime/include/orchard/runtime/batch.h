#pragma once
#include <cstdint>
#include <span>

#include "orchard/runtime/body_pair.h"
#include "orchard/runtime/executor.h"
#include "orchard/runtime/shape_query.h"

// Many questions in one call, on as many threads as the executor has. Every answer is the one that the single call
// gives: it depends neither on the executor nor on the other questions. `workspaces`: at least one; as many jobs run as
// there are workspaces, so give executor.concurrency of them. Spans of results are as long as those of questions.
// Nothing here throws or allocates.
namespace orchard::runtime {

// Poses as arrays of their parts, as simulations keep them: element i of each. An empty `scale` means 1.
struct PoseArrays {
  std::span<const std::array<double, 9>> rotation;
  std::span<const std::array<double, 3>> translation;
  std::span<const double> scale;

  std::size_t size() const noexcept { return translation.size(); }
  Pose operator[](std::size_t i) const noexcept { return {rotation[i], translation[i], scale.empty() ? 1 : scale[i]}; }
};

// Pair i of trees with pose i of a and of b; one pair of trees is asked about at all poses.
void collide(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
             const PoseArrays& a, const PoseArrays& b, std::span<Verdict> verdicts, const Budget& each = {}) noexcept;
// Distances, and closer_than() with one margin.
void distance(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
              const PoseArrays& a, const PoseArrays& b, std::span<Distance> distances,
              const DistanceQuery::Tolerance& tolerance = {}) noexcept;
void closer_than(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
                 const PoseArrays& a, const PoseArrays& b, double margin, std::span<Answer> answers) noexcept;

}  // namespace orchard::runtime
