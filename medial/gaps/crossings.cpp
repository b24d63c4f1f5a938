#include "crossings.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "joined_inside.h"
#include "neck_test.h"

namespace orchard::detail {
namespace {

// What the point of a cell lies on: its clusters, and for the loose definition those that adjoin them.
class AllowedClusters {
 public:
  AllowedClusters(const Surface& surface, const SurfaceSampling& sampling, bool adjoining)
      : surface_(surface), sampling_(sampling), adjoining_(adjoining) {}

  std::vector<Index> of(Index cell) const {
    std::vector<Index> around;
    surface_.triangles_at(sampling_.triangles[cell], sampling_.features[cell], around);
    std::vector<Index> allowed = clusters_of(around);
    if (!adjoining_) return allowed;
    std::vector<Index> near;
    for (const Index cluster : allowed) {
      for (const Index triangle : surface_.clusters().triangles[cluster]) {
        for (const Index vertex : surface_.mesh().triangles[triangle]) {
          const auto fan = surface_.triangles_around(vertex);
          near.insert(near.end(), fan.begin(), fan.end());
        }
      }
    }
    return clusters_of(near);
  }

 private:
  std::vector<Index> clusters_of(const std::vector<Index>& triangles) const {
    std::vector<Index> clusters;
    clusters.reserve(triangles.size());
    for (const Index triangle : triangles) clusters.push_back(surface_.clusters().of_triangle[triangle]);
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    return clusters;
  }

  const Surface& surface_;
  const SurfaceSampling& sampling_;
  bool adjoining_;
};

// The definitions of 6.2.4, seen from the cell: a face crosses a cluster where the two cells meet on it, and it may if
// the cluster is allowed to both. So each cell answers for the clusters it reaches; one patch for each forbidden one.
std::vector<CellPatch> patches_on_forbidden_clusters(const Surface& surface, const SurfaceSampling& sampling,
                                                     const std::vector<CellPatch>& patches, bool adjoining) {
  const AllowedClusters allowed_clusters(surface, sampling, adjoining);
  std::vector<std::vector<CellPatch>> found(patches.size());
  tbb::parallel_for(std::size_t{0}, patches.size(), [&](std::size_t i) {
    const std::vector<Index> allowed = allowed_clusters.of(patches[i].cell);
    std::vector<std::pair<Index, Index>> forbidden;  // cluster, triangle
    for (const Index triangle : patches[i].triangles) {
      const Index cluster = surface.clusters().of_triangle[triangle];
      if (!std::binary_search(allowed.begin(), allowed.end(), cluster)) forbidden.emplace_back(cluster, triangle);
    }
    std::sort(forbidden.begin(), forbidden.end());
    for (std::size_t k = 0; k < forbidden.size(); ++k) {
      if (k == 0 || forbidden[k].first != forbidden[k - 1].first) found[i].push_back({patches[i].cell, {}, false, 0});
      found[i].back().triangles.push_back(forbidden[k].second);
    }
  });
  std::vector<CellPatch> result;
  for (std::vector<CellPatch>& some : found) std::move(some.begin(), some.end(), std::back_inserter(result));
  return result;
}

// The cells beyond the patch's borders whose faces cross harmfully.
std::vector<Index> harmful_neighbors(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const CellPatch& patch,
                                     double joined_radius) {
  std::vector<std::pair<Index, Index>> borders;  // other cell, triangle
  for (const Index triangle : patch.triangles) {
    for (const CellBorder& border : restricted.piece(triangle, patch.cell)->borders) {
      borders.emplace_back(border.cell, triangle);
    }
  }
  std::sort(borders.begin(), borders.end());
  std::vector<Index> harmful, crossed;
  for (auto border = borders.begin(); border != borders.end();) {
    const Index other = border->first;
    crossed.clear();
    for (; border != borders.end() && border->first == other; ++border) crossed.push_back(border->second);
    const Point& a = restricted.points()[patch.cell];
    const Point& b = restricted.points()[other];
    const Sphere ball{0.5 * (a + b), joined_radius * (a - b).norm()};
    if (joined_radius > 0 && joined_inside(surface, sampling, ball, crossed, {patch.cell, other})) continue;
    harmful.push_back(other);
  }
  return harmful;
}

// Nothing for a patch that is as it should be.
std::optional<Crossing> gap_crossing(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const CellPatch& patch,
                                     const GapRepairOptions& options) {
  std::vector<Index> harmful = harmful_neighbors(surface, sampling, restricted, patch, options.joined_radius);
  if (harmful.empty()) {
    const bool has_border = std::any_of(patch.triangles.begin(), patch.triangles.end(), [&](Index triangle) {
      return !restricted.piece(triangle, patch.cell)->borders.empty();
    });
    // A closed component without a point of its own has no border; no face would ever tell of it.
    if (has_border || options.definition != GapDefinition::connected) return std::nullopt;
  }
  return Crossing{patch, std::move(harmful), false, false};
}

// A harmless second patch of a cell looks like a neck to its neighbours.
bool mends_necks(const GapRepairOptions& options) {
  return options.mend_necks && options.definition == GapDefinition::connected && !(options.joined_radius > 0);
}

std::optional<Crossing> neck(const Surface& surface, const RestrictedVoronoi& restricted, const CellPatch& patch) {
  NeckFault fault = find_neck(surface, restricted, patch);
  if (!fault.found) return std::nullopt;
  return Crossing{patch, std::move(fault.neighbors), true, false};
}

}  // namespace

std::vector<Crossing> find_crossings(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const PatchScope& scope,
                                     const GapRepairOptions& options) {
  const std::vector<CellPatch> patches = find_cell_patches(surface, sampling, restricted, scope);
  std::vector<CellPatch> suspects;
  if (options.definition == GapDefinition::connected) {
    std::copy_if(patches.begin(), patches.end(), std::back_inserter(suspects),
                 [](const CellPatch& patch) { return !patch.home; });
  } else {
    suspects = patches_on_forbidden_clusters(surface, sampling, patches, options.definition == GapDefinition::loose);
  }
  std::vector<std::optional<Crossing>> gaps(suspects.size()), necks(mends_necks(options) ? patches.size() : 0);
  tbb::parallel_for(std::size_t{0}, gaps.size(), [&](std::size_t i) {
    gaps[i] = gap_crossing(surface, sampling, restricted, suspects[i], options);
  });
  tbb::parallel_for(std::size_t{0}, necks.size(), [&](std::size_t i) {
    if (patches[i].home) necks[i] = neck(surface, restricted, patches[i]);
  });
  std::vector<Crossing> crossings;
  for (auto* some : {&gaps, &necks}) {
    for (std::optional<Crossing>& crossing : *some) {
      if (crossing) crossings.push_back(std::move(*crossing));
    }
  }
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.patch.cell < b.patch.cell; });
  return crossings;
}

Index count_faces(const std::vector<Crossing>& crossings) {
  std::vector<std::array<Index, 2>> faces;
  for (const Crossing& crossing : crossings) {
    const Index cell = crossing.patch.cell;
    for (const Index other : crossing.neighbors) faces.push_back({std::min(cell, other), std::max(cell, other)});
  }
  std::sort(faces.begin(), faces.end());
  return static_cast<Index>(std::unique(faces.begin(), faces.end()) - faces.begin());
}

Index count_cells(const std::vector<Crossing>& crossings) {
  Index count = 0, last = kNone;  // crossings ascend by cell
  for (const Crossing& crossing : crossings) {
    if (crossing.patch.cell != last) ++count;
    last = crossing.patch.cell;
  }
  return count;
}

}  // namespace orchard::detail
