#include "contractible_mesh.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace orchard::detail {
namespace {

bool has_corner(const ContractibleMesh::Triangle& triangle, Index vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

// The third corner of a triangle that has the other two.
Index third(const ContractibleMesh::Triangle& triangle, Index a, Index b) {
  for (const Index corner : triangle) {
    if (corner != a && corner != b) return corner;
  }
  return kNone;
}

void insert_sorted(std::vector<Index>& items, Index item) {
  const auto at = std::lower_bound(items.begin(), items.end(), item);
  if (at == items.end() || *at != item) items.insert(at, item);
}

void erase_sorted(std::vector<Index>& items, Index item) {
  const auto at = std::lower_bound(items.begin(), items.end(), item);
  if (at != items.end() && *at == item) items.erase(at);
}

void erase_unsorted(std::vector<Index>& items, Index item) {
  const auto at = std::find(items.begin(), items.end(), item);
  if (at != items.end()) items.erase(at);
}

}  // namespace

ContractibleMesh::ContractibleMesh(const MedialMesh& mesh) {
  balls_.reserve(mesh.centers.size());
  for (Index v = 0; v < mesh.size(); ++v) add_vertex(ball4(mesh.centers[v], mesh.radii[v]));
  for (const auto& [a, b] : mesh.edges) join(a, b);
  for (const auto& [a, b, c] : mesh.triangles) add_triangle(a, b, c);
}

bool ContractibleMesh::adjacent(Index a, Index b) const {
  return std::binary_search(neighbors_[a].begin(), neighbors_[a].end(), b);
}

void ContractibleMesh::opposite(Index a, Index b, std::vector<Index>& out) const {
  out.clear();
  for (const Index t : triangles_at_[a]) {
    if (has_corner(triangles_[t], b)) out.push_back(third(triangles_[t], a, b));
  }
}

Index ContractibleMesh::count_triangles_at(Index a, Index b) const {
  Index count = 0;
  for (const Index t : triangles_at_[a]) count += has_corner(triangles_[t], b) ? 1 : 0;
  return count;
}

bool ContractibleMesh::may_contract(Index a, Index b) const {
  std::vector<Index> common;
  std::set_intersection(neighbors_[a].begin(), neighbors_[a].end(), neighbors_[b].begin(), neighbors_[b].end(),
                        std::back_inserter(common));
  if (common.size() != count_triangles_at(a, b)) return false;
  const auto is_common = [&](Index v) { return std::binary_search(common.begin(), common.end(), v); };
  // If a and b both form a triangle with the same edge of common neighbours, the two triangles would become one.
  for (const Index t : triangles_at_[a]) {
    const Triangle& triangle = triangles_[t];
    if (has_corner(triangle, b)) continue;
    std::array<Index, 2> far{};
    std::size_t count = 0;
    for (const Index corner : triangle) {
      if (corner != a) far[count++] = corner;
    }
    if (!is_common(far[0]) || !is_common(far[1])) continue;
    const bool twice = std::any_of(triangles_at_[b].begin(), triangles_at_[b].end(), [&](Index other) {
      return has_corner(triangles_[other], far[0]) && has_corner(triangles_[other], far[1]);
    });
    if (twice) return false;
  }
  return true;
}

void ContractibleMesh::contract(Index a, Index b, const Ball4& ball) {
  const std::vector<Index> around = triangles_at_[b];
  for (const Index t : around) {
    Triangle& triangle = triangles_[t];
    if (has_corner(triangle, a)) {
      remove_triangle(t);
      continue;
    }
    for (Index& corner : triangle) {
      if (corner == b) corner = a;
    }
    std::sort(triangle.begin(), triangle.end());
    triangles_at_[a].push_back(t);
  }
  for (const Index other : neighbors_[b]) {
    erase_sorted(neighbors_[other], b);
    if (other != a) join(a, other);
  }
  neighbors_[b].clear();
  triangles_at_[b].clear();
  alive_[b] = 0;
  --living_;
  balls_[a] = ball;
}

Index ContractibleMesh::divide(Index a, Index b, const Ball4& ball) {
  const Index middle = add_vertex(ball);
  std::vector<Index> at_edge;
  for (const Index t : triangles_at_[a]) {
    if (has_corner(triangles_[t], b)) at_edge.push_back(t);
  }
  for (const Index t : at_edge) {
    const Index c = third(triangles_[t], a, b);
    remove_triangle(t);
    add_triangle(a, middle, c);
    add_triangle(middle, b, c);
  }
  part(a, b);
  join(a, middle);
  join(b, middle);
  return middle;
}

Index ContractibleMesh::extend(Index a, const Ball4& ball) {
  const Index end = add_vertex(ball);
  join(a, end);
  return end;
}

Index ContractibleMesh::extend(Index a, Index b, const Ball4& ball) {
  const Index end = add_vertex(ball);
  add_triangle(a, b, end);
  return end;
}

Index ContractibleMesh::collapse(Index a, Index b) {
  const auto at = std::find_if(triangles_at_[a].begin(), triangles_at_[a].end(),
                               [&](Index t) { return has_corner(triangles_[t], b); });
  const Index c = third(triangles_[*at], a, b);
  remove_triangle(*at);
  part(a, b);
  return c;
}

bool ContractibleMesh::has_contractible_edge() const {
  for (Index v = 0; v < size(); ++v) {
    for (const Index other : neighbors_[v]) {
      if (v < other && may_contract(v, other)) return true;
    }
  }
  return false;
}

bool ContractibleMesh::make_contractible() {
  while (!has_contractible_edge()) {
    if (!take_free_triangle()) return false;
  }
  return true;
}

bool ContractibleMesh::take_free_triangle() {
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (!triangle_alive_[t]) continue;
    const auto [a, b, c] = triangles_[t];
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{a, c}, std::pair{b, c}}) {
      if (count_triangles_at(p, q) != 1) continue;
      remove_triangle(t);
      part(p, q);
      return true;
    }
  }
  return false;
}

bool ContractibleMesh::merge_edges() {
  double min = std::numeric_limits<double>::infinity();
  std::array<Index, 3> best{kNone, kNone, kNone};
  std::vector<Index> common;
  for (Index v = 0; v < size(); ++v) {
    for (const Index a : neighbors_[v]) {
      for (const Index b : neighbors_[v]) {
        const double distance = (balls_[a] - balls_[b]).squaredNorm();
        if (b <= a || distance >= min || adjacent(a, b)) continue;
        common.clear();
        std::set_intersection(neighbors_[a].begin(), neighbors_[a].end(), neighbors_[b].begin(), neighbors_[b].end(),
                              std::back_inserter(common));
        if (common.size() > 1) continue;
        min = distance;
        best = {v, a, b};
      }
    }
  }
  const auto [v, a, b] = best;
  if (v == kNone) return false;
  add_triangle(v, a, b);
  contract(a, b, 0.5 * (balls_[a] + balls_[b]));
  return true;
}

MedialMesh ContractibleMesh::mesh() const {
  MedialMesh mesh;
  std::vector<Index> number(balls_.size(), kNone);
  for (Index v = 0; v < size(); ++v) {
    if (!alive(v)) continue;
    number[v] = mesh.size();
    mesh.centers.emplace_back(balls_[v].head<3>());
    mesh.radii.push_back(balls_[v][3]);
  }
  for (Index v = 0; v < size(); ++v) {
    for (const Index other : neighbors_[v]) {
      if (v < other) mesh.edges.push_back({number[v], number[other]});
    }
  }
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (!triangle_alive_[t]) continue;
    const auto& [a, b, c] = triangles_[t];
    mesh.triangles.push_back({number[a], number[b], number[c]});
  }
  complete(mesh);
  return mesh;
}

std::vector<ContractibleMesh::Triangle> ContractibleMesh::triangles() const {
  std::vector<Triangle> triangles;
  triangles.reserve(triangles_.size());
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (triangle_alive_[t]) triangles.push_back(triangles_[t]);
  }
  return triangles;
}

std::vector<ContractibleMesh::Triangle> ContractibleMesh::maximal_cells() const {
  std::vector<Triangle> cells = triangles();
  for (Index v = 0; v < size(); ++v) {
    for (const Index other : neighbors_[v]) {
      if (v < other && count_triangles_at(v, other) == 0) cells.push_back({v, other, v});
    }
    if (alive(v) && neighbors_[v].empty()) cells.push_back({v, v, v});
  }
  return cells;
}

Index ContractibleMesh::add_vertex(const Ball4& ball) {
  balls_.push_back(ball);
  alive_.push_back(1);
  neighbors_.emplace_back();
  triangles_at_.emplace_back();
  ++living_;
  return size() - 1;
}

void ContractibleMesh::add_triangle(Index a, Index b, Index c) {
  Triangle triangle{a, b, c};
  std::sort(triangle.begin(), triangle.end());
  Index number = static_cast<Index>(triangles_.size());
  if (free_triangles_.empty()) {
    triangles_.push_back(triangle);
    triangle_alive_.push_back(1);
  } else {
    number = free_triangles_.back();
    free_triangles_.pop_back();
    triangles_[number] = triangle;
    triangle_alive_[number] = 1;
  }
  for (const Index corner : triangle) triangles_at_[corner].push_back(number);
  join(a, b);
  join(a, c);
  join(b, c);
}

void ContractibleMesh::remove_triangle(Index triangle) {
  for (const Index corner : triangles_[triangle]) erase_unsorted(triangles_at_[corner], triangle);
  triangle_alive_[triangle] = 0;
  free_triangles_.push_back(triangle);
}

void ContractibleMesh::join(Index a, Index b) {
  insert_sorted(neighbors_[a], b);
  insert_sorted(neighbors_[b], a);
}

void ContractibleMesh::part(Index a, Index b) {
  erase_sorted(neighbors_[a], b);
  erase_sorted(neighbors_[b], a);
}

}  // namespace orchard::detail
