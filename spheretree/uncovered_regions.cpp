#include "uncovered_regions.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "orchard/covering/path_forest.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

constexpr int kProbes = 14;  // outward from the middle of an arc, each twice as far as the one before
// What is known of distances by other distances may be wrong by a few roundings.
constexpr double kRegionDistanceFactor = 1 + 1e-6;
// Uncovered regions below this part of the last growth are left to it.
constexpr double kLeftToGrowth = 0.4;

struct ArcGroup {
  std::vector<const UncoveredArc*> arcs;
  std::vector<Point> corners;
  Box box;  // of the corners
};

// Most groups are told apart by their boxes, and mostly by one side.
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

  // An uncovered region between an arc and an edge of the triangle has no corner off its border: look outward from the
  // arc.
  void try_outward(const UncoveredArc& arc, UncoveredRegion& region) {
    Vector out = arc.middle - balls_[arc.ball].center;
    out -= out.dot(normal_) * normal_;
    const double length = out.norm();
    if (!(length > 0)) return;
    // The distance grows by no more than the way.
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

  // path_distance() from the balls near the triangle; where that is not above `limit`, anything that is not.
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

  // What path_distance() at the middle of an arc does not exceed: that of the path that ends there, if one does.
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

  // A path's excess only grows downwards: what is not below the least found so far can be left out.
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
  NearBalls near_;                  // roots first, children of one ball side by side
  std::vector<Children> children_;  // of each
  Index roots_ = 0;
  Index last_ = kNone;  // the leaf that decided the last distance: it is near the next point as well
};

// Of those whose distance is not above `beyond`, it stays at that, and where they are farthest is not known.
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
