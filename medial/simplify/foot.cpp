#include "foot.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace orchard::detail {
namespace {

constexpr int kMaxHops = 6;
constexpr std::size_t kBallsInTurn = 64;  // that one task takes, one after the other

// Along a segment the distance is convex: sqrt(h^2 + (t - q)^2) - r(t), least where the slope of the root is that of
// the radius. Returns the share of b.
double share_on_edge(const Point& query, const Ball4& a, const Ball4& b) {
  const Vector along = (b - a).head<3>();
  const double length = along.norm();
  if (!(length > 0)) return a[3] >= b[3] ? 0 : 1;
  const double slope = (b[3] - a[3]) / length;
  const Vector offset = query - a.head<3>();
  const double foot = along.dot(offset) / length;
  if (std::abs(slope) >= 1) return slope > 0 ? 1 : 0;
  const double height = std::sqrt(std::max(0.0, offset.squaredNorm() - foot * foot));
  return std::clamp((foot + slope * height / std::sqrt(1 - slope * slope)) / length, 0.0, 1.0);
}

double value_of(const Point& query, const Ball4& ball) { return (query - ball.head<3>()).norm() - ball[3]; }

// A lower bound on what a cell has: what is seen of the distance along one direction is linear on it, so no less than
// at a corner. Along the way from the middle it is nearly all of the distance.
double bound_on(const ContractibleMesh& mesh, const std::array<Index, 3>& corners, const Point& query) {
  const Ball4 &a = mesh.ball(corners[0]), &b = mesh.ball(corners[1]), &c = mesh.ball(corners[2]);
  Vector direction = query - (a + b + c).head<3>() / 3;
  const double length = direction.norm();
  if (!(length > 0)) return -std::numeric_limits<double>::infinity();
  direction /= length;
  Ball4 support;
  support << direction, 1;
  return direction.dot(query) - std::max({support.dot(a), support.dot(b), support.dot(c)});
}

Foot edge_foot(const ContractibleMesh& mesh, Index a, Index b, const Point& query) {
  const double share = share_on_edge(query, mesh.ball(a), mesh.ball(b));
  Foot foot{.corners = {a, b, a}, .weights = {1 - share, share, 0}};
  foot.value = value_of(query, foot.ball(mesh));
  return foot;
}

// `visit` shows the cells at a corner.
template <class Visit>
Foot walk_from(const ContractibleMesh& mesh, const Point& query, const Foot& start, const Visit& visit) {
  Foot best = foot_on(mesh, start.corners, query);
  Index last = kNone;
  for (int hop = 0; hop < kMaxHops; ++hop) {
    const auto heaviest = std::max_element(best.weights.begin(), best.weights.end()) - best.weights.begin();
    const Index corner = best.corners[static_cast<std::size_t>(heaviest)];
    if (corner == last) break;
    last = corner;
    visit(corner, [&](const std::array<Index, 3>& cell) {
      if (cell == best.corners || bound_on(mesh, cell, query) >= best.value) return;
      const Foot foot = foot_on(mesh, cell, query);
      if (foot.value < best.value) best = foot;
    });
  }
  return best;
}

}  // namespace

// Over a plane the radius has a gradient, and the least is one step along it from the foot of the perpendicular. Where
// that leaves the triangle, or does not exist, the least is on the border.
Foot foot_on(const ContractibleMesh& mesh, const std::array<Index, 3>& corners, const Point& query) {
  const auto& [ia, ib, ic] = corners;
  if (ib == ia) return {.corners = corners, .weights = {1, 0, 0}, .value = value_of(query, mesh.ball(ia))};
  if (ic == ia) return edge_foot(mesh, ia, ib, query);
  const Ball4 &a = mesh.ball(ia), &b = mesh.ball(ib), &c = mesh.ball(ic);
  const Vector u = (b - a).head<3>(), v = (c - a).head<3>(), normal = u.cross(v);
  const double squared = normal.squaredNorm();
  if (squared > 0) {
    const Vector across_v = v.cross(normal) / squared, across_u = normal.cross(u) / squared;
    const Vector gradient = (b[3] - a[3]) * across_v + (c[3] - a[3]) * across_u;
    const double steep = gradient.squaredNorm();
    if (steep < 1) {
      const Vector offset = query - a.head<3>();
      const double height = std::abs(normal.dot(offset)) / std::sqrt(squared);
      const Vector place = offset + height / std::sqrt(1 - steep) * gradient;
      const double beta = across_v.dot(place), gamma = across_u.dot(place);
      if (beta >= 0 && gamma >= 0 && beta + gamma <= 1) {
        Foot foot{.corners = corners, .weights = {1 - beta - gamma, beta, gamma}};
        foot.value = value_of(query, foot.ball(mesh));
        return foot;
      }
    }
  }
  Foot best{.value = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double share = share_on_edge(query, mesh.ball(corners[i]), mesh.ball(corners[j]));
    Foot foot{.corners = corners};
    foot.weights[i] = 1 - share;
    foot.weights[j] = share;
    foot.weights[k] = 0;
    foot.value = value_of(query, foot.ball(mesh));
    if (foot.value < best.value) best = foot;
  }
  return best;
}

FootWalker::FootWalker(const ContractibleMesh& mesh) : mesh_(mesh), cells_(mesh.maximal_cells()) {
  std::vector<Index> next(mesh.size() + 1, 0);
  const auto visit = [&](const auto& look_at) {
    for (Index i = 0; i < cells_.size(); ++i) {
      const auto& [a, b, c] = cells_[i];
      look_at(a, i);
      if (b != a) look_at(b, i);
      if (c != a) look_at(c, i);
    }
  };
  visit([&](Index v, Index) { ++next[v + 1]; });
  for (Index v = 0; v < mesh.size(); ++v) next[v + 1] += next[v];
  at_.offsets = next;
  at_.items.resize(next.back());
  visit([&](Index v, Index cell) { at_.items[next[v]++] = cell; });
}

Foot FootWalker::walk(const Point& query, const Foot& start) const {
  const Foot here = foot_on(mesh_, start.corners, query);
  // Inside a triangle it is the best around.
  if (*std::min_element(here.weights.begin(), here.weights.end()) > 0) return here;
  return walk_from(mesh_, query, start, [&](Index corner, const auto& look_at) {
    for (const Index cell : at_[corner]) look_at(cells_[cell]);
  });
}

Foot walk_to_foot(const ContractibleMesh& mesh, const Point& query, const Foot& start) {
  const Foot here = foot_on(mesh, start.corners, query);
  if (*std::min_element(here.weights.begin(), here.weights.end()) > 0) return here;
  return walk_from(mesh, query, start, [&](Index corner, const auto& look_at) {
    for (const Index t : mesh.triangles_at(corner)) look_at(mesh.triangle(t));
    for (const Index other : mesh.neighbors(corner)) {
      if (mesh.count_triangles_at(corner, other) == 0) look_at({corner, other, corner});
    }
  });
}

FootFinder::FootFinder(const ContractibleMesh& mesh) : mesh_(mesh), cells_(mesh.maximal_cells()) {
  std::vector<SupportTree::Item> items;
  items.reserve(cells_.size());
  for (const auto& cell : cells_) {
    SupportTree::Item item;
    for (std::size_t k = 0; k < 3; ++k) item[k] = {mesh.ball(cell[k]).head<3>(), mesh.ball(cell[k])[3]};
    items.push_back(item);
  }
  tree_ = SupportTree(std::move(items));
}

Foot FootFinder::find(const Point& query, const Foot* guess, double slack) const {
  Foot best{.value = std::numeric_limits<double>::infinity()};
  if (guess != nullptr) best = foot_on(mesh_, guess->corners, query);
  tree_.min(query, best.value - slack, [&](Index item, const SupportTree::Item&, double min) {
    const double bound = bound_on(mesh_, cells_[item], query);
    if (bound >= min) return bound;
    const Foot foot = foot_on(mesh_, cells_[item], query);
    if (foot.value < best.value) best = foot;
    return foot.value;
  });
  return best;
}

std::vector<Sphere> balls_beyond(const ContractibleMesh& mesh, std::span<const Sphere> balls, double depth) {
  const FootFinder finder(mesh);
  const FootWalker walker(mesh);
  std::vector<std::uint8_t> beyond(balls.size(), 0);
  tbb::parallel_for(std::size_t{0}, (balls.size() + kBallsInTurn - 1) / kBallsInTurn, [&](std::size_t block) {
    const std::size_t begin = block * kBallsInTurn, end = std::min(balls.size(), begin + kBallsInTurn);
    Foot foot;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [center, radius] = balls[i];
      foot = i == begin ? finder.find(center) : walker.walk(center, foot);
      beyond[i] = foot.value >= depth - radius ? 1 : 0;
    }
  });
  std::vector<Sphere> result;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (beyond[i]) result.push_back(balls[i]);
  }
  return result;
}

}  // namespace orchard::detail
