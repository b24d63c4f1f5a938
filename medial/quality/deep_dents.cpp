#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "deep_dents.h"
#include "search_precision.h"

namespace orchard::detail {
namespace {

constexpr int kMaxCubeLevels = 40;      // then a cube is as small as rounding
constexpr std::size_t kCubeBlock = 64;  // cubes that one task divides

struct Cube {
  Point center;
  double bound;    // no boundary of the reconstruction in it is deeper
  Sphere ball;     // of the reconstruction: one of the deepest at the centre
  Index triangle;  // of the surface, nearest to the centre
};

// A place of the reconstruction's boundary.
struct BoundaryPlace {
  double depth = 0;  // in the solid
  Point place = Point::Zero();
  Sphere ball{Point::Zero(), 0};  // of the reconstruction
};

class DentSearch {
 public:
  // Looks for places deeper than `known` only.
  DentSearch(const Surface& surface, const Reconstruction& reconstruction, double known, Index max_cubes)
      : surface_(surface), reconstruction_(reconstruction), max_cubes_(max_cubes) {
    found_.depth = known;
    const Box& box = surface.bounding_box();
    rounding_ = search_rounding(box);
    half_ = 0.5 * (box.max() - box.min()).maxCoeff();
    cubes_ = {first_cube(box)};
  }

  SearchedMax run(double accuracy) {
    while (more_cubes()) {
      const BoundaryPlace found = divide();
      if (found.depth > found_.depth) found_ = found;
      const double enough = found_.depth + std::max(accuracy, kShareAbove * found_.depth);
      std::erase_if(cubes_, [&](const Cube& cube) {
        const bool done = cube.bound <= enough;
        if (done) open_ = std::max(open_, cube.bound);
        return done;
      });
    }
    for (const Cube& cube : cubes_) open_ = std::max(open_, cube.bound);
    return {.max = found_.depth,
            .upper = std::max(open_, found_.depth) + rounding_,
            .place = found_.place,
            .ball = found_.ball};
  }

 private:
  bool more_cubes() {
    divided_ += cubes_.size();
    return !cubes_.empty() && divided_ <= max_cubes_ && level_++ < kMaxCubeLevels;
  }

  Cube first_cube(const Box& box) const {
    Cube cube{.center = 0.5 * (box.min() + box.max()), .bound = 0, .ball = {Point::Zero(), 0}, .triangle = 0};
    cube.bound = (box.max() - box.min()).norm();
    reconstruction_.distance(cube.center, cube.ball);
    cube.triangle = surface_.closest(cube.center).triangle;
    return cube;
  }

  // Puts the parts that may hold places deeper than what was found in place of all cubes, and returns the deepest such
  // place. What was found stays the same for all parts, so that their order does not matter.
  BoundaryPlace divide() {
    struct Result {
      std::vector<Cube> parts;
      BoundaryPlace deepest;
    };
    half_ *= 0.5;
    std::vector<Result> results((cubes_.size() + kCubeBlock - 1) / kCubeBlock);
    tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t block) {
      Result& result = results[block];
      const std::size_t end = std::min(cubes_.size(), (block + 1) * kCubeBlock);
      for (std::size_t i = block * kCubeBlock; i < end; ++i) {
        for (int part = 0; part < 8; ++part) {
          const Vector step(part & 1 ? half_ : -half_, part & 2 ? half_ : -half_, part & 4 ? half_ : -half_);
          look_at(cubes_[i], cubes_[i].center + step, result.parts, result.deepest);
        }
      }
    });
    cubes_.clear();
    BoundaryPlace deepest;
    for (const Result& result : results) {
      cubes_.insert(cubes_.end(), result.parts.begin(), result.parts.end());
      if (result.deepest.depth > deepest.depth) deepest = result.deepest;
    }
    return deepest;
  }

  // A part of a cube: nothing of the boundary is in it if the reconstruction holds it wholly, or has nothing in it.
  void look_at(const Cube& whole, const Point& center, std::vector<Cube>& parts, BoundaryPlace& deepest) const {
    const double reach = std::sqrt(3.0) * half_ + rounding_;
    const auto farthest_from = [&](const Point& place) {
      return ((center - place).cwiseAbs() + Vector::Constant(half_)).norm() + rounding_;
    };
    const auto holds_all = [&](const Sphere& ball) { return farthest_from(ball.center) < ball.radius; };
    Cube cube{.center = center, .bound = whole.bound, .ball = whole.ball, .triangle = whole.triangle};
    if (holds_all(cube.ball)) return;
    const double at_most = (center - cube.ball.center).norm() - cube.ball.radius;
    // No place is deeper than it is far from any place of the surface.
    const auto [a, b, c] = surface_.corners(whole.triangle);
    cube.bound = std::min(cube.bound, farthest_from(closest_point_of_triangle(center, a, b, c).position));
    if (cube.bound <= found_.depth || is_held_or_shallow(cube)) return;
    ClosestPoint nearest;
    const double depth = -surface_.signed_distance(center, nearest);
    cube.triangle = nearest.triangle;
    cube.bound = std::min({cube.bound, depth + reach, farthest_from(nearest.position)});
    if (cube.bound <= found_.depth) return;
    if (cube.triangle != whole.triangle && is_held_or_shallow(cube)) return;
    // Searching for the deepest ball takes longest. Where the one of the whole cube ends in this part, too, it can but
    // tell of a place that is deeper than what was found.
    if (at_most > 0 || depth + at_most > found_.depth) {
      const double gap = reconstruction_.distance_between(-reach, std::min(at_most, reach), center, cube.ball);
      if (!(std::abs(gap) < reach) || holds_all(cube.ball)) return;
      if (gap >= 0 && depth + gap > found_.depth) take_boundary(center, cube.ball, deepest);
      const bool other_ball = cube.ball.center != whole.ball.center || cube.ball.radius != whole.ball.radius;
      if (other_ball && is_held_or_shallow(cube)) return;
    }
    parts.push_back(cube);
  }

  // Whether each place of a cube is in its ball, or no deeper than what was found. How far it is from the triangle,
  // which is no less than its depth, and how far beyond the ball are convex functions of the place, and so is their
  // sum, which is nowhere more than at the corners: where that is less than what was found, one or the other holds. A
  // cube across the surface is held by no ball, and along the surface this is what spares its parts.
  bool is_held_or_shallow(const Cube& cube) const {
    const auto [a, b, c] = surface_.corners(cube.triangle);
    // The corner farthest from the ball comes first, which tells soonest.
    const Vector away = cube.center - cube.ball.center;
    const int first = (away.x() > 0 ? 1 : 0) | (away.y() > 0 ? 2 : 0) | (away.z() > 0 ? 4 : 0);
    for (int k = 0; k < 8; ++k) {
      const int corner = first ^ k;
      const Point place =
          cube.center + Vector(corner & 1 ? half_ : -half_, corner & 2 ? half_ : -half_, corner & 4 ? half_ : -half_);
      const double beyond = (place - cube.ball.center).norm() - cube.ball.radius;
      if (!(beyond < found_.depth)) return false;
      if (!(beyond + closest_point_of_triangle(place, a, b, c).distance + 2 * rounding_ < found_.depth)) return false;
    }
    return true;
  }

  // The place of the boundary that is nearest to a point outside the reconstruction.
  void take_boundary(const Point& from, const Sphere& ball, BoundaryPlace& deepest) const {
    const Vector way = from - ball.center;
    const double length = way.norm();
    if (!(length > 0)) return;
    const Point place = ball.center + ball.radius / length * way;
    const double depth = -surface_.signed_distance(place);
    if (depth > std::max(found_.depth, deepest.depth)) deepest = {depth, place, ball};
  }

  const Surface& surface_;
  const Reconstruction& reconstruction_;
  const std::size_t max_cubes_;  // to divide, all levels together
  std::vector<Cube> cubes_;
  double half_ = 0;      // side, halved, of the cubes
  double open_ = 0;      // the largest bound of what is not divided any more
  double rounding_ = 0;  // of coordinates
  std::size_t divided_ = 0;
  int level_ = 0;
  BoundaryPlace found_;
};

}  // namespace

SearchedMax max_deep_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double accuracy,
                          Index max_cubes) {
  return DentSearch(surface, reconstruction, known, max_cubes).run(accuracy);
}

}  // namespace orchard::detail
