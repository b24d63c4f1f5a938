#include "medial_faces.h"

#include <algorithm>

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

// Decides whether two points are so close to each other within the surface that the face between them is a topology
// face, which stands on the surface, and not a sheet along the middle of the solid. That is so if the points lie on one
// coplanar cluster, or on two triangles that share an edge which is nearly flat.
class SurfaceNeighbors {
 public:
  SurfaceNeighbors(const Surface& surface, const SurfaceSampling& sampling) : surface_(surface) {
    std::vector<Index> around;
    for (Index point = 0; point < sampling.size(); ++point) {
      surface.triangles_at(sampling.triangles[point], sampling.features[point], around);
      triangles_.items.insert(triangles_.items.end(), around.begin(), around.end());
      triangles_.close_row();
    }
  }

  bool operator()(Index a, Index b) const {
    for (const Index first : triangles_[a]) {
      for (const Index second : triangles_[b]) {
        if (first == second || same_cluster(first, second) || joined_flatly(first, second)) return true;
      }
    }
    return false;
  }

 private:
  bool same_cluster(Index a, Index b) const {
    return surface_.clusters().of_triangle[a] == surface_.clusters().of_triangle[b];
  }
  bool joined_flatly(Index a, Index b) const {
    const auto& next = surface_.neighbors(a);
    return std::find(next.begin(), next.end(), b) != next.end() &&
           surface_.normal(a).dot(surface_.normal(b)) > tolerance::kFlatEdgeCosine;
  }

  const Surface& surface_;
  Rows triangles_;  // of each point
};

}  // namespace

void find_medial_faces(const Surface& surface, const SurfaceSampling& sampling, const VoronoiFaces& voronoi,
                       const std::vector<Index>& medial, const std::vector<Index>& stems, MedialAxis& axis) {
  const SurfaceNeighbors are_neighbors(surface, sampling);
  std::vector<Index> corners;
  for (Index face = 0; face < voronoi.vertices.size(); ++face) {
    corners.clear();
    bool interior = true;
    for (const Index vertex : voronoi.vertices[face]) {
      const Index corner = medial[vertex];
      interior = interior && corner != kNone && (stems.empty() || stems[vertex] == kNone);
      if (!interior) break;
      // Vertices that were merged into one follow each other.
      if (corners.empty() || corners.back() != corner) corners.push_back(corner);
    }
    while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
    const auto& [a, b] = voronoi.points[face];
    if (!interior || corners.size() < 3) continue;
    const bool for_topology = are_neighbors(a, b);
    (for_topology ? axis.topology_face_points : axis.face_points).push_back({a, b});
    Rows& faces = for_topology ? axis.topology_faces : axis.faces;
    faces.items.insert(faces.items.end(), corners.begin(), corners.end());
    faces.close_row();
  }
}

}  // namespace orchard::detail
