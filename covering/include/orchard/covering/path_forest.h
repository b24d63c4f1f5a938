#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/covering/boundary_lemma.h"

// Finds the balls of a forest that are near a triangle, a point or a box.
namespace orchard {

// The balls near one triangle, renumbered; parents are indices into this list.
struct NearBalls {
  std::vector<PathBall> balls;
  std::vector<Index> original;  // The indices in the forest; ascending on each level.
};

// Balls with their children, so that those near a triangle are found from the roots down. Balls may be changed in
// place; parents may not.
class PathForest {
 public:
  explicit PathForest(std::span<const PathBall> balls);

  std::span<const PathBall> balls() const { return balls_; }
  PathBall& ball(Index i) { return balls_[i]; }
  std::span<const Index> roots() const { return roots_; }
  std::span<const Index> children(Index i) const { return children_[i]; }

  // Replaces the contents of `near` by the balls whose whole path is near the triangle. A ball that is left out does
  // not touch the triangle, and neither do the path regions below it.
  void gather(const std::array<Point, 3>& triangle, NearBalls& near) const;
  // Gathers only those balls that are also near the part of the triangle in the sphere.
  void gather(const std::array<Point, 3>& triangle, const Sphere& where, NearBalls& near) const;

  // Returns path_distance() over all balls; visits only a few of them.
  double distance(const Point& point) const;
  // Returns whether that distance is at most `limit`.
  bool within(const Point& point, double limit) const;

 private:
  void descend(Index ball, const Point& point, double above, double& min) const;
  bool within(Index ball, const Point& point, double limit) const;

  std::vector<PathBall> balls_;
  std::vector<Index> roots_;
  Rows children_;
};

// Decides whether one path of balls is certain to contain a box, and so covers all triangles in it, as
// cover_of_triangle() would find. Use it for a sequence of boxes near each other, because it tries the last path first.
// The object keeps a reference to the forest and must not be used by several threads at once.
class HoldingPath {
 public:
  explicit HoldingPath(const PathForest& forest) : forest_(forest) {}
  bool holds(const Box& box);

 private:
  bool descend(Index ball, const Box& box);

  const PathForest& forest_;
  Index last_ = kNone;  // The leaf of the last path that contained a box.
};

// Returns whether the ball is certain to contain the box, with a margin for all roundings.
bool surely_holds(const Sphere& ball, const Box& box);

}  // namespace orchard
