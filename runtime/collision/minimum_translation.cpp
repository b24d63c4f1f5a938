#include "collision/minimum_translation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "collision/support_map.h"
#include "collision/triangle_cut.h"
#include "math/vector_functions.h"
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime::detail {
namespace {

using Cut = Workspace::Scratch::Cut;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxAdvances = 512;  // along one direction
constexpr int kMet = 3;          // triangles that are looked at in one place, since the last of many takes long to find
constexpr double kClear = 0.25;  // of a nudge: more than what rounding does to poses
constexpr double kRounded = 64;  // nudges: a way that is no longer is rounding, and so would be a shorter one
constexpr double kGain = 1e-6;   // less is no gain
constexpr double kSame = 1 - 1e-9;            // cosine of directions that count as one
constexpr std::uint64_t kTestsPerShifts = 4;  // of the walk, that take as long as MeetingShifts
constexpr double kWayRounding = 1e-12;        // of the bodies' size: the rounding of shifts

// A point of a piece in the frame of a box, and how it moves there for each unit of the way of the second body.
struct MovingPoint {
  Vec3 start, velocity;

  MovingPoint(const MinimumTranslationSearch& search, const SolidBox& solid, const Pose& back, const Vec3& u,
              const Vec3& piece) noexcept {
    const PlacedPair& pair = search.pair;
    const Vec3 first_origin = pair.first.tree.origin, second_origin = pair.second.tree.origin;
    if (solid.is_first) {
      start = Vec3(transform(pair.relative, piece - second_origin)) + first_origin;
      velocity = u;
    } else {
      start = Vec3(transform(back, piece - first_origin)) + second_origin;
      velocity = -back.scale * Vec3(rotate(back, u));
    }
  }
  bool is_inside(const Vec3& half, double at) const noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(std::fabs(start[i] + at * velocity[i]) <= half[i])) return false;
    }
    return true;
  }
  double leaves(const Vec3& half) const noexcept {
    double first = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      if (velocity[i] == 0) continue;
      first = std::min(first, ((velocity[i] > 0 ? half[i] : -half[i]) - start[i]) / velocity[i]);
    }
    return first;
  }
};

// When the last of the pieces that are inside boxes at `at` has left them by its point, or minus infinity if there is
// none.
double leaves_boxes(const MinimumTranslationSearch& search, const Vec3& u, double at) noexcept {
  double last = -std::numeric_limits<double>::infinity();
  for (const SolidBox& solid : search.solids) {
    const Pose back = inverse(search.pair.relative);
    for (const Vec3& piece : solid.pieces) {
      const MovingPoint point(search, solid, back, u, piece);
      if (point.is_inside(solid.half, at)) last = std::max(last, point.leaves(solid.half));
    }
  }
  return last;
}

// How far a shift can grow between the planes of the two triangles: no less than while these meet.
double exit_of(const std::array<ShiftPlanes, 2>& faces, const Vec3& u, double slack) noexcept {
  return std::min(faces[0].exit(u, slack), faces[1].exit(u, slack));
}

// The triangles that meet after a part of a way, as far as some of them can move on together. Ends at the first pair
// that can do so to `limit` of the way.
struct Meeting {
  bool any = false;
  bool clear = true;  // those that do not meet are farther apart than rounding
  double farthest = -kInfinity;
  Vec3 normal;
};

Meeting meeting_at(const MinimumTranslationSearch& search, const Vec3& u, double at, double limit) noexcept {
  const PlacedPair ahead = search.pair.moved(at * u);
  Meeting meeting;
  meeting.normal = u;
  int met = 0;
  walk_candidates(ahead, search.room,
                  [&](const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row) {
                    const TrianglePoints a = points_of(lanes, lane), b = moved_points_of(rows, row, ahead.relative);
                    if (!meeting.any && are_parted_by(a, b, kClear * search.nudge)) return false;
                    if (!triangles_intersect(a, b, nullptr)) return meeting.clear = false;
                    meeting.any = true;
                    const std::array<ShiftPlanes, 2> faces = face_planes(a, b);
                    if (exit_of(faces, u, kWayRounding * search.size) <= meeting.farthest) return false;
                    search.room.work += kTestsPerShifts;
                    const MeetingShifts::Exit exit = MeetingShifts(a, b).exit(u, meeting.farthest);
                    if (exit.way > meeting.farthest) meeting.farthest = exit.way, meeting.normal = exit.normal;
                    return at + exit.way >= limit || ++met == kMet;
                  });
  return meeting;
}

// What the triangles that meet now tell about directions, without a look at any others.
class Obstacles {
 public:
  explicit Obstacles(const MinimumTranslationSearch& search) noexcept
      : room_(search.room), cuts_(search.cuts), slack_(kWayRounding * search.size) {}

  // How far all of them are left behind, and what the last one is left at. Ends once that is `enough`.
  MeetingShifts::Exit exit(const Vec3& u, double enough) noexcept {
    MeetingShifts::Exit last{0, u};
    for (std::size_t i = 0; i < cuts_.size() && last.way < enough; ++i) {
      if (exit_of(cuts_[i].faces, u, slack_) <= last.way) continue;
      const MeetingShifts::Exit exit = shifts_of(i).exit(u, last.way);
      if (exit.way > last.way) last = exit;
    }
    return last;
  }

  // Whether one of them is in the way of all directions, and often is among the first.
  bool block_all(double limit) noexcept {
    constexpr std::size_t kFirst = 8;
    for (std::size_t i = 0; i < std::min(kFirst, kept()); ++i) {
      if (shifts_of(i).shortest() >= limit) return true;
    }
    return false;
  }

  bool block(const Vec3& u, double limit) noexcept {
    if (!std::isfinite(limit)) return false;
    for (std::size_t i = 0; i < cuts_.size(); ++i) {
      if (exit_of(cuts_[i].faces, u, slack_) >= limit && shifts_of(i).contain(u, limit)) return true;
    }
    return false;
  }

  std::size_t kept() const noexcept { return std::min(kKept, cuts_.size()); }
  const MeetingShifts& shifts_of(std::size_t i) noexcept {
    if (i < kKept && known_[i]) return shifts_[i];
    room_.work += kTestsPerShifts;
    if (i < kKept) known_[i] = true;
    return (i < kKept ? shifts_[i] : other_) = MeetingShifts(cuts_[i].first, cuts_[i].second);
  }

 private:
  static constexpr std::size_t kKept = 32;

  WalkStack& room_;
  std::span<const Cut> cuts_;
  double slack_;
  std::array<MeetingShifts, kKept> shifts_;
  std::array<bool, kKept> known_{};
  MeetingShifts other_;
};

// To where the bodies' extents along a direction part, or some 1 % of the bodies beyond: always an end, seldom the
// first one.
double way_past(const MinimumTranslationSearch& search, const Vec3& u) noexcept {
  const Pose& relative = search.pair.relative;
  const Pose back = inverse(Pose{.rotation = relative.rotation});
  const double reach = reach_along(search.pair.first.tree.supports, u) +
                       reach_along(search.pair.second.tree.supports, rotate(back, -u)) * relative.scale;
  return std::max(0.0, reach - dot(u, relative.translation));
}

// The same by the triangles.
double exact_way_past(const MinimumTranslationSearch& search, const Vec3& u) noexcept {
  const TreeView &first = search.pair.first.tree, &second = search.pair.second.tree;
  const Pose &relative = search.pair.relative, back = inverse(Pose{.rotation = relative.rotation});
  const double reach =
      -deepest_point(first, {.translation = -Vec3(first.origin)}, -u, 0).distance -
      deepest_point(second, {.translation = -Vec3(second.origin)}, rotate(back, u), 0).distance * relative.scale;
  return std::max(0.0, reach - dot(u, relative.translation)) + kWayRounding * search.size + search.nudge;
}

// The corners of a grid on a cube: 98 directions, at most 27 degrees from each other.
template <typename Visit>
void each_direction_around(Visit&& visit) noexcept {
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const Vec3 v = {double(x), double(y), double(z)};
        if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == 2) visit((1 / length(v)) * v);
      }
    }
  }
}

// Directions in the order of what is known of their ways: first as long as the triangles that meet now take, then
// longer by what else gets in the way, until a way is free and no other one can be shorter.
class WaySearch {
 public:
  WaySearch(const MinimumTranslationSearch& search, std::uint32_t refinements) noexcept
      : search_(search),
        obstacles_(search),
        refinements_(refinements),
        last_listing_(search.room.work / 2 + search.work / 2) {}

  const MinimumTranslation& best() const noexcept { return best_; }
  Obstacles& obstacles() noexcept { return obstacles_; }
  void limit_to(double way) noexcept { limit_ = std::min(limit_, way); }

  // Lists a direction.
  void add(const Vec3& direction) noexcept {
    Plane plane;
    list(direction, plane);
  }

  // Lists a direction and the ways across what is in the way of it.
  void add_with_refinements(const Vec3& direction) noexcept {
    Vec3 next = direction;
    Plane before{};
    for (std::uint32_t i = 0; i <= refinements_; ++i) {
      Plane plane;
      if (!list(next, plane)) return;
      if (i > 0) add(past_both(plane, before));
      next = plane.normal, before = plane;
    }
  }

  void settle() noexcept {
    for (bool first = true; count_ > 0 && (first || search_.room.work < search_.work); first = false) {
      std::pop_heap(listed_.begin(), listed_.begin() + static_cast<std::ptrdiff_t>(count_), longer);
      Listed next = listed_[--count_];
      if (next.way >= limit_) {
        count_ = 0;
        return;
      }
      advance(next);
    }
  }

 private:
  struct Listed {
    Vec3 u;
    double way;
    Vec3 normal;
    double nudge;
    int advances = 0;
  };
  struct Plane {  // that a direction is left at: no shorter way leads past it
    Vec3 normal;
    double height;
  };
  static bool longer(const Listed& a, const Listed& b) noexcept { return a.way > b.way; }

  bool list(const Vec3& direction, Plane& plane) noexcept {
    const double size = length(direction);
    if (!(size > 0) || search_.room.work >= last_listing_) return false;
    search_.room.work += 1 + search_.cuts.size() / kCutsPerTest;
    const Vec3 u = (1 / size) * direction;
    for (std::size_t i = 0; i < tried_count_; ++i) {
      if (dot(tried_[i], u) > kSame) return false;
    }
    tried_[tried_count_ < tried_.size() ? tried_count_++ : tried_.size() - 1] = u;
    const MeetingShifts::Exit exit = obstacles_.exit(u, limit_);
    if (exit.way >= limit_) return false;
    push({u, exit.way, exit.normal, search_.nudge});
    plane = {exit.normal, exit.way * dot(exit.normal, u)};
    return true;
  }

  void push(const Listed& listed) noexcept {
    if (count_ == listed_.size()) return;
    listed_[count_++] = listed;
    std::push_heap(listed_.begin(), listed_.begin() + static_cast<std::ptrdiff_t>(count_), longer);
  }

  // One step along a direction, to where what is in the way there has been left.
  void advance(Listed next) noexcept {
    const double at = next.way + next.nudge;
    const Meeting meeting = meeting_at(search_, next.u, at, limit_);
    const double further = meeting.any ? at + meeting.farthest : leaves_boxes(search_, next.u, at);
    if (!meeting.any && further < 0) {  // the way includes the nudge, since only there it is known to have ended
      best_ = {next.u, at, next.normal, true, meeting.clear};
      limit_ = at * (1 - kGain);
      if (refinements_ > 0) add_with_refinements(next.normal);
      return;
    }
    if (further >= limit_ || ++next.advances == kMaxAdvances) return;
    if (further > at) {
      next.way = further, next.nudge = search_.nudge;
      if (meeting.any) next.normal = meeting.normal;
    } else {
      next.nudge *= 4;  // they touch but for rounding
    }
    push(next);
  }

  // The shortest way that reaches two planes; 0 of parallel ones.
  static Vec3 past_both(const Plane& p, const Plane& q) noexcept {
    const double c = dot(p.normal, q.normal), across = 1 - c * c;
    if (!(across > 1e-9)) return {};
    return ((p.height - c * q.height) / across) * p.normal + ((q.height - c * p.height) / across) * q.normal;
  }

  static constexpr std::size_t kCutsPerTest = 8;  // that take as long to look at as a test of the walk

  const MinimumTranslationSearch& search_;
  Obstacles obstacles_;
  std::uint32_t refinements_;
  std::uint64_t last_listing_;  // work of the walk from which on no direction is listed any more
  MinimumTranslation best_{{}, kInfinity, {}, false};
  double limit_ = kInfinity;  // of ways that count
  std::array<Listed, 192> listed_;
  std::size_t count_ = 0;
  std::array<Vec3, 64> tried_{};
  std::size_t tried_count_ = 0;
};

// Whether a way is so long, beside the smaller body or beside the curves in which the surfaces cut each other, that a
// shorter one is likely to lead elsewhere.
bool is_doubtful(const MinimumTranslationSearch& search, double way) noexcept {
  constexpr double kDeep = 0.01, kBeyondContact = 2;
  const PlacedPair& pair = search.pair;
  if (way > kDeep * std::min(pair.first.radius, pair.second.radius * pair.relative.scale)) return true;
  double square = 0;
  for (const Cut& cut : search.cuts) {
    for (const Vec3& p : {cut.p, cut.q}) {
      const Vec3 from = minus(p, search.cuts[0].p);
      square = std::max(square, dot(from, from));
    }
  }
  return way * way > kBeyondContact * kBeyondContact * square;
}

// For any way shorter than a doubtful one, else for one that is shorter by far.
void look_around(const MinimumTranslationSearch& search, WaySearch& ways) noexcept {
  constexpr double kShorterByFar = 0.85;
  const MinimumTranslation first = ways.best();
  const bool doubtful = !first.ended || is_doubtful(search, first.way);
  const double limit = doubtful ? first.way : kShorterByFar * first.way;
  Obstacles& obstacles = ways.obstacles();
  if (!doubtful && obstacles.block_all(limit)) return;
  ways.limit_to(limit);
  for (std::size_t i = 0; i < obstacles.kept() && doubtful; ++i) {
    const Vec3 way = obstacles.shifts_of(i).shortest_way_out();
    if (length(way) < limit) ways.add(way);
  }
  each_direction_around([&](const Vec3& u) {
    if (!obstacles.block(u, limit)) ways.add(u);
  });
  ways.settle();
}

// The shortest way to where the bodies' extents part, along one of the directions or of a grid of them.
MinimumTranslation shortest_past(const MinimumTranslationSearch& search, std::span<const Vec3> directions) noexcept {
  Vec3 nearest = directions[0];
  double least = kInfinity;
  each_direction_around([&](const Vec3& u) {
    if (const double way = way_past(search, u); way < least) least = way, nearest = u;
  });
  MinimumTranslation past{nearest, exact_way_past(search, nearest), nearest, false};
  for (const Vec3& u : directions) {
    if (const double way = exact_way_past(search, u); way < past.way) past = {u, way, u, false};
  }
  return past;
}

}  // namespace

const Vec3* piece_inside(const MinimumTranslationSearch& search, const SolidBox& solid) noexcept {
  const Pose back = inverse(search.pair.relative);
  for (const Vec3& piece : solid.pieces) {
    if (MovingPoint(search, solid, back, {0, 0, 0}, piece).is_inside(solid.half, 0)) return &piece;
  }
  return nullptr;
}

MinimumTranslation minimum_translation(const MinimumTranslationSearch& search, std::span<const Vec3> directions,
                                       std::uint32_t refinements) noexcept {
  WaySearch ways(search, refinements);
  for (const Vec3& direction : directions) ways.add_with_refinements(direction);
  ways.settle();
  const bool is_rounding = ways.best().ended && ways.best().way <= kRounded * search.nudge;
  if (refinements > 0 && !is_rounding) look_around(search, ways);
  return ways.best().ended ? ways.best() : shortest_past(search, directions);
}

}  // namespace orchard::runtime::detail
