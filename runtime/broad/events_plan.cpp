#include "events.h"

// When to look at all bodies anew, and how long their windows are then.
namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kSmallSample = 16, kSample = 48;  // bodies that the first plan looks at: of few, and of many
constexpr double kCrowding = 4;                         // lines read per entry from which on the cells are too large
constexpr unsigned kPlansKept = 8;      // a plan that fits is made anew after as many looks at all bodies
constexpr double kFewPairs = 1e-3;      // per body: too few to say anything about the prediction
constexpr std::size_t kAskedAhead = 8;  // bodies, to see whether the next bounds are known

}  // namespace

bool Events::crowded(const GridCounts& counts) const noexcept {
  return counts.bodies >= roster_.size() &&
         static_cast<double>(counts.lines_read) > kCrowding * static_cast<double>(counts.entries);
}

// When most bodies are due it is cheaper to start afresh; it also lets the plan follow the bodies.
bool Events::worth_a_rebuild() const noexcept {
  const std::size_t n = roster_.size();
  if (due_.empty() || n == 0) return false;
  return 2 * due_.size() >= n || n > 2 * planned_bodies_ || crowded(grid_.counts());
}

void Events::replan(Step now) {
  const std::size_t n = roster_.size();
  const GridCounts counts = grid_.take_counts();
  double off = 1;  // pairs seen to pairs predicted
  if (counts.bodies > 0) {
    const double seen = static_cast<double>(counts.pairs) / static_cast<double>(counts.bodies);
    off = (seen + kFewPairs) / (plan_.pairs_per_body + kFewPairs);
  }
  if (crowded(counts) && n <= 2 * planned_bodies_) {
    spacing_ /= 2;  // bodies in clusters: what counts is how dense these are
  } else if (n > 2 * planned_bodies_ || 2 * n < planned_bodies_) {
    survey(now);
  } else if (0.5 < off && off < 2 && plans_++ % kPlansKept != 1) {
    return;
  }
  correction_ = std::clamp(correction_ * off, 0.05, 50.0);
  plan_ = plan_window(means_, n, spacing_, options_.time_step, correction_, options_.window);
  lattice_ = Lattice(lattice_.origin(), plan_.cell_size);
  means_ = {};
}

// How bodies lie and move, from a sample.
void Events::survey(Step now) {
  const std::size_t n = roster_.size(), wanted = std::clamp(n / 8, kSmallSample, kSample);
  const std::size_t stride = std::max<std::size_t>(1, n / wanted);
  std::vector<BodyIndex> sample;
  std::size_t seen = 0;
  for (BodyIndex body = 0; body < roster_.slots() && sample.size() < wanted; ++body) {
    if (roster_.alive(body) && seen++ % stride == 0) sample.push_back(body);
  }
  motions_.resize(sample.size());
  roster_.ask(now, sample, motions_);
  std::vector<Vec3> centers;
  means_ = {};
  for (const Motion& motion : motions_) {
    means_.add(motion);
    centers.push_back(motion.position);
  }
  lattice_ = Lattice(centers.front(), 1);
  spacing_ = mean_spacing(centers, n);
  planned_bodies_ = n;
  correction_ = 1;
  plans_ = 0;
}

void Events::place_all_anew() {
  calendar_.clear_bodies();
  std::fill(places_.begin(), places_.end(), Place::nowhere);
  oversized_.clear();
  if (due_.capacity() > 2 * roster_.size()) due_ = {};
  due_.clear();
  due_.reserve(roster_.size());
  for (BodyIndex body = 0; body < roster_.slots(); ++body) {
    if (roster_.alive(body)) due_.push_back(body);
  }
  voted_ = kNeverStep;
  votes_ = 0;
  few_ = roster_.slots() <= BoxList::kMostBodies;
  if (few_) {
    list_.reset(roster_.slots());
    grid_.release();
    boxes_ = {};
  } else {
    list_.release();
    grid_.reset(plan_.lines);
    grow(boxes_, roster_.slots());
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

// A step ahead of the rush: the present bounds have answered for this step, and hold no longer than that. If the next
// ones are known already, some bodies are looked at now, with windows that begin at the rush.
bool Events::prepare(Step now) {
  const Step from = now + 1;
  rush_ = kNeverStep;
  std::array<BodyIndex, kSample> sample;
  std::size_t count = 0;
  const std::size_t stride = std::max<std::size_t>(1, roster_.slots() / kAskedAhead);
  for (std::size_t body = 0; body < roster_.slots() && count < kAskedAhead; body += stride) {
    if (roster_.alive(static_cast<BodyIndex>(body))) sample[count++] = static_cast<BodyIndex>(body);
  }
  motions_.resize(kBlock);
  roster_.ask(now, std::span(sample).first(count), std::span(motions_).first(count));
  if (2 * known_at(from, std::span(sample).first(count)) < count) return false;

  rush_ = from;
  prepared_round_ = ++round_;
  replan(now);
  place_all_anew();
  const std::size_t ahead = due_.size() / 2;
  Meter unlimited;
  near_.clear();
  look_at(now, from, std::span(due_).first(ahead), unlimited);
  due_.erase(due_.begin(), due_.begin() + static_cast<std::ptrdiff_t>(ahead));
  tests_.clear();
  for (const BodyPair& pair : near_) tests_.push_back({pair, round_});
  test_all(now, unlimited);
  return true;
}

}  // namespace orchard::runtime::detail
