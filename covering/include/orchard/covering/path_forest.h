#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/covering/boundary_lemma.h"

namespace orchard {

// The balls near one triangle, renumbered; parents within the list.
struct NearBalls {
  std::vector<PathBall> balls;
  std::vector<Index> original;  // into the forest; ascending on each level
};

// Balls with their children, so that those near a triangle are found from the roots down. Balls may be changed in
// place; the parents may not.
class PathForest {
 public:
  explicit PathForest(std::span<const PathBall> balls);

  std::span<const PathBall> balls() const { return balls_; }
  PathBall& ball(Index i) { return balls_[i]; }
  std::span<const Index> roots() const { return roots_; }
  std::span<const Index> children(Index i) const { return children_[i]; }

  // Gathers the balls whose whole path comes near the triangle. A ball that is left out does not touch the triangle,
  // and neither do the path regions below it. `near` is cleared first.
  void gather(const std::array<Point, 3>& triangle, NearBalls& near) const;
  // Only those near the part of the triangle in the sphere, too.
  void gather(const std::array<Point, 3>& triangle, const Sphere& where, NearBalls& near) const;

  // path_distance() over all balls, without a look at most of them.
  double distance(const Point& point) const;
  // Whether that is at most so much.
  bool within(const Point& point, double limit) const;

 private:
  void descend(Index ball, const Point& point, double above, double& min) const;
  bool within(Index ball, const Point& point, double limit) const;

  std::vector<PathBall> balls_;
  std::vector<Index> roots_;
  Rows children_;
};

// Tells whether one path of balls surely holds a box, and so covers whatever triangles lie in it: cover_of_triangle()
// says that they are covered. For boxes that lie near each other, one after the other: the last path is tried first.
// One thread at a time. Keeps a reference to the forest.
class HoldingPath {
 public:
  explicit HoldingPath(const PathForest& forest) : forest_(forest) {}
  bool holds(const Box& box);

 private:
  bool descend(Index ball, const Box& box);

  const PathForest& forest_;
  Index last_ = kNone;  // the leaf of the last path that held anything
};

// Whether the ball surely holds the box, with room for all roundings.
bool surely_holds(const Sphere& ball, const Box& box);

}  // namespace orchard
