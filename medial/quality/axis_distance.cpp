#include "orchard/medial/axis_distance.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "orchard/geometry/error.h"
#include "orchard/geometry/surface.h"

namespace orchard {
namespace {

constexpr std::size_t kMostPlaces = 1'000'000;

// The triangles; where no triangle has an edge or a vertex, a flat triangle for that.
TriangleMesh cells_of(const MedialMesh& mesh) {
  TriangleMesh cells{.vertices = mesh.centers, .triangles = mesh.triangles};
  std::vector<std::array<Index, 2>> sides;
  std::vector<std::uint8_t> used(mesh.centers.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& side : {std::array{a, b}, std::array{a, c}, std::array{b, c}}) sides.push_back(side);
  }
  std::sort(sides.begin(), sides.end());
  for (const auto& edge : mesh.edges) {
    used[edge[0]] = used[edge[1]] = 1;
    if (!std::binary_search(sides.begin(), sides.end(), edge)) cells.triangles.push_back({edge[0], edge[1], edge[1]});
  }
  for (Index v = 0; v < mesh.size(); ++v) {
    if (used[v] == 0) cells.triangles.push_back({v, v, v});
  }
  return cells;
}

struct Piece {
  std::array<Point, 3> corners;
  double bound;  // no place of it is farther from the other axis
  bool operator<(const Piece& other) const { return bound < other.bound; }
};

// One-sided: from the cells of one axis to another.
class OneSided {
 public:
  OneSided(const TriangleMesh& from, const Surface& to, double accuracy) : to_(to), accuracy_(accuracy) {
    for (const Point& vertex : from.vertices) look_at(vertex);
    measure(from);
    while (!queue_.empty() && queue_.top().bound > max_ + accuracy_ && places_ < kMostPlaces) {
      const Piece piece = queue_.top();
      queue_.pop();
      divide(piece);
    }
    if (!queue_.empty()) gap_ = std::max(0.0, queue_.top().bound - max_);
  }

  double max() const { return max_; }
  double gap() const { return gap_; }
  double mean() const { return mean_; }

 private:
  // Means of pieces at their middles, weighted by what they measure; large ones in parts of the mean one's size.
  void measure(const TriangleMesh& from) {
    std::vector<double> area, length;
    for (const auto& [a, b, c] : from.triangles) {
      const Point &p = from.vertices[a], &q = from.vertices[b], &r = from.vertices[c];
      area.push_back(0.5 * (q - p).cross(r - p).norm());
      length.push_back((q - p).norm());
    }
    const auto sum = [](const std::vector<double>& values) {
      double whole = 0;
      for (const double value : values) whole += value;
      return whole;
    };
    std::vector<double> weight = sum(area) > 0 ? area : sum(length) > 0 ? length : std::vector(area.size(), 1.0);
    const double whole = sum(weight), mean_weight = whole / static_cast<double>(weight.size());
    for (std::size_t t = 0; t < from.triangles.size(); ++t) {
      const auto& [a, b, c] = from.triangles[t];
      const std::array corners{from.vertices[a], from.vertices[b], from.vertices[c]};
      mean_ += weight[t] / whole * mean_of(corners, weight[t], mean_weight);
    }
  }

  ClosestPoint look_at(const Point& place) {
    ++places_;
    const ClosestPoint nearest = to_.closest(place);
    max_ = std::max(max_, nearest.distance);
    return nearest;
  }

  // Puts the piece, or those it is divided into, in the queue.
  double mean_of(const std::array<Point, 3>& corners, double weight, double most) {
    const auto [longest, middle] = longest_side(corners);
    if (weight > 2 * most) {
      const auto [first, second] = halves(corners, longest, middle);
      return 0.5 * (mean_of(first, weight / 2, most) + mean_of(second, weight / 2, most));
    }
    return put(corners);
  }

  // The distance at the middle, and with it a bound: no place is farther from there than the farthest corner is, and to
  // the triangle nearest there, the distance to which is convex, no place is as far as the farthest corner is.
  double put(const std::array<Point, 3>& corners) {
    const Point middle = (corners[0] + corners[1] + corners[2]) / 3;
    const ClosestPoint nearest = look_at(middle);
    const auto [a, b, c] = to_.corners(nearest.triangle);
    double reach = 0, at_corners = 0;
    for (const Point& corner : corners) {
      reach = std::max(reach, (corner - middle).norm());
      at_corners = std::max(at_corners, closest_point_of_triangle(corner, a, b, c).distance);
    }
    const double bound = std::min(nearest.distance + reach, at_corners);
    if (bound > max_ + accuracy_) queue_.push({corners, bound});
    return nearest.distance;
  }

  void divide(const Piece& piece) {
    const auto [longest, middle] = longest_side(piece.corners);
    const auto [first, second] = halves(piece.corners, longest, middle);
    put(first);
    put(second);
  }

  // The corner that the longest side starts at, and that side's middle.
  static std::pair<std::size_t, Point> longest_side(const std::array<Point, 3>& corners) {
    std::size_t longest = 0;
    double most = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (corners[k] - corners[(k + 1) % 3]).squaredNorm();
      if (length > most) most = length, longest = k;
    }
    return {longest, 0.5 * (corners[longest] + corners[(longest + 1) % 3])};
  }
  static std::pair<std::array<Point, 3>, std::array<Point, 3>> halves(const std::array<Point, 3>& corners,
                                                                      std::size_t longest, const Point& middle) {
    const Point &a = corners[longest], &b = corners[(longest + 1) % 3], &c = corners[(longest + 2) % 3];
    return {{a, middle, c}, {middle, b, c}};
  }

  const Surface& to_;
  const double accuracy_;
  std::priority_queue<Piece> queue_;
  std::size_t places_ = 0;
  double max_ = 0, mean_ = 0, gap_ = 0;
};

}  // namespace

AxisDistance axis_distance(const MedialMesh& a, const MedialMesh& b, double accuracy) {
  if (!(accuracy > 0)) throw InputError("the distance of two axes: the accuracy must be above 0");
  const TriangleMesh first = cells_of(a), second = cells_of(b);
  const Surface first_cells(first), second_cells(second);
  const OneSided from(first, second_cells, accuracy), to(second, first_cells, accuracy);
  AxisDistance distance{.max = std::max(from.max(), to.max()),
                        .mean = 0.5 * (from.mean() + to.mean()),
                        .max_from = from.max(),
                        .max_to = to.max()};
  distance.max_gap = std::max(from.max() + from.gap(), to.max() + to.gap()) - distance.max;
  return distance;
}

}  // namespace orchard
