#include <algorithm>
#include <cmath>
#include <utility>

#include "area_vector.h"
#include "half_edges.h"
#include "orchard/geometry/disjoint_sets.h"
#include "repair_steps.h"

namespace orchard::detail {
namespace {

Index next(Index half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; }

class Corners {
 public:
  explicit Corners(const TriangleMesh& mesh) : mesh_(mesh) {}
  Index start(Index half_edge) const { return mesh_.triangles[half_edge / 3][half_edge % 3]; }
  Index end(Index half_edge) const { return start(next(half_edge)); }
  Index apex(Index half_edge) const { return start(next(next(half_edge))); }

 private:
  const TriangleMesh& mesh_;
};

// Returns a number that grows with the angle of (x, y), from 0 at the first axis up to 4. It uses no functions whose
// rounding differs between machines.
double pseudo_angle(double x, double y) {
  const double length = std::abs(x) + std::abs(y);
  if (!(length > 0)) return 0;
  const double t = y / length;
  return x >= 0 ? (y >= 0 ? t : 4 + t) : 2 - t;
}

// Pairs the triangles around an edge where more than two meet, such that each pair has the solid between its triangles.
// Seen in the order of their angles about the edge, directed from its lower to its higher vertex, a triangle that runs
// along the edge from high to low has the solid after it, and one that runs the other way has the solid before it.
class EdgePairs {
 public:
  explicit EdgePairs(const TriangleMesh& mesh) : mesh_(mesh), corners_(mesh) {}

  using Pair = std::pair<Index, Index>;  // half-edges of opposite direction
  const std::vector<Pair>& find(std::span<const EdgeUse> edge) {
    sort_around(edge);
    pairs_.clear();
    open_.clear();
    // Goes around twice, because a part of the solid may begin before the first axis and end after it.
    done_.assign(around_.size(), false);
    for (std::size_t step = 0; step < 2 * around_.size(); ++step) {
      const std::size_t i = step % around_.size();
      if (done_[i]) continue;
      const Use& use = around_[i];
      if (!use.closes) {
        if (step < around_.size()) open_.push_back(i);
      } else if (!open_.empty()) {
        done_[i] = done_[open_.back()] = true;
        pairs_.emplace_back(around_[open_.back()].half_edge, use.half_edge);
        open_.pop_back();
      }
    }
    return pairs_;
  }

 private:
  struct Use {
    double angle;
    bool closes;  // whether the solid ends here
    Index half_edge;
  };

  void sort_around(std::span<const EdgeUse> edge) {
    const Point& origin = mesh_.vertices[edge[0].low];
    const Vector axis = (mesh_.vertices[edge[0].high] - origin).normalized();
    const auto across = [&](const EdgeUse& use) -> Vector {
      const Vector arm = mesh_.vertices[corners_.apex(use.half_edge)] - origin;
      return arm - axis.dot(arm) * axis;
    };
    const Vector x = across(edge[0]).normalized(), y = axis.cross(x);
    around_.clear();
    for (const EdgeUse& use : edge) {
      const Vector arm = across(use);
      // The first triangle is the axis itself, whose angle must be 0 in spite of rounding.
      const bool on_axis = corners_.apex(use.half_edge) == corners_.apex(edge[0].half_edge);
      const double angle = on_axis ? 0 : pseudo_angle(arm.dot(x), arm.dot(y));
      around_.push_back({angle, corners_.start(use.half_edge) == use.low, use.half_edge});
    }
    // If two solids share a wall, one of them ends before the other begins.
    std::sort(around_.begin(), around_.end(), [](const Use& a, const Use& b) {
      if (a.angle != b.angle) return a.angle < b.angle;
      if (a.closes != b.closes) return a.closes;
      return a.half_edge < b.half_edge;
    });
  }

  const TriangleMesh& mesh_;
  Corners corners_;
  std::vector<Use> around_;
  std::vector<std::size_t> open_;
  std::vector<bool> done_;
  std::vector<Pair> pairs_;
};

// Gives each fan of triangles at a vertex a vertex of its own. Fans continue only across the pairs.
class FanCutter {
 public:
  FanCutter(TriangleMesh& mesh, MeshRepairReport& report) : mesh_(mesh), report_(report) {}

  void run() {
    DisjointSets fans(3 * mesh_.triangles.size());
    const Corners corners(mesh_);
    const auto join = [&](Index a, Index b) {
      const bool same_direction = corners.start(a) == corners.start(b);
      fans.unite(a, same_direction ? b : next(b));
      fans.unite(next(a), same_direction ? next(b) : b);
    };
    EdgePairs pairs(mesh_);
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh_);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      if (edge.size() == 2) join(edge[0].half_edge, edge[1].half_edge);
      if (edge.size() <= 2) return;
      const auto& found = pairs.find(edge);
      report_.edges_cut += found.empty() ? 0 : 1;
      for (const auto& [a, b] : found) join(a, b);
    });
    rename(fans);
  }

 private:
  void rename(DisjointSets& fans) {
    std::vector<Index> first_fan(mesh_.vertices.size(), kNone), name(3 * mesh_.triangles.size(), kNone);
    std::vector<bool> split(mesh_.vertices.size(), false);
    for (Index corner = 0; corner < name.size(); ++corner) {
      const Index fan = fans.root(corner);
      Index& vertex = mesh_.triangles[corner / 3][corner % 3];
      if (name[fan] == kNone) {
        if (first_fan[vertex] == kNone) {
          first_fan[vertex] = fan;
          name[fan] = vertex;
        } else {
          if (!split[vertex]) ++report_.vertices_split;
          split[vertex] = true;
          name[fan] = static_cast<Index>(mesh_.vertices.size());
          mesh_.vertices.push_back(Point(mesh_.vertices[vertex]));
        }
      }
      vertex = name[fan];
    }
  }

  TriangleMesh& mesh_;
  MeshRepairReport& report_;
};

// Adds a midpoint for each pair to edges whose pairs still share both ends. The midpoints are different vertices at the
// same place, so the pairs get different edges. At most one edge of a triangle is divided in a call. Returns whether
// there was such an edge.
bool give_midpoints(TriangleMesh& mesh) {
  EdgePairs pairs(mesh);
  std::vector<bool> touched(mesh.triangles.size(), false);
  struct Split {
    Index half_edge, midpoint;
  };
  std::vector<Split> splits;
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() <= 2 || edge.size() % 2 != 0) return;
    if (std::ranges::any_of(edge, [&](const EdgeUse& use) { return touched[use.half_edge / 3]; })) return;
    const auto& found = pairs.find(edge);
    if (2 * found.size() != edge.size()) return;
    for (const EdgeUse& use : edge) touched[use.half_edge / 3] = true;
    const Point middle = mesh.vertices[edge[0].low] / 2 + mesh.vertices[edge[0].high] / 2;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Index midpoint = static_cast<Index>(mesh.vertices.size());
      mesh.vertices.push_back(middle);
      splits.push_back({found[i].first, midpoint});
      splits.push_back({found[i].second, midpoint});
    }
  });
  for (const auto& [half_edge, midpoint] : splits) {
    const auto t = mesh.triangles[half_edge / 3];
    const Index i = half_edge % 3, x = t[i], y = t[(i + 1) % 3], z = t[(i + 2) % 3];
    mesh.triangles[half_edge / 3] = {x, midpoint, z};
    mesh.triangles.push_back({midpoint, y, z});
  }
  return !splits.empty();
}

}  // namespace

void orient_components(TriangleMesh& mesh, MeshRepairReport& report) {
  const auto neighbors = triangle_neighbors(mesh);
  const auto runs_along = [&](Index t, Index from, Index to) {
    const auto& corners = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i)
      if (corners[i] == from && corners[(i + 1) % 3] == to) return true;
    return false;
  };
  Box box;
  for (const auto& corners : mesh.triangles)
    for (const Index vertex : corners) box.extend(mesh.vertices[vertex]);
  const double scale = unit_scale(box);
  const auto area = [&](Index t) {
    const auto& [i, j, k] = mesh.triangles[t];
    return area_vector({mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]}, scale).norm();
  };
  std::vector<bool> seen(mesh.triangles.size(), false), against(mesh.triangles.size(), false);
  std::vector<Index> component;
  for (Index first = 0; first < mesh.triangles.size(); ++first) {
    if (seen[first]) continue;
    component.assign(1, first);
    seen[first] = true;
    double area_along = 0, area_against = 0;
    for (std::size_t at = 0; at < component.size(); ++at) {
      const Index t = component[at];
      (against[t] ? area_against : area_along) += area(t);
      for (std::size_t i = 0; i < 3; ++i) {
        const Index other = neighbors[t][i];
        if (other == kNone || seen[other]) continue;
        const bool disagree = runs_along(other, mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
        against[other] = against[t] != disagree;
        seen[other] = true;
        component.push_back(other);
      }
    }
    // The orientation of the larger part of the component is kept.
    const bool turn = area_against <= area_along;
    for (const Index t : component) {
      if (against[t] != turn) continue;
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      ++report.flipped;
    }
  }
}

void cut_apart(TriangleMesh& mesh, MeshRepairReport& report) {
  FanCutter(mesh, report).run();
  constexpr int kMaxPasses = 3;  // one for each edge of a triangle
  for (int i = 0; i < kMaxPasses && give_midpoints(mesh); ++i) {
  }
}

}  // namespace orchard::detail
