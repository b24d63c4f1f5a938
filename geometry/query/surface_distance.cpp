#include "orchard/geometry/surface_distance.h"

#include <algorithm>
#include <array>
#include <queue>

namespace orchard {
namespace {

// More than the rounding error of a closest point, which is a few units in the last place of the coordinates.
constexpr double kClosestPointRounding = 1e-14;

struct Piece {
  std::array<Point, 3> corners;
  double upper;
  std::uint64_t number;  // ties go to the older piece
};

struct Later {
  bool operator()(const Piece& a, const Piece& b) const {
    return a.upper != b.upper ? a.upper < b.upper : a.number > b.number;
  }
};

class Search {
 public:
  Search(const Surface& from, const Surface& to, const SurfaceDistanceOptions& options, const Progress& progress)
      : from_(from),
        to_(to),
        options_(options),
        progress_(progress),
        width_(options.tolerance * to.bounding_radius()) {}

  SurfaceDistance run() {
    std::vector<bool> visited(from_.mesh().vertices.size(), false);
    // Vertices first: the farthest point of a surface from another is mostly a vertex.
    for (const auto& corners : from_.mesh().triangles)
      for (const Index vertex : corners) {
        if (!visited[vertex]) probe(from_.mesh().vertices[vertex]);
        visited[vertex] = true;
      }
    const Index triangles = static_cast<Index>(from_.mesh().triangles.size());
    for (Index t = 0; t < triangles; ++t) {
      if (t % kBetweenReports == 0) report_progress(progress_, "distance", 0.5 * t / triangles);
      add(from_.corners(t));
    }
    std::uint64_t splits = 0;
    while (!queue_.empty() && queue_.top().upper > result_.lower + width_ && evaluations_ < options_.max_evaluations) {
      if (++splits % kBetweenReports == 0)
        report_progress(progress_, "distance", 0.5 + 0.5 * result_.lower / queue_.top().upper);
      const Piece piece = queue_.top();
      queue_.pop();
      split(piece);
    }
    result_.upper = std::max(result_.lower, settled_);
    if (!queue_.empty()) result_.upper = std::max(result_.upper, queue_.top().upper);
    const double size = to_.bounding_box().min().cwiseAbs().cwiseMax(to_.bounding_box().max().cwiseAbs()).sum() +
                        from_.bounding_box().min().cwiseAbs().cwiseMax(from_.bounding_box().max().cwiseAbs()).sum();
    result_.upper += kClosestPointRounding * size;
    result_.lower = std::max(0.0, result_.lower - kClosestPointRounding * size);
    return result_;
  }

 private:
  static constexpr std::uint64_t kBetweenReports = 1024;

  ClosestPoint probe(const Point& point) {
    ClosestPoint closest = to_.closest(point);
    ++evaluations_;
    if (closest.distance > result_.lower) {
      result_.lower = closest.distance;
      result_.at = point;
    }
    return closest;
  }

  void add(const std::array<Point, 3>& corners) {
    const Point center = (corners[0] + corners[1] + corners[2]) / 3;
    const ClosestPoint closest = probe(center);
    double reach = 0;
    for (const Point& corner : corners) reach = std::max(reach, (corner - center).norm());
    const auto& [a, b, c] = to_.corners(closest.triangle);
    double to_one_triangle = 0;
    for (const Point& corner : corners)
      to_one_triangle = std::max(to_one_triangle, closest_point_of_triangle(corner, a, b, c).distance);
    const double upper = std::min(closest.distance + reach, to_one_triangle);
    if (upper <= result_.lower + width_) {
      settled_ = std::max(settled_, upper);
    } else {
      queue_.push({corners, upper, number_++});
    }
  }

  // Halves a piece at the middle of its longest edge.
  void split(const Piece& piece) {
    std::size_t longest = 0;
    std::array<double, 3> squared{};
    for (std::size_t i = 0; i < 3; ++i) {
      squared[i] = (piece.corners[(i + 1) % 3] - piece.corners[i]).squaredNorm();
      if (squared[i] > squared[longest]) longest = i;
    }
    const Point &x = piece.corners[longest], &y = piece.corners[(longest + 1) % 3],
                &z = piece.corners[(longest + 2) % 3];
    const Point middle = x + (y - x) / 2;
    add({x, middle, z});
    add({middle, y, z});
  }

  const Surface &from_, &to_;
  const SurfaceDistanceOptions& options_;
  const Progress& progress_;
  double width_, settled_ = 0;
  std::uint64_t evaluations_ = 0, number_ = 0;
  SurfaceDistance result_;
  std::priority_queue<Piece, std::vector<Piece>, Later> queue_;
};

}  // namespace

SurfaceDistance surface_distance(const Surface& from, const Surface& to, const SurfaceDistanceOptions& options,
                                 const Progress& progress) {
  return Search(from, to, options, progress).run();
}

}  // namespace orchard
