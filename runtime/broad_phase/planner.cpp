#include "broad_phase/planner.h"

#include <cmath>

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kSmallSample = 16;   // bodies that a plan asks at least
constexpr double kCrowding = 4;            // lines read per entry, from which on the cells are too large
constexpr double kStepsToTell = 3;         // fewer steps do not show how often bounds are cancelled
constexpr double kNearlyAll = 0.9;         // of many bodies at each step; even one step shows such a share
constexpr double kStepsCounted = 256;      // steps after which older ones count less for the share
constexpr unsigned kPlansKept = 8;         // a plan that fits is made again after so many updates of all windows
constexpr double kFarthestWay = 0x1p20;    // in spacings; cells are not much smaller than a spacing
constexpr double kFewPairsPerBody = 1e-3;  // fewer do not show whether the prediction is right

}  // namespace

bool Planner::crowded(const GridCounts& counts) const noexcept {
  return plan_.roomy && counts.bodies >= pool_.size() &&
         static_cast<double>(counts.lines_read) > kCrowding * static_cast<double>(counts.entries);
}

Planner::Outcome Planner::replan(Step now, const GridCounts& counts, BudgetTracker& tracker) {
  const std::size_t n = pool_.size();
  const bool too_crowded = crowded(counts) && !many_more_bodies();
  const bool other_number = many_more_bodies() || 2 * n < planned_bodies_;
  double off = 1;  // pairs seen to pairs predicted
  if (counts.bodies > 0) {
    const double seen = static_cast<double>(counts.pairs) / static_cast<double>(counts.bodies);
    off = (seen + kFewPairsPerBody) / (plan_.pairs_per_body + kFewPairsPerBody);
  }
  const double steps = static_cast<double>(std::max<Step>(1, now - planned_at_));
  const double share = std::min(1.0, static_cast<double>(cancellations_) / (steps * static_cast<double>(n)));
  const bool tells = steps >= kStepsToTell || (share > kNearlyAll && n > kFewBodies);
  const double cancelled = tells ? share : cancelled_;
  const bool few = n < kSmallSample;  // to ask these more than once would cost more than any plan saves
  if (!too_crowded && !other_number && (few || !outdated(off, cancelled))) {
    if (steps > kStepsCounted) {  // older steps count less and less
      cancellations_ /= 2;
      planned_at_ = now - (now - planned_at_) / 2;
    }
    return Outcome::same;
  }
  if (!survey(now, tracker)) return Outcome::interrupted;
  std::erase_if(sample_, [](const Motion& motion) { return !is_valid(motion); });
  const double before = spread_.spacing;
  spread_ = spread_of(sample_, n);
  if (other_number) {
    planned_bodies_ = n;
    crowding_ = correction_ = 1;
    plans_ = 0;
  } else if (too_crowded) {
    crowding_ *= 2;  // bodies are in clusters, whose density counts
  }
  spread_.spacing /= crowding_;
  if (!other_number && !too_crowded && before > 0) off *= std::pow(spread_.spacing / before, 3);
  correction_ = std::clamp(correction_ * off, 0.05, 50.0);
  // The grid does not move if there are static bodies: their windows have no end only if they stay in the same cells.
  // Nor does it move so far in a window that it leaves the range in which rounding stays below a quantum.
  velocity_ = pool_.statics.any() ? Vec3{} : crowd_velocity(sample_);
  if (!(length(velocity_) * kLongestWindow * options_.time_step < kFarthestWay * spread_.spacing)) velocity_ = {};
  plan_ =
      plan_window(mean_of(sample_, velocity_), n, spread_, options_.time_step, correction_, options_.window, cancelled);
  sample_.clear();
  cancelled_ = cancelled;
  if (tells || other_number) {
    planned_at_ = now;
    cancellations_ = 0;
  }
  return Outcome::rebuild;
}

// Returns whether the plan does not fit any more, or is old. `off` is the ratio of the pairs seen to the pairs
// predicted. Bounds that are cancelled more often than the plan assumes, or less often, count as well.
bool Planner::outdated(double off, double cancelled) noexcept {
  constexpr double kSeldom = 0.005;  // a share that makes no difference
  const bool fits = 0.5 < off && off < 2;
  const bool as_often = std::max(cancelled, cancelled_) < kSeldom + 2 * std::min(cancelled, cancelled_);
  return !fits || !as_often || plans_++ % kPlansKept == 1;
}

// Asks for the motions of a sample of the bodies. Returns false if a budget ended it before it was complete. The next
// call then continues with the bodies after those that were asked for.
bool Planner::survey(Step now, BudgetTracker& tracker) {
  const std::size_t wanted = std::clamp(pool_.size() / 8, kSmallSample, kSample), stride = pool_.slots() / wanted;
  if (sample_.empty()) survey_next_ = 0;
  std::array<BodyIndex, kSample> bodies;
  std::size_t count = 0;
  for (std::size_t body = survey_next_; sample_.size() + count < wanted;) {
    while (body < pool_.slots() && !pool_.alive(static_cast<BodyIndex>(body))) ++body;
    if (body >= pool_.slots()) break;
    bodies[count++] = static_cast<BodyIndex>(body);
    // Steps of one size would find a single row of bodies that were added row by row, such as those of a pile.
    const double golden = 0.6180339887498949 * static_cast<double>(sample_.size() + count);
    const double step = 2 * static_cast<double>(stride) * (golden - std::floor(golden));
    body += static_cast<std::size_t>(std::max(1.0, step));
  }
  for (std::size_t done = 0; done < count;) {
    survey_next_ = bodies[done];
    if (tracker.spent()) return false;
    const std::size_t some = tracker.grant(count - done);
    sample_.resize(sample_.size() + some);
    pool_.motions.ask(now, std::span(bodies).subspan(done, some), std::span(sample_).last(some));
    tracker.count(some);
    done += some;
  }
  return true;
}

// Both steps should take the same time. The one ahead finds only the near pairs among its own bodies: a share s of the
// bodies costs s + pairs s^2 there, and 1 - s + pairs (1 - s^2) in the other step, in units of one update. All that is
// done once, with code and a grid that have left the cache, is done in the step ahead. It takes as long as kOnce
// updates and kOncePerBody for each of at most kMostOnce bodies, which is a large part if bodies are few.
double Planner::share_ahead() const noexcept {
  constexpr double kOnce = 20, kOncePerBody = 0.13, kMostOnce = 1000, kLeastShare = 0.1, kNearPair = 2.7;
  const double bodies = static_cast<double>(std::max<std::size_t>(1, pool_.size()));
  const double pairs = std::max(1e-3, kNearPair * plan_.pairs_per_body);
  const double share = (std::sqrt(1 + 2 * pairs * (1 + pairs)) - 1) / (2 * pairs);
  return std::max(kLeastShare, share - (kOnce + kOncePerBody * std::min(bodies, kMostOnce)) / bodies);
}

}  // namespace orchard::runtime::detail
