#include "detector/query_pool.h"

#include "collision/workspace_scratch.h"

namespace orchard::runtime::detail {

void QueryPool::prepare(const ShapeTable& shapes, std::size_t shape_count, std::size_t jobs, bool sweeps) {
  const bool more = seen_shapes_ < shape_count || (sweeps && !sweeps_);
  sweeps_ = sweeps_ || sweeps;
  for (; seen_shapes_ < shape_count; ++seen_shapes_) {
    const Shape& shape = shapes[static_cast<ShapeId>(seen_shapes_)];
    if (deepest_.tree.blocks.empty() || deepest_.tree.triangle_tree_depth <= shape.tree.triangle_tree_depth) {
      deepest_ = shape.prepared;
    }
  }
  const std::size_t before = scratches_.size();
  while (scratches_.size() < jobs) scratches_.push_back(std::make_unique<Scratch>());
  if (deepest_.tree.blocks.empty()) return;
  for (std::size_t i = more ? 0 : before; i < scratches_.size(); ++i) {
    scratches_[i]->workspace.narrow.bind(deepest_, deepest_);
    scratches_[i]->workspace.distance.bind(deepest_, deepest_);
    if (!sweeps_) continue;
    Workspace::Scratch* const scratch = scratches_[i]->workspace.scratch();
    if (scratch != nullptr) scratch->timed.reserve(deepest_.tree, deepest_.tree);
  }
  for (std::size_t i = 0; more && i < pool_.size(); ++i) pool_[i]->bind(deepest_, deepest_);
}

PairQuery* QueryPool::take(std::size_t most) {
  if (used_ >= most) return nullptr;
  if (used_ == pool_.size()) {
    pool_.push_back(std::make_unique<PairQuery>(kRoom));
    if (!deepest_.tree.blocks.empty()) pool_.back()->bind(deepest_, deepest_);
  }
  return pool_[used_++].get();
}

std::size_t QueryPool::memory_bytes() const noexcept {
  const std::size_t stack = (std::size_t{kBlockWidth} * (2 * deepest_.tree.triangle_tree_depth + 1) + 1) * 48;
  const std::size_t lists = 3 * (kRoom + std::size_t{kBlockWidth} * kBlockWidth) * 8;
  const std::size_t timed = (std::size_t{kBlockWidth} * (2 * deepest_.tree.triangle_tree_depth + 1) + 1) *
                            sizeof(Workspace::Scratch::TimedPair);
  const std::size_t sweeps = sweeps_ ? sizeof(Workspace::Scratch) + timed : 0;
  return scratches_.size() * (sizeof(Scratch) + 2 * stack + sweeps) +
         pool_.size() * (sizeof(PairQuery) + stack + lists);
}

}  // namespace orchard::runtime::detail
