#include "foot.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace orchard::detail {
namespace {

constexpr int kMaxHops = 6;
constexpr std::size_t kBallsInTurn = 64;  // balls that one task handles in turn

// A lower bound on the value of a cell's foot. The component of the distance along one direction, minus the radius, is
// linear on the cell, so it is least at a corner. In the direction from the cell's middle, the component is nearly the
// whole distance.
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

bool inside(const Foot& foot) { return *std::min_element(foot.weights.begin(), foot.weights.end()) > 0; }

// `improve` searches the cells at a corner for a better foot.
template <class Improve>
Foot walk_from(Foot best, const Improve& improve) {
  Index last = kNone;
  for (int hop = 0; hop < kMaxHops; ++hop) {
    const auto heaviest = std::max_element(best.weights.begin(), best.weights.end()) - best.weights.begin();
    const Index corner = best.corners[static_cast<std::size_t>(heaviest)];
    if (corner == last) break;
    last = corner;
    improve(corner, best);
  }
  return best;
}

}  // namespace

Foot foot_on(const ContractibleMesh& mesh, const std::array<Index, 3>& corners, const Point& query) {
  const auto& [ia, ib, ic] = corners;
  const Ball4 &a = mesh.ball(ia), &b = mesh.ball(ib), &c = mesh.ball(ic);
  Foot foot{.corners = corners};
  if (ib == ia) {
    foot.value = value_of(query, a);
  } else if (ic == ia) {
    foot.value = EdgeBalls(a, b).value(query, foot.weights[1]);
    foot.weights[0] = 1 - foot.weights[1];
  } else {
    const std::array<const Ball4*, 4> balls{&a, &b, &c, &a};
    const CellFoot found = foot_on_triangle(
        PlaneBalls(a, b, c), [&](std::size_t i) { return EdgeBalls(*balls[i], *balls[i + 1]); }, query);
    foot.weights = found.weights;
    foot.value = found.value;
  }
  return foot;
}

std::vector<CellBalls> balls_of_cells(const ContractibleMesh& mesh) {
  std::vector<CellBalls> result;
  for (const auto& cell : mesh.maximal_cells()) result.emplace_back(mesh, cell);
  return result;
}

FootWalker::FootWalker(const ContractibleMesh& mesh) : mesh_(mesh), cells_(balls_of_cells(mesh)) {
  std::vector<Index> next(mesh.size() + 1, 0);
  const auto visit = [&](const auto& look_at) {
    for (Index i = 0; i < cells_.size(); ++i) {
      const auto& [a, b, c] = cells_[i].corners();
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

void FootWalker::follow_mesh() {
  for (CellBalls& cell : cells_) cell.prepare(mesh_);
}

Foot FootWalker::foot_of(const Point& query, const Foot& start) const {
  if (start.corners[1] != start.corners[0]) {
    for (const Index cell : at_[start.corners[0]]) {
      if (cells_[cell].corners() != start.corners) continue;
      const auto [weights, value] = cells_[cell].foot(query);
      return {start.corners, weights, value};
    }
  }
  return foot_on(mesh_, start.corners, query);
}

Foot FootWalker::walk(const Point& query, const Foot& start) const {
  const Foot here = foot_of(query, start);
  if (inside(here)) return here;  // its neighbours have no better one
  return walk_from(here, [&](Index corner, Foot& best) {
    const auto from = best.corners;
    for (const Index cell : at_[corner]) {
      const auto& corners = cells_[cell].corners();
      if (corners == from) continue;
      const auto [weights, value] = cells_[cell].foot(query);
      if (value < best.value) best = {corners, weights, value};
    }
  });
}

Foot walk_to_foot(const ContractibleMesh& mesh, const Point& query, const Foot& start) {
  const Foot here = foot_on(mesh, start.corners, query);
  if (inside(here)) return here;
  return walk_from(here, [&](Index corner, Foot& best) {
    const auto look_at = [&](const std::array<Index, 3>& cell) {
      if (cell == best.corners || bound_on(mesh, cell, query) >= best.value) return;
      const Foot foot = foot_on(mesh, cell, query);
      if (foot.value < best.value) best = foot;
    };
    for (const Index t : mesh.triangles_at(corner)) look_at(mesh.triangle(t));
    for (const Index other : mesh.neighbors(corner)) {
      if (mesh.count_triangles_at(corner, other) == 0) look_at({corner, other, corner});
    }
  });
}

FootFinder::FootFinder(const ContractibleMesh& mesh) : mesh_(mesh), cells_(balls_of_cells(mesh)) {
  std::vector<SupportTree::Item> items;
  items.reserve(cells_.size());
  for (const auto& cell : cells_) {
    SupportTree::Item item;
    for (std::size_t k = 0; k < 3; ++k) {
      const Ball4& ball = mesh.ball(cell.corners()[k]);
      item[k] = {ball.head<3>(), ball[3]};
    }
    items.push_back(item);
  }
  tree_ = SupportTree(std::move(items));
}

Foot FootFinder::find(const Point& query, const Foot* guess, double slack) const {
  Foot best{.value = std::numeric_limits<double>::infinity()};
  if (guess != nullptr) best = foot_on(mesh_, guess->corners, query);
  tree_.min(query, best.value - slack, [&](Index item, const SupportTree::Item&, double) {
    const auto [weights, value] = cells_[item].foot(query);
    if (value < best.value) best = {cells_[item].corners(), weights, value};
    return value;
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
