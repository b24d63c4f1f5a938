#include "orchard/runtime/collide.h"

#include "collision/pair_query.h"

namespace orchard::runtime {

void answer_exactly(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget, Order order) noexcept {
  pair.start(a, b);
  for (PairBudget tracker(budget); !pair.finished() && !tracker.exhausted();) {
    pair.advance(tracker, order);
  }
}

Verdict collide(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget, Order order) noexcept {
  answer_exactly(pair, a, b, budget, order);
  return pair.verdict();
}

Verdict collide(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget, Order order) noexcept {
  return collide(query_of(pair), a, b, budget, order);
}

}  // namespace orchard::runtime
