#include "orchard/runtime/time_of_impact.h"

#include <algorithm>
#include <cmath>

#include "collision/impact_search.h"

namespace orchard::runtime {
namespace detail {

namespace {

constexpr double kMinTolerance = 1e-9;  // relative to the bodies' size
constexpr double kShorter = 1 - 1e-9;   // a factor for steps, which covers their own rounding
constexpr double kMaxQuantity = 1e18;   // of speeds and reaches, in the first tree's units: floats hold their products
constexpr int kFineSteps = 12;          // the number of steps within the tolerance
constexpr int kProbes = 24;   // the number of times after the last certified one that are tested for a contact
constexpr int kHalvings = 8;  // of the interval in which the contact begins

// Returns a bound on the distance of points of the surface from the centre of rotation.
double reach_of(const PreparedTree& tree, const Vec3& center) noexcept {
  const Ball all = ball_around(tree.tree);
  return (length(minus(center, all.middle)) + all.radius) * (1 + kImpactRounding);
}

}  // namespace

bool ImpactSearch::prepare() noexcept {
  Scratch* const scratch = workspace_.scratch();
  query_of(workspace_.narrow).bind(pair_.a(), pair_.b());
  const TreeView &a = pair_.a().tree, &b = pair_.b().tree;
  return scratch != nullptr && !a.obb_nodes.empty() && !b.obb_nodes.empty() && scratch->timed.reserve(a, b);
}

// Places the bodies at a time, and computes their motion and the limits. Returns false if the poses are refused or the
// motion is out of range.
bool ImpactSearch::place(double time) noexcept {
  const Pose pose_a = a_.at(time), pose_b = b_.at(time);
  Roots roots;
  if (trees_.test_roots(pose_a, pose_b, roots) == Roots::Answer::refused || !trees_.place(pose_a, pose_b)) return false;
  const bool exchanged = trees_.exchanged();
  const Travel &first = exchanged ? b_ : a_, &second = exchanged ? a_ : b_;
  const Pose& frame = trees_.first_pose();
  const double shrink = 1 / frame.scale;
  const auto turn_of = [&](const Travel& travel) {
    Turn turn;
    const double spin = length(travel.spin);
    if (travel.pose_at != nullptr) {
      turn.turning = travel.turning;
    } else if (!(spin == 0)) {  // what is not a number is refused below
      turn.spin = spin;
      turn.axis = turned_back(frame, along({0, 0, 0}, travel.spin, 1 / spin));
    }
    return turn;
  };
  const auto velocity_of = [&](const Travel& travel) {
    return travel.pose_at != nullptr ? Vec3{} : along({0, 0, 0}, turned_back(frame, travel.velocity), shrink);
  };
  const auto speed_of = [&](const Travel& travel) { return travel.pose_at != nullptr ? travel.speed * shrink : 0.0; };
  motion_.first = turn_of(first), motion_.second = turn_of(second);
  motion_.first.center = minus(first.center, this->first().origin);
  motion_.second.center = transform(trees_.relative(), minus(second.center, this->second().origin));
  motion_.velocity = minus(velocity_of(second), velocity_of(first));
  motion_.speed = speed_of(first) + speed_of(second);

  const PreparedTree &p = trees_.first(), &q = trees_.second();
  const double scale = trees_.relative().scale, size = p.extent + q.extent * scale;
  const double reach =
      reach_of(p, motion_.first.center) + scale * reach_of(q, minus(second.center, this->second().origin));
  const double fastest = length(motion_.velocity) + motion_.speed +
                         (motion_.first.spin + motion_.first.turning + motion_.second.spin + motion_.second.turning);
  if (!(fastest <= kMaxQuantity && reach <= kMaxQuantity && fastest * reach <= kMaxQuantity * kMaxQuantity))
    return false;
  if (!(motion_.speed >= 0 && motion_.first.turning >= 0 && motion_.second.turning >= 0)) return false;
  limits_.error = trees_.exact_error() * shrink + kImpactRounding * size;
  limits_.margin = options_.margin * shrink;
  limits_.finest = std::max(kMinTolerance * size, 4 * limits_.error);
  limits_.tolerance = std::max(options_.tolerance * shrink, limits_.finest);
  find_closing();
  return true;
}

// Converts the motion to float, in the frames in which the nodes of either tree are tested.
void ImpactSearch::find_closing() noexcept {
  const Pose& relative = trees_.relative();
  const Vec3 back = turned_back(relative, motion_.velocity);
  motion_.of_first =
      motion_.of_second = {.speed = static_cast<float>((motion_.speed + 1e-6 * length(motion_.velocity)) * (1 + 1e-6)),
                           .rounding = trees_.placement().box_margin};
  for (std::size_t i = 0; i < 3; ++i) {
    motion_.of_first.velocity[i] = static_cast<float>(-motion_.velocity[i]);
    motion_.of_second.velocity[i] = static_cast<float>(back[i]);
  }
  motion_.of_first.lanes = motion_.first.in_float(), motion_.of_first.single = motion_.second.in_float();
  motion_.of_second.lanes = motion_.second.from(relative).in_float();
  motion_.of_second.single = motion_.first.from(relative).in_float();
}

// Returns a time before which the bodies cannot meet however they turn, because the balls in which they turn do not
// meet.
double ImpactSearch::without_turning() const noexcept {
  const double scale = trees_.relative().scale;
  const Vec3 way = minus(motion_.second.center, motion_.first.center);
  const double distance = length(way);
  const auto &p = trees_.first(), &q = trees_.second();
  const bool exchanged = trees_.exchanged();
  const Vec3 center = minus((exchanged ? a_ : b_).center, q.tree.origin);
  const double gap = distance * (1 - kImpactRounding) - reach_of(p, motion_.first.center) -
                     scale * reach_of(q, center) - limits_.margin - limits_.error;
  if (!(gap > 0)) return 0;
  // This also holds for balls that pass each other, because the direction is fixed.
  const double rate =
      motion_.speed - dot(motion_.velocity, way) / distance + kImpactRounding * length(motion_.velocity);
  return rate > 0 ? gap / rate : std::numeric_limits<double>::infinity();
}

void ImpactSearch::report(const Critical& critical) noexcept {
  if (critical.triangle_first == kNoTriangle) return;
  result_.distance = critical.distance * trees_.first_pose().scale * (1 + kImpactRounding) + trees_.exact_error();
  result_.on_a = trees_.in_world(critical.on_first), result_.on_b = trees_.in_world(critical.on_second);
  result_.triangle_a = critical.triangle_first, result_.triangle_b = critical.triangle_second;
  if (!trees_.exchanged()) return;
  std::swap(result_.on_a, result_.on_b);
  std::swap(result_.triangle_a, result_.triangle_b);
}

// Returns whether the bodies are no farther apart than the margin at a time; false if the budget ends the test.
bool ImpactSearch::touching(PairBudget& tracker, double time) noexcept {
  if (tracker.exhausted()) return false;
  const std::uint64_t left = options_.budget.work - tracker.spent();
  const Answer answer = closer_than(workspace_, pair_, a_.at(time), b_.at(time), options_.margin, {left});
  tracker.spend(options_.margin > 0 ? workspace_.distance.work() : query_of(workspace_.narrow).known().work);
  return answer == Answer::yes;
}

// Searches for a contact soon after a time at which the bodies nearly touch. If it finds one, it bisects the time at
// which the contact begins.
void ImpactSearch::find_contact(PairBudget& tracker) noexcept {
  const double begin = result_.t0, end = options_.end;
  double step = 0, miss = begin;
  for (int i = 0; i < kProbes; ++i) {
    const double time = std::min(end, begin + step);
    if (touching(tracker, time)) {
      result_.t1 = time;
      break;
    }
    if (tracker.exhausted() || time >= end || step > (end - options_.begin) / 16) return;
    miss = time;
    step = step > 0 ? 2 * step : soon_ / 4;
  }
  if (!(result_.t1 <= end)) return;
  result_.answer = Answer::yes;
  for (int i = 0; i < kHalvings && result_.t1 - miss > 1e-15 * std::fabs(end) && !tracker.exhausted(); ++i) {
    const double middle = miss + (result_.t1 - miss) / 2;
    (touching(tracker, middle) ? result_.t1 : miss) = middle;
  }
}

// Takes one step. Returns false if it was the last one, or if the budget has ended it.
bool ImpactSearch::advance(PairBudget& tracker) noexcept {
  if (!place(result_.t0)) {
    result_.finished = result_.refused = true;
    return false;
  }
  ++result_.steps;
  const double left = options_.end - result_.t0;
  Critical critical{without_turning()};
  const bool skip = critical.time > left / 64;
  bool all = true;
  if (!skip) {
    // A contact exactly at the end counts, so the limit is the next number above the remaining time.
    critical = Critical{std::nextafter(left, std::numeric_limits<double>::infinity())};
    all = find_critical(tracker, critical);
    critical.time = std::min(critical.time, critical.left_out);
  }
  const bool found = critical.triangle_first != kNoTriangle;
  if (skip ? critical.time > left : all && !found) {
    result_.answer = Answer::no;
    result_.t0 = options_.end;
    result_.finished = true;
    return false;
  }
  if (all && found) report(critical);
  // Within the tolerance, a few more steps distinguish a contact from a near miss.
  if (all && found && critical.distance <= limits_.margin + limits_.tolerance) {
    const double soon = critical.rate > 0 ? (critical.distance + limits_.finest) / critical.rate : left;
    if (++near_ > kFineSteps || critical.distance <= limits_.margin + limits_.finest) {
      soon_ = soon;
      return false;
    }
    soon_ = soon;
  }
  const double next = std::min(options_.end, result_.t0 + critical.time * kShorter);
  if (!(next > result_.t0)) {  // the step is too short to change the time
    result_.finished = all;
    return false;
  }
  result_.t0 = next;
  result_.distance = std::numeric_limits<double>::infinity();
  return all;
}

Impact ImpactSearch::run() noexcept {
  result_.t0 = options_.begin;
  const bool improper = !(options_.margin >= 0) || !(options_.end >= options_.begin) ||
                        std::isnan(options_.tolerance) || !std::isfinite(options_.begin) ||
                        !std::isfinite(options_.end);
  if (improper || !prepare()) {
    result_.finished = result_.refused = true;
    return result_;
  }
  PairBudget tracker(options_.budget);
  while (!result_.finished && !tracker.exhausted() && advance(tracker)) {
  }
  if (near_ > 0 && result_.answer == Answer::maybe) {
    find_contact(tracker);
    result_.finished = result_.answer == Answer::yes || !tracker.exhausted();
  }
  result_.work = tracker.spent();
  return result_;
}

}  // namespace detail

Impact time_of_impact(Workspace& workspace, const TreePair& pair, const Travel& a, const Travel& b,
                      const ImpactOptions& options) noexcept {
  return detail::ImpactSearch(workspace, pair, a, b, options).run();
}

}  // namespace orchard::runtime
