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
  std::span<const Index> children(Index i) const { return children_[i]; }

  // Gathers the balls whose whole path comes near the triangle. A ball that is left out does not touch the triangle,
  // and neither do the path regions below it. `near` is cleared first.
  void gather(const std::array<Point, 3>& triangle, NearBalls& near) const;

  // path_distance() over all balls, without a look at most of them.
  double distance(const Point& point) const;

 private:
  void descend(Index ball, const Point& point, double above, double& min) const;

  std::vector<PathBall> balls_;
  std::vector<Index> roots_;
  Rows children_;
};

}  // namespace orchard
