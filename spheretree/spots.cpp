#include "spots.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "orchard/covering/path_forest.h"

namespace orchard::detail {
namespace {

constexpr int kProbes = 14;  // outward from the middle of an arc, each twice as far as the one before

bool same_spot(const std::vector<Point>& spot, const UncoveredArc& arc, double near) {
  return std::any_of(spot.begin(), spot.end(),
                     [&](const Point& p) { return (p - arc.begin).norm() <= near || (p - arc.end).norm() <= near; });
}

std::vector<std::vector<const UncoveredArc*>> joined_arcs(const TriangleCover& cover, double near) {
  std::vector<std::vector<const UncoveredArc*>> groups;
  std::vector<std::vector<Point>> corners;
  for (const UncoveredArc& arc : cover.arcs) {
    std::vector<const UncoveredArc*> group{&arc};
    std::vector<Point> points{arc.begin, arc.middle, arc.end};
    for (std::size_t i = groups.size(); i-- > 0;) {
      if (!same_spot(corners[i], arc, near)) continue;
      group.insert(group.end(), groups[i].begin(), groups[i].end());
      points.insert(points.end(), corners[i].begin(), corners[i].end());
      groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(i));
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    }
    groups.push_back(std::move(group));
    corners.push_back(std::move(points));
  }
  return groups;
}

class Prober {
 public:
  Prober(const Surface& surface, Index triangle, std::span<const PathBall> balls, const PathForest& forest, double step)
      : corners_(surface.corners(triangle)), normal_(surface.normal(triangle)), balls_(balls), step_(step) {
    forest.gather(corners_, near_);
  }

  void try_point(const Point& point, Spot& spot) const {
    const Point inside = closest_point_of_triangle(point, corners_[0], corners_[1], corners_[2]).position;
    const double depth = path_depth(inside, near_.balls);
    if (depth <= spot.depth) return;
    spot.depth = depth;
    spot.deepest = inside;
  }

  // A spot between an arc and an edge of the triangle has no corner off its border: look outward from the arc.
  void try_outward(const UncoveredArc& arc, Spot& spot) const {
    Vector out = arc.middle - balls_[arc.ball].center;
    out -= out.dot(normal_) * normal_;
    const double length = out.norm();
    if (!(length > 0)) return;
    double step = step_;
    for (int probe = 0; probe < kProbes; ++probe, step *= 2) try_point(arc.middle + out * (step / length), spot);
  }

 private:
  std::array<Point, 3> corners_;
  Vector normal_;
  std::span<const PathBall> balls_;
  const double step_;
  NearBalls near_;
};

std::vector<Spot> spots_of(const UncoveredTriangle& uncovered, const Prober& prober, double near) {
  std::vector<Spot> spots;
  for (const auto& arcs : joined_arcs(uncovered.cover, near)) {
    Spot spot{{}, arcs[0]->middle, 0};
    Point middle = Point::Zero();
    for (const UncoveredArc* arc : arcs) {
      for (const Point& p : {arc->begin, arc->middle, arc->end}) {
        spot.corners.push_back(p);
        middle += p;
      }
      prober.try_outward(*arc, spot);
    }
    prober.try_point(middle / static_cast<double>(spot.corners.size()), spot);
    spots.push_back(std::move(spot));
  }
  if (spots.empty()) {
    spots.push_back({{uncovered.cover.witness}, uncovered.cover.witness, 0});
    prober.try_point(uncovered.cover.witness, spots.back());
  }
  return spots;
}

}  // namespace

std::vector<Spot> find_spots(const Surface& surface, const Coverage& coverage, std::span<const PathBall> balls,
                             double near) {
  const PathForest forest(balls);
  const std::size_t count = coverage.uncovered.size();
  std::vector<std::vector<Spot>> found(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const UncoveredTriangle& uncovered = coverage.uncovered[i];
    found[i] = spots_of(uncovered, Prober(surface, uncovered.triangle, balls, forest, near), near);
  });
  std::vector<Spot> spots;
  for (auto& list : found)
    for (Spot& spot : list) spots.push_back(std::move(spot));
  return spots;
}

}  // namespace orchard::detail
