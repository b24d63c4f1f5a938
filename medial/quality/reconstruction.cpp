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

// Returns a lower bound on the distance to all balls of a triangle. The component of the distance along a fixed
// direction is linear on the triangle, so it is smallest at a corner. The direction from the query to the middle is
// chosen, along which that component is nearly the whole distance.
double min_along(const Point& query, const std::array<Sphere, 3>& balls) {
  Vector direction = query - (balls[0].center + balls[1].center + balls[2].center) / 3;
  const double length = direction.norm();
  if (!(length > 0)) return -std::numeric_limits<double>::infinity();
  direction /= length;
  double min = std::numeric_limits<double>::infinity();
  for (const Sphere& ball : balls) min = std::min(min, direction.dot(query - ball.center) - ball.radius);
  return min;
}

// Returns the cells that are part of no larger one: triangles, edges and vertices. Smaller cells repeat their last
// corner.
std::vector<std::array<Index, 3>> max_cells(const MedialMesh& mesh) {
  const EdgeNumbers edge(mesh.edges, mesh.size());
  std::vector<std::uint8_t> has_triangle(mesh.edges.size(), 0), has_edge(mesh.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles)
    has_triangle[edge(a, b)] = has_triangle[edge(a, c)] = has_triangle[edge(b, c)] = 1;
  std::vector<std::array<Index, 3>> cells = mesh.triangles;
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b] = mesh.edges[e];
    has_edge[a] = has_edge[b] = 1;
    if (!has_triangle[e]) cells.push_back({a, b, b});
  }
  for (Index v = 0; v < mesh.size(); ++v) {
    if (!has_edge[v]) cells.push_back({v, v, v});
  }
  return cells;
}

int dimension(const std::array<Index, 3>& cell) { return cell[0] == cell[1] ? 0 : cell[1] == cell[2] ? 1 : 2; }

// The order of cells in max_cells() of a complete mesh.
bool is_before(const std::array<Index, 3>& a, const std::array<Index, 3>& b) {
  const int of_a = dimension(a), of_b = dimension(b);
  return of_a != of_b ? of_a > of_b : a < b;
}

}  // namespace

// Along the segment, the distance sqrt(h^2 + (t - q)^2) - r(t) is a convex function. Its minimum is where the slope of
// the root equals that of the radius.
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

// The same over a plane, where the radius has a gradient. The minimum is one step along the gradient from the foot of
// the perpendicular. If that leaves the triangle, or does not exist, the minimum is on the border of the triangle.
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

Reconstruction::Reconstruction(const MedialMesh& mesh) : first_(part_of(mesh, max_cells(mesh))) {
  balls_.reserve(mesh.size());
  for (Index v = 0; v < mesh.size(); ++v) balls_.push_back(vertex_ball(mesh, v));
}

// Builds the tree of some cells, and numbers the cells.
Reconstruction::Part Reconstruction::part_of(const MedialMesh& mesh, const std::vector<std::array<Index, 3>>& cells) {
  Part part;
  part.first = this->cells();
  part.size = static_cast<Index>(cells.size());
  std::vector<SupportTree::Item> items;
  items.reserve(cells.size());
  for (const auto& cell : cells) {
    const auto& [a, b, c] = cell;
    items.push_back({vertex_ball(mesh, a), vertex_ball(mesh, b), vertex_ball(mesh, c)});
    part.triangles += dimension(cell) == 2 ? 1 : 0;
    part.edges += dimension(cell) == 1 ? 1 : 0;
  }
  corners_.insert(corners_.end(), cells.begin(), cells.end());
  part.tree = SupportTree(std::move(items));
  return part;
}

void Reconstruction::change(const MedialMesh& mesh) {
  const std::vector<std::array<Index, 3>> now = max_cells(mesh);
  std::vector<std::uint8_t> moved(mesh.size(), 1);
  for (Index v = 0; v < std::min<Index>(mesh.size(), static_cast<Index>(balls_.size())); ++v)
    moved[v] = mesh.centers[v] != balls_[v].center || mesh.radii[v] != balls_[v].radius ? 1 : 0;
  const auto is_new = [&](const std::array<Index, 3>& cell) {
    return std::any_of(cell.begin(), cell.end(), [&](Index v) { return moved[v] != 0; });
  };
  corners_.resize(first_.size);
  std::vector<std::uint8_t> gone(corners_.size(), 1);
  std::vector<std::array<Index, 3>> fresh;
  std::size_t old = 0;
  for (const auto& cell : now) {
    while (old < gone.size() && is_before(corners_[old], cell)) ++old;
    // A cell that is gone stays gone, because a later cell with these corners may have other balls.
    if (old < gone.size() && corners_[old] == cell && !is_new(cell) && (gone_.empty() || !gone_[old])) {
      gone[old] = 0;
    } else {
      fresh.push_back(cell);
    }
  }
  gone_ = std::move(gone);
  changed_ = part_of(mesh, fresh);
  balls_.resize(mesh.size());
  for (Index v = 0; v < mesh.size(); ++v) balls_[v] = vertex_ball(mesh, v);
}

double Reconstruction::evaluate(const Part& part, Index item, const SupportTree::Item& balls, const Point& query,
                                double best, Sphere& ball) {
  if (item < part.triangles) {
    const double bound = min_along(query, balls);
    if (bound >= best) return bound;
    ball = nearest_ball(query, balls[0], balls[1], balls[2]);
  } else {
    ball = item - part.triangles < part.edges ? nearest_ball(query, balls[0], balls[1]) : balls[0];
  }
  return distance_to(query, ball);
}

double Reconstruction::evaluate(Index cell, const Point& query, double best, Sphere& ball) const {
  const auto& [a, b, c] = corners_[cell];
  const Part& part = cell < first_.size ? first_ : changed_;
  return evaluate(part, cell - part.first, {balls_[a], balls_[b], balls_[c]}, query, best, ball);
}

template <class Improved>
double Reconstruction::search(const Point& query, double best, double enough, const Improved& improved) const {
  const auto value_in = [&](const Part& part, Index item, const SupportTree::Item& balls, double least) {
    Sphere ball;
    const double value = evaluate(part, item, balls, query, least, ball);
    if (value < least) improved(part.first + item, ball);
    return value;
  };
  const auto value_of_first = [&](Index item, const SupportTree::Item& balls, double least) {
    return !gone_.empty() && gone_[item] ? least : value_in(first_, item, balls, least);
  };
  best = first_.tree.min(query, best, value_of_first, enough);
  if (changed_.size == 0 || best < enough) return best;
  return changed_.tree.min(
      query, best,
      [&](Index item, const SupportTree::Item& balls, double least) { return value_in(changed_, item, balls, least); },
      enough);
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
  return search(query, bound, enough, [&](Index, const Sphere& found) { ball = found; });
}

Reconstruction::Nearest Reconstruction::nearest(const Point& query, double enough) const {
  return nearest_from({}, query, enough);
}

Reconstruction::Nearest Reconstruction::nearest_from(Nearest nearest, const Point& query, double enough) const {
  nearest.distance = search(query, nearest.distance, enough, [&](Index cell, const Sphere& found) {
    nearest.ball = found;
    nearest.cell = cell;
  });
  return nearest;
}

Reconstruction::Nearest Reconstruction::nearest_in(Index cell, const Point& query) const {
  Nearest result{.distance = 0, .ball = {Point::Zero(), 0}, .cell = cell};
  result.distance = evaluate(cell, query, std::numeric_limits<double>::infinity(), result.ball);
  return result;
}

double Reconstruction::distance_to_cell(Index cell, const Point& query, double best) const {
  Sphere ball;
  return evaluate(cell, query, best, ball);
}

}  // namespace orchard::detail
