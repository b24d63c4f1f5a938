#include "detector/sweep.h"

#include <algorithm>

#include "math/vector_functions.h"

namespace orchard::runtime::detail {
namespace {

// The distance below which two parts are probed for a contact, relative to the smaller of their radii that is above 0.
constexpr double kCloseness = 1e-5;
constexpr int kMaxSteps = 512;  // towards a half-space
// How far a search moves on if it cannot distinguish a graze from a contact: kSkip times the distance above at first,
// and kSkipGrowth times as far each further time. The first move is at least kMinSkip and at most kMaxSkip of the way.
constexpr double kSkip = 4;
constexpr double kSkipGrowth = 4;
constexpr double kMinSkip = 1e-9;
constexpr double kMaxSkip = 1.0 / 64;
constexpr double kSpeedRounding = 1e-9;  // relative to speeds

// Returns the radius of a round shape, including the rounding of its segment, whose tree has floats; otherwise 0.
double margin_of(const PlacedPart& part) noexcept {
  const Shape& shape = *part.shape;
  return shape.kind == ShapeKind::round ? (shape.radius + shape.tree.vertex_error) * part.pose().scale : 0;
}

// Returns an upper bound on the speed of the points of a part.
double speed_of(const Travel& travel, double reach) noexcept {
  return (length(Vec3(travel.velocity)) + length(Vec3(travel.spin)) * reach) * (1 + kSpeedRounding);
}

bool can_travel(const PlacedPart& from, const PlacedPart& to) noexcept {
  return from.rigid && to.rigid && is_rigid(from.pose()) && is_rigid(to.pose()) && from.pose().scale == to.pose().scale;
}

Travel travel_of(const PlacedPart& from, const PlacedPart& to) noexcept {
  return travel_between(from.pose(), to.pose(), from.shape->center);
}

// Returns the verdict about two parts at the time of an impact.
Verdict touch_at(Workspace& workspace, const PartPair& pair, const Impact& impact, std::uint64_t most,
                 std::uint64_t& work) noexcept {
  Verdict verdict;
  if (work < most) verdict = answer_exactly(query_of(workspace.narrow), pair, work, most);
  if (verdict.answer == Answer::yes) return verdict;
  // The exact test does not confirm the contact, because of rounding or the end of the budget. The search has its
  // place.
  const Vec3 way = Vec3(impact.on_b) - Vec3(impact.on_a);
  const double size = length(way);
  return {.answer = Answer::yes,
          .contact = {.center = impact.on_a,
                      .normal = size > 0 ? (1 / size) * way : Vec3{0, 0, 1},
                      .triangle_a = impact.triangle_a,
                      .triangle_b = impact.triangle_b}};
}

// Sweeps two shapes that have trees or, if they are round, are around the tree of a segment.
Swept sweep_trees(Workspace& workspace, const PartPair& from, const PartPair& to, std::uint64_t most,
                  std::uint64_t& work) noexcept {
  Swept result;
  const Travel a = travel_of(from.a, to.a), b = travel_of(from.b, to.b);
  const double speed = speed_of(a, from.a.reach) + speed_of(b, from.b.reach);
  if (speed == 0) return result;
  // A box is solid, so a shape that lies wholly in it touches it, although the surfaces are apart.
  if (from.a.shape->kind == ShapeKind::box || from.b.shape->kind == ShapeKind::box) {
    result.verdict = answer_exactly(query_of(workspace.narrow), from, work, most);
    result.answer = result.verdict.answer;
    if (result.answer != Answer::no) return result.to = 0, result;
  }
  ImpactOptions options;
  options.margin = margin_of(from.a) + margin_of(from.b);
  const auto [smaller, larger] = std::minmax(from.a.reach, from.b.reach);
  options.tolerance = kCloseness * (smaller > 0 ? smaller : larger);
  double skip = std::clamp(kSkip * options.tolerance / speed, kMinSkip, kMaxSkip);
  const TreePair pair(from.a.shape->prepared, from.b.shape->prepared);
  result.answer = Answer::maybe;
  for (bool certain = true; work < most; certain = false, skip *= kSkipGrowth) {
    work += kPairWork;
    options.budget.work = most - std::min(work, most);
    const Impact impact = time_of_impact(workspace, pair, a, b, options);
    work += impact.work;
    if (certain) result.from = impact.t0;
    if (impact.answer == Answer::yes) {
      PartPair now = from;
      now.a.move_to(a.at(impact.t1)), now.b.move_to(b.at(impact.t1));
      result.answer = Answer::yes;
      result.to = impact.t1;
      result.verdict = touch_at(workspace, now, impact, most, work);
      return result;
    }
    if (impact.answer == Answer::no && certain) result.answer = Answer::no;
    // The parts are so near that rounding decides. The search goes on later, when they may be nearer still.
    options.begin = impact.t0 + skip;
    if (impact.answer == Answer::no || !impact.finished || impact.refused || !(options.begin < options.end)) break;
  }
  return result;
}

// Sweeps a part to a half-space. The height over the plane shrinks no faster than the centre sinks, plus the speed at
// which points that turn about the centre sink.
Swept sweep_to_half_space(Workspace& workspace, const PartPair& from, const PartPair& to, std::uint64_t most,
                          std::uint64_t& work) noexcept {
  Swept result;
  const Travel travel = travel_of(from.a, to.a);
  const HalfSpace& half = from.b.shape->half;
  const Vec3& normal = half.normal;
  const double speed = speed_of(travel, from.a.reach), near = kCloseness * from.a.reach;
  if (speed == 0) return result;
  const double turn = from.a.shape->kind == ShapeKind::round && from.a.shape->p == from.a.shape->q
                          ? 0
                          : length(cross(Vec3(travel.spin), normal)) * from.a.reach;
  const double sinking = turn - dot(Vec3(travel.velocity), normal) + kSpeedRounding * speed;
  PartPair now = from;
  double time = 0;
  bool certain = true;
  for (int step = 0; step < kMaxSteps && work < most; ++step) {
    now.a.move_to(travel.at(time));
    work += kSimplePairWork;
    const double gap = half_space_distance(*now.a.shape, now.a.pose(), half);
    if (gap <= near) {
      const Verdict verdict = answer_exactly(query_of(workspace.narrow), now, work, most);
      if (verdict.answer == Answer::yes) {
        if (certain) result.from = time;
        result.answer = Answer::yes;
        result.to = time;
        result.verdict = verdict;
        return result;
      }
    }
    if (gap < near && certain) {
      certain = false;
      result.from = time;
    }
    if (time >= 1 || (gap >= near && !(sinking * (1 - time) >= gap))) {
      result.answer = certain ? Answer::no : Answer::maybe;
      return result;
    }
    time = std::min(1.0, time + (gap >= near ? gap / sinking : near / speed));
  }
  if (certain) result.from = time;
  result.answer = Answer::maybe;
  return result;
}

}  // namespace

Swept sweep(Workspace& workspace, const PartPair& from, const PartPair& to, std::uint64_t most,
            std::uint64_t& work) noexcept {
  if (!can_travel(from.a, to.a) || !can_travel(from.b, to.b)) return {.answer = Answer::maybe};
  return from.with_half_space() ? sweep_to_half_space(workspace, from, to, most, work)
                                : sweep_trees(workspace, from, to, most, work);
}

}  // namespace orchard::runtime::detail
