#include <algorithm>
#include <tuple>

#include "area_vector.h"
#include "half_edges.h"
#include "orchard/geometry/disjoint_sets.h"
#include "repair_steps.h"
#include "same_place.h"

namespace orchard::detail {
namespace {

using TriangleCorners = std::array<Index, 3>;

bool repeats_a_corner(const TriangleCorners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// The triangles with all vertices welded that lie in the same place. The result has no positions.
TriangleMesh all_welded(const TriangleMesh& mesh, const std::vector<Index>& first) {
  TriangleMesh welded{{}, mesh.triangles};
  for (TriangleCorners& t : welded.triangles)
    for (Index& vertex : t) vertex = first[vertex];
  return welded;
}

// The vertices that welding may help: the ends of boundary edges, the corners of triangles of which two lie in the same
// place, and the corners of triangles that lie in the same place as another.
std::vector<bool> weldable_vertices(const TriangleMesh& mesh, const std::vector<Index>& first) {
  std::vector<bool> weldable(mesh.vertices.size(), false);
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) weldable[edge[0].low] = weldable[edge[0].high] = true;
  });
  const TriangleMesh welded = all_welded(mesh, first);
  const auto allow = [&](Index triangle) {
    for (const Index vertex : mesh.triangles[triangle]) weldable[vertex] = true;
  };
  for (Index t = 0; t < welded.triangles.size(); ++t)
    if (repeats_a_corner(welded.triangles[t])) allow(t);
  for (const auto& group : same_corners(welded)) std::for_each(group.begin(), group.end(), allow);
  return weldable;
}

// The corner opposite a triangle's longest edge.
std::size_t apex_of(const TriangleMesh& mesh, const TriangleCorners& t) {
  std::array<double, 3> squared{};
  for (std::size_t i = 0; i < 3; ++i)
    squared[i] = (mesh.vertices[t[(i + 1) % 3]] - mesh.vertices[t[(i + 2) % 3]]).squaredNorm();
  return static_cast<std::size_t>(std::max_element(squared.begin(), squared.end()) - squared.begin());
}

// Removes triangles without area. Their apex lies on their longest edge, so splitting the triangles across that edge at
// the apex closes the gap without moving the surface.
class FlatTriangles {
 public:
  FlatTriangles(TriangleMesh& mesh, MeshRepairReport& report) : mesh_(mesh), report_(report) {
    Box box;
    for (const TriangleCorners& t : mesh.triangles)
      for (const Index vertex : t) box.extend(mesh.vertices[vertex]);
    scale_ = unit_scale(box);
  }

  // Removes those that do not change the same triangles as others before them. Returns whether there were any without
  // area: the rest are left to another pass.
  bool pass() {
    const std::vector<Index> flat = find();
    if (flat.empty()) return false;
    uses_ = sorted_edge_uses(mesh_);
    erased_.assign(mesh_.triangles.size(), false);
    touched_.assign(mesh_.triangles.size(), false);
    for (const Index t : flat) {
      if (!touched_[t]) remove(t);
    }
    erased_.resize(mesh_.triangles.size(), false);
    erase_marked(mesh_, erased_);
    return true;
  }

 private:
  std::vector<Index> find() const {
    std::vector<Index> flat;
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      if (area_vector({mesh_.vertices[i], mesh_.vertices[j], mesh_.vertices[k]}, scale_) == Vector::Zero())
        flat.push_back(t);
    }
    return flat;
  }

  std::span<const EdgeUse> edge(Index a, Index b) const {
    const auto [low, high] = std::minmax(a, b);
    const auto before = [](const EdgeUse& use, const std::pair<Index, Index>& key) {
      return std::tie(use.low, use.high) < std::tie(key.first, key.second);
    };
    const std::pair<Index, Index> key{low, high};
    auto first = std::lower_bound(uses_.begin(), uses_.end(), key, before);
    auto last = first;
    while (last != uses_.end() && last->low == low && last->high == high) ++last;
    return {first, last};
  }

  void remove(Index t) {
    const TriangleCorners corners = mesh_.triangles[t];
    const std::size_t at = apex_of(mesh_, corners);
    const Index apex = corners[at];
    const auto across = edge(corners[(at + 1) % 3], corners[(at + 2) % 3]);
    if (std::any_of(across.begin(), across.end(), [&](const EdgeUse& use) { return touched_[use.half_edge / 3]; }))
      return;  // left to another pass
    for (const EdgeUse& use : across) {
      const Index other = use.half_edge / 3, i = use.half_edge % 3;
      touched_[other] = true;
      if (other != t) split(other, i, apex);
    }
    erased_[t] = touched_[t] = true;
    ++report_.degenerate_dropped;
  }

  // Splits edge i of a triangle at `apex`; a triangle folded onto the flat one is removed with it.
  void split(Index triangle, Index i, Index apex) {
    const TriangleCorners corners = mesh_.triangles[triangle];
    const Index x = corners[i], y = corners[(i + 1) % 3], z = corners[(i + 2) % 3];
    if (z == apex) {
      erased_[triangle] = true;
      ++report_.degenerate_dropped;
      return;
    }
    mesh_.triangles[triangle] = {x, apex, z};
    mesh_.triangles.push_back({apex, y, z});
    ++report_.neighbors_split;
  }

  TriangleMesh& mesh_;
  MeshRepairReport& report_;
  double scale_ = 1;
  std::vector<EdgeUse> uses_;
  std::vector<bool> erased_, touched_;
};

}  // namespace

Index erase_marked(TriangleMesh& mesh, const std::vector<bool>& marked) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!marked[t]) mesh.triangles[kept++] = mesh.triangles[t];
  }
  const std::size_t erased = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  return static_cast<Index>(erased);
}

void weld_vertices(TriangleMesh& mesh, MeshRepairReport& report) {
  const std::vector<Index> first = first_at_place(mesh);
  const std::vector<bool> weldable = weldable_vertices(mesh, first);
  // The lowest weldable one at each place.
  std::vector<Index> kept(mesh.vertices.size(), kNone);
  for (Index v = 0; v < kept.size(); ++v) {
    if (!weldable[v]) continue;
    if (kept[first[v]] == kNone) {
      kept[first[v]] = v;
    } else {
      ++report.vertices_welded;
    }
  }
  for (TriangleCorners& t : mesh.triangles)
    for (Index& vertex : t)
      if (weldable[vertex]) vertex = kept[first[vertex]];
}

void drop_duplicates(TriangleMesh& mesh, MeshRepairReport& report) {
  // A component all of whose triangles come in both orientations is a surface with two sides, meant as one. Elsewhere
  // opposite triangles are the wall between two solids.
  const std::vector<std::vector<Index>> groups = same_corners(mesh);
  if (groups.empty()) return;
  std::vector<bool> reversed(mesh.triangles.size()), two_sided(mesh.triangles.size(), false);
  for (Index t = 0; t < mesh.triangles.size(); ++t) reversed[t] = canonical(mesh.triangles[t]).second;
  for (const auto& group : groups) {
    const bool both =
        std::any_of(group.begin(), group.end(), [&](Index t) { return reversed[t] != reversed[group[0]]; });
    for (const Index t : group) two_sided[t] = both;
  }
  DisjointSets components(mesh.triangles.size());
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    for (const EdgeUse& use : edge) components.unite(edge[0].half_edge / 3, use.half_edge / 3);
  });
  std::vector<bool> one_sided_component(mesh.triangles.size(), false);
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    if (!two_sided[t]) one_sided_component[components.root(t)] = true;

  std::vector<bool> drop(mesh.triangles.size(), false);
  for (const auto& group : groups) {
    const bool keep_both = two_sided[group[0]] && one_sided_component[components.root(group[0])];
    bool opposite_kept = false;
    for (std::size_t i = 1; i < group.size(); ++i) {
      const bool opposite = reversed[group[i]] != reversed[group[0]];
      drop[group[i]] = !(keep_both && opposite && !opposite_kept);
      opposite_kept |= opposite;
    }
  }
  report.duplicates_dropped += erase_marked(mesh, drop);
}

void drop_degenerate(TriangleMesh& mesh, MeshRepairReport& report) {
  std::vector<bool> drop(mesh.triangles.size());
  for (std::size_t t = 0; t < drop.size(); ++t) drop[t] = repeats_a_corner(mesh.triangles[t]);
  report.degenerate_dropped += erase_marked(mesh, drop);
  // Splitting can leave a flat triangle again, where more than three vertices lie on a line.
  constexpr int kMaxPasses = 30;
  FlatTriangles flat(mesh, report);
  for (int i = 0; i < kMaxPasses && flat.pass(); ++i) {
  }
}

void drop_unused_vertices(TriangleMesh& mesh, MeshRepairReport& report) {
  std::vector<Index> number(mesh.vertices.size(), kNone);
  for (const TriangleCorners& t : mesh.triangles)
    for (const Index vertex : t) number[vertex] = 0;
  Index used = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    mesh.vertices[used] = mesh.vertices[v];
    number[v] = used++;
  }
  const Index dropped = static_cast<Index>(number.size()) - used;
  // A welded or joined vertex is out of use too, and is counted there.
  report.unused_vertices_dropped = dropped - std::min(dropped, report.vertices_welded + report.vertices_joined);
  mesh.vertices.resize(used);
  for (TriangleCorners& t : mesh.triangles)
    for (Index& vertex : t) vertex = number[vertex];
}

}  // namespace orchard::detail
