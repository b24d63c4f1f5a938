#include "triangulate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace orchard::models {

namespace {

using Edge = std::pair<std::size_t, std::size_t>;

// Lengths and angles closer than this count as equal: far above rounding noise, far below any
// difference that is meant.
constexpr double kTie = 1e-5;
constexpr double kOnLine = 1e-7;

Edge make_edge(std::size_t a, std::size_t b) { return {std::min(a, b), std::max(a, b)}; }

double corner_angle(Vec2 at, Vec2 a, Vec2 b) {
  return std::atan2(std::abs(cross(a - at, b - at)), dot(a - at, b - at));
}

double min_angle(Vec2 a, Vec2 b, Vec2 c) {
  return std::min({corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)});
}

class Triangulator {
 public:
  Triangulator(const std::vector<Vec2>& points, const std::vector<std::vector<std::size_t>>& rings) : points_(points) {
    for (const auto& ring : rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        boundary_.push_back(make_edge(ring[i], ring[(i + 1) % ring.size()]));
      }
    }
    edges_ = boundary_;
    expected_ = points.size() + 2 * rings.size() - 4;
  }

  std::vector<IndexTriangle> run() {
    add_diagonals();
    collect_triangles();
    if (triangles_.size() != expected_) {
      throw std::logic_error("a polygon of the model could not be triangulated");
    }
    while (flip_one()) {
    }
    return triangles_;
  }

 private:
  [[nodiscard]] double side(Vec2 a, Vec2 b, Vec2 p) const { return cross(b - a, p - a) / length(b - a); }

  [[nodiscard]] bool inside(Vec2 p) const {
    bool odd = false;
    for (const auto& [i, j] : boundary_) {
      const Vec2 a = points_[i];
      const Vec2 b = points_[j];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if (p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) odd = !odd;
    }
    return odd;
  }

  [[nodiscard]] bool passes_through_point(Edge e) const {
    const Vec2 a = points_[e.first];
    const Vec2 b = points_[e.second];
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (k == e.first || k == e.second) continue;
      const Vec2 p = points_[k];
      if (std::abs(side(a, b, p)) < kOnLine && dot(p - a, p - b) < 0.0) return true;
    }
    return false;
  }

  [[nodiscard]] bool crosses(Edge e, Edge f) const {
    if (e.first == f.first || e.first == f.second || e.second == f.first || e.second == f.second) {
      return false;
    }
    const Vec2 a = points_[e.first];
    const Vec2 b = points_[e.second];
    const Vec2 c = points_[f.first];
    const Vec2 d = points_[f.second];
    return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
  }

  // Shortest diagonals first: a reasonable start that needs no special case for holes.
  void add_diagonals() {
    std::vector<std::tuple<long long, std::size_t, std::size_t>> candidates;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t j = i + 1; j < points_.size(); ++j) {
        const double key = std::round(length(points_[i] - points_[j]) / kTie);
        candidates.emplace_back(static_cast<long long>(key), i, j);
      }
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [key, i, j] : candidates) {
      const Edge e{i, j};
      if (std::find(boundary_.begin(), boundary_.end(), e) != boundary_.end()) continue;
      if (!inside((points_[i] + points_[j]) * 0.5) || passes_through_point(e)) continue;
      if (std::any_of(edges_.begin(), edges_.end(), [&](Edge f) { return crosses(e, f); })) {
        continue;
      }
      edges_.push_back(e);
    }
  }

  [[nodiscard]] bool has_edge(std::size_t a, std::size_t b) const {
    return std::find(edges_.begin(), edges_.end(), make_edge(a, b)) != edges_.end();
  }

  [[nodiscard]] bool is_empty_triangle(const IndexTriangle& t) const {
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (k == t[0] || k == t[1] || k == t[2]) continue;
      const Vec2 p = points_[k];
      if (side(points_[t[0]], points_[t[1]], p) > 0.0 && side(points_[t[1]], points_[t[2]], p) > 0.0 &&
          side(points_[t[2]], points_[t[0]], p) > 0.0) {
        return false;
      }
    }
    return true;
  }

  void collect_triangles() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t j = i + 1; j < points_.size(); ++j) {
        if (!has_edge(i, j)) continue;
        for (std::size_t k = j + 1; k < points_.size(); ++k) {
          if (has_edge(j, k) && has_edge(k, i)) consider_triangle(i, j, k);
        }
      }
    }
  }

  void consider_triangle(std::size_t i, std::size_t j, std::size_t k) {
    const double height = side(points_[i], points_[j], points_[k]);
    if (std::abs(height) < kOnLine) return;
    const IndexTriangle t = height > 0.0 ? IndexTriangle{i, j, k} : IndexTriangle{i, k, j};
    const Vec2 centre = (points_[i] + points_[j] + points_[k]) * (1.0 / 3.0);
    if (inside(centre) && is_empty_triangle(t)) triangles_.push_back(t);
  }

  // Replaces one inner edge by the other diagonal of its two triangles when that makes the
  // smallest angle larger. The smallest angles only grow, so this ends.
  bool flip_one() {
    for (std::size_t s = 0; s < triangles_.size(); ++s) {
      for (std::size_t t = s + 1; t < triangles_.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
          if (try_flip(triangles_[s], triangles_[t], i)) return true;
        }
      }
    }
    return false;
  }

  bool try_flip(IndexTriangle& s, IndexTriangle& t, std::size_t i) const {
    const std::size_t a = s[i];
    const std::size_t b = s[(i + 1) % 3];
    const std::size_t c = s[(i + 2) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      if (t[j] != b || t[(j + 1) % 3] != a) continue;
      const std::size_t d = t[(j + 2) % 3];
      const Vec2 pa = points_[a];
      const Vec2 pb = points_[b];
      const Vec2 pc = points_[c];
      const Vec2 pd = points_[d];
      if (side(pc, pd, pa) > -kOnLine || side(pc, pd, pb) < kOnLine) return false;
      const double now = std::min(min_angle(pa, pb, pc), min_angle(pb, pa, pd));
      const double then = std::min(min_angle(pc, pd, pb), min_angle(pd, pc, pa));
      if (then < now + kTie) return false;
      s = {c, d, b};
      t = {d, c, a};
      return true;
    }
    return false;
  }

  const std::vector<Vec2>& points_;
  std::vector<Edge> boundary_;
  std::vector<Edge> edges_;
  std::vector<IndexTriangle> triangles_;
  std::size_t expected_ = 0;
};

}  // namespace

std::vector<IndexTriangle> triangulate_polygon(const std::vector<Vec2>& points,
                                               const std::vector<std::vector<std::size_t>>& rings) {
  return Triangulator(points, rings).run();
}

}  // namespace orchard::models
