#include <algorithm>
#include <cmath>
#include <memory>

#include "half_edges.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/surface.h"
#include "repair_steps.h"
#include "same_place.h"

namespace orchard::detail {
namespace {

struct Part {
  std::vector<Index> triangles;  // ascending
  Box box;
  bool inside_out = false;
  Index depth = 0;  // number of other parts that hold it

  void turn(TriangleMesh& mesh) const {
    for (const Index t : triangles) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
};

std::vector<Part> parts_of(const TriangleMesh& mesh) {
  DisjointSets components(mesh.triangles.size());
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    for (const EdgeUse& use : edge) components.unite(edge[0].half_edge / 3, use.half_edge / 3);
  });
  std::vector<Part> parts;
  std::vector<Index> number(mesh.triangles.size(), kNone);
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    Index& at = number[components.root(t)];
    if (at == kNone) {
      at = static_cast<Index>(parts.size());
      parts.emplace_back();
    }
    parts[at].triangles.push_back(t);
    for (const Index vertex : mesh.triangles[t]) parts[at].box.extend(mesh.vertices[vertex]);
  }
  return parts;
}

// Drops every part whose triangles all lie on triangles of parts before it, in the same orientation or reversed.
void drop_repeated(TriangleMesh& mesh, MeshRepairReport& report) {
  const std::vector<Index> first = first_at_place(mesh);
  TriangleMesh welded{{}, mesh.triangles};
  for (auto& corners : welded.triangles)
    for (Index& vertex : corners) vertex = first[vertex];
  const auto groups = same_corners(welded);
  if (groups.empty()) return;
  std::vector<Index> group_of(mesh.triangles.size(), kNone);
  for (Index g = 0; g < groups.size(); ++g)
    for (const Index t : groups[g]) group_of[t] = g;
  std::vector<bool> taken(groups.size(), false);  // whether a part that is kept has a triangle of the group
  std::vector<bool> drop(mesh.triangles.size(), false);
  for (const Part& part : parts_of(mesh)) {
    const bool repeated =
        std::ranges::all_of(part.triangles, [&](Index t) { return group_of[t] != kNone && taken[group_of[t]]; });
    for (const Index t : part.triangles) {
      drop[t] = repeated;
      if (!repeated && group_of[t] != kNone) taken[group_of[t]] = true;
    }
  }
  report.duplicates_dropped += erase_marked(mesh, drop);
}

// A mesh of this part alone, with vertices renumbered.
TriangleMesh extract(const TriangleMesh& mesh, const Part& part) {
  TriangleMesh alone;
  std::vector<Index> old;
  for (const Index t : part.triangles) old.insert(old.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::sort(old.begin(), old.end());
  old.erase(std::unique(old.begin(), old.end()), old.end());
  for (const Index vertex : old) alone.vertices.push_back(mesh.vertices[vertex]);
  const auto renumbered = [&](Index vertex) {
    return static_cast<Index>(std::lower_bound(old.begin(), old.end(), vertex) - old.begin());
  };
  for (const Index t : part.triangles) {
    const auto& [i, j, k] = mesh.triangles[t];
    alone.triangles.push_back({renumbered(i), renumbered(j), renumbered(k)});
  }
  return alone;
}

// Whether every vertex of `inner` is strictly inside `outer`. A part that pokes out of another is no cavity of it.
bool holds(const Surface& outer, const TriangleMesh& mesh, const Part& inner) {
  return std::ranges::all_of(inner.triangles, [&](Index t) {
    return std::ranges::all_of(mesh.triangles[t], [&](Index vertex) { return outer.inside(mesh.vertices[vertex]); });
  });
}

}  // namespace

void orient_parts(TriangleMesh& mesh, MeshRepairReport& report) {
  drop_repeated(mesh, report);
  std::vector<Part> parts = parts_of(mesh);
  for (Part& part : parts) {
    part.inside_out = check_mesh(extract(mesh, part)).volume < 0;
    if (part.inside_out) part.turn(mesh);
  }
  for (const Part& outer : parts) {
    std::unique_ptr<Surface> surface;
    for (Part& inner : parts) {
      if (&inner == &outer || !outer.box.contains(inner.box)) continue;
      if (!surface) surface = std::make_unique<Surface>(extract(mesh, outer));
      if (!surface->solid()) break;
      inner.depth += holds(*surface, mesh, inner) ? 1 : 0;
    }
  }
  for (const Part& part : parts) {
    const bool cavity = part.depth % 2 == 1;
    if (cavity) part.turn(mesh);
    if (cavity && !part.inside_out) ++report.cavities_turned_inward;
    if (!cavity && part.inside_out) ++report.parts_turned_outward;
  }
}

}  // namespace orchard::detail
