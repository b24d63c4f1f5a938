#include "way_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "triangle_cut.h"
#include "vector_functions.h"

namespace orchard::runtime::detail {
namespace {

using Cut = Workspace::Scratch::Cut;

constexpr int kMaxAdvances = 64;       // along one direction
constexpr double kNudge = 1e-12;       // of the bodies' size: beyond a contact
constexpr double kGain = 1e-6;         // less is no gain
constexpr double kSame = 1 - 1e-9;     // cosine of directions that count as one
constexpr std::size_t kObstacles = 8;  // kept at most

// Half-spaces that the way out has to reach: normal . x >= height.
struct Obstacle {
  Vec3 normal;
  double height;
};

// Along one direction to the end, or until it is longer than `limit`.
WayOut follow(const PlacedPair& pair, const WalkStack& room, std::span<const Cut> cuts, const Vec3& direction,
              double size, double limit) noexcept {
  const Way way(direction);
  WayOut out{way.u, 0, way.u, true};
  for (const Cut& cut : cuts) {
    const Exit exit = exit_along(cut.first, cut.second, way);
    if (exit.t > out.way) out.way = exit.t, out.normal = exit.normal;
  }
  double nudge = kNudge * size;
  for (int i = 0; i < kMaxAdvances; ++i) {
    out.ended = false;
    if (out.way >= limit) return out;
    const double at = out.way + nudge;
    const PlacedPair ahead = pair.moved(along({0, 0, 0}, way.u, at));
    bool any = false;
    double farthest = -std::numeric_limits<double>::infinity();
    Vec3 normal = way.u;
    walk_candidates(ahead, room,
                    [&](const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row) {
                      const TrianglePoints a = points_of(lanes, lane), b = moved_points_of(rows, row, ahead.relative);
                      if (!triangles_intersect(a, b, nullptr)) return;
                      any = true;
                      const Exit exit = exit_along(a, b, way);
                      if (exit.t > farthest) farthest = exit.t, normal = exit.normal;
                    });
    out.ended = !any;
    if (!any) return out;
    if (farthest > 0) {
      out.way = at + farthest, out.normal = normal;
      nudge = kNudge * size;
    } else {
      nudge *= 4;  // they touch but for rounding
    }
  }
  return out;
}

bool outside(const Vec3& x, std::span<const Obstacle> obstacles, double size) noexcept {
  return std::all_of(obstacles.begin(), obstacles.end(),
                     [&](const Obstacle& o) { return dot(o.normal, x) >= o.height - kNudge * size; });
}

// The least vectors that reach one, two or three planes.
Vec3 reaching(const Obstacle& p) noexcept { return along({0, 0, 0}, p.normal, p.height); }

Vec3 reaching(const Obstacle& p, const Obstacle& q) noexcept {
  const double c = dot(p.normal, q.normal), det = 1 - c * c;
  if (!(det > 1e-9)) return {};
  const double s = (p.height - c * q.height) / det, t = (q.height - c * p.height) / det;
  return along(along({0, 0, 0}, p.normal, s), q.normal, t);
}

Vec3 reaching(const Obstacle& p, const Obstacle& q, const Obstacle& r) noexcept {
  const Vec3 qr = cross(q.normal, r.normal), rp = cross(r.normal, p.normal), pq = cross(p.normal, q.normal);
  const double det = dot(p.normal, qr);
  if (!(std::fabs(det) > 1e-6)) return {};
  return along(along(along({0, 0, 0}, qr, p.height / det), rp, q.height / det), pq, r.height / det);
}

// The least vector that reaches all of them, or zero if there is none.
Vec3 min_reaching(std::span<const Obstacle> obstacles, double size) noexcept {
  Vec3 best{};
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec3& x) {
    const double square = dot(x, x);
    if (square > 0 && square < least && outside(x, obstacles, size)) least = square, best = x;
  };
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    offer(reaching(obstacles[i]));
    for (std::size_t j = 0; j < i; ++j) {
      offer(reaching(obstacles[i], obstacles[j]));
      for (std::size_t k = 0; k < j; ++k) offer(reaching(obstacles[i], obstacles[j], obstacles[k]));
    }
  }
  return best;
}

// From one direction to a local minimum.
class Descent {
 public:
  Descent(const PlacedPair& pair, const WalkStack& room, std::span<const Cut> cuts, double size) noexcept
      : pair_(pair), room_(room), cuts_(cuts), size_(size) {}

  // False if it was tried before, nearly.
  bool try_direction(const Vec3& direction) noexcept {
    const double length = std::sqrt(dot(direction, direction));
    if (!(length > 0)) return false;
    const Vec3 u = along({0, 0, 0}, direction, 1 / length);
    for (std::size_t i = 0; i < tried_count_; ++i) {
      if (dot(tried_[i], u) > kSame) return false;
    }
    tried_[tried_count_ < tried_.size() ? tried_count_++ : tried_.size() - 1] = u;
    last_ = follow(pair_, room_, cuts_, u, size_, best_.way);
    add({last_.normal, last_.way * dot(last_.normal, last_.direction)});
    if (last_.ended && last_.way < best_.way * (1 - kGain)) best_ = last_;
    return true;
  }

  void refine(std::uint32_t& left) noexcept {
    while (left > 0) {
      const double before = best_.way;
      if (try_direction(best_.normal)) --left;
      if (best_.way < before) continue;
      if (left > 0 && try_direction(min_reaching(std::span(obstacles_.data(), obstacle_count_), size_))) {
        --left;
      } else {
        return;
      }
      if (!(best_.way < before) && ++idle_ > 3) return;
    }
  }

  const WayOut& best() const noexcept { return best_; }
  const WayOut& last() const noexcept { return last_; }

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

  const PlacedPair& pair_;
  const WalkStack& room_;
  std::span<const Cut> cuts_;
  double size_;
  WayOut best_{{}, std::numeric_limits<double>::infinity(), {}, false}, last_{};
  std::array<Obstacle, kObstacles> obstacles_{};
  std::size_t obstacle_count_ = 0;
  std::array<Vec3, 32> tried_{};
  std::size_t tried_count_ = 0;
  int idle_ = 0;
};

}  // namespace

WayOut least_way_out(const PlacedPair& pair, const WalkStack& room, std::span<const Cut> cuts,
                     std::span<const Vec3> directions, double size, std::uint32_t refinements) noexcept {
  Descent descent(pair, room, cuts, size);
  for (const Vec3& direction : directions) descent.try_direction(direction);
  std::uint32_t left = refinements;
  if (descent.best().ended) descent.refine(left);
  return descent.best().ended ? descent.best() : descent.last();
}

}  // namespace orchard::runtime::detail
