#pragma once
#include <memory>
#include <span>
#include <vector>

#include "orchard/covering/path_forest.h"
#include "orchard/geometry/surface.h"

// Keeps the path rule up to date while single balls change.
namespace orchard {

// The state of the path rule for a surface and balls, for builders that move spheres and check the rule after every
// step. For each triangle it keeps the leaves that its certificate depends on, and each near ball's circle in the
// triangle. A change rechecks only the triangles whose certificate depends on the changed ball and the uncovered ones
// that it touches.
// The result agrees with surface_coverage(), with one exception: if a changed ball makes a triangle uncertain whose
// certificate does not depend on it, the triangle remains covered, because the certificate remains valid. An object
// must not be used by several threads at once. Source: dissertation 5.3.3.
class IncrementalCover {
 public:
  // Checks all triangles, or the given ones, in parallel. The object keeps a reference to `surface`.
  IncrementalCover(const Surface& surface, std::span<const PathBall> balls);
  IncrementalCover(const Surface& surface, std::vector<Index> triangles, std::span<const PathBall> balls);
  ~IncrementalCover();
  IncrementalCover(IncrementalCover&&) noexcept;
  IncrementalCover& operator=(IncrementalCover&&) noexcept;

  std::span<const PathBall> balls() const;
  bool complete() const { return uncovered_count() == 0; }
  Index uncovered_count() const;
  std::vector<Index> uncovered() const;  // Returns the uncovered triangles, ascending.

  // Replaces the centre and the radius of a ball.
  void change(Index ball, const Sphere& sphere);
  // Does the same if every covered triangle remains covered; otherwise changes nothing. Returns whether the ball
  // changed.
  bool try_change(Index ball, const Sphere& sphere);

  std::uint64_t triangles_checked() const;  // Returns the number of checks so far, the first ones included.

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace orchard
