#include "orchard/medial/axis_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "../axis/incidence.h"
#include "max_over_triangles.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/surface.h"

namespace orchard {
namespace {

constexpr std::size_t kMaxPlaces = 1'000'000;

// Returns the triangles of a mesh, and flat triangles for edges without triangles and for vertices without edges.
TriangleMesh cells_of(const MedialMesh& mesh) {
  TriangleMesh cells{.vertices = mesh.centers, .triangles = mesh.triangles};
  const detail::CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  for (const Index e : at.bare_edges())
    cells.triangles.push_back({mesh.edges[e][0], mesh.edges[e][1], mesh.edges[e][1]});
  for (const Index v : at.lone_vertices()) cells.triangles.push_back({v, v, v});
  return cells;
}

using detail::Corners;
using detail::PieceValue;

// The one-sided distance from the cells of one axis to another axis.
class OneSided {
 public:
  OneSided(const TriangleMesh& from, const Surface& to, double accuracy) : to_(to) {
    std::vector<Corners> cells;
    for (const auto& [a, b, c] : from.triangles)
      cells.push_back({from.vertices[a], from.vertices[b], from.vertices[c]});
    found_ = {.max = 0, .upper = 0, .place = from.vertices.front()};
    for (const Point& vertex : from.vertices) found_.max = std::max(found_.max, to.closest(vertex).distance);
    found_ = detail::max_over_triangles(cells, found_, accuracy, kMaxPlaces,
                                        [&](const Corners& corners, Index, double) { return evaluate(corners); });
    measure_mean(cells);
  }

  double max() const { return found_.max; }
  double gap() const { return found_.upper - found_.max; }
  double mean() const { return mean_; }

 private:
  // Returns the distance at the middle of a piece and an upper bound for the piece. There are two bounds: the distance
  // at the middle plus that of the farthest corner from the middle, and the largest distance of a corner to the
  // triangle that is nearest to the middle, because the distance to one triangle is convex.
  PieceValue evaluate(const Corners& corners) const {
    const Point middle = middle_of(corners);
    const ClosestPoint nearest = to_.closest(middle);
    const auto [a, b, c] = to_.corners(nearest.triangle);
    double reach = 0, at_corners = 0;
    for (const Point& corner : corners) {
      reach = std::max(reach, (corner - middle).norm());
      at_corners = std::max(at_corners, closest_point_of_triangle(corner, a, b, c).distance);
    }
    return {.value = nearest.distance, .bound = std::min(nearest.distance + reach, at_corners), .place = middle};
  }

  // Measures the mean distance at the middles of cells, weighted by area or length. Large cells are divided into parts
  // of the mean size.
  void measure_mean(const std::vector<Corners>& cells) {
    std::vector<double> area, length;
    for (const auto& [a, b, c] : cells) {
      area.push_back(0.5 * (b - a).cross(c - a).norm());
      length.push_back((b - a).norm());
    }
    const auto sum = [](const std::vector<double>& values) {
      return std::accumulate(values.begin(), values.end(), 0.0);
    };
    const std::vector<double> weight = sum(area) > 0 ? area : sum(length) > 0 ? length : std::vector(cells.size(), 1.0);
    const double whole = sum(weight), mean_weight = whole / static_cast<double>(weight.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      mean_ += weight[i] / whole * mean_of(cells[i], weight[i], mean_weight);
  }
  double mean_of(const Corners& corners, double weight, double max_weight) const {
    if (!(weight > 2 * max_weight)) return to_.closest(middle_of(corners)).distance;
    const auto [first, second] = detail::halves(corners);
    return 0.5 * (mean_of(first, weight / 2, max_weight) + mean_of(second, weight / 2, max_weight));
  }

  static Point middle_of(const Corners& corners) { return (corners[0] + corners[1] + corners[2]) / 3; }

  const Surface& to_;
  detail::MaxOverTriangles found_;
  double mean_ = 0;
};

}  // namespace

AxisDistance axis_distance(const MedialMesh& a, const MedialMesh& b, double accuracy) {
  if (!(accuracy > 0)) throw InputError("the accuracy of the distance of two axes must be above 0");
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
