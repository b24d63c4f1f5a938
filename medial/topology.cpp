#include "orchard/medial/topology.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "axis/incidence.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/error.h"
#include "solid_parts.h"

namespace orchard {
namespace {

// A complex that is reduced by elementary collapses, which keep its homotopy type.
class Complex {
 public:
  explicit Complex(const MedialMesh& mesh) : mesh_(mesh), at_(mesh.edges, mesh.triangles, mesh.size()) {
    edge_alive_.assign(mesh.edges.size(), 1);
    triangle_alive_.assign(mesh.triangles.size(), 1);
    vertex_alive_.assign(mesh.centers.size(), 1);
  }

  Topology run() {
    collapse_triangles();
    collapse_edges();
    Topology result;
    result.components = count_components();
    result.cavities = count_cavities();
    const auto alive = [](const std::vector<std::uint8_t>& cells) { return std::count(cells.begin(), cells.end(), 1); };
    result.loops =
        result.components + result.cavities - (alive(vertex_alive_) - alive(edge_alive_) + alive(triangle_alive_));
    return result;
  }

 private:
  void collapse_triangles() {
    std::vector<Index> open(mesh_.edges.size());
    std::iota(open.begin(), open.end(), Index{0});
    while (!open.empty()) {
      const Index edge = open.back();
      open.pop_back();
      if (!edge_alive_[edge]) continue;
      const Index triangle = detail::only(at_.triangles_at[edge], triangle_alive_);
      if (triangle == kNone) continue;
      edge_alive_[edge] = triangle_alive_[triangle] = 0;
      open.insert(open.end(), at_.sides[triangle].begin(), at_.sides[triangle].end());
    }
  }
  void collapse_edges() {
    std::vector<Index> open(mesh_.centers.size());
    std::iota(open.begin(), open.end(), Index{0});
    while (!open.empty()) {
      const Index vertex = open.back();
      open.pop_back();
      const Index edge = detail::only(at_.edges_at[vertex], edge_alive_);
      if (edge == kNone || has_triangle(edge)) continue;
      vertex_alive_[vertex] = edge_alive_[edge] = 0;
      open.insert(open.end(), mesh_.edges[edge].begin(), mesh_.edges[edge].end());
    }
  }
  bool has_triangle(Index edge) const {
    const auto row = at_.triangles_at[edge];
    return std::any_of(row.begin(), row.end(), [&](Index triangle) { return triangle_alive_[triangle] != 0; });
  }

  std::int64_t count_components() const {
    DisjointSets sets(mesh_.centers.size());
    std::int64_t count = std::count(vertex_alive_.begin(), vertex_alive_.end(), 1);
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      if (!edge_alive_[e]) continue;
      const auto [a, b] = mesh_.edges[e];
      if (sets.root(a) == sets.root(b)) continue;
      sets.unite(a, b);
      --count;
    }
    return count;
  }

  // Returns the dimension of the space of 2-cycles. Where exactly two triangles meet at an edge, a cycle contains both
  // or neither. So the unknowns are sets of such triangles, of which there are few, and the edges where more of them
  // meet give the equations.
  std::int64_t count_cavities() const {
    DisjointSets sheet(mesh_.triangles.size());
    std::vector<std::vector<Index>> equations;
    std::vector<Index> at;
    const auto living_at = [&](Index edge) {
      at.clear();
      for (const Index triangle : at_.triangles_at[edge]) {
        if (triangle_alive_[triangle]) at.push_back(triangle);
      }
    };
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      living_at(e);
      if (at.size() == 2) sheet.unite(at[0], at[1]);
    }
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      living_at(e);
      if (at.size() < 3) continue;
      for (Index& triangle : at) triangle = sheet.root(triangle);
      equations.push_back(odd(at));
    }
    std::int64_t sheets = 0;
    for (Index t = 0; t < mesh_.triangles.size(); ++t) sheets += triangle_alive_[t] && sheet.root(t) == t ? 1 : 0;
    return sheets - rank(std::move(equations));
  }
  // Returns the items that occur an odd number of times, ascending.
  static std::vector<Index> odd(std::vector<Index> items) {
    std::sort(items.begin(), items.end());
    std::vector<Index> result;
    for (const Index item : items) {
      if (!result.empty() && result.back() == item) {
        result.pop_back();
      } else {
        result.push_back(item);
      }
    }
    return result;
  }
  static std::int64_t rank(std::vector<std::vector<Index>> equations) {
    std::sort(equations.begin(), equations.end());
    equations.erase(std::unique(equations.begin(), equations.end()), equations.end());
    std::map<Index, std::vector<Index>> by_pivot;
    for (std::vector<Index>& equation : equations) {
      while (!equation.empty()) {
        const auto [found, added] = by_pivot.try_emplace(equation[0], equation);
        if (added) break;
        std::vector<Index> sum;
        std::set_symmetric_difference(equation.begin(), equation.end(), found->second.begin(), found->second.end(),
                                      std::back_inserter(sum));
        equation = std::move(sum);
      }
    }
    return static_cast<std::int64_t>(by_pivot.size());
  }

  const MedialMesh& mesh_;
  const detail::CellIncidence at_;
  std::vector<std::uint8_t> vertex_alive_, edge_alive_, triangle_alive_;
};

}  // namespace

Topology solid_topology(const Surface& surface) {
  if (!surface.solid()) {
    throw InputError("the topology of a solid needs a solid: " + surface.report().faults() + "; repair the mesh first");
  }
  const detail::SolidParts parts = detail::find_solid_parts(surface);
  Topology result;
  std::int64_t euler = 0;
  for (Index part = 0; part < parts.count(); ++part) {
    ++(parts.volume[part] > 0 ? result.components : result.cavities);
    euler += parts.euler_characteristic[part];
  }
  result.loops = result.components + result.cavities - euler / 2;
  return result;
}

Topology topology(const MedialMesh& mesh) { return Complex(mesh).run(); }

}  // namespace orchard
