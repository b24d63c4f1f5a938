#include "reconstruction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace orchard::detail {
namespace {

double distance_to(const Point& query, const Sphere& ball) { return (query - ball.center).norm() - ball.radius; }

Sphere vertex_ball(const MedialMesh& mesh, Index vertex) { return {mesh.centers[vertex], mesh.radii[vertex]}; }

// A lower bound on the distance to all balls of a triangle: what is seen of the distance along one direction is linear
// on the triangle, so least at a corner. Along the way from the middle it is nearly all of the distance.
double min_along(const Point& query, const std::array<Sphere, 3>& balls) {
  Vector direction = query - (balls[0].center + balls[1].center + balls[2].center) / 3;
  const double length = direction.norm();
  if (!(length > 0)) return -std::numeric_limits<double>::infinity();
  direction /= length;
  double min = std::numeric_limits<double>::infinity();
  for (const Sphere& ball : balls) min = std::min(min, direction.dot(query - ball.center) - ball.radius);
  return min;
}

// What makes up the items, in their order.
struct Cells {
  std::vector<Index> triangles, edges, vertices;
  std::vector<Box> boxes;
  std::vector<double> radii;
};

template <std::size_t kCorners>
void add(const MedialMesh& mesh, const std::array<Index, kCorners>& corners, Cells& cells) {
  Box box;
  double radius = 0;
  for (const Index corner : corners) {
    box.extend(mesh.centers[corner]);
    radius = std::max(radius, mesh.radii[corner]);
  }
  cells.boxes.push_back(box);
  cells.radii.push_back(radius);
}

Cells max_cells(const MedialMesh& mesh) {
  Cells cells;
  std::vector<std::array<Index, 2>> sides;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    for (const auto& side : {std::array{a, b}, std::array{a, c}, std::array{b, c}}) sides.push_back(side);
    cells.triangles.push_back(t);
    add(mesh, mesh.triangles[t], cells);
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::uint8_t> used(mesh.centers.size(), 0);
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    for (const Index vertex : mesh.edges[e]) used[vertex] = 1;
    if (std::binary_search(sides.begin(), sides.end(), mesh.edges[e])) continue;
    cells.edges.push_back(e);
    add(mesh, mesh.edges[e], cells);
  }
  for (Index v = 0; v < mesh.size(); ++v) {
    if (used[v]) continue;
    cells.vertices.push_back(v);
    add(mesh, std::array{v}, cells);
  }
  return cells;
}

}  // namespace

// Along the segment the distance is a convex function: sqrt(h^2 + (t - q)^2) - r(t), least where the slope of the root
// is that of the radius.
Sphere nearest_ball(const Point& query, const Sphere& a, const Sphere& b) {
  const Vector along = b.center - a.center;
  const double length = along.norm();
  if (!(length > 0)) return a.radius >= b.radius ? a : b;
  const double slope = (b.radius - a.radius) / length;
  const double foot = along.dot(query - a.center) / length;
  double t = slope > 0 ? length : 0;
  if (std::abs(slope) < 1) {
    const double height = std::sqrt(std::max(0.0, (query - a.center).squaredNorm() - foot * foot));
    t = std::clamp(foot + slope * height / std::sqrt(1 - slope * slope), 0.0, length);
  }
  const double fraction = t / length;
  return {a.center + fraction * along, a.radius + fraction * (b.radius - a.radius)};
}

// The same over a plane: there the radius has a gradient, and the least is one step along it from the foot. Where that
// leaves the triangle, or does not exist, the least is on the border.
Sphere nearest_ball(const Point& query, const Sphere& a, const Sphere& b, const Sphere& c) {
  const Vector u = b.center - a.center, v = c.center - a.center;
  const Vector normal = u.cross(v);
  const double squared = normal.squaredNorm();
  if (squared > 0) {
    const Vector across_v = v.cross(normal) / squared, across_u = normal.cross(u) / squared;  // dual basis of u, v
    const Vector gradient = (b.radius - a.radius) * across_v + (c.radius - a.radius) * across_u;
    const double steep = gradient.squaredNorm();
    if (steep < 1) {
      const double height = std::abs(normal.dot(query - a.center)) / std::sqrt(squared);
      const Vector place = query - a.center + height / std::sqrt(1 - steep) * gradient;
      const double beta = across_v.dot(place), gamma = across_u.dot(place);
      if (beta >= 0 && gamma >= 0 && beta + gamma <= 1) {
        return {a.center + beta * u + gamma * v,
                a.radius + beta * (b.radius - a.radius) + gamma * (c.radius - a.radius)};
      }
    }
  }
  Sphere best = nearest_ball(query, a, b);
  for (const Sphere& other : {nearest_ball(query, b, c), nearest_ball(query, a, c)}) {
    if (distance_to(query, other) < distance_to(query, best)) best = other;
  }
  return best;
}

Reconstruction::Reconstruction(const MedialMesh& mesh) : mesh_(&mesh), tree_({}, {}) {
  Cells cells = max_cells(mesh);
  triangles_ = std::move(cells.triangles);
  edges_ = std::move(cells.edges);
  vertices_ = std::move(cells.vertices);
  tree_ = BallTree(std::move(cells.boxes), std::move(cells.radii));
}

// A value that is `best` or more need not be exact.
double Reconstruction::evaluate(Index item, const Point& query, double best, Sphere& ball) const {
  const MedialMesh& mesh = *mesh_;
  if (item < triangles_.size()) {
    const auto& [a, b, c] = mesh.triangles[triangles_[item]];
    const double bound = min_along(query, {vertex_ball(mesh, a), vertex_ball(mesh, b), vertex_ball(mesh, c)});
    if (bound >= best) return bound;
    ball = nearest_ball(query, vertex_ball(mesh, a), vertex_ball(mesh, b), vertex_ball(mesh, c));
  } else if (item - triangles_.size() < edges_.size()) {
    const auto& [a, b] = mesh.edges[edges_[item - triangles_.size()]];
    ball = nearest_ball(query, vertex_ball(mesh, a), vertex_ball(mesh, b));
  } else {
    ball = vertex_ball(mesh, vertices_[item - triangles_.size() - edges_.size()]);
  }
  return distance_to(query, ball);
}

double Reconstruction::distance(const Point& query) const {
  Sphere ball;
  return distance(query, ball);
}

double Reconstruction::distance(const Point& query, Sphere& ball) const {
  double best = std::numeric_limits<double>::infinity();
  return tree_.min(query, best, [&](Index item) {
    Sphere found;
    const double value = evaluate(item, query, best, found);
    if (value < best) {
      best = value;
      ball = found;
    }
    return value;
  });
}

}  // namespace orchard::detail
