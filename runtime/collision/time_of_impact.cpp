// One search, whose steps share what it knows of both motions: hence more than 300 lines.
#include "orchard/runtime/time_of_impact.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "collision/kernels/ball_slab_time.h"
#include "collision/pair_query.h"
#include "collision/triangle_distance.h"
#include "collision/workspace_scratch.h"
#include "math/vector_functions.h"

namespace orchard::runtime {

using detail::along;
using detail::BallSlab;
using detail::cross;
using detail::dot;
using detail::minus;
using detail::Vec3;

namespace {

constexpr double kMinTolerance = 1e-9;  // of the bodies' size
constexpr double kRounding = 1e-12;     // of lengths in double
constexpr double kShorter = 1 - 1e-9;   // of a step: its own rounding
constexpr double kEnough = 0.5;         // of the earliest time found: what may meet later than that is not looked at
constexpr double kMaxQuantity = 1e18;   // of speeds and reaches, in the first tree's units: floats hold their products
constexpr int kFineSteps = 12;          // nearer than the tolerance
constexpr int kProbes = 24;             // for a contact after the last certified time
constexpr int kHalvings = 8;            // of the bracket

double length(const Vec3& v) noexcept { return std::sqrt(dot(v, v)); }

Vec3 turned_back(const Pose& pose, const Vec3& v) noexcept {
  const auto& r = pose.rotation;
  return {r[0] * v[0] + r[3] * v[1] + r[6] * v[2], r[1] * v[0] + r[4] * v[1] + r[7] * v[2],
          r[2] * v[0] + r[5] * v[1] + r[8] * v[2]};
}

// One body's motion in the first tree's frame as it is at one time.
struct Turn {
  Vec3 center{}, axis{};
  double spin = 0, turning = 0;
  // How fast a point so far from the centre comes closer along u at most.
  double rate(const Vec3& u, double reach) const noexcept {
    return (spin * (length(cross(axis, u)) + kRounding) + turning) * reach;
  }
  detail::Turning in_float() const noexcept {
    detail::Turning result;
    for (std::size_t i = 0; i < 3; ++i) {
      result.center[i] = static_cast<float>(center[i]), result.axis[i] = static_cast<float>(axis[i]);
    }
    result.spin = static_cast<float>(spin * (1 + 1e-6)), result.turning = static_cast<float>(turning * (1 + 1e-6));
    return result;
  }
};

// Of a point of the surface from the centre of rotation, at most.
double reach_of(const PreparedTree& tree, const Vec3& center) noexcept {
  const BallSlabBlock& root = tree.tree.ball_slabs[0];
  return (length(minus(center, {root.x[0], root.y[0], root.z[0]})) + double{root.radius[0]}) * (1 + kRounding);
}

struct Critical {     // triangles that could meet nearly first
  double time;        // nothing meets before
  double cut = time;  // what surely does not meet before is left out, and counts for `time` with what is known of it
  double distance = std::numeric_limits<double>::infinity();
  double rate = 0;
  Vec3 on_first{}, on_second{};
  std::uint32_t triangle_first = kNoTriangle, triangle_second = kNoTriangle;
  double left_out = std::numeric_limits<double>::infinity();
  // Whether what meets at that time at the earliest need not be looked at.
  bool leaves(double earliest) noexcept {
    if (earliest < cut) return false;
    left_out = std::min(left_out, earliest);
    return true;
  }
};

class Search {
 public:
  Search(Workspace& workspace, const TreePair& pair, const Travel& a, const Travel& b,
         const ImpactOptions& options) noexcept
      : workspace_(workspace), narrow_(query_of(workspace.narrow)), pair_(pair), a_(a), b_(b), options_(options) {}

  Impact run() noexcept;

 private:
  using Scratch = Workspace::Scratch;

  bool prepare() noexcept;
  bool place(double time) noexcept;
  bool find_critical(PairBudget& tracker, Critical& critical) noexcept;
  void expand(const Scratch::TimedPair& top, std::size_t& size, Critical& critical) noexcept;
  void compare_leaves(const Scratch::TimedPair& top, Critical& critical) noexcept;
  struct Speeds {  // of two leaves: how fast anything comes closer, and how far they reach from where they turn about
    double fastest, first_reach, second_reach;
  };
  void compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row,
                         const Speeds& speeds, Critical& critical) noexcept;
  double without_turning() const noexcept;
  void report(const Critical& critical) noexcept;
  void find_contact(PairBudget& tracker) noexcept;
  bool advance(PairBudget& tracker) noexcept;
  bool touching(PairBudget& tracker, double time) noexcept;
  const TreeView& first() const noexcept { return narrow_.first().tree; }
  const TreeView& second() const noexcept { return narrow_.second().tree; }

  Workspace& workspace_;
  PairQuery& narrow_;
  const TreePair& pair_;
  const Travel &a_, &b_;
  const ImpactOptions& options_;
  Impact result_;

  // At the time under way, in the first tree's units.
  Vec3 velocity_{};  // of the second one's centre less the first one's
  double speed_ = 0;
  Turn first_turn_, second_turn_;
  detail::Closing closing_;
  double margin_ = 0, tolerance_ = 0, finest_ = 0, error_ = 0;
  int near_ = 0;     // steps within the tolerance
  double soon_ = 0;  // a contact may be expected by then, from the last one
  std::array<float, 3> direction_{};
};

bool Search::prepare() noexcept {
  Scratch* const scratch = workspace_.scratch();
  narrow_.bind(pair_.a(), pair_.b());
  const TreeView &a = pair_.a().tree, &b = pair_.b().tree;
  return scratch != nullptr && !a.ball_slabs.empty() && !b.ball_slabs.empty() &&
         scratch->reserve_timed(pair_.a(), pair_.b());
}

// False where nothing can be said.
bool Search::place(double time) noexcept {
  if (!narrow_.place(a_.at(time), b_.at(time))) return false;
  const bool exchanged = narrow_.exchanged();
  const Travel &first = exchanged ? b_ : a_, &second = exchanged ? a_ : b_;
  const Pose& frame = narrow_.first_pose();
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
  first_turn_ = turn_of(first), second_turn_ = turn_of(second);
  first_turn_.center = minus(first.center, this->first().origin);
  second_turn_.center = transform(narrow_.relative(), minus(second.center, this->second().origin));
  velocity_ = minus(velocity_of(second), velocity_of(first));
  speed_ = speed_of(first) + speed_of(second);

  const PreparedTree &p = narrow_.first(), &q = narrow_.second();
  const double scale = narrow_.relative().scale, size = p.extent + q.extent * scale;
  const double reach =
      reach_of(p, first_turn_.center) + scale * reach_of(q, minus(second.center, this->second().origin));
  const double fastest =
      length(velocity_) + speed_ + (first_turn_.spin + first_turn_.turning + second_turn_.spin + second_turn_.turning);
  if (!(fastest <= kMaxQuantity && reach <= kMaxQuantity && fastest * reach <= kMaxQuantity * kMaxQuantity))
    return false;
  if (!(speed_ >= 0 && first_turn_.turning >= 0 && second_turn_.turning >= 0)) return false;
  error_ = narrow_.exact_error() * shrink + kRounding * size;
  margin_ = options_.margin * shrink;
  finest_ = std::max(kMinTolerance * size, 4 * error_);
  tolerance_ = std::max(options_.tolerance * shrink, finest_);
  for (std::size_t i = 0; i < 3; ++i) closing_.velocity[i] = static_cast<float>(velocity_[i]);
  closing_.speed = static_cast<float>((speed_ + 1e-6 * length(velocity_)) * (1 + 1e-6));
  closing_.first = first_turn_.in_float(), closing_.second = second_turn_.in_float();
  return true;
}

// Until when the balls in which the bodies turn, whatever way, do not meet.
double Search::without_turning() const noexcept {
  const double scale = narrow_.relative().scale;
  const Vec3 way = minus(second_turn_.center, first_turn_.center);
  const double distance = length(way);
  const auto &p = narrow_.first(), &q = narrow_.second();
  const bool exchanged = narrow_.exchanged();
  const Vec3 center = minus((exchanged ? a_ : b_).center, q.tree.origin);
  const double gap =
      distance * (1 - kRounding) - reach_of(p, first_turn_.center) - scale * reach_of(q, center) - margin_ - error_;
  if (!(gap > 0)) return 0;
  // The direction is fixed, so this holds for balls that pass each other, too.
  const double rate = speed_ - dot(velocity_, way) / distance + kRounding * length(velocity_);
  return rate > 0 ? gap / rate : std::numeric_limits<double>::infinity();
}

// When triangles can meet first, within what is left of the time. False if the budget ends before all was looked at:
// critical.time then holds for what was left, too.
bool Search::find_critical(PairBudget& tracker, Critical& critical) noexcept {
  Scratch& scratch = *workspace_.scratch();
  Scratch::TimedPair* const stack = scratch.timed.get();
  std::size_t size = 0;
  stack[size++] = {0, 0, 0, detail::moved(detail::ball_slab_at(second().ball_slabs[0], 0), narrow_.placement())};
  while (size > 0) {
    if (tracker.exhausted()) {
      for (std::size_t i = 0; i < size; ++i)
        critical.time = std::min(critical.time, std::max(0.0, double{stack[i].time}));
      return false;
    }
    const Scratch::TimedPair top = stack[--size];
    if (critical.leaves(double{top.time})) continue;
    const std::uint32_t a = detail::ball_slab_child(first(), top.a), b = detail::ball_slab_child(second(), top.b);
    if (a & b & kLeafBit) {
      compare_leaves(top, critical);
      tracker.spend(std::uint64_t{kLeafPairTests} * kTriangleTestCost);
    } else {
      expand(top, size, critical);
      tracker.spend(kBlockWidth);
    }
  }
  return true;
}

// In place of a pair, those of its children that may meet in time, the earliest last.
void Search::expand(const Scratch::TimedPair& top, std::size_t& size, Critical& critical) noexcept {
  Scratch::TimedPair* const stack = workspace_.scratch()->timed.get();
  const detail::Placement& placement = narrow_.placement();
  const std::uint32_t a = detail::ball_slab_child(first(), top.a), b = detail::ball_slab_child(second(), top.b);
  const BallSlabBlock& own = first().ball_slabs[top.a / kBlockWidth];
  const std::uint32_t own_lane = top.a % kBlockWidth;
  const bool open_second = (a & kLeafBit) != 0 || ((b & kLeafBit) == 0 && own.radius[own_lane] < top.second.radius);
  const std::uint32_t block = open_second ? b : a;
  const auto margin = static_cast<float>((double{placement.margin} + margin_) * (1 + 1e-6));
  detail::BallSlabTimes times;
  if (open_second) {
    detail::ball_slab_times(detail::ball_slab_at(own, own_lane), second().ball_slabs[block], &placement, closing_,
                            margin, times);
  } else {
    detail::ball_slab_times(top.second, first().ball_slabs[block], nullptr, closing_, margin, times);
  }
  const std::size_t begin = size;
  for (std::uint32_t left = times.used; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    const float time = top.time > 0 ? std::max(times.time[lane], top.time) : times.time[lane];
    if (critical.leaves(double{time})) continue;
    std::size_t at = size++;
    for (; at > begin && stack[at - 1].time < time; --at) stack[at] = stack[at - 1];
    const std::uint32_t node = block * kBlockWidth + lane;
    stack[at] = open_second ? Scratch::TimedPair{time, top.a, node, times.slab(lane)}
                            : Scratch::TimedPair{time, node, top.b, top.second};
  }
}

void Search::compare_leaves(const Scratch::TimedPair& top, Critical& critical) noexcept {
  const TriangleBlock& lanes = first().triangle_blocks[detail::ball_slab_child(first(), top.a) & ~kLeafBit];
  const TriangleBlock& rows = second().triangle_blocks[detail::ball_slab_child(second(), top.b) & ~kLeafBit];
  const BallSlab p = detail::ball_slab_at(first().ball_slabs[top.a / kBlockWidth], top.a % kBlockWidth);
  const auto reach = [](const BallSlab& slab, const Vec3& center) {
    const Vec3 from = minus({slab.x, slab.y, slab.z}, center);
    return (length(from) + double{slab.radius}) * (1 + 1e-5);
  };
  const double first_reach = reach(p, first_turn_.center), second_reach = reach(top.second, second_turn_.center);
  const double fastest = length(velocity_) + speed_ + (first_turn_.spin + first_turn_.turning) * first_reach +
                         (second_turn_.spin + second_turn_.turning) * second_reach;
  // Before that no gap closes, whatever its direction.
  const auto earliest = [&](float lower) {
    const double gap = double{lower} - margin_;
    return gap > 0 ? gap / (fastest * (1 + kRounding)) : 0;
  };
  const double reach_in_time = fastest * (1 + kRounding) * critical.cut + margin_;
  detail::TriangleGaps gaps;
  detail::triangle_gaps(lanes, rows, narrow_.placement(), direction_,
                        static_cast<float>(std::min(reach_in_time * (1 + 1e-6), 1e30)), gaps);
  // The nearest first: each makes fewer of the others worth a look.
  std::array<std::uint8_t, std::size_t{kBlockWidth} * kBlockWidth> order;
  std::size_t count = 0;
  const auto lower_of = [&](std::uint8_t i) { return gaps.lower[i / kBlockWidth][i % kBlockWidth]; };
  for (std::uint32_t row = 0; row < kBlockWidth && rows.triangle[row] != kNoTriangle; ++row) {
    for (std::uint32_t lane = 0; lane < kBlockWidth && lanes.triangle[lane] != kNoTriangle; ++lane) {
      const float lower = gaps.lower[row][lane];
      if (critical.leaves(earliest(lower))) continue;
      std::size_t at = count++;
      for (; at > 0 && lower_of(order[at - 1]) > lower; --at) order[at] = order[at - 1];
      order[at] = static_cast<std::uint8_t>(kBlockWidth * row + lane);
    }
  }
  for (std::size_t i = 0; i < count && !critical.leaves(earliest(lower_of(order[i]))); ++i) {
    compare_triangles(lanes, order[i] % kBlockWidth, rows, order[i] / kBlockWidth, {fastest, first_reach, second_reach},
                      critical);
  }
}

void Search::compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows,
                               std::uint32_t row, const Speeds& speeds, Critical& critical) noexcept {
  const detail::TrianglePoints a = detail::points_of(lanes, lane),
                               b = detail::moved_points_of(rows, row, narrow_.relative());
  const detail::NearestPoints nearest = detail::nearest_points(a, b);
  const Vec3 way = minus(nearest.on_b, nearest.on_a);
  const double size = length(way);
  double gap = -1, rate = speeds.fastest;
  if (size > 0) {
    const Vec3 u = along({0, 0, 0}, way, 1 / size);
    const auto [low, high] = std::pair(std::min({dot(u, b[0]), dot(u, b[1]), dot(u, b[2])}),
                                       std::max({dot(u, a[0]), dot(u, a[1]), dot(u, a[2])}));
    gap = low - high - margin_ - error_;
    rate = speed_ - dot(velocity_, u) + first_turn_.rate(u, speeds.first_reach) +
           second_turn_.rate(u, speeds.second_reach) + kRounding * speeds.fastest;
  }
  const double time = gap > 0 ? (rate > 0 ? gap / rate : std::numeric_limits<double>::infinity()) : 0;
  if (time >= critical.time) return;
  critical = {time,
              kEnough * time,
              nearest.distance,
              rate,
              nearest.on_a,
              nearest.on_b,
              lanes.triangle[lane],
              rows.triangle[row],
              critical.left_out};
  if (gap <= 0 && detail::triangles_intersect(a, b, &critical.on_first)) {
    critical.distance = 0, critical.on_second = critical.on_first;
  }
  for (std::size_t i = 0; i < 3; ++i) direction_[i] = size > 0 ? static_cast<float>(way[i] / size) : 0;
}

void Search::report(const Critical& critical) noexcept {
  if (critical.triangle_first == kNoTriangle) return;
  const Pose& frame = narrow_.first_pose();
  const auto world = [&](const Vec3& p) { return transform(frame, along(p, first().origin, 1)); };
  result_.distance = critical.distance * frame.scale * (1 + kRounding) + narrow_.exact_error();
  result_.on_a = world(critical.on_first), result_.on_b = world(critical.on_second);
  result_.triangle_a = critical.triangle_first, result_.triangle_b = critical.triangle_second;
  if (!narrow_.exchanged()) return;
  std::swap(result_.on_a, result_.on_b);
  std::swap(result_.triangle_a, result_.triangle_b);
}

// False where the budget ends it.
bool Search::touching(PairBudget& tracker, double time) noexcept {
  if (tracker.exhausted()) return false;
  const std::uint64_t left = options_.budget.work - tracker.spent();
  const Answer answer = closer_within(workspace_, pair_, {a_.at(time), b_.at(time)}, options_.margin, {left});
  tracker.spend(options_.margin > 0 ? workspace_.distance.work() : query_of(workspace_.narrow).work());
  return answer == Answer::yes;
}

// From a time at which they nearly touch: when they do, if they do soon.
void Search::find_contact(PairBudget& tracker) noexcept {
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

// One step. False where there is none left, or the budget ended it.
bool Search::advance(PairBudget& tracker) noexcept {
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
    // What happens exactly at the end counts: one more than what is left.
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
  // Nearer than asked for, a few more steps tell a contact from a near miss.
  if (all && found && critical.distance <= margin_ + tolerance_) {
    const double soon = critical.rate > 0 ? (critical.distance + finest_) / critical.rate : left;
    if (++near_ > kFineSteps || critical.distance <= margin_ + finest_) {
      soon_ = soon;
      return false;
    }
    soon_ = soon;
  }
  const double next = std::min(options_.end, result_.t0 + critical.time * kShorter);
  if (!(next > result_.t0)) {  // no time left between two numbers
    result_.finished = all;
    return false;
  }
  result_.t0 = next;
  result_.distance = std::numeric_limits<double>::infinity();
  return all;
}

Impact Search::run() noexcept {
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

}  // namespace

Impact time_of_impact(Workspace& workspace, const TreePair& pair, const Travel& a, const Travel& b,
                      const ImpactOptions& options) noexcept {
  return Search(workspace, pair, a, b, options).run();
}

}  // namespace orchard::runtime
