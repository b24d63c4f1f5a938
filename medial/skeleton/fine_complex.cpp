#include "fine_complex.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "../axis/incidence.h"

namespace orchard::detail {
namespace {

constexpr double kMaxDivided = 2e6;  // the maximum number of triangles
// The average area of a triangle after edges have been halved until they are short enough, over the squared longest
// edge.
constexpr double kAreaOfDivided = 0.2;

// Adds a vertex at the middle of each edge that is too long, and returns it for each edge; kNone for the others.
std::vector<Index> add_middles_of_long(MedialMesh& mesh, double length) {
  std::vector<Index> middles(mesh.edges.size(), kNone);
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const auto [a, b] = mesh.edges[e];
    if (!((mesh.centers[a] - mesh.centers[b]).norm() > length)) continue;
    middles[e] = mesh.size();
    mesh.centers.push_back(0.5 * (mesh.centers[a] + mesh.centers[b]));
    mesh.radii.push_back(0.5 * (mesh.radii[a] + mesh.radii[b]));
  }
  return middles;
}

// Appends the pieces into which triangle abc is divided at the middles of its edges. Edges that are not divided have
// kNone.
void add_pieces(const MedialMesh& mesh, std::array<Index, 3> abc, std::array<Index, 3> middles_ab_bc_ca,
                std::vector<std::array<Index, 3>>& pieces) {
  auto [ab, bc, ca] = middles_ab_bc_ca;
  const auto count =
      std::count_if(middles_ab_bc_ca.begin(), middles_ab_bc_ca.end(), [](Index m) { return m != kNone; });
  if (count == 0) {
    pieces.push_back(abc);
    return;
  }
  // The corners are rotated until the first edge is divided and the last one is not, if there is such an edge.
  while (count < 3 && !(ca == kNone && ab != kNone)) {
    abc = {abc[1], abc[2], abc[0]};
    std::tie(ab, bc, ca) = std::tuple(bc, ca, ab);
  }
  const auto [a, b, c] = abc;
  if (count == 3) {
    pieces.insert(pieces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  } else if (count == 2) {
    const auto squared = [&](Index i, Index k) { return (mesh.centers[i] - mesh.centers[k]).squaredNorm(); };
    pieces.push_back({ab, b, bc});
    if (squared(a, bc) <= squared(ab, c)) {
      pieces.insert(pieces.end(), {{a, ab, bc}, {a, bc, c}});
    } else {
      pieces.insert(pieces.end(), {{a, ab, c}, {ab, bc, c}});
    }
  } else {
    pieces.insert(pieces.end(), {{a, ab, c}, {ab, b, c}});
  }
}

}  // namespace

double affordable_edge_length(const MedialMesh& mesh, double wanted) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += (mesh.centers[b] - mesh.centers[a]).cross(mesh.centers[c] - mesh.centers[a]).norm() / 2;
  return std::max(wanted, std::sqrt(area / (kAreaOfDivided * kMaxDivided)));
}

MedialMesh divided(const MedialMesh& mesh, double length) {
  MedialMesh fine = mesh;
  for (;;) {
    const CellIncidence at(fine.edges, fine.triangles, fine.size());
    const std::vector<Index> middles = add_middles_of_long(fine, length);
    if (std::all_of(middles.begin(), middles.end(), [](Index m) { return m == kNone; })) return fine;
    std::vector<std::array<Index, 3>> triangles;
    triangles.reserve(2 * fine.triangles.size());
    for (Index t = 0; t < fine.triangles.size(); ++t) {
      const auto [ab, ac, bc] = at.sides[t];
      add_pieces(fine, fine.triangles[t], {middles[ab], middles[bc], middles[ac]}, triangles);
    }
    std::vector<std::array<Index, 2>> edges;  // the edges of triangles are added again later
    for (Index e = 0; e < middles.size(); ++e) {
      if (!at.triangles_at[e].empty()) continue;
      const auto [a, b] = fine.edges[e];
      if (middles[e] == kNone) {
        edges.push_back({a, b});
      } else {
        edges.push_back({a, middles[e]});
        edges.push_back({b, middles[e]});
      }
    }
    complete_cells(edges, triangles);
    fine.edges = std::move(edges);
    fine.triangles = std::move(triangles);
  }
}

}  // namespace orchard::detail
