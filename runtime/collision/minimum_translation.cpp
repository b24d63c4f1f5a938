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
constexpr int kMaxAdvances = 512;   // the number of steps along one direction
constexpr int kMet = 3;             // the number of pairs examined in one place: to find the last of many takes long
constexpr double kClear = 0.25;     // a fraction of a nudge, above the rounding error of poses
constexpr double kRounded = 64;     // in nudges: a way that is no longer is a matter of rounding
constexpr double kGain = 1e-6;      // the fraction by which a way has to be shorter to replace the best one
constexpr double kSame = 1 - 1e-9;  // the cosine of directions that count as the same
constexpr std::uint64_t kTestsPerShifts = 4;  // so many tests of the walk take as long as MeetingShifts
constexpr double kWayRounding = 1e-12;        // relative to the bodies' size: the rounding error of shifts

// A point of a piece of a surface, in the frame of a box, and its velocity there per unit of the second body's way.
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

// Returns the way after which the last piece has left its box, of the pieces whose points are inside boxes at `at`.
// Returns minus infinity if there is none.
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

// Returns how far a shift along u can go until it leaves the planes of both triangles: an upper bound on the way after
// which they still meet.
double exit_of(const std::array<ShiftPlanes, 2>& faces, const Vec3& u, double slack) noexcept {
  return std::min(faces[0].exit(u, slack), faces[1].exit(u, slack));
}

// The triangles that meet after a part of a way, and how far the second body can go on until they part.
struct Meeting {
  bool any = false;
  bool clear = true;  // if none meet: all are farther apart than rounding could close
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

// The triangles that meet at the present place. They give lower bounds on ways without a search for others.
class Obstacles {
 public:
  explicit Obstacles(const MinimumTranslationSearch& search) noexcept
      : room_(search.room), cuts_(search.cuts), slack_(kWayRounding * search.size) {}

  // Returns the way along u after which none of them meet, and the normal at which the last pair parts. It may stop at
  // a way of at least `enough`.
  MeetingShifts::Exit exit(const Vec3& u, double enough) noexcept {
    MeetingShifts::Exit last{0, u};
    for (std::size_t i = 0; i < cuts_.size() && last.way < enough; ++i) {
      if (exit_of(cuts_[i].faces, u, slack_) <= last.way) continue;
      const MeetingShifts::Exit exit = shifts_of(i).exit(u, last.way);
      if (exit.way > last.way) last = exit;
    }
    return last;
  }

  // Returns whether one of the first eight pairs alone makes ways in all directions at least `limit` long. Such a pair
  // is often among the first.
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

// Returns the way along u after which the extents of the bodies along u do not overlap, or a way that is longer by
// about 1 % of the bodies' size. The bodies are apart there, but usually earlier, too.
double way_past(const MinimumTranslationSearch& search, const Vec3& u) noexcept {
  const Pose& relative = search.pair.relative;
  const Pose back = inverse(Pose{.rotation = relative.rotation});
  const double reach = reach_along(search.pair.first.tree.supports, u) +
                       reach_along(search.pair.second.tree.supports, rotate(back, -u)) * relative.scale;
  return std::max(0.0, reach - dot(u, relative.translation));
}

// Computes the same from the triangles, without that error.
double exact_way_past(const MinimumTranslationSearch& search, const Vec3& u) noexcept {
  const TreeView &first = search.pair.first.tree, &second = search.pair.second.tree;
  const Pose &relative = search.pair.relative, back = inverse(Pose{.rotation = relative.rotation});
  const double reach =
      -deepest_point(first, {.translation = -Vec3(first.origin)}, -u, 0).distance -
      deepest_point(second, {.translation = -Vec3(second.origin)}, rotate(back, u), 0).distance * relative.scale;
  return std::max(0.0, reach - dot(u, relative.translation)) + kWayRounding * search.size + search.nudge;
}

// Visits the directions to the points of a grid on a cube: 98 directions, of which neighbours along the grid are at
// most 27 degrees apart.
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

// A best-first search for the shortest way. It keeps a list of directions, each with a lower bound on its way: at
// first, from the triangles that meet now; later, also from others that are found on the way. The direction with the
// least bound is advanced, until its way is free and no other one can be shorter.
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

  void add(const Vec3& direction) noexcept {
    Plane plane;
    list(direction, plane);
  }

  // Adds a direction. Then, up to refinements_ times, it adds the normal of the plane at which the last direction
  // became free, and the shortest way past this plane and the one before it.
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
  struct Plane {  // a direction becomes free at it; shifts shorter than `height` do not lead past it
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

  // Takes one step along a direction, to where the triangles and pieces found at the present place no longer meet the
  // other body. If there are none, the way is the best so far.
  void advance(Listed next) noexcept {
    const double at = next.way + next.nudge;
    const Meeting meeting = meeting_at(search_, next.u, at, limit_);
    const double further = meeting.any ? at + meeting.farthest : leaves_boxes(search_, next.u, at);
    if (!meeting.any && further < 0) {  // the way includes the nudge, because only its end is known to be free
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
      next.nudge *= 4;  // they touch up to rounding
    }
    push(next);
  }

  // Returns the shortest shift that reaches two planes; 0 if these are parallel.
  static Vec3 past_both(const Plane& p, const Plane& q) noexcept {
    const double c = dot(p.normal, q.normal), across = 1 - c * c;
    if (!(across > 1e-9)) return {};
    return ((p.height - c * q.height) / across) * p.normal + ((q.height - c * p.height) / across) * q.normal;
  }

  static constexpr std::size_t kCutsPerTest = 8;  // so many cuts take as long as a test of the walk

  const MinimumTranslationSearch& search_;
  Obstacles obstacles_;
  std::uint32_t refinements_;
  std::uint64_t last_listing_;  // no direction is listed once the work has reached this
  MinimumTranslation best_{{}, kInfinity, {}, false};
  double limit_ = kInfinity;  // ways that are at least so long do not count
  std::array<Listed, 192> listed_;
  std::size_t count_ = 0;
  std::array<Vec3, 64> tried_{};
  std::size_t tried_count_ = 0;
};

// Returns whether a way is so long, compared with the smaller body or with the curves in which the surfaces cut each
// other, that a shorter one probably leads in another direction.
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

// Does part 2 of the search, as minimum_translation.h describes it.
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

// Does part 3 of the search: returns the shortest way after which the extents of the bodies do not overlap, along one
// of `directions` or a direction of the grid.
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
