#include "cell_components.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "orchard/geometry/disjoint_sets.h"

namespace orchard::detail {
namespace {

// Divides the pieces of the surface in one cell into connected components.
class ComponentFinder {
 public:
  ComponentFinder(const Surface& surface, const RestrictedVoronoi& restricted, Index cell, std::vector<Index> triangles)
      : surface_(surface), cell_(cell), triangles_(std::move(triangles)), sets_(triangles_.size()) {
    for (const Index triangle : triangles_) pieces_.push_back(restricted.piece(triangle, cell));
    euler_.assign(triangles_.size(), 1);
    joined_.assign(triangles_.size(), 0);
  }

  std::vector<CellComponent> run() {
    for (std::size_t i = 0; i < triangles_.size(); ++i) join_across_edges(i);
    for (std::size_t i = 0; i < triangles_.size(); ++i) count_inner_vertices(i);
    std::vector<CellComponent> components;
    std::vector<std::size_t> component_of(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const std::size_t first = sets_.root(static_cast<Index>(i));  // the lowest of its set
      if (first == i) {
        component_of[i] = components.size();
        components.push_back({cell_, {}, false, 0});
      }
      CellComponent& component = components[component_of[first]];
      component.triangles.push_back(triangles_[i]);
      component.euler_characteristic += euler_[i];
    }
    return components;
  }

 private:
  static constexpr std::size_t kNotHere = ~std::size_t{0};

  std::size_t find(Index triangle) const {
    const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), triangle);
    return found != triangles_.end() && *found == triangle ? static_cast<std::size_t>(found - triangles_.begin())
                                                           : kNotHere;
  }

  // Two pieces share at most one stretch of an edge. It is counted at the first of the two.
  void join_across_edges(std::size_t i) {
    for (unsigned edge = 0; edge < 3; ++edge) {
      const Index next = surface_.neighbors(triangles_[i])[edge];
      if (next == kNone || next < triangles_[i]) continue;
      const std::size_t k = find(next);
      if (k == kNotHere) continue;
      const std::uint8_t here = static_cast<std::uint8_t>(1u << edge), there = edges_towards(next, triangles_[i]);
      if (!(pieces_[i]->edges & here) && !(pieces_[k]->edges & there)) continue;
      joined_[i] |= here;
      joined_[k] |= there;
      --euler_[i];
      sets_.unite(static_cast<Index>(i), static_cast<Index>(k));
    }
  }
  std::uint8_t edges_towards(Index triangle, Index neighbor) const {
    std::uint8_t mask = 0;
    for (unsigned edge = 0; edge < 3; ++edge) {
      if (surface_.neighbors(triangle)[edge] == neighbor) mask |= static_cast<std::uint8_t>(1u << edge);
    }
    return mask;
  }

  // A vertex lies inside a component if the pieces around it are joined all the way round. It is counted at the first
  // of them.
  void count_inner_vertices(std::size_t i) {
    for (const Index vertex : surface_.mesh().triangles[triangles_[i]]) {
      const auto around = surface_.triangles_around(vertex);
      if (around[0] != triangles_[i]) continue;
      const bool inner = std::all_of(around.begin(), around.end(), [&](Index triangle) {
        const std::size_t k = find(triangle);
        if (k == kNotHere) return false;
        const std::uint8_t spokes = edges_at(triangle, vertex);
        return (joined_[k] & spokes) == spokes;
      });
      if (inner) ++euler_[i];
    }
  }
  std::uint8_t edges_at(Index triangle, Index vertex) const {
    const auto& corners = surface_.mesh().triangles[triangle];
    return corners[0] == vertex ? 0b101 : corners[1] == vertex ? 0b011 : 0b110;
  }

  const Surface& surface_;
  Index cell_;
  std::vector<Index> triangles_;  // ascending
  std::vector<const CellPiece*> pieces_;
  DisjointSets sets_;
  std::vector<int> euler_;            // the contribution of each piece to the Euler characteristic of its component
  std::vector<std::uint8_t> joined_;  // bit i is set if the piece is joined across edge i of its triangle
};

double distance_to(const Surface& surface, const CellComponent& component, const Point& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Index triangle : component.triangles) {
    const auto [a, b, c] = surface.corners(triangle);
    nearest = std::min(nearest, closest_point_of_triangle(point, a, b, c).distance);
  }
  return nearest;
}

// Marks the home component among the components of one cell, of which there is at least one. If the diagram is not
// exact, rounding may put the cell's own point outside all of them; then the nearest component is the home component.
void mark_home(const Surface& surface, const SurfaceSampling& sampling, std::vector<CellComponent>& components) {
  const Index cell = components[0].cell;
  std::vector<Index> around;
  surface.triangles_at(sampling.triangles[cell], sampling.features[cell], around);
  for (CellComponent& component : components) {
    component.home = std::any_of(around.begin(), around.end(), [&](Index triangle) {
      return std::binary_search(component.triangles.begin(), component.triangles.end(), triangle);
    });
  }
  if (std::any_of(components.begin(), components.end(), [](const CellComponent& component) { return component.home; }))
    return;
  const auto nearer = [&](const CellComponent& a, const CellComponent& b) {
    return distance_to(surface, a, sampling.points[cell]) < distance_to(surface, b, sampling.points[cell]);
  };
  std::min_element(components.begin(), components.end(), nearer)->home = true;
}

}  // namespace

ComponentScope ComponentScope::everything(const Surface& surface, const SurfaceSampling& sampling) {
  ComponentScope scope;
  scope.cells.assign(sampling.size(), 1);
  scope.triangles.resize(surface.mesh().triangles.size());
  std::iota(scope.triangles.begin(), scope.triangles.end(), Index{0});
  return scope;
}

std::vector<CellComponent> find_cell_components(const Surface& surface, const SurfaceSampling& sampling,
                                                const RestrictedVoronoi& restricted, const ComponentScope& scope) {
  std::vector<std::vector<Index>> triangles_of(scope.cells.size());
  for (const Index triangle : scope.triangles) {
    for (const CellPiece& piece : restricted.pieces(triangle)) {
      if (scope.cells[piece.cell]) triangles_of[piece.cell].push_back(triangle);
    }
  }
  std::vector<std::vector<CellComponent>> components_of(triangles_of.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(triangles_of.size()), [&](Index cell) {
    if (triangles_of[cell].empty()) return;
    components_of[cell] = ComponentFinder(surface, restricted, cell, std::move(triangles_of[cell])).run();
    mark_home(surface, sampling, components_of[cell]);
  });
  std::vector<CellComponent> components;
  for (auto& some : components_of) std::move(some.begin(), some.end(), std::back_inserter(components));
  return components;
}

}  // namespace orchard::detail
