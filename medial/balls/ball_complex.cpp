#include "ball_complex.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

namespace orchard::detail {
namespace {

using Triangle = std::array<Index, 3>;

// Cuts a triangle by the vertices that divide its sides (b c), (c a) and (a b); kNone for a side that is not divided.
class TriangleCutter {
 public:
  TriangleCutter(const BallComplex& complex, std::vector<Triangle>& out) : complex_(complex), out_(out) {}

  void cut(const Triangle& corners, const Triangle& middle) {
    const auto cuts = std::count_if(middle.begin(), middle.end(), [](Index m) { return m != kNone; });
    if (cuts == 3) {
      out_.push_back(middle);
      for (std::size_t i = 0; i < 3; ++i) out_.push_back({corners[i], middle[(i + 1) % 3], middle[(i + 2) % 3]});
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = corners[i], b = corners[(i + 1) % 3], c = corners[(i + 2) % 3];
      if (cuts == 1 && middle[i] != kNone) {
        out_.push_back({a, b, middle[i]});
        out_.push_back({a, middle[i], c});
      }
      if (cuts == 2 && middle[i] == kNone) {
        const Index ca = middle[(i + 1) % 3], ab = middle[(i + 2) % 3];
        out_.push_back({a, ab, ca});
        quad(b, c, ca, ab);
      }
    }
  }

 private:
  // Divides a quadrilateral along its shorter diagonal.
  void quad(Index a, Index b, Index c, Index d) {
    const auto apart = [&](Index p, Index q) {
      return (complex_.balls[p].center - complex_.balls[q].center).squaredNorm();
    };
    if (apart(a, c) <= apart(b, d)) {
      out_.push_back({a, b, c});
      out_.push_back({a, c, d});
    } else {
      out_.push_back({a, b, d});
      out_.push_back({b, c, d});
    }
  }

  const BallComplex& complex_;
  std::vector<Triangle>& out_;
};

class ComplexCollapse {
 public:
  ComplexCollapse(BallComplex& complex, const Doomed& doomed, const std::vector<double>& value)
      : complex_(complex), doomed_(doomed), value_(value), at_(complex.edges, complex.triangles, complex.size()) {
    alive_.vertices.assign(complex.balls.size(), 1);
    alive_.edges.assign(complex.edges.size(), 1);
    alive_.triangles.assign(complex.triangles.size(), 1);
  }

  void run() {
    for (Index e = 0; e < alive_.edges.size(); ++e) offer(e);
    while (!queue_.empty()) {
      const Index edge = std::get<1>(queue_.top());
      queue_.pop();
      if (alive_.edges[edge]) take(edge);
    }
    keep_alive(complex_, alive_);
  }

 private:
  bool has_triangle(Index edge) const {
    const auto row = at_.triangles_at[edge];
    return std::any_of(row.begin(), row.end(), [&](Index t) { return alive_.triangles[t] != 0; });
  }
  Index free_end(Index edge) const {
    if (has_triangle(edge)) return kNone;
    for (const Index v : complex_.edges[edge]) {
      if (doomed_.vertices[v] && only(at_.edges_at[v], alive_.edges) == edge) return v;
    }
    return kNone;
  }
  void offer(Index edge) {
    if (!alive_.edges[edge] || !doomed_.edges[edge]) return;
    if (only(at_.triangles_at[edge], alive_.triangles) == kNone && free_end(edge) == kNone) return;
    const auto& [a, b] = complex_.edges[edge];
    queue_.emplace(std::min(value_[a], value_[b]), edge);
  }
  void take(Index edge) {
    const Index triangle = only(at_.triangles_at[edge], alive_.triangles);
    if (triangle != kNone) {
      alive_.edges[edge] = alive_.triangles[triangle] = 0;
      for (const Index side : at_.sides[triangle]) offer(side);
    } else {
      const Index end = free_end(edge);
      if (end == kNone) return;
      alive_.edges[edge] = alive_.vertices[end] = 0;
    }
    for (const Index v : complex_.edges[edge]) {
      for (const Index other : at_.edges_at[v]) offer(other);
    }
  }

  BallComplex& complex_;
  const Doomed& doomed_;
  const std::vector<double>& value_;
  const CellIncidence at_;
  Alive alive_;
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue_;
};

}  // namespace

MedialMesh BallComplex::mesh() const {
  MedialMesh mesh{.centers = {}, .radii = {}, .edges = edges, .triangles = triangles};
  for (const ExactBall& ball : balls) {
    mesh.centers.push_back(ball.center);
    mesh.radii.push_back(ball.radius);
  }
  return mesh;
}

void BallComplex::complete() { complete_cells(edges, triangles); }

void subdivide(BallComplex& complex, const std::vector<Index>& cut) {
  std::vector<std::uint8_t> at_cut(complex.size(), 0);  // the vertices at edges that are cut, which are usually few
  for (Index e = 0; e < complex.edges.size(); ++e) {
    if (cut[e] == kNone) continue;
    for (const Index v : complex.edges[e]) at_cut[v] = 1;
  }
  std::vector<Triangle> kept, pieces;
  kept.reserve(complex.triangles.size());
  TriangleCutter cutter(complex, pieces);
  const EdgeNumbers edge = complex.edge_numbers();
  for (const auto& [a, b, c] : complex.triangles) {
    Triangle middle{kNone, kNone, kNone};
    if (at_cut[a] + at_cut[b] + at_cut[c] > 1) middle = {cut[edge(b, c)], cut[edge(a, c)], cut[edge(a, b)]};
    if (middle == Triangle{kNone, kNone, kNone}) {
      kept.push_back({a, b, c});
    } else {
      cutter.cut({a, b, c}, middle);
    }
  }
  std::vector<std::array<Index, 2>> edges, halves;
  edges.reserve(complex.edges.size());
  for (Index e = 0; e < complex.edges.size(); ++e) {
    const auto& [a, b] = complex.edges[e];
    if (cut[e] == kNone) {
      edges.push_back({a, b});
    } else {
      halves.push_back({a, cut[e]});
      halves.push_back({b, cut[e]});
    }
  }
  insert_cells(edges, kept, std::move(halves), std::move(pieces));
  complex.triangles = std::move(kept);
  complex.edges = std::move(edges);
}

void keep_alive(BallComplex& complex, const Alive& alive) {
  std::vector<Index> number(alive.vertices.size(), kNone);
  Index count = 0;
  for (Index v = 0; v < number.size(); ++v) {
    if (!alive.vertices[v]) continue;
    number[v] = count;
    complex.balls[count++] = complex.balls[v];
  }
  complex.balls.resize(count);
  const auto keep = [&](auto& cells, const std::vector<std::uint8_t>& stays) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!stays[i]) continue;
      cells[kept] = cells[i];
      for (Index& v : cells[kept]) v = number[v];
      ++kept;
    }
    cells.resize(kept);
  };
  keep(complex.edges, alive.edges);
  keep(complex.triangles, alive.triangles);
}

void collapse(BallComplex& complex, const Doomed& doomed, const std::vector<double>& value_of_vertex) {
  ComplexCollapse(complex, doomed, value_of_vertex).run();
}

}  // namespace orchard::detail
