#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "deep_dents.h"
#include "search_precision.h"

namespace orchard::detail {
namespace {

constexpr int kMaxCubeLevels = 40;      // after these a cube is as small as rounding errors
constexpr std::size_t kCubeBlock = 64;  // cubes that one task divides

struct Cube {
  Point center;
  double bound;    // at least the depth of the reconstruction's boundary in it
  Sphere ball;     // a ball of the reconstruction in which the centre is deepest
  Index triangle;  // of the surface, nearest to the centre or to a larger cube's
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

  // Tests a part of a cube. The boundary does not meet it if the reconstruction holds all of it or none of it.
  void look_at(const Cube& whole, const Point& center, std::vector<Cube>& parts, BoundaryPlace& deepest) const {
    const double reach = std::sqrt(3.0) * half_ + rounding_;
    const auto farthest_from = [&](const Point& place) {
      return ((center - place).cwiseAbs() + Vector::Constant(half_)).norm() + rounding_;
    };
    const auto holds_all = [&](const Sphere& ball) { return farthest_from(ball.center) < ball.radius; };
    Cube cube{.center = center, .bound = whole.bound, .ball = whole.ball, .triangle = whole.triangle};
    if (holds_all(cube.ball)) return;
    const double at_most = (center - cube.ball.center).norm() - cube.ball.radius;
    // The depth of a place is at most its distance from any point of the surface.
    const auto [a, b, c] = surface_.corners(whole.triangle);
    cube.bound = std::min(cube.bound, farthest_from(closest_point_of_triangle(center, a, b, c).position));
    if (cube.bound <= found_.depth || is_held_or_shallow(cube)) return;
    ClosestPoint nearest;
    const double depth = -surface_.signed_distance(center, nearest);
    cube.triangle = nearest.triangle;
    cube.bound = std::min({cube.bound, depth + reach, farthest_from(nearest.position)});
    if (cube.bound <= found_.depth) return;
    if (cube.triangle != whole.triangle && is_held_or_shallow(cube)) return;
    // The search for the deepest ball takes most of the time. If the ball of the whole cube ends in this part, too, the
    // search is useful only if the part may have a place deeper than the found maximum.
    if (at_most > 0 || depth + at_most > found_.depth) {
      const double gap = reconstruction_.distance_between(-reach, std::min(at_most, reach), center, cube.ball);
      if (!(std::abs(gap) < reach) || holds_all(cube.ball)) return;
      if (gap >= 0 && depth + gap > found_.depth) take_boundary(center, cube.ball, deepest);
      const bool other_ball = cube.ball.center != whole.ball.center || cube.ball.radius != whole.ball.radius;
      if (other_ball && is_held_or_shallow(cube)) return;
    }
    parts.push_back(cube);
  }

  // Whether every place of a cube is in the cube's ball or no deeper than the found maximum. The distance from the
  // cube's triangle, which is at least the depth, and the distance beyond the ball are convex functions of the place.
  // So is their sum, which is therefore largest at a corner of the cube. If it is below the found maximum there, each
  // place is either inside the ball or not deeper. For cubes that the surface cuts, which no ball holds, this is the
  // test that avoids dividing them.
  bool is_held_or_shallow(const Cube& cube) const {
    const auto [a, b, c] = surface_.corners(cube.triangle);
    // The corner farthest from the ball comes first: it fails most often.
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

  // Takes the place of the ball's boundary that is nearest to a point outside the reconstruction, if it is the deepest.
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
  double half_ = 0;      // half of the cubes' side
  double open_ = 0;      // the largest bound of cubes that are not divided any more
  double rounding_ = 0;  // bound on the rounding errors of coordinates
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
