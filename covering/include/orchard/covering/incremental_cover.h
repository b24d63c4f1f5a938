#pragma once
#include <memory>
#include <span>
#include <vector>

#include "orchard/covering/path_forest.h"
#include "orchard/geometry/surface.h"

namespace orchard {

// The path rule kept up to date while single balls change (dissertation 5.3.3): what builders that move spheres about
// ask after every step. For each triangle it keeps the leaves that its certificate rests on, and each near ball's
// circle in the triangle; a change rechecks only triangles that rest on the changed ball, and uncovered ones that it
// touches. Agrees with surface_coverage(), but for triangles that a ball elsewhere makes uncertain: their certificate
// without that ball stands. Not for use by several threads at once.
class IncrementalCover {
 public:
  // Checks all triangles, or the given ones. Keeps a reference to `surface`. Parallel.
  IncrementalCover(const Surface& surface, std::span<const PathBall> balls);
  IncrementalCover(const Surface& surface, std::vector<Index> triangles, std::span<const PathBall> balls);
  ~IncrementalCover();
  IncrementalCover(IncrementalCover&&) noexcept;
  IncrementalCover& operator=(IncrementalCover&&) noexcept;

  std::span<const PathBall> balls() const;
  bool complete() const { return uncovered_count() == 0; }
  Index uncovered_count() const;
  std::vector<Index> uncovered() const;  // triangles, ascending

  // Gives the ball another centre and radius.
  void change(Index ball, const Sphere& sphere);
  // The same if every triangle that is covered stays so; otherwise nothing changes. Returns whether it was done.
  bool try_change(Index ball, const Sphere& sphere);

  std::uint64_t triangles_checked() const;  // so far, the first check included

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace orchard
