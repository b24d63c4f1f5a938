#include "uncut_parts.h"

#include <limits>

#include "exact_side.h"
#include "half_edges.h"
#include "orchard/geometry/disjoint_sets.h"
#include "same_place.h"

// Why triangles that agree may be believed. Let c be the point of the surface nearest to the query q, and let all
// triangles that hold c be uncut and see q strictly on the same side. Walk from q towards c, which meets nothing before
// c, stop just before it, and turn about c, on a small sphere, by less than half a turn until a triangle T is met; T
// holds c. The walk stayed on one side of T's plane: a half-line from c that turns towards T can cross T's plane only
// at T itself or after half a turn. So T was met from the side on which it sees q, and the winding number of q is the
// one next to T on that side. Next to an uncut triangle it is the same everywhere on a side, since nothing else comes
// near the triangle's inner points; on the back it is higher by one. Across an edge at which exactly two triangles
// meet, both uncut, the front goes on, since nothing else comes near the edge's inner points either. If c is an inner
// point of an edge or a face the walk is the same or shorter.
//
// Triangles that merely may hold c can be asked besides: they can only disagree. What the walk does not settle, a ray
// does; and what a ray has settled tells the winding number in front of the part that the triangles belong to.

namespace orchard::detail {
namespace {

constexpr int kUnknown = std::numeric_limits<int>::min();

}  // namespace

UncutParts::UncutParts(const TriangleMesh& mesh, const TriangleTree& tree, std::span<const std::array<Index, 2>> cuts)
    : mesh_(mesh), tree_(tree) {
  // Vertices at the same place count as one here, because a surface may touch itself along edges and in triangles.
  const std::vector<Index> first = first_at_place(mesh);
  TriangleMesh welded{{}, mesh.triangles};
  for (auto& corners : welded.triangles)
    for (Index& vertex : corners) vertex = first[vertex];
  std::vector<bool> cut(mesh.triangles.size(), false);
  for (const auto& pair : cuts)
    for (const Index triangle : pair) cut[triangle] = true;
  for (const auto& group : same_corners(welded))
    for (const Index triangle : group) cut[triangle] = true;
  welded.vertices.resize(mesh.vertices.size());
  const auto neighbors = triangle_neighbors(welded);

  DisjointSets parts(mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (const Index other : neighbors[t])
      if (other != kNone && !cut[t] && !cut[other]) parts.unite(t, other);
  part_of_.assign(mesh.triangles.size(), kNone);
  Index count = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    if (cut[t]) continue;
    const Index root = parts.root(t);
    if (root == t) part_of_[t] = count++;
    part_of_[t] = part_of_[root];
  }
  in_front_ = std::vector<std::atomic<int>>(count);
  for (auto& winding : in_front_) winding = kUnknown;
}

std::optional<UncutParts::Vote> UncutParts::vote(const Point& query, const NearestTriangles& nearest) const {
  if (!nearest.complete) return std::nullopt;
  std::optional<Vote> vote;
  for (std::size_t i = 0; i < nearest.count; ++i) {
    const auto& [a, b, c] = mesh_.triangles[nearest.triangles[i]];
    const Index part = part_of_[nearest.triangles[i]];
    if (part == kNone || (vote && part != vote->part)) return std::nullopt;
    const int side = plane_side({mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]}, query);
    if (side == 0 || (vote && (side > 0) != vote->in_front)) return std::nullopt;
    vote = {part, side > 0};
  }
  return vote;
}

bool UncutParts::inside(const Point& query, const NearestTriangles& nearest) const {
  const std::optional<Vote> agreed = vote(query, nearest);
  if (!agreed) return tree_.winding_number(query) > 0;
  const int behind = agreed->in_front ? 0 : 1;
  std::atomic<int>& in_front = in_front_[agreed->part];
  int known = in_front.load(std::memory_order_relaxed);
  if (known == kUnknown) {
    known = tree_.winding_number(query) - behind;
    in_front.store(known, std::memory_order_relaxed);
  }
  return known + behind > 0;
}

}  // namespace orchard::detail
