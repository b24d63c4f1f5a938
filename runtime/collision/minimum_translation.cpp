#include "collision/minimum_translation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "collision/least_reaching.h"
#include "collision/support_map.h"
#include "collision/triangle_cut.h"
#include "math/vector_functions.h"

namespace orchard::runtime::detail {
namespace {

using Cut = Workspace::Scratch::Cut;

constexpr int kMaxAdvances = 64;       // along one direction
constexpr double kClear = 0.25;        // of a nudge: more than what rounding does to poses
constexpr double kGain = 1e-6;         // less is no gain
constexpr double kSame = 1 - 1e-9;     // cosine of directions that count as one
constexpr std::size_t kObstacles = 8;  // kept at most

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

// The triangles that meet after a part of a way, as far as they can move on together. Ends at the first pair that can
// do so to `limit` of the way.
struct Meeting {
  bool any = false;
  bool clear = true;  // those that do not meet are farther apart than rounding
  double farthest = -std::numeric_limits<double>::infinity();
  Vec3 normal;
};

Meeting meeting_at(const MinimumTranslationSearch& search, const Way& way, double at, double limit) noexcept {
  const PlacedPair ahead = search.pair.moved(along({0, 0, 0}, way.u, at));
  Meeting meeting;
  meeting.normal = way.u;
  walk_candidates(ahead, search.room,
                  [&](const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row) {
                    const TrianglePoints a = points_of(lanes, lane), b = moved_points_of(rows, row, ahead.relative);
                    if (!triangles_intersect(a, b, nullptr)) {
                      if (!meeting.any && meeting.clear) meeting.clear = are_parted_by(a, b, kClear * search.nudge);
                      return false;
                    }
                    meeting.any = true;
                    const Exit exit = exit_along(a, b, way);
                    if (exit.t > meeting.farthest) meeting.farthest = exit.t, meeting.normal = exit.normal;
                    return at + exit.t >= limit;
                  });
  return meeting;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Along one direction to the end, or until it is longer than `limit`. What is in the way beyond `give_up` at some place
// ends it there, at the first pair of triangles that is.
MinimumTranslation follow(const MinimumTranslationSearch& search, const Vec3& direction, double limit,
                          double give_up = kInfinity) noexcept {
  const Way way(direction);
  MinimumTranslation out{way.u, 0, way.u, true};
  for (const Cut& cut : search.cuts) {
    const Exit exit = exit_along(cut.first, cut.second, way);
    if (exit.t > out.way) out.way = exit.t, out.normal = exit.normal;
  }
  double nudge = search.nudge;
  for (int i = 0; i < kMaxAdvances; ++i) {
    out.ended = false;
    if (out.way >= limit) return out;
    const double at = out.way + nudge;
    const Meeting meeting = meeting_at(search, way, at, give_up);
    const double further = meeting.any ? at + meeting.farthest : leaves_boxes(search, way.u, at);
    if (!meeting.any && further < 0) {  // the way includes the nudge, since only there it is known to have ended
      out.way = at, out.ended = true, out.clear = meeting.clear;
      return out;
    }
    if (further > at) {
      out.way = further, nudge = search.nudge;
      if (meeting.any) out.normal = meeting.normal;
    } else {
      nudge *= 4;  // they touch but for rounding
    }
  }
  return out;
}

// To where the bodies' extents along a direction part: always an end, seldom the first one.
MinimumTranslation way_past(const MinimumTranslationSearch& search, const Vec3& direction) noexcept {
  const Way way(direction);
  const Pose &relative = search.pair.relative, turn = {.rotation = relative.rotation};
  const Vec3 back = rotate(inverse(turn), along({0, 0, 0}, way.u, -1));
  const double reach = reach_along(search.pair.first.tree.supports, way.u) +
                       reach_along(search.pair.second.tree.supports, back) * relative.scale;
  const double past = reach - dot(way.u, relative.translation);
  return {way.u, std::max(0.0, past) + kReaches * search.size + search.nudge, way.u, false};
}

// From one direction to a local minimum.
class Descent {
 public:
  explicit Descent(const MinimumTranslationSearch& search) noexcept : search_(search) {}

  // False if it was tried before, nearly.
  bool try_direction(const Vec3& direction) noexcept {
    const double length = std::sqrt(dot(direction, direction));
    if (!(length > 0)) return false;
    const Vec3 u = along({0, 0, 0}, direction, 1 / length);
    for (std::size_t i = 0; i < tried_count_; ++i) {
      if (dot(tried_[i], u) > kSame) return false;
    }
    tried_[tried_count_ < tried_.size() ? tried_count_++ : tried_.size() - 1] = u;
    last_ = follow(search_, u, best_.way);
    add({last_.normal, last_.way * dot(last_.normal, last_.direction)});
    if (last_.ended && last_.way < best_.way * (1 - kGain)) best_ = last_;
    return true;
  }

  void refine(std::uint32_t& left) noexcept {
    while (left > 0) {
      const double before = best_.way;
      if (try_direction(best_.normal)) --left;
      if (best_.way < before) continue;
      if (left > 0 && try_direction(min_reaching(std::span(obstacles_.data(), obstacle_count_), search_.size))) {
        --left;
      } else {
        return;
      }
      if (!(best_.way < before) && ++idle_ > 3) return;
    }
  }

  const MinimumTranslation& best() const noexcept { return best_; }
  const MinimumTranslation& last() const noexcept { return last_; }

 private:
  void add(const Obstacle& obstacle) noexcept {
    for (std::size_t i = 0; i < obstacle_count_; ++i) {
      if (dot(obstacles_[i].normal, obstacle.normal) > kSame) {
        obstacles_[i].height = std::max(obstacles_[i].height, obstacle.height);
        return;
      }
    }
    if (obstacle_count_ < kObstacles) obstacles_[obstacle_count_++] = obstacle;
  }

  const MinimumTranslationSearch& search_;
  MinimumTranslation best_{{}, std::numeric_limits<double>::infinity(), {}, false}, last_{};
  std::array<Obstacle, kObstacles> obstacles_{};
  std::size_t obstacle_count_ = 0;
  std::array<Vec3, 32> tried_{};
  std::size_t tried_count_ = 0;
  int idle_ = 0;
};

// Directions all around, and the best of them to go down from.
class AllAround {
 public:
  // Looks for ways shorter than `limit`. `best`: the shortest one so far.
  AllAround(const MinimumTranslationSearch& search, const MinimumTranslation& best, double limit,
            std::uint32_t refinements) noexcept
      : search_(search), best_(best), refinements_(refinements), limit_(limit) {}

  // `thorough`: also along the shortest way out of every pair of triangles, not only of those that are in the way.
  MinimumTranslation find(bool thorough) noexcept {
    if (thorough) {
      for (std::size_t i = 0; i < remembered(); ++i) shifts_of(i);
      try_shortest();
    } else if (is_blocked_all_around()) {
      return best_;
    }
    // The corners of a grid on a cube: 98 directions, at most 27 degrees from each other.
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = -2; z <= 2; ++z) {
          if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == 2) try_direction({double(x), double(y), double(z)});
        }
      }
    }
    if (!thorough) try_shortest();
    if (best_.ended) try_beside(best_.direction);
    for (std::size_t i = 0; i < start_count_; ++i) {
      Descent descent(search_);
      descent.try_direction(starts_[i].direction);
      std::uint32_t left = refinements_;
      if (descent.best().ended) descent.refine(left);
      offer(descent.best());
    }
    return best_;
  }

 private:
  static constexpr double kWorthStarting = 1.5;  // times the best way: from there a descent may end below it
  static constexpr std::size_t kStarts = 3, kRemembered = 32;

  std::size_t remembered() const noexcept { return std::min(kRemembered, search_.cuts.size()); }

  void offer(const MinimumTranslation& out) noexcept {
    if (out.ended && (!best_.ended || out.way < best_.way)) best_ = out;
  }

  void try_shortest() noexcept {
    for (std::size_t i = 0; i < remembered(); ++i) {
      if (!known_[i]) continue;
      const double way = shifts_[i].shortest();
      if (way > 0 && way < limit_) try_direction(shifts_[i].shortest_way_out());
    }
  }

  // Close to a direction, where little may be in the way of its neighbours.
  void try_beside(const Vec3& direction) noexcept {
    constexpr std::array<std::array<double, 2>, 6> kAround = {
        {{1, 0}, {0.5, 0.866}, {-0.5, 0.866}, {-1, 0}, {-0.5, -0.866}, {0.5, -0.866}}};
    const Way way(direction);
    for (const double off : {0.02, 0.06, 0.18}) {
      for (const auto& [x, y] : kAround) try_direction(along(along(way.u, way.e, off * x), way.f, off * y));
    }
  }

  void try_direction(const Vec3& direction) noexcept {
    const Vec3 u = along({0, 0, 0}, direction, 1 / std::sqrt(dot(direction, direction)));
    if (is_blocked(u)) return;
    const MinimumTranslation out = follow(search_, u, limit_, limit_);
    if (!out.ended || !(out.way < limit_)) return;
    limit_ = std::min(limit_, kWorthStarting * out.way);
    std::size_t at = start_count_ < kStarts ? start_count_++ : kStarts;
    for (; at > 0 && starts_[at - 1].way > out.way; --at) {
      if (at < kStarts) starts_[at] = starts_[at - 1];
    }
    if (at < kStarts) starts_[at] = out;
    offer(out);
  }

  // One pair of triangles that is in the way of every direction settles it at once, and often is among the first.
  bool is_blocked_all_around() noexcept {
    constexpr std::size_t kFirst = 8;
    for (std::size_t i = 0; i < std::min(kFirst, remembered()); ++i) {
      if (shifts_of(i).shortest() >= limit_) return true;
    }
    return false;
  }

  // By the triangles that meet now: the pair that was in the way of the direction before is likely to be so again.
  bool is_blocked(const Vec3& u) noexcept {
    if (!std::isfinite(limit_)) return false;
    const std::size_t count = search_.cuts.size();
    if (blocking_ < count && is_in_the_way(blocking_, u)) return true;
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_in_the_way(i, u)) continue;
      blocking_ = i;
      return true;
    }
    return false;
  }

  bool is_in_the_way(std::size_t i, const Vec3& u) noexcept {
    if (i < kRemembered) return shifts_of(i).contain(u, limit_);
    return MeetingShifts(search_.cuts[i].first, search_.cuts[i].second).contain(u, limit_);
  }

  const MeetingShifts& shifts_of(std::size_t i) noexcept {
    if (!known_[i]) shifts_[i] = MeetingShifts(search_.cuts[i].first, search_.cuts[i].second), known_[i] = true;
    return shifts_[i];
  }

  const MinimumTranslationSearch& search_;
  MinimumTranslation best_;
  std::uint32_t refinements_;
  double limit_;
  std::size_t blocking_ = 0;
  std::array<MeetingShifts, kRemembered> shifts_;
  std::array<bool, kRemembered> known_{};
  std::array<MinimumTranslation, kStarts> starts_{};
  std::size_t start_count_ = 0;
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
  Descent descent(search);
  for (const Vec3& direction : directions) descent.try_direction(direction);
  std::uint32_t left = refinements;
  if (descent.best().ended) descent.refine(left);
  MinimumTranslation best = descent.best();
  if (refinements > 0) {
    // A way that is not doubtful is given up only for one that is shorter by far.
    constexpr double kShorterByFar = 0.85;
    const bool doubtful = !best.ended || is_doubtful(search, best.way);
    const double limit = !best.ended ? kInfinity : doubtful ? best.way : kShorterByFar * best.way;
    best = AllAround(search, best, limit, refinements).find(doubtful);
  }
  return best.ended ? best : way_past(search, descent.last().direction);
}

}  // namespace orchard::runtime::detail
