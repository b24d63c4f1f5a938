#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "bodies.h"
#include "orchard/runtime/collide.h"

// A judge of contacts: the least way out along each of many directions, by whole queries of yes and no, which are
// tested elsewhere; and the shallow poses that it is asked about.
namespace orchard::runtime::test {

inline double inner(const Vec& p, const Vec& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

inline Vec unit_of(Vec v) {
  const double size = std::sqrt(inner(v, v));
  for (double& x : v) x /= size;
  return v;
}

inline double degrees_between(const Vec& p, const Vec& q) {
  return std::acos(std::clamp(inner(p, q), -1.0, 1.0)) * 180 / std::numbers::pi;
}

struct MinimumTranslation {
  double depth;
  Vec direction;
};

// The second body at `b` is moved.
class LeastWayOut {
 public:
  LeastWayOut(const TreePair& pair, const Pose& a, const Pose& b) : pair_(pair), a_(a), b_(b) {}

  // Up to `most`, where the surfaces first come apart along a direction: the first of 24 places, then bisected.
  double along(const Vec& u, double most) {
    constexpr int kPlaces = 24;
    for (int i = 1; i <= kPlaces; ++i) {
      if (touch(u, most * i / kPlaces)) continue;
      double low = most * (i - 1) / kPlaces, high = most * i / kPlaces;
      for (int k = 0; k < 20; ++k) (touch(u, (low + high) / 2) ? low : high) = (low + high) / 2;
      return high;
    }
    return std::numeric_limits<double>::infinity();
  }

  // Of 2,000 directions, the best twenty refined, all ways that are within 1.2 of the least, which is the first.
  std::vector<MinimumTranslation> find(Draw& draw, double most) {
    std::vector<MinimumTranslation> ways;
    double limit = most;
    for (int i = 0; i < 2000; ++i) {
      const Vec u = draw.direction();
      const double depth = along(u, limit);
      if (!std::isfinite(depth)) continue;
      ways.push_back({depth, u});
      limit = std::min(limit, 1.3 * depth);
    }
    const auto less = [](const MinimumTranslation& p, const MinimumTranslation& q) { return p.depth < q.depth; };
    std::sort(ways.begin(), ways.end(), less);
    for (std::size_t i = 0; i < std::min<std::size_t>(20, ways.size()); ++i) refine(draw, ways[i]);
    std::sort(ways.begin(), ways.end(), less);
    std::erase_if(ways, [&](const MinimumTranslation& way) { return way.depth > 1.2 * ways[0].depth; });
    return ways;
  }

 private:
  void refine(Draw& draw, MinimumTranslation& way) {
    double spread = 0.06;
    for (int k = 0; k < 60; ++k) {
      Vec u = way.direction;
      const Vec off = draw.direction();
      for (std::size_t d = 0; d < 3; ++d) u[d] += spread * off[d];
      u = unit_of(u);
      const double depth = along(u, way.depth);
      if (depth < way.depth) {
        way = {depth, u};
      } else {
        spread *= 0.93;
      }
    }
  }

  bool touch(const Vec& u, double by) {
    Pose b = b_;
    for (std::size_t i = 0; i < 3; ++i) b.translation[i] += by * u[i];
    return collide(workspace_, pair_, a_, b).answer != Answer::no;
  }

  Workspace workspace_;
  TreePair pair_;
  Pose a_, b_;
};

// Whether all of them lead about the same way: the least one's direction is then what a normal should be.
inline bool is_unique(const std::vector<MinimumTranslation>& ways) {
  return std::all_of(ways.begin(), ways.end(),
                     [&](const MinimumTranslation& w) { return degrees_between(w.direction, ways[0].direction) < 40; });
}

// Two of the closed bodies, the second one come along a random line until they meet, in steps of 0.4 % of both radii.
struct ShallowPose {
  std::size_t i, j;
  double reach;  // sum of the radii
  Pose a, b;
};

// Draws from `draw`. None if the line leads past.
inline std::optional<ShallowPose> shallow_pose(Draw& draw, const std::vector<Body>& all,
                                               const std::vector<PreparedTree>& trees, Workspace& workspace) {
  const std::size_t i = draw.bits() % 7, j = draw.bits() % 7;  // the closed ones
  const Vec way = draw.direction();
  const Pose a = centered(all[i].tree, draw.pose(0)), turned = draw.pose(0);
  const double reach = all[i].tree.bounding_radius + all[j].tree.bounding_radius;
  const TreePair pair(trees[i], trees[j]);
  for (int step = 0; step < 250; ++step) {
    const double far = (1 - 0.004 * step) * reach;
    Pose b = centered(all[j].tree, turned);
    for (std::size_t k = 0; k < 3; ++k) b.translation[k] += far * way[k];
    if (collide(workspace, pair, a, b).answer == Answer::yes) return ShallowPose{i, j, reach, a, b};
  }
  return std::nullopt;
}

}  // namespace orchard::runtime::test
