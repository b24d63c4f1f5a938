#include "broad_phase/planner.h"

#include <cmath>

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kSmallSample = 16, kSample = 48;  // bodies that the first plan asks: of few, and of many
constexpr double kCrowding = 4;                         // lines read per entry from which on the cells are too large
constexpr double kStepsToTell = 3;                      // fewer do not tell how often bounds are cancelled
constexpr double kNearlyAll = 0.9;                      // of many, at each step so far: one step is enough
constexpr double kStepsCounted = 256;                   // that tell how often bounds are cancelled
constexpr unsigned kPlansKept = 8;         // a plan that fits is made again after so many updates of all windows
constexpr double kFarthestWay = 0x1p20;    // spacings, which cells are not much smaller than
constexpr double kFewPairsPerBody = 1e-3;  // per body: too few to say anything about the prediction

}  // namespace

bool Planner::crowded(const GridCounts& counts) const noexcept {
  return plan_.roomy && counts.bodies >= pool_.size() &&
         static_cast<double>(counts.lines_read) > kCrowding * static_cast<double>(counts.entries);
}

Planner::Outcome Planner::replan(Step now, const GridCounts& counts, BudgetTracker& tracker) {
  const std::size_t n = pool_.size();
  surveyed_now_ = false;
  const bool too_crowded = crowded(counts) && !many_more_bodies();
  const bool other_number = many_more_bodies() || 2 * n < planned_bodies_;
  if (!too_crowded && other_number && !survey(now, tracker)) return Outcome::interrupted;
  double off = 1;  // pairs seen to pairs predicted
  if (counts.bodies > 0) {
    const double seen = static_cast<double>(counts.pairs) / static_cast<double>(counts.bodies);
    off = (seen + kFewPairsPerBody) / (plan_.pairs_per_body + kFewPairsPerBody);
  }
  const double steps = static_cast<double>(std::max<Step>(1, now - planned_at_));
  const double share = std::min(1.0, static_cast<double>(cancellations_) / (steps * static_cast<double>(n)));
  const bool tells = steps >= kStepsToTell || (share > kNearlyAll && n > kFewBodies);
  const double cancelled = tells ? share : cancelled_;
  if (too_crowded) {
    crowding_ *= 2;  // bodies in clusters: what counts is how dense these are
    spread_.spacing /= 2;
  } else if (!other_number) {
    if (!outdated(off, cancelled)) {
      if (steps > kStepsCounted) {  // what was long ago counts less and less
        cancellations_ /= 2;
        planned_at_ = now - (now - planned_at_) / 2;
      }
      return Outcome::same;
    }
    if (means_.sample().size() >= kSmallSample) {  // bodies may have come closer, or gone apart
      const double before = spread_.spacing;
      spread_ = spread_of(means_.sample(), n);
      spread_.spacing /= crowding_;
      if (before > 0) off *= std::pow(spread_.spacing / before, 3);
    }
  }
  correction_ = std::clamp(correction_ * off, 0.05, 50.0);
  const Vec3 velocity = frame_velocity();
  means_.refer_to(velocity);
  plan_ = plan_window(means_, n, spread_, options_.time_step, correction_, options_.window, cancelled);
  cancelled_ = cancelled;
  if (tells || other_number) {
    planned_at_ = now;
    cancellations_ = 0;
  }
  means_ = {};
  means_.frame = velocity;
  return Outcome::rebuild;
}

// Static bodies have windows without end only where they stay in the same cells. Rounding stays below a
// quantum where a window's way is within the quantized grid's range.
Vec3 Planner::frame_velocity() const noexcept {
  if (pool_.statics.any()) return {};
  const Vec3 velocity = means_.crowd_velocity();
  const double way = std::sqrt(dot(velocity, velocity)) * kLongestWindow * options_.time_step;
  return way < kFarthestWay * spread_.spacing ? velocity : Vec3{};
}

// `off`: pairs seen to pairs predicted. Bounds that are cancelled more often than they were, or less, count as well.
bool Planner::outdated(double off, double cancelled) noexcept {
  constexpr double kSeldom = 0.005;  // a share that makes no difference
  const bool fits = 0.5 < off && off < 2;
  const bool as_often = std::max(cancelled, cancelled_) < kSeldom + 2 * std::min(cancelled, cancelled_);
  return !fits || !as_often || plans_++ % kPlansKept == 1;
}

// False if a budget ended it before it was complete.
// How bodies lie and move, from a sample. What a budget interrupts goes on with the bodies after those seen.
bool Planner::survey(Step now, BudgetTracker& tracker) {
  const std::size_t n = pool_.size(), wanted = std::clamp(n / 8, kSmallSample, kSample);
  const std::size_t stride = std::max<std::size_t>(1, n / wanted);
  if (surveyed_.empty()) survey_next_ = 0;
  std::vector<BodyIndex> sample;
  std::size_t skipped = stride - 1;
  const bool all_alive = pool_.slots() == n;  // no need to look at each
  for (; all_alive && survey_next_ < n && surveyed_.size() + sample.size() < wanted;) {
    sample.push_back(survey_next_);
    survey_next_ += static_cast<BodyIndex>(stride);
  }
  for (; survey_next_ < pool_.slots() && surveyed_.size() + sample.size() < wanted; ++survey_next_) {
    if (!pool_.alive(survey_next_) || ++skipped < stride) continue;
    skipped = 0;
    sample.push_back(survey_next_);
  }
  while (!sample.empty()) {
    if (tracker.spent()) {
      survey_next_ = sample.front();
      return false;
    }
    const std::size_t count = tracker.grant(sample.size());
    surveyed_.resize(surveyed_.size() + count);
    pool_.motions.ask(now, std::span(sample).first(count), std::span(surveyed_).last(count));
    tracker.count(count);
    sample.erase(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(count));
  }
  std::vector<Vec3> centers;
  means_ = {};
  for (const Motion& motion : surveyed_) {
    if (!is_valid(motion)) continue;
    means_.add(motion);
    centers.push_back(motion.position);
  }
  surveyed_.clear();
  surveyed_now_ = true;
  spread_ = spread_of(centers, n);
  planned_bodies_ = n;
  crowding_ = correction_ = 1;
  plans_ = 0;
  return true;
}

// Of the bodies, so that both steps take the same time: of the near pairs only those among them are found ahead, and
// what is done once, with code and grid that have left the cache, is done then. Of few bodies that is much of it.
double Planner::share_ahead() const noexcept {
  struct Costs {                                    // nanoseconds of one machine
    double update, near_pair, once, once_per_body;  // the last one of a thousand at most
  };
  constexpr Costs kFew = {15, 50, 600, 4}, kMany = {30, 80, 1250, 3.5};
  constexpr std::size_t kMostOfFew = 4096;
  constexpr double kMostOnce = 1000, kLeastShare = 0.1;
  const Costs& costs = pool_.size() <= kMostOfFew ? kFew : kMany;
  const double update = costs.update, bodies = static_cast<double>(std::max<std::size_t>(1, pool_.size()));
  const double once = costs.once + costs.once_per_body * std::min(bodies, kMostOnce);
  const double pairs = costs.near_pair * plan_.pairs_per_body;
  const double share =
      pairs < 1 ? 0.5 : (std::sqrt(update * update + 2 * pairs * (update + pairs)) - update) / (2 * pairs);
  return std::max(kLeastShare, share - once / (2 * update * bodies));
}

}  // namespace orchard::runtime::detail
