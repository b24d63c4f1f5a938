#include "orchard/runtime/collide.h"

#include <algorithm>

#include "pair_access.h"

namespace orchard::runtime {

namespace {

bool unlimited(const Budget& budget) noexcept {
  const Budget none;
  return budget.pair_tests == none.pair_tests && budget.time == none.time;
}

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
    return left_.pair_tests == 0 || (timed_ && left_.time <= std::chrono::nanoseconds(0));
  }
  const Budget& left() const noexcept { return left_; }
  void spend(std::uint64_t tests) noexcept { left_.pair_tests -= std::min(tests, left_.pair_tests); }

 private:
  Budget left_;
  bool timed_ = false;
  std::chrono::steady_clock::time_point deadline_;
};

// Each may be off by kRigidTolerance, and together by more. What is not rigid stays so, and will be refused.
Pose placed(const Pose& body, const Pose& local) noexcept {
  const Pose pose = compose(body, local);
  if (is_rigid(body) && is_rigid(local)) return is_rigid(pose) ? pose : made_rigid(pose).value_or(pose);
  Pose nothing;  // two wrongs, mirrors for one, can make a right
  nothing.rotation = {};
  return nothing;
}

}  // namespace

void answer_exactly(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget) noexcept {
  pair.start(a, b);
  while (!pair.finished() && budget.pair_tests > 0) {
    pair.refine_exactly(budget);
    if (!unlimited(budget)) break;
  }
}

Verdict collide(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget, Order order) noexcept {
  if (order == Order::exact_first) {
    answer_exactly(pair, a, b, budget);
    return pair.verdict();
  }
  pair.start(a, b);
  if (unlimited(budget)) {
    while (!pair.finished()) pair.refine();
    return pair.verdict();
  }
  SharedBudget shared(budget);
  while (!pair.finished() && !shared.empty()) {
    const std::uint64_t before = pair.work();
    pair.refine(shared.left());
    shared.spend(pair.work() - before);
  }
  return pair.verdict();
}

void collide(NarrowPhase& pair, std::span<const PosePair> poses, std::span<Verdict> verdicts, const Budget& each,
             Order order) noexcept {
  for (std::size_t i = 0; i < poses.size(); ++i) verdicts[i] = collide(pair, poses[i].a, poses[i].b, each, order);
}

bool RoundRobin::refine(const Budget& budget) noexcept {
  SharedBudget shared(budget);
  std::size_t idle = 0;  // finished pairs in a row
  while (idle < pairs_.size() && !shared.empty()) {
    if (next_ >= pairs_.size()) next_ = 0;
    NarrowPhase& pair = pairs_[next_];
    if (pair.finished()) {
      ++idle, ++next_;
      continue;
    }
    idle = 0;
    const std::uint64_t before = pair.work();
    const std::uint32_t level = pair.level();
    pair.refine(shared.left());
    shared.spend(pair.work() - before);
    if (pair.finished() || pair.level() != level) ++next_;  // else it goes on next time
  }
  return std::all_of(pairs_.begin(), pairs_.end(), [](const NarrowPhase& pair) { return pair.finished(); });
}

ArticulatedPair::ArticulatedPair(std::span<const Part> a, std::span<const Part> b, std::size_t room)
    : round_(std::span<NarrowPhase>()) {
  for (const Part& part : a) locals_a_.push_back(part.local);
  for (const Part& part : b) locals_b_.push_back(part.local);
  placed_b_.resize(b.size());
  pairs_.reserve(a.size() * b.size());
  for (const Part& of_a : a) {
    for (const Part& of_b : b) pairs_.emplace_back(of_a.tree, of_b.tree, room);
  }
}

Answer ArticulatedPair::start(const Pose& a, const Pose& b) noexcept {
  for (std::size_t j = 0; j < locals_b_.size(); ++j) placed_b_[j] = placed(b, locals_b_[j]);
  for (std::size_t i = 0; i < locals_a_.size(); ++i) {
    const Pose pose_a = placed(a, locals_a_[i]);
    for (std::size_t j = 0; j < locals_b_.size(); ++j) pairs_[i * locals_b_.size() + j].start(pose_a, placed_b_[j]);
  }
  round_ = RoundRobin(pairs_);
  const Answer now = answer();
  finished_ = now != Answer::maybe ||
              std::all_of(pairs_.begin(), pairs_.end(), [](const NarrowPhase& pair) { return pair.finished(); });
  return now;
}

Answer ArticulatedPair::refine(const Budget& budget) noexcept {
  if (finished_) return answer();
  const bool all = round_.refine(budget);
  const Answer now = answer();
  finished_ = all || now == Answer::yes;
  return now;
}

Answer ArticulatedPair::answer() const noexcept {
  Answer result = Answer::no;
  for (const NarrowPhase& pair : pairs_) result = std::max(result, pair.answer());
  return result;
}

std::size_t ArticulatedPair::decisive() const noexcept {
  std::size_t best = 0;
  const auto before = [](const NarrowPhase& p, const NarrowPhase& q) {
    return p.answer() != q.answer() ? p.answer() > q.answer() : p.separation_bound() < q.separation_bound();
  };
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    if (before(pairs_[i], pairs_[best])) best = i;
  }
  return best;
}

Verdict ArticulatedPair::verdict() const noexcept {
  Verdict result;
  result.answer = Answer::no;
  if (pairs_.empty()) return result;
  result = pairs_[decisive()].verdict();
  result.work = 0;
  for (const NarrowPhase& pair : pairs_) {
    result.separation_bound = std::min(result.separation_bound, pair.separation_bound());
    result.lower_bound = std::min(result.lower_bound, pair.lower_bound());
    result.work += pair.work();
  }
  return result;
}

}  // namespace orchard::runtime
