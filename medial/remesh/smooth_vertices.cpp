#include <algorithm>
#include <cmath>
#include <limits>

#include "remesher.h"

namespace orchard::detail {
namespace {

constexpr double kAside = 0.5;          // of a step: how far the exact ball may be from the place aimed at
constexpr double kAlwaysNear = 0.1;     // of the length aimed at: it may be this far in any case
constexpr double kNothing = 0.01;       // of that length: shorter steps change nothing
constexpr std::array kParts{1.0, 0.4};  // parts of a step that are tried

// The two contacts that lie farthest apart along a normal.
std::array<ClosestPoint, 2> sides(const ExactBall& ball, const Vector& normal) {
  const auto height = [&](const ClosestPoint& contact) { return normal.dot(contact.position - ball.center); };
  const auto less = [&](const ClosestPoint& p, const ClosestPoint& q) { return height(p) < height(q); };
  const auto touching = ball.touching();
  const auto [low, high] = std::minmax_element(touching.begin(), touching.end(), less);
  return {*low, *high};
}

}  // namespace

void Remesher::smooth() {
  for (Index v = 0; v < mesh_.vertices(); ++v) {
    if (!mesh_.has(v) || active_[v] == 0 || open_[v] == 0) continue;
    active_[v] = 0;
    bool moved = false;
    switch (mesh_.stratum(v)) {
      case Stratum::junction:
        break;
      case Stratum::sheet:
        moved = !on_surface(v) && smooth_in_sheet(v);
        break;
      case Stratum::border:
        moved = on_surface(v) ? slide(v) : smooth_border(v);
        break;
      default:
        moved = smooth_along(v);
        break;
    }
    moved_ += moved ? 1 : 0;
  }
}

// Moves a vertex in the plane of its triangles to the mean of their centroids, weighted by their areas. Areas are
// measured in units of the length aimed at.
bool Remesher::smooth_in_sheet(Index v) {
  Vector sum = Vector::Zero(), normal = Vector::Zero();
  double weight = 0;
  for (const Index c : mesh_.cells_at(v)) {
    const Cell& cell = mesh_.corners(c);
    const Point &p = mesh_.center(cell[0]), &q = mesh_.center(cell[1]), &r = mesh_.center(cell[2]);
    const Vector across = (q - p).cross(r - p);
    const double area = across.norm() / std::pow((target_[cell[0]] + target_[cell[1]] + target_[cell[2]]) / 3, 2);
    sum += area * (p + q + r) / 3;
    weight += area;
    normal += across.dot(normal) < 0 ? -across : across;
  }
  if (!(weight > 0) || !(normal.squaredNorm() > 0)) return false;
  normal.normalize();
  Vector step = sum / weight - mesh_.center(v);
  step -= step.dot(normal) * normal;
  return move(v, step, &normal);
}

// Moves a vertex of a border towards the quadratic curve that fits five vertices of the border by least squares
// (Savitzky and Golay 1964), which removes zigzags and keeps arcs; and along the border towards the middle of its
// neighbours.
bool Remesher::smooth_border(Index v) {
  std::vector<Index> along, next;
  mesh_.neighbors_along(v, along);
  if (along.size() != 2) return false;
  std::array<Point, 2> near, far;
  bool full = true;
  for (std::size_t i = 0; i < 2; ++i) {
    near[i] = far[i] = mesh_.center(along[i]);
    full = full && mesh_.stratum(along[i]) == Stratum::border && !on_surface(along[i]);
    if (!full) continue;
    mesh_.neighbors_along(along[i], next);
    full = next.size() == 2;
    if (full) far[i] = mesh_.center(next[0] == v ? next[1] : next[0]);
  }
  const Point& here = mesh_.center(v);
  Vector step = full ? Vector((17 * here + 12 * (near[0] + near[1]) - 3 * (far[0] + far[1])) / 35 - here)
                     : Vector(0.25 * (near[0] + near[1] - 2 * here));
  const Vector chord = near[1] - near[0];
  if (chord.squaredNorm() > 0) {
    const Vector tangent = chord.normalized();
    const double even = 0.5 * tangent.dot(0.5 * (near[0] + near[1]) - here);
    step += (even - step.dot(tangent)) * tangent;
  }
  return move(v, step, nullptr);
}

bool Remesher::smooth_along(Index v) {
  std::vector<Index> along;
  mesh_.neighbors_along(v, along);
  if (along.size() != 2) return false;
  return move(v, 0.25 * (mesh_.center(along[0]) + mesh_.center(along[1]) - 2 * mesh_.center(v)), nullptr);
}

// Moves a vertex along a feature edge of the surface.
bool Remesher::slide(Index v) {
  std::vector<Index> along;
  mesh_.neighbors_along(v, along);
  if (along.size() != 2 || !on_surface(along[0]) || !on_surface(along[1])) return false;
  const Point middle = 0.5 * mesh_.center(v) + 0.25 * (mesh_.center(along[0]) + mesh_.center(along[1]));
  ClosestPoint place = ExactBall::nowhere();
  return sharp_.nearest(middle, 0.25 * length(along[0], along[1]), place) && put(v, ball_on_edge(place));
}

// Between which contacts a ball near a vertex is looked for: those of the two sides of its sheet, or all of its own;
// its neighbours' where it has none.
std::vector<ClosestPoint> Remesher::contacts_near(Index v, const Vector* normal) const {
  const ExactBall& ball = mesh_.ball(v);
  std::vector<ClosestPoint> contacts;
  const auto add = [&](const auto& some) { contacts.insert(contacts.end(), some.begin(), some.end()); };
  if (ball.count < 2) {
    std::vector<Index> around;
    mesh_.neighbors(v, around);
    for (const Index other : around) add(mesh_.ball(other).touching());
  } else if (normal != nullptr) {
    add(sides(ball, *normal));
  } else {
    add(ball.touching());
  }
  if (contacts_wanted(v) > ball.count) {
    std::vector<Index> along;
    mesh_.neighbors_along(v, along);
    for (const Index other : along) add(mesh_.ball(other).touching());
  }
  return contacts;
}

// A ball of a seam touches in three places. One that has less has left its seam.
int Remesher::contacts_wanted(Index v) const {
  return mesh_.stratum(v) == Stratum::seam ? std::max(3, mesh_.ball(v).count) : 0;
}

bool Remesher::move(Index v, const Vector& step, const Vector* normal) {
  const double size = step.norm();
  if (!(size > kNothing * target_[v]) && mesh_.ball(v).count >= contacts_wanted(v)) return false;
  const std::vector<ClosestPoint> contacts = contacts_near(v, normal);
  const Point from = mesh_.center(v);
  return std::any_of(kParts.begin(), kParts.end(), [&](double part) {
    const Point start = from + part * step;
    const ExactBall found = solver_.solve(start, contacts);
    const bool near = found.exact && (found.center - start).norm() <= kAside * part * size + kAlwaysNear * target_[v];
    if (found.count < contacts_wanted(v)) return false;
    return near && surface_.inside(found.center) && put(v, found);
  });
}

// Makes a vertex this ball, if that keeps what must be kept.
bool Remesher::put(Index v, const ExactBall& ball) {
  const std::vector<Index> cells = cells_at(v);
  const ExactBall ball_before = mesh_.ball(v);
  mesh_.set_ball(v, ball);
  if (stays_well_shaped(cells, v, ball_before) && cover_.stay_covered(mesh_, cells, cells, std::array{v}) &&
      stays_right(cells, v, ball_before)) {
    cover_.settle();
    for (const Index c : cells) {
      for (const Index other : mesh_.corners(c)) active_[other] = 1;
    }
    return true;
  }
  mesh_.set_ball(v, ball_before);
  return false;
}

// Whether the cells at a vertex are well shaped, or as well as before.
bool Remesher::stays_well_shaped(std::span<const Index> cells, Index v, const ExactBall& ball_before) {
  const TriangleShape now = worst_shape(mesh_, cells);
  if (now.quality >= kGoodQuality && now.flatness.keeps({})) return true;
  const ExactBall ball = mesh_.ball(v);
  mesh_.set_ball(v, ball_before);
  const TriangleShape before = worst_shape(mesh_, cells);
  mesh_.set_ball(v, ball);
  return now.quality >= std::min(before.quality, kGoodQuality) && now.flatness.keeps(before.flatness);
}

// Whether the cells at a vertex are off by no more than the tolerance, or than before.
bool Remesher::stays_right(std::span<const Index> cells, Index v, const ExactBall& ball_before) {
  const double error = errors_.of_cells_at(cells, v, std::numeric_limits<double>::infinity());
  if (error <= options_.tolerance) return true;
  const ExactBall ball = mesh_.ball(v);
  mesh_.set_ball(v, ball_before);
  const double error_before = errors_.of_cells_at(cells, v, error);
  mesh_.set_ball(v, ball);
  return error <= error_before;
}

}  // namespace orchard::detail
