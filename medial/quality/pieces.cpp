#include <algorithm>

#include "../axis/incidence.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/medial/quality.h"

namespace orchard {
namespace {

struct Extent {
  Box box;
  double radius = 0;
  void add(const MedialMesh& mesh, Index vertex) {
    box.extend(mesh.centers[vertex]);
    radius = std::max(radius, mesh.radii[vertex]);
  }
};

Index small_ones(const std::vector<Extent>& extents) {
  return static_cast<Index>(std::count_if(extents.begin(), extents.end(), [](const Extent& extent) {
    return !extent.box.isEmpty() && extent.box.diagonal().norm() < extent.radius;
  }));
}

// The number of extents that are not empty.
Index count_of(const std::vector<Extent>& extents) {
  return static_cast<Index>(
      std::count_if(extents.begin(), extents.end(), [](const Extent& extent) { return !extent.box.isEmpty(); }));
}

}  // namespace

MedialPieces medial_pieces(const MedialMesh& mesh) {
  const detail::CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  DisjointSets faces(mesh.triangles.size()), curves(mesh.size());
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const auto triangles = at.triangles_at[e];
    for (const Index t : triangles) faces.unite(triangles.front(), t);
    if (triangles.empty()) curves.unite(mesh.edges[e][0], mesh.edges[e][1]);
  }
  std::vector<Extent> of_faces(mesh.triangles.size()), of_curves(mesh.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index vertex : mesh.triangles[t]) of_faces[faces.root(t)].add(mesh, vertex);
  }
  for (const Index e : at.bare_edges()) {
    for (const Index vertex : mesh.edges[e]) of_curves[curves.root(vertex)].add(mesh, vertex);
  }
  for (const Index v : at.lone_vertices()) of_curves[v].add(mesh, v);
  MedialPieces pieces{.face_components = count_of(of_faces), .curve_components = count_of(of_curves)};
  if (pieces.face_components + pieces.curve_components > 1) pieces.small = small_ones(of_faces) + small_ones(of_curves);
  return pieces;
}

double border_length(const MedialMesh& mesh) {
  double sum = 0;
  for (const Index e : detail::CellIncidence(mesh.edges, mesh.triangles, mesh.size()).border_edges())
    sum += (mesh.centers[mesh.edges[e][0]] - mesh.centers[mesh.edges[e][1]]).norm();
  return sum;
}

}  // namespace orchard
