#include "orchard/runtime/collide.h"

#include "execution/share_among.h"

namespace orchard::runtime {

namespace {

template <typename Ask>
void share(std::span<Workspace> workspaces, const Executor& executor, std::size_t count, Ask&& ask) noexcept {
  share_among(executor, workspaces.size(), count, [&](std::size_t job, std::size_t i) { ask(workspaces[job], i); });
}

}  // namespace

void collide(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
             const PoseArrays& a, const PoseArrays& b, std::span<Verdict> verdicts, const Budget& each) noexcept {
  share(workspaces, executor, a.size(), [&](Workspace& workspace, std::size_t i) {
    verdicts[i] = collide(workspace, pairs[pairs.size() == 1 ? 0 : i], a[i], b[i], each);
  });
}

void distance(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
              const PoseArrays& a, const PoseArrays& b, std::span<Distance> distances,
              const DistanceQuery::Tolerance& tolerance) noexcept {
  share(workspaces, executor, a.size(), [&](Workspace& workspace, std::size_t i) {
    distances[i] = distance(workspace, pairs[pairs.size() == 1 ? 0 : i], a[i], b[i], tolerance);
  });
}

void closer_than(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
                 const PoseArrays& a, const PoseArrays& b, double margin, std::span<Answer> answers) noexcept {
  share(workspaces, executor, a.size(), [&](Workspace& workspace, std::size_t i) {
    answers[i] = closer_than(workspace, pairs[pairs.size() == 1 ? 0 : i], a[i], b[i], margin);
  });
}

}  // namespace orchard::runtime
