#include "orchard/medial/medial_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_set>
#include <utility>

#include "axis/incidence.h"
#include "axis_triangles.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

using Edge = std::array<Index, 2>;

// Cuts the faces of an axis into triangles.
class Triangulator {
 public:
  explicit Triangulator(const MedialAxis& axis) : axis_(axis) {
    mesh_.centers = axis.centers;
    mesh_.radii = axis.radii;
    for (Index i = 0; i < axis.size(); ++i) {
      for (const Index next : axis.neighbors[i]) {
        if (i < next) mesh_.edges.push_back({i, next});
      }
    }
    for (const auto& [a, b] : mesh_.edges) joined_.insert(key(a, b));
  }

  detail::AxisTriangles run() {
    for (; face_ < axis_.faces.size(); ++face_) cut(axis_.faces[face_], axis_.face_points[face_]);
    for (Index i = 0; i < axis_.topology_faces.size(); ++i, ++face_)
      cut(axis_.topology_faces[i], axis_.topology_face_points[i]);
    std::sort(pieces_.begin(), pieces_.end());
    detail::AxisTriangles result;
    for (const auto& [triangle, face] : pieces_) {
      if (!mesh_.triangles.empty() && mesh_.triangles.back() == triangle)
        continue;  // it belongs to two faces: the first keeps it
      mesh_.triangles.push_back(triangle);
      result.face_of_triangle.push_back(face);
    }
    complete(mesh_);
    result.mesh = std::move(mesh_);
    return result;
  }

 private:
  static std::uint64_t key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }
  bool apex_serves(std::span<const Index> corners, std::size_t apex) const {
    for (std::size_t k = 2; k + 1 < corners.size(); ++k) {
      const Index other = corners[(apex + k) % corners.size()];
      if (other == corners[apex] || joined_.contains(key(corners[apex], other))) return false;
    }
    return true;
  }
  void cut(std::span<const Index> corners, const Edge& points) {
    const std::size_t size = corners.size();
    for (std::size_t apex = 0; apex < size; ++apex) {
      if (!apex_serves(corners, apex)) continue;
      for (std::size_t k = 1; k + 1 < size; ++k) {
        joined_.insert(key(corners[apex], corners[(apex + k) % size]));
        add(corners[apex], corners[(apex + k) % size], corners[(apex + k + 1) % size]);
      }
      return;
    }
    const Index middle = add_middle(corners, points);
    for (std::size_t k = 0; k < size; ++k) add(middle, corners[k], corners[(k + 1) % size]);
  }
  Index add_middle(std::span<const Index> corners, const Edge& points) {
    Point middle = Point::Zero();
    for (const Index corner : corners) middle += axis_.centers[corner];
    middle /= static_cast<double>(corners.size());
    mesh_.centers.push_back(middle);
    mesh_.radii.push_back((axis_.points[points[0]] - middle).norm());
    return mesh_.size() - 1;
  }
  void add(Index a, Index b, Index c) {
    std::array<Index, 3> triangle{a, b, c};
    std::sort(triangle.begin(), triangle.end());
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2]) pieces_.emplace_back(triangle, face_);
  }

  const MedialAxis& axis_;
  MedialMesh mesh_;
  Index face_ = 0;                                              // the face that is being cut
  std::vector<std::pair<std::array<Index, 3>, Index>> pieces_;  // triangles, and their faces
  std::unordered_set<std::uint64_t> joined_;                    // only looked up, never iterated: pairs of vertices
};

[[noreturn]] void fail(const char* kind, std::size_t index, const char* fault) {
  throw InputError("medial mesh: " + std::string(kind) + " " + std::to_string(index) + " " + fault);
}

template <std::size_t kCorners>
void validate_cells(const std::vector<std::array<Index, kCorners>>& cells, Index vertices, const char* kind) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t k = 0; k < kCorners; ++k) {
      if (cells[i][k] >= vertices) fail(kind, i, "names a vertex that does not exist");
      if (k > 0 && cells[i][k] <= cells[i][k - 1]) fail(kind, i, "has corners that are not distinct and ascending");
    }
    if (i > 0 && !(cells[i - 1] < cells[i])) fail(kind, i, "is repeated or out of order");
  }
}

}  // namespace

detail::AxisTriangles detail::axis_triangles(const MedialAxis& axis) { return Triangulator(axis).run(); }

MedialMesh medial_mesh(const MedialAxis& axis) { return detail::axis_triangles(axis).mesh; }

void complete(MedialMesh& mesh) { detail::complete_cells(mesh.edges, mesh.triangles); }

void validate(const MedialMesh& mesh) {
  if (mesh.centers.empty()) throw InputError("a medial mesh needs at least one vertex");
  if (mesh.radii.size() != mesh.centers.size()) throw InputError("a medial mesh needs as many radii as vertices");
  for (std::size_t i = 0; i < mesh.centers.size(); ++i) {
    if (!mesh.centers[i].allFinite()) fail("vertex", i, "has a coordinate that is not finite");
    if (!(mesh.radii[i] >= 0) || !std::isfinite(mesh.radii[i]))
      fail("vertex", i, "has a radius that is negative or not a number");
  }
  validate_cells(mesh.edges, mesh.size(), "edge");
  validate_cells(mesh.triangles, mesh.size(), "triangle");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    for (const Edge& side : {Edge{a, b}, Edge{a, c}, Edge{b, c}}) {
      if (!std::binary_search(mesh.edges.begin(), mesh.edges.end(), side))
        fail("triangle", i, "has no edge of its own");
    }
  }
}

}  // namespace orchard
