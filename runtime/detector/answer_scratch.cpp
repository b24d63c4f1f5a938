#include "detector/answer_scratch.h"

#include "collision/pair_query.h"
#include "collision/workspace_scratch.h"

namespace orchard::runtime::detail {

void AnswerScratches::prepare(const ShapeTable& shapes, std::size_t jobs, bool sweeps) {
  const bool more = seen_shapes_ < shapes.size() || (sweeps && !sweeps_);
  sweeps_ = sweeps_ || sweeps;
  for (; seen_shapes_ < shapes.size(); ++seen_shapes_) {
    const Shape& shape = shapes[static_cast<ShapeId>(seen_shapes_)];
    if (deepest_.tree.blocks.empty() || deepest_.tree.triangle_tree_depth <= shape.tree.triangle_tree_depth) {
      deepest_ = shape.prepared;
    }
  }
  const std::size_t before = scratches_.size();
  while (scratches_.size() < jobs) scratches_.push_back(std::make_unique<AnswerScratch>());
  if (deepest_.tree.blocks.empty()) return;
  for (std::size_t i = more ? 0 : before; i < scratches_.size(); ++i) {
    Workspace& workspace = scratches_[i]->workspace;
    workspace.narrow.bind(deepest_, deepest_);
    workspace.distance.bind(deepest_, deepest_);
    Workspace::Scratch* const scratch = sweeps_ ? workspace.scratch() : nullptr;
    if (scratch != nullptr) scratch->timed.reserve(deepest_.tree, deepest_.tree);
  }
}

std::size_t AnswerScratches::memory_bytes() const noexcept {
  const std::size_t pairs = std::size_t{kBlockWidth} * (2 * deepest_.tree.triangle_tree_depth + 1) + 1;
  const std::size_t sweeps = sweeps_ ? sizeof(Workspace::Scratch) + pairs * sizeof(Workspace::Scratch::TimedPair) : 0;
  constexpr std::size_t kStackEntry = 48;
  return scratches_.size() * (sizeof(AnswerScratch) + 2 * pairs * kStackEntry + sweeps);
}

}  // namespace orchard::runtime::detail
