#include "orchard/runtime/collide.h"

#include <algorithm>

#include "collision/pair_query.h"

namespace orchard::runtime {

namespace {

// What several calls may spend together.
class SharedBudget {
 public:
  explicit SharedBudget(const Budget& budget) noexcept : left_(budget) {
    timed_ = budget.time < std::chrono::hours(24 * 365);
    if (timed_) deadline_ = std::chrono::steady_clock::now() + budget.time;
  }
  // Nothing is left once tests are spent or time is over; reads the clock.
  bool empty() noexcept {
    if (timed_) left_.time = deadline_ - std::chrono::steady_clock::now();
    return left_.work == 0 || (timed_ && left_.time <= std::chrono::nanoseconds(0));
  }
  const Budget& left() const noexcept { return left_; }
  void spend(std::uint64_t tests) noexcept { left_.work -= std::min(tests, left_.work); }

 private:
  Budget left_;
  bool timed_ = false;
  std::chrono::steady_clock::time_point deadline_;
};

}  // namespace

void answer_exactly(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget) noexcept {
  pair.start(a, b);
  while (!pair.finished() && budget.work > 0) {
    pair.refine_exactly(budget);
    if (budget.limited()) break;
  }
}

Verdict collide(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget, Order order) noexcept {
  if (order == Order::exact_first) {
    answer_exactly(pair, a, b, budget);
    return pair.verdict();
  }
  pair.start(a, b);
  if (!budget.limited()) {
    while (!pair.finished()) pair.refine();
    return pair.verdict();
  }
  SharedBudget shared(budget);
  while (!pair.finished() && !shared.empty()) {
    const std::uint64_t before = pair.known().work;
    pair.refine(shared.left());
    shared.spend(pair.known().work - before);
  }
  return pair.verdict();
}

Verdict collide(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget, Order order) noexcept {
  return collide(query_of(pair), a, b, budget, order);
}

}  // namespace orchard::runtime
