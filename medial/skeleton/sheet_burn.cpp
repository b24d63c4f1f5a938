#include "sheet_burn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "orchard/geometry/disjoint_sets.h"

namespace orchard::detail {
namespace {

constexpr double kNotBurned = std::numeric_limits<double>::infinity();
// The corners at the ends of side i of a triangle, and the corner opposite to it (CellIncidence::sides).
constexpr std::array<std::array<Index, 3>, 3> kCornersOfSide{{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}};

// Returns when a straight front that is at a and b at the given times arrives at c.
double arrival_at(const Point& a, double time_a, const Point& b, double time_b, const Point& c) {
  const Vector along = b - a, to = c - a;
  const double length = along.norm(), slope = (time_b - time_a) / length;
  const double by_edges = std::min(time_a + to.norm(), time_b + (c - b).norm());
  if (!(length > 0) || !(std::abs(slope) < 1)) return by_edges;
  const double x = to.dot(along) / length, y = along.cross(to).norm() / length;
  const double rise = std::sqrt(1 - slope * slope), source = x - y * slope / rise;
  return source >= 0 && source <= length ? time_a + slope * x + rise * y : by_edges;
}

// Returns the gradient of times that are linear in a triangle. It is at most 1 long, since no fire is slower than that.
Vector gradient_of(const std::array<Point, 3>& corners, const std::array<double, 3>& times) {
  const Vector e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], normal = e1.cross(e2);
  const double squared = normal.squaredNorm();
  if (!(squared > 0)) return Vector::Zero();
  const Vector gradient =
      ((times[1] - times[0]) * e2.cross(normal) + (times[2] - times[0]) * normal.cross(e1)) / squared;
  const double length = gradient.norm();
  if (!std::isfinite(length)) return Vector::Zero();
  return gradient / std::max(1.0, length);
}

class SheetBurner {
 public:
  SheetBurner(const MedialMesh& mesh, const CellIncidence& at)
      : mesh_(mesh), at_(at), sectors_(3 * mesh.triangles.size()), arrivals_(3 * mesh.triangles.size(), kNotBurned) {
    result_.isolated.assign(mesh.edges.size(), std::numeric_limits<double>::quiet_NaN());
    result_.edge_alive.assign(mesh.edges.size(), 1);
    result_.triangle_alive.assign(mesh.triangles.size(), 1);
  }

  SheetBurn run() {
    join_sectors();
    light_borders();
    while (!queue_.empty()) {
      const auto [time, edge] = queue_.top();
      queue_.pop();
      const Index triangle = result_.edge_alive[edge] ? only(at_.triangles_at[edge], result_.triangle_alive) : kNone;
      if (triangle == kNone) continue;
      now_ = std::max(now_, time);
      burn(triangle, first_free_side(triangle));
    }
    set_vertices();
    return std::move(result_);
  }

 private:
  Index side_of(Index triangle, Index edge) const {
    const auto& sides = at_.sides[triangle];
    return sides[0] == edge ? 0 : sides[1] == edge ? 1 : 2;
  }
  Index corner_at(Index triangle, Index vertex) const {
    const auto& corners = mesh_.triangles[triangle];
    return 3 * triangle + (corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2);
  }
  double& arrival(Index corner) { return arrivals_[sectors_.root(corner)]; }
  void arrive(Index corner, double time) { arrival(corner) = std::min(arrival(corner), time); }

  // The corners around a vertex that are connected across edges with two triangles burn together.
  void join_sectors() {
    for (Index edge = 0; edge < mesh_.edges.size(); ++edge) {
      const auto triangles = at_.triangles_at[edge];
      if (triangles.size() != 2) continue;
      for (const Index vertex : mesh_.edges[edge])
        sectors_.unite(corner_at(triangles[0], vertex), corner_at(triangles[1], vertex));
    }
  }

  void light_borders() {
    for (Index edge = 0; edge < mesh_.edges.size(); ++edge) {
      const auto triangles = at_.triangles_at[edge];
      const auto [a, b] = mesh_.edges[edge];
      if (triangles.empty()) result_.isolated[edge] = 0.5 * (mesh_.radii[a] + mesh_.radii[b]);
      if (triangles.size() != 1) continue;
      for (const Index vertex : {a, b}) arrive(corner_at(triangles[0], vertex), mesh_.radii[vertex]);
    }
    for (const Index edge : at_.border_edges()) offer(edge, at_.triangles_at[edge][0]);
  }

  // Returns the side that the fire reached first, among those that no other triangle has any more; kNone if there is
  // none.
  Index first_free_side(Index triangle) {
    Index best = kNone;
    std::pair<double, double> least;
    for (Index k = 0; k < 3; ++k) {
      const Index side = at_.sides[triangle][k];
      if (only(at_.triangles_at[side], result_.triangle_alive) != triangle) continue;
      const double a = arrival(3 * triangle + kCornersOfSide[k][0]), b = arrival(3 * triangle + kCornersOfSide[k][1]);
      const std::pair<double, double> times{std::max(a, b), std::min(a, b)};
      if (best == kNone || times < least) best = side, least = times;
    }
    return best;
  }

  double time_across(Index triangle, Index edge) {
    const auto& [i, k, m] = kCornersOfSide[side_of(triangle, edge)];
    const auto& corners = mesh_.triangles[triangle];
    const auto& at = mesh_.centers;
    return arrival_at(at[corners[i]], arrival(3 * triangle + i), at[corners[k]], arrival(3 * triangle + k),
                      at[corners[m]]);
  }

  // Puts a triangle into the queue at the time at which all of its corners burn.
  void offer(Index edge, Index triangle) {
    const auto& [i, k, m] = kCornersOfSide[side_of(triangle, edge)];
    const double across = std::min(arrival(3 * triangle + m), time_across(triangle, edge));
    queue_.emplace(std::max({arrival(3 * triangle + i), arrival(3 * triangle + k), across}), edge);
  }

  void burn(Index triangle, Index edge) {
    const Index corner = 3 * triangle + kCornersOfSide[side_of(triangle, edge)][2];
    arrive(corner, time_across(triangle, edge));
    result_.triangle_alive[triangle] = result_.edge_alive[edge] = 0;
    for (const Index side : at_.sides[triangle]) {
      if (side == edge) continue;
      const auto triangles = at_.triangles_at[side];
      const auto left =
          std::count_if(triangles.begin(), triangles.end(), [&](Index t) { return result_.triangle_alive[t] != 0; });
      if (left == 0) result_.isolated[side] = now_;
      if (left != 1) continue;
      const Index next = only(triangles, result_.triangle_alive);
      if (triangles.size() > 2) cross(side, next);
      offer(side, next);
    }
  }

  // Lets the fire go on into the last sheet at an edge after the others have burned.
  void cross(Index edge, Index next) {
    for (const Index vertex : mesh_.edges[edge]) {
      double latest = 0;
      for (const Index triangle : at_.triangles_at[edge]) {
        if (triangle != next) latest = std::max(latest, arrival(corner_at(triangle, vertex)));
      }
      arrive(corner_at(next, vertex), latest);
    }
  }

  void set_vertices() {
    std::vector<double>& times = result_.vertex_times;
    times.assign(mesh_.centers.size(), -kNotBurned);
    std::vector<Vector>& fronts = result_.vertex_fronts;
    fronts.assign(mesh_.centers.size(), Vector::Zero());
    std::vector<double> areas(mesh_.centers.size(), 0);
    for (Index triangle = 0; triangle < mesh_.triangles.size(); ++triangle) {
      const auto& [a, b, c] = mesh_.triangles[triangle];
      const auto& at = mesh_.centers;
      const double area = (at[b] - at[a]).cross(at[c] - at[a]).norm();
      const std::array own{arrival(3 * triangle), arrival(3 * triangle + 1), arrival(3 * triangle + 2)};
      const Vector front = gradient_of({at[a], at[b], at[c]}, own);
      for (Index k = 0; k < 3; ++k) {
        const Index vertex = mesh_.triangles[triangle][k];
        times[vertex] = std::max(times[vertex], own[k]);
        fronts[vertex] += area * front;
        areas[vertex] += area;
      }
    }
    for (Index vertex = 0; vertex < mesh_.size(); ++vertex) {
      times[vertex] = std::max(times[vertex], mesh_.radii[vertex]);
      if (areas[vertex] > 0) fronts[vertex] /= areas[vertex];
    }
  }

  const MedialMesh& mesh_;
  const CellIncidence& at_;
  DisjointSets sectors_;          // of the corners of triangles
  std::vector<double> arrivals_;  // of each sector, at its root
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue_;
  double now_ = 0;
  SheetBurn result_;
};

}  // namespace

SheetBurn burn_sheets(const MedialMesh& mesh, const CellIncidence& at) { return SheetBurner(mesh, at).run(); }

}  // namespace orchard::detail
