#include "uncovered_regions.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "orchard/covering/path_forest.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

// The number of places that are tried outward from the middle of an arc, each twice as far as the one before.
constexpr int kProbes = 14;
// A margin for distances that are derived from other distances, which may be off by a few rounding errors.
constexpr double kRegionDistanceFactor = 1 + 1e-6;
// Over the last growth: shallower uncovered regions are left to it.
constexpr double kLeftToGrowth = 0.4;

struct ArcGroup {
  std::vector<const UncoveredArc*> arcs;
  std::vector<Point> corners;
  Box box;  // the box of the corners
};

// The boxes exclude most groups, and usually by one side.
bool bounds_same(const ArcGroup& group, const UncoveredArc& arc, double near) {
  const double limit = near * (1 + 1e-9);
  const auto apart = [&](const Point& end) {
    return ((group.box.min() - end).array() > limit).any() || ((end - group.box.max()).array() > limit).any();
  };
  if (apart(arc.begin) && apart(arc.end)) return false;
  return std::any_of(group.corners.begin(), group.corners.end(),
                     [&](const Point& p) { return (p - arc.begin).norm() <= near || (p - arc.end).norm() <= near; });
}

std::vector<ArcGroup> joined_arcs(const TriangleCover& cover, double near) {
  std::vector<ArcGroup> groups;
  for (const UncoveredArc& arc : cover.arcs) {
    ArcGroup joined{{&arc}, {arc.begin, arc.middle, arc.end}, {}};
    for (const Point& corner : joined.corners) joined.box.extend(corner);
    for (std::size_t i = groups.size(); i-- > 0;) {
      const ArcGroup& group = groups[i];
      if (!bounds_same(group, arc, near)) continue;
      joined.arcs.insert(joined.arcs.end(), group.arcs.begin(), group.arcs.end());
      joined.corners.insert(joined.corners.end(), group.corners.begin(), group.corners.end());
      joined.box.extend(group.box);
      groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(i));
    }
    groups.push_back(std::move(joined));
  }
  return groups;
}

class Prober {
 public:
  Prober(const Surface& surface, Index triangle, std::span<const PathBall> balls, const PathForest& forest, double step)
      : corners_(surface.corners(triangle)), normal_(surface.normal(triangle)), balls_(balls), step_(step) {
    forest.gather(corners_, near_);
    children_.assign(near_.balls.size(), {0, 0});
    for (Index i = 0; i < near_.balls.size(); ++i) {
      const Index parent = near_.balls[i].parent;
      if (parent == kNone) {
        ++roots_;
      } else {
        if (children_[parent].count++ == 0) children_[parent].first = i;
      }
    }
  }

  void try_point(const Point& point, UncoveredRegion& region) {
    const Point inside = closest_point_of_triangle(point, corners_[0], corners_[1], corners_[2]).position;
    const double distance = distance_beyond(inside, region.distance);
    if (distance <= region.distance) return;
    region.distance = distance;
    region.farthest = inside;
  }

  // An uncovered region between an arc and an edge of the triangle has no corner off its border. So places outward from
  // the arc are tried.
  void try_outward(const UncoveredArc& arc, UncoveredRegion& region) {
    Vector out = arc.middle - balls_[arc.ball].center;
    out -= out.dot(normal_) * normal_;
    const double length = out.norm();
    if (!(length > 0)) return;
    // The distance grows by at most the length of the path.
    const double here = distance_bound(arc);
    double step = step_;
    for (int probe = 0; probe < kProbes; ++probe, step *= 2)
      if ((here + step) * kRegionDistanceFactor > region.distance)
        try_point(arc.middle + out * (step / length), region);
  }

 private:
  struct Children {
    Index first, count;
  };

  // Returns path_distance() from the balls near the triangle, or any value of at most `limit` if it is not above
  // `limit`.
  double distance_beyond(const Point& point, double limit) {
    double min = std::numeric_limits<double>::infinity();
    if (last_ != kNone) {
      min = -min;
      for (Index i = last_; i != kNone; i = near_.balls[i].parent) min = std::max(min, excess(i, point));
    }
    for (Index root = 0; root < roots_ && min > limit; ++root)
      descend(root, point, -std::numeric_limits<double>::infinity(), limit, min);
    return min;
  }

  // Returns an upper bound on path_distance() at the middle of an arc: the distance of the path that ends there, if one
  // does.
  double distance_bound(const UncoveredArc& arc) const {
    if (!balls_[arc.ball].leaf) return std::numeric_limits<double>::infinity();
    double bound = 0;
    for (Index i = arc.ball; i != kNone; i = balls_[i].parent)
      bound = std::max(bound, (arc.middle - balls_[i].center).norm() - balls_[i].radius);
    return bound;
  }

  double excess(Index ball, const Point& point) const {
    return (point - near_.balls[ball].center).norm() - near_.balls[ball].radius;
  }

  // The excess of a path only grows downwards, so a branch whose excess is not below the smallest one so far is
  // skipped.
  void descend(Index ball, const Point& point, double above, double limit, double& min) {
    const double here = std::max(above, excess(ball, point));
    if (here >= min) return;
    if (near_.balls[ball].leaf) {
      min = here;
      last_ = ball;
    }
    const auto [first, count] = children_[ball];
    for (Index child = first; child < first + count && min > limit; ++child) descend(child, point, here, limit, min);
  }

  std::array<Point, 3> corners_;
  Vector normal_;
  std::span<const PathBall> balls_;
  const double step_;
  NearBalls near_;                  // roots first, and the children of a ball next to each other
  std::vector<Children> children_;  // the children of each ball
  Index roots_ = 0;
  Index last_ = kNone;  // the leaf that decided the last distance, which is probably near the next point as well
};

// For regions with a distance of at most `beyond`, that distance is reported as it is, and the farthest point is not
// searched.
std::vector<UncoveredRegion> uncovered_regions_of(const UncoveredTriangle& uncovered, Prober prober, double near,
                                                  double beyond) {
  std::vector<UncoveredRegion> regions;
  for (const auto& [arcs, corners, box] : joined_arcs(uncovered.cover, near)) {
    UncoveredRegion region{{}, arcs[0]->middle, beyond};
    Point middle = Point::Zero();
    for (const UncoveredArc* arc : arcs) {
      for (const Point& p : {arc->begin, arc->middle, arc->end}) {
        region.corners.push_back(p);
        middle += p;
      }
      prober.try_outward(*arc, region);
    }
    prober.try_point(middle / static_cast<double>(region.corners.size()), region);
    regions.push_back(std::move(region));
  }
  if (regions.empty()) {
    regions.push_back({{uncovered.cover.witness}, uncovered.cover.witness, beyond});
    prober.try_point(uncovered.cover.witness, regions.back());
  }
  return regions;
}

std::vector<UncoveredRegion> find_regions(const Surface& surface, const Coverage& coverage,
                                          std::span<const PathBall> balls, double near, double beyond) {
  const PathForest forest(balls);
  const std::size_t count = coverage.uncovered.size();
  std::vector<std::vector<UncoveredRegion>> found(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const UncoveredTriangle& uncovered = coverage.uncovered[i];
    found[i] = uncovered_regions_of(uncovered, Prober(surface, uncovered.triangle, balls, forest, near), near, beyond);
  });
  std::vector<UncoveredRegion> regions;
  for (auto& list : found)
    for (UncoveredRegion& region : list) regions.push_back(std::move(region));
  return regions;
}

}  // namespace

std::vector<Point> UncoveredRegion::points() const {
  std::vector<Point> points = corners;
  points.push_back(farthest);
  return points;
}

std::vector<UncoveredRegion> find_uncovered_regions(const Surface& surface, const Coverage& coverage,
                                                    std::span<const PathBall> balls, double near) {
  return find_regions(surface, coverage, balls, near, 0);
}

std::vector<UncoveredRegion> find_deep_uncovered_regions(const Surface& surface, const Coverage& coverage,
                                                         std::span<const PathBall> balls) {
  const double radius = surface.bounding_radius(), left_to_growth = kLeftToGrowth * kLastGrowth * radius;
  auto uncovered = find_regions(surface, coverage, balls, tolerance::kCoverMargin * radius, left_to_growth);
  std::erase_if(uncovered, [&](const UncoveredRegion& region) { return region.distance <= left_to_growth; });
  return uncovered;
}

std::vector<Index> triangles_to_check(const Surface& surface, std::span<const PathBall> balls) {
  return triangles_to_recheck(surface, {}, {&surface.bounding_ball(), 1}, balls);
}

std::vector<Index> triangles_to_recheck(const Surface& surface, const Coverage& before, std::span<const Sphere> changed,
                                        std::span<const PathBall> balls) {
  const PathForest forest(balls);
  std::vector<char> marked(surface.mesh().triangles.size(), 0);
  for (const UncoveredTriangle& uncovered : before.uncovered) marked[uncovered.triangle] = 1;
  std::vector<Index> near;
  HoldingPath path(forest);
  for (const Sphere& ball : changed) {
    surface.triangles_near(
        ball, [&](const Box& box) { return path.holds(box); }, near);
    for (Index triangle : near) marked[triangle] = 1;
  }
  std::vector<Index> triangles;
  for (Index i = 0; i < marked.size(); ++i)
    if (marked[i]) triangles.push_back(i);
  return triangles;
}

}  // namespace orchard::detail
