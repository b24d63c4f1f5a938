#include "crossings.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "axis/incidence.h"
#include "joined_inside.h"
#include "neck_test.h"

namespace orchard::detail {
namespace {

using ClusterPair = std::array<Index, 2>;

std::vector<Index> clusters_at(const Surface& surface, std::span<const Index> triangles) {
  std::vector<Index> clusters;
  clusters.reserve(triangles.size());
  for (const Index triangle : triangles) clusters.push_back(surface.clusters().of_triangle[triangle]);
  std::sort(clusters.begin(), clusters.end());
  clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
  return clusters;
}

// Returns the pairs of clusters that have a common vertex. Only the border vertices of the clusters are compared: a
// cluster may have very many inner vertices, and a vertex may have very many clusters around it.
std::vector<ClusterPair> adjoining_pairs(const Surface& surface, std::vector<ClusterPair> pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<std::array<Index, 2>> at_border;  // cluster, vertex
  for (Index vertex = 0; vertex < surface.mesh().vertices.size(); ++vertex) {
    const std::vector<Index> clusters = clusters_at(surface, surface.triangles_around(vertex));
    if (clusters.size() < 2) continue;
    for (const Index cluster : clusters) at_border.push_back({cluster, vertex});
  }
  const Rows vertices = rows_of(at_border, surface.clusters().count());
  std::vector<std::uint8_t> adjoin(pairs.size(), 0);
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
    auto few = vertices[pairs[i][0]], many = vertices[pairs[i][1]];
    if (few.size() > many.size()) std::swap(few, many);
    adjoin[i] = std::any_of(few.begin(), few.end(),
                            [&](Index vertex) { return std::binary_search(many.begin(), many.end(), vertex); });
  });
  std::vector<ClusterPair> result;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (adjoin[i]) result.push_back(pairs[i]);
  }
  return result;
}

// Applies the definitions of 6.2.4 to cells instead of faces. A face crosses a cluster if its two cells meet on the
// cluster, which is harmless if the cluster is allowed for both cells. So it suffices to find, for each cell, the
// clusters that it reaches and that are not allowed for it; each gives a component. The clusters that contain the
// cell's point are allowed, and with the loose definition also those that adjoin one of these.
class ForbiddenClusters {
 public:
  ForbiddenClusters(const Surface& surface, const SurfaceSampling& sampling,
                    const std::vector<CellComponent>& components)
      : surface_(surface), components_(components), own_(components.size()), reached_(components.size()) {
    tbb::parallel_for(std::size_t{0}, components.size(), [&](std::size_t i) {
      std::vector<Index> around;
      surface.triangles_at(sampling.triangles[components[i].cell], sampling.features[components[i].cell], around);
      own_[i] = clusters_at(surface, around);
      reached_[i] = clusters_at(surface, components[i].triangles);
      std::erase_if(reached_[i],
                    [&](Index cluster) { return std::binary_search(own_[i].begin(), own_[i].end(), cluster); });
    });
  }

  void allow_adjoining() {
    std::vector<ClusterPair> pairs;
    for (std::size_t i = 0; i < components_.size(); ++i) {
      for (const Index own : own_[i]) {
        for (const Index cluster : reached_[i]) pairs.push_back({own, cluster});
      }
    }
    const std::vector<ClusterPair> adjoining = adjoining_pairs(surface_, std::move(pairs));
    tbb::parallel_for(std::size_t{0}, components_.size(), [&](std::size_t i) {
      std::erase_if(reached_[i], [&](Index cluster) {
        return std::any_of(own_[i].begin(), own_[i].end(), [&](Index own) {
          return std::binary_search(adjoining.begin(), adjoining.end(), ClusterPair{own, cluster});
        });
      });
    });
  }

  std::vector<CellComponent> components() const {
    std::vector<CellComponent> result;
    for (std::size_t i = 0; i < components_.size(); ++i) {
      const std::size_t first = result.size();
      for (std::size_t k = 0; k < reached_[i].size(); ++k) result.push_back({components_[i].cell, {}, false, 0});
      if (reached_[i].empty()) continue;
      for (const Index triangle : components_[i].triangles) {
        const Index cluster = surface_.clusters().of_triangle[triangle];
        const auto found = std::lower_bound(reached_[i].begin(), reached_[i].end(), cluster);
        if (found == reached_[i].end() || *found != cluster) continue;
        result[first + static_cast<std::size_t>(found - reached_[i].begin())].triangles.push_back(triangle);
      }
    }
    return result;
  }

 private:
  const Surface& surface_;
  const std::vector<CellComponent>& components_;
  std::vector<std::vector<Index>> own_, reached_;  // of each component: clusters, ascending; reached_: not allowed yet
};

// Returns the cells beyond the borders of a component whose faces cross where they should not.
std::vector<Index> harmful_neighbors(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const CellComponent& component,
                                     double joined_radius) {
  std::vector<std::pair<Index, Index>> borders;  // other cell, triangle
  for (const Index triangle : component.triangles) {
    for (const CellBorder& border : restricted.piece(triangle, component.cell)->borders) {
      borders.emplace_back(border.cell, triangle);
    }
  }
  std::sort(borders.begin(), borders.end());
  std::vector<Index> harmful, crossed;
  for (auto border = borders.begin(); border != borders.end();) {
    const Index other = border->first;
    crossed.clear();
    for (; border != borders.end() && border->first == other; ++border) crossed.push_back(border->second);
    const Point& a = restricted.points()[component.cell];
    const Point& b = restricted.points()[other];
    const Sphere ball{0.5 * (a + b), joined_radius * (a - b).norm()};
    if (joined_radius > 0 && joined_inside(surface, sampling, ball, crossed, {component.cell, other})) continue;
    harmful.push_back(other);
  }
  return harmful;
}

// Returns the crossing of a component, or nullopt if it has none.
std::optional<Crossing> gap_crossing(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const CellComponent& component,
                                     const GapRepairOptions& options) {
  std::vector<Index> harmful = harmful_neighbors(surface, sampling, restricted, component, options.joined_radius);
  if (harmful.empty()) {
    const bool has_border = std::any_of(component.triangles.begin(), component.triangles.end(), [&](Index triangle) {
      return !restricted.piece(triangle, component.cell)->borders.empty();
    });
    // A closed component without a point of its own has no border, so no face crosses there.
    if (has_border || options.definition != GapDefinition::connected) return std::nullopt;
  }
  return Crossing{component, std::move(harmful), false, false};
}

// Whether necks are repaired. They are not if harmless crossings remain, because a harmless second component of a cell
// looks like a neck to the adjacent cells.
bool mends_necks(const GapRepairOptions& options) {
  return options.mend_necks && options.definition == GapDefinition::connected && !(options.joined_radius > 0);
}

std::optional<Crossing> neck(const Surface& surface, const RestrictedVoronoi& restricted,
                             const CellComponent& component) {
  NeckFault fault = find_neck(surface, restricted, component);
  if (!fault.found) return std::nullopt;
  return Crossing{component, std::move(fault.neighbors), true, false};
}

}  // namespace

std::vector<Crossing> find_crossings(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const ComponentScope& scope,
                                     const GapRepairOptions& options) {
  const std::vector<CellComponent> components = find_cell_components(surface, sampling, restricted, scope);
  std::vector<CellComponent> suspects;
  if (options.definition == GapDefinition::connected) {
    std::copy_if(components.begin(), components.end(), std::back_inserter(suspects),
                 [](const CellComponent& component) { return !component.home; });
  } else {
    ForbiddenClusters forbidden(surface, sampling, components);
    if (options.definition == GapDefinition::loose) forbidden.allow_adjoining();
    suspects = forbidden.components();
  }
  std::vector<std::optional<Crossing>> gaps(suspects.size()), necks(mends_necks(options) ? components.size() : 0);
  tbb::parallel_for(std::size_t{0}, gaps.size(), [&](std::size_t i) {
    gaps[i] = gap_crossing(surface, sampling, restricted, suspects[i], options);
  });
  tbb::parallel_for(std::size_t{0}, necks.size(), [&](std::size_t i) {
    if (components[i].home) necks[i] = neck(surface, restricted, components[i]);
  });
  std::vector<Crossing> crossings;
  for (auto* some : {&gaps, &necks}) {
    for (std::optional<Crossing>& crossing : *some) {
      if (crossing) crossings.push_back(std::move(*crossing));
    }
  }
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.component.cell < b.component.cell; });
  return crossings;
}

Index count_faces(const std::vector<Crossing>& crossings) {
  std::vector<std::array<Index, 2>> faces;
  for (const Crossing& crossing : crossings) {
    const Index cell = crossing.component.cell;
    for (const Index other : crossing.neighbors) faces.push_back({std::min(cell, other), std::max(cell, other)});
  }
  std::sort(faces.begin(), faces.end());
  return static_cast<Index>(std::unique(faces.begin(), faces.end()) - faces.begin());
}

Index count_cells(const std::vector<Crossing>& crossings) {
  Index count = 0, last = kNone;  // crossings ascend by cell
  for (const Crossing& crossing : crossings) {
    if (crossing.component.cell != last) ++count;
    last = crossing.component.cell;
  }
  return count;
}

}  // namespace orchard::detail
