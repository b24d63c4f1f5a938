#include "reconstruction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../axis/incidence.h"

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

// The cells that no larger one holds: triangles, edges, vertices.
struct Cells {
  std::vector<SupportTree::Item> items;
  std::vector<std::array<Index, 3>> corners;
  Index triangles = 0, edges = 0;
};

Cells max_cells(const MedialMesh& mesh) {
  const CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  const std::vector<Index> bare = at.bare_edges();
  Cells cells{.items = {},
              .corners = {},
              .triangles = static_cast<Index>(mesh.triangles.size()),
              .edges = static_cast<Index>(bare.size())};
  const auto add = [&](Index a, Index b, Index c) {
    cells.items.push_back({vertex_ball(mesh, a), vertex_ball(mesh, b), vertex_ball(mesh, c)});
    cells.corners.push_back({a, b, c});
  };
  for (const auto& [a, b, c] : mesh.triangles) add(a, b, c);
  for (const Index e : bare) add(mesh.edges[e][0], mesh.edges[e][1], mesh.edges[e][1]);
  for (const Index v : at.lone_vertices()) add(v, v, v);
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

Reconstruction::Reconstruction(const MedialMesh& mesh) {
  Cells cells = max_cells(mesh);
  triangles_ = cells.triangles;
  edges_ = cells.edges;
  corners_ = std::move(cells.corners);
  balls_.reserve(mesh.size());
  for (Index v = 0; v < mesh.size(); ++v) balls_.push_back(vertex_ball(mesh, v));
  tree_ = SupportTree(std::move(cells.items));
}

double Reconstruction::evaluate(Index item, const SupportTree::Item& balls, const Point& query, double best,
                                Sphere& ball) const {
  if (item < triangles_) {
    const double bound = min_along(query, balls);
    if (bound >= best) return bound;
    ball = nearest_ball(query, balls[0], balls[1], balls[2]);
  } else {
    ball = item - triangles_ < edges_ ? nearest_ball(query, balls[0], balls[1]) : balls[0];
  }
  return distance_to(query, ball);
}

double Reconstruction::distance(const Point& query) const {
  Sphere ball;
  return distance(query, ball);
}

double Reconstruction::distance(const Point& query, Sphere& ball) const {
  return distance_below(std::numeric_limits<double>::infinity(), query, ball);
}

double Reconstruction::distance_below(double bound, const Point& query, Sphere& ball) const {
  return distance_between(-std::numeric_limits<double>::infinity(), bound, query, ball);
}

double Reconstruction::distance_between(double enough, double bound, const Point& query, Sphere& ball) const {
  const auto value_of = [&](Index item, const SupportTree::Item& balls, double best) {
    Sphere found;
    const double value = evaluate(item, balls, query, best, found);
    if (value < best) ball = found;
    return value;
  };
  return tree_.min(query, bound, value_of, enough);
}

Reconstruction::Nearest Reconstruction::nearest(const Point& query, double enough) const {
  return nearest_from({}, query, enough);
}

Reconstruction::Nearest Reconstruction::nearest_from(Nearest nearest, const Point& query, double enough) const {
  const auto value_of = [&](Index item, const SupportTree::Item& balls, double best) {
    Sphere found;
    const double value = evaluate(item, balls, query, best, found);
    if (value < best) {
      nearest.ball = found;
      nearest.cell = item;
    }
    return value;
  };
  nearest.distance = tree_.min(query, nearest.distance, value_of, enough);
  return nearest;
}

Reconstruction::Nearest Reconstruction::nearest_in(Index cell, const Point& query) const {
  const auto& [a, b, c] = corners_[cell];
  Nearest result{.distance = 0, .ball = {Point::Zero(), 0}, .cell = cell};
  result.distance =
      evaluate(cell, {balls_[a], balls_[b], balls_[c]}, query, std::numeric_limits<double>::infinity(), result.ball);
  return result;
}

double Reconstruction::distance_to_cell(Index cell, const Point& query, double best) const {
  const auto& [a, b, c] = corners_[cell];
  Sphere ball;
  return evaluate(cell, {balls_[a], balls_[b], balls_[c]}, query, best, ball);
}

}  // namespace orchard::detail
