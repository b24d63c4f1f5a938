#include "events.h"

// When to update all windows anew, and how long their windows are then.
namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kSmallSample = 16, kSample = 48;  // bodies that the first plan asks: of few, and of many
constexpr double kCrowding = 4;                         // lines read per entry from which on the cells are too large
constexpr double kStepsToTell = 3;                      // fewer do not tell how often bounds are cancelled
constexpr double kNearlyAll = 0.9;                      // cancelled at each step so far: one is enough
constexpr double kStepsCounted = 256;                   // that tell how often bounds are cancelled
constexpr unsigned kPlansKept = 8;       // a plan that fits is made anew after as many updates of all windows
constexpr double kFarthestWay = 0x1p20;  // spacings, which cells are not much smaller than
constexpr double kFewPairs = 1e-3;       // per body: too few to say anything about the prediction
constexpr std::size_t kAskedAhead = 8;   // bodies, to see whether the next bounds are known

}  // namespace

bool Events::crowded(const GridCounts& counts) const noexcept {
  return plan_.roomy && counts.bodies >= pool_.size() &&
         static_cast<double>(counts.lines_read) > kCrowding * static_cast<double>(counts.entries);
}

// When most bodies are due it is cheaper to start afresh; it also lets the plan follow the bodies.
bool Events::worth_a_rebuild(std::size_t due) const noexcept {
  const std::size_t n = pool_.size();
  if (rounds_run_out()) return true;  // what is updated seldom has to stay comparable
  if (due == 0 || n == 0) return false;
  return 2 * due >= n || n > 2 * planned_bodies_ || crowded(grid_.counts());
}

// False if a budget ended the survey before it was complete: it goes on at the next call.
bool Events::replan(Step now, BudgetTracker& tracker) {
  const std::size_t n = pool_.size();
  const bool too_crowded = crowded(grid_.counts()) && n <= 2 * planned_bodies_;
  const bool other_number = n > 2 * planned_bodies_ || 2 * n < planned_bodies_;
  if (!too_crowded && other_number && !survey(now, tracker)) return false;
  GridCounts counts = grid_.take_counts();
  if (sorting_) counts.bodies = n, counts.pairs = sorted_.boxes_met();
  double off = 1;  // pairs seen to pairs predicted
  if (counts.bodies > 0) {
    const double seen = static_cast<double>(counts.pairs) / static_cast<double>(counts.bodies);
    off = (seen + kFewPairs) / (plan_.pairs_per_body + kFewPairs);
  }
  const double steps = static_cast<double>(std::max<Step>(1, now - planned_at_));
  const double share = std::min(1.0, static_cast<double>(cancellations_) / (steps * static_cast<double>(n)));
  const bool tells = steps >= kStepsToTell || share > kNearlyAll;
  const double cancelled = tells ? share : cancelled_;
  if (too_crowded) {
    crowding_ *= 2;  // bodies in clusters: what counts is how dense these are
    spacing_ /= 2;
  } else if (!other_number) {
    if (!plan_outdated(off, cancelled)) {
      if (steps > kStepsCounted) {  // what was long ago counts less and less
        cancellations_ /= 2;
        planned_at_ = now - (now - planned_at_) / 2;
      }
      return true;
    }
    if (means_.sample().size() >= kSmallSample) {  // bodies may have come closer, or gone apart
      const double before = spacing_;
      spacing_ = mean_spacing(means_.sample(), n) / crowding_;
      if (before > 0) off *= std::pow(spacing_ / before, 3);
    }
  }
  correction_ = std::clamp(correction_ * off, 0.05, 50.0);
  const Vec3 velocity = frame_velocity();
  means_.refer_to(velocity);
  plan_ = plan_window(means_, n, spacing_, options_.time_step, correction_, options_.window, cancelled);
  cancelled_ = cancelled;
  if (tells || other_number) {
    planned_at_ = now;
    cancellations_ = 0;
  }
  lattice_.move_to(seconds_between(lattice_from_, now));
  lattice_ = Lattice(lattice_.origin(), velocity, plan_.cell_size, 2 * options_.position_slack);
  lattice_from_ = now;
  means_ = {};
  means_.frame = velocity;
  return true;
}

// Of the lattice. Static bodies have windows without end only where they stay in the same cells. Rounding stays below a
// quantum where a window's way is within the lattice's range.
Vec3 Events::frame_velocity() const noexcept {
  if (pool_.any_static()) return {};
  const Vec3 velocity = means_.crowd_velocity();
  const double way = std::sqrt(dot(velocity, velocity)) * seconds_between(0, kLongestWindow);
  return way < kFarthestWay * spacing_ ? velocity : Vec3{};
}

// `off`: pairs seen to pairs predicted. Bounds that are cancelled more often than they were, or less, count as well.
bool Events::plan_outdated(double off, double cancelled) noexcept {
  constexpr double kSeldom = 0.005;  // a share that makes no difference
  const bool fits = 0.5 < off && off < 2;
  const bool as_often = std::max(cancelled, cancelled_) < kSeldom + 2 * std::min(cancelled, cancelled_);
  return !fits || !as_often || plans_++ % kPlansKept == 1;
}

// How bodies lie and move, from a sample. What a budget interrupts goes on with the bodies after those seen.
bool Events::survey(Step now, BudgetTracker& tracker) {
  const std::size_t n = pool_.size(), wanted = std::clamp(n / 8, kSmallSample, kSample);
  const std::size_t stride = std::max<std::size_t>(1, n / wanted);
  if (surveyed_.empty()) survey_next_ = 0;
  std::vector<BodyIndex> sample;
  std::size_t seen = 0;
  for (; survey_next_ < pool_.slots() && surveyed_.size() + sample.size() < wanted; ++survey_next_) {
    if (pool_.alive(survey_next_) && seen++ % stride == 0) sample.push_back(survey_next_);
  }
  while (!sample.empty()) {
    if (tracker.spent()) {
      survey_next_ = sample.front();
      return false;
    }
    const std::size_t count = tracker.grant(sample.size());
    surveyed_.resize(surveyed_.size() + count);
    pool_.ask(now, std::span(sample).first(count), std::span(surveyed_).last(count));
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
  lattice_ = Lattice(centers.empty() ? Vec3{} : centers.front(), {}, 1, 0);
  lattice_from_ = now;
  spacing_ = mean_spacing(centers, n);
  planned_bodies_ = n;
  crowding_ = correction_ = 1;
  plans_ = 0;
  return true;
}

void Events::all_are_due() {
  if (due_.capacity() > 2 * pool_.size()) give_back(due_);
  due_.clear();
  due_.reserve(pool_.size());
  for (BodyIndex body = 0; body < pool_.slots(); ++body) {
    if (pool_.alive(body)) due_.push_back(body);
  }
}

void Events::place_all_anew() {
  if (sorting_) sorted_.release();
  sorting_ = false;
  rebuilt_round_ = round_;
  wheel_.clear_bodies();
  std::fill(places_.begin(), places_.end(), Place::nowhere);
  oversized_.clear();
  extent_ = kNothing;
  all_are_due();
  any_short_ = any_short_ && std::any_of(windows_.begin(), windows_.end(),
                                         [](const Window& window) { return window.lasting < kLastsAsEver; });
  voted_ = kNeverStep;
  votes_ = 0;
  few_ = pool_.slots() <= BoxList::kMaxBodies;
  if (few_) {
    list_.reset(pool_.slots());
    grid_.release();
    give_back(boxes_);
  } else {
    list_.release();
    grid_.reset(plan_.lines);
    grow(boxes_, pool_.slots());
  }
}

// The majority's vote, if there is one: what differs is paired off.
void Events::vote(Step end, std::size_t bodies) noexcept {
  if (end == voted_) {
    votes_ += bodies;
  } else if (bodies > votes_) {
    voted_ = end;
    votes_ = bodies - votes_;
  } else {
    votes_ -= bodies;
  }
}

// Of the bodies, so that both steps take the same time: of the near pairs only those among them are found ahead.
double Events::share_ahead() const noexcept {
  constexpr double kUpdate = 60, kNearPair = 100;  // nanoseconds of one machine
  const double pairs = kNearPair * plan_.pairs_per_body;
  return pairs < 1 ? 0.5 : (std::sqrt(kUpdate * kUpdate + 2 * pairs * (kUpdate + pairs)) - kUpdate) / (2 * pairs);
}

// A step ahead of the common expiry: the present bounds have answered for this step, and hold no longer than that. If
// the next ones are known already, half of the work is done now, in updates with windows that begin at the common
// expiry.
bool Events::prepare(Step now) {
  const Step from = now + 1;
  common_expiry_ = kNeverStep;
  std::array<BodyIndex, kSample> sample;
  std::size_t count = 0;
  const std::size_t stride = std::max<std::size_t>(1, pool_.slots() / kAskedAhead);
  for (std::size_t body = 0; body < pool_.slots() && count < kAskedAhead; body += stride) {
    if (pool_.alive(static_cast<BodyIndex>(body))) sample[count++] = static_cast<BodyIndex>(body);
  }
  motions_.resize(kBlock);
  pool_.ask(now, std::span(sample).first(count), std::span(motions_).first(count));
  if (2 * known_at(from, std::span(sample).first(count)) < count) return false;

  common_expiry_ = from;
  prepared_ = preparing_ = true;
  ++round_;
  BudgetTracker unlimited;
  replan(now, unlimited);
  place_all_anew();
  wheel_.clear_events();
  const auto ahead = static_cast<std::size_t>(share_ahead() * static_cast<double>(due_.size()));
  near_.clear();
  make_room_for_spheres();
  update_windows(now, from, std::span(due_).first(ahead), Found::tested);
  due_.erase(due_.begin(), due_.begin() + static_cast<std::ptrdiff_t>(ahead));
  preparing_ = false;
  return true;
}

}  // namespace orchard::runtime::detail
