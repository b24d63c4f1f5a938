#include "orchard/geometry/mesh.h"

#include <charconv>
#include <string>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

std::string text_of(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 6).ptr};
}

}  // namespace

void require_usable_size(const TriangleMesh& mesh) {
  Box box;
  for (const auto& corners : mesh.triangles)
    for (const Index vertex : corners) box.extend(mesh.vertices[vertex]);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const double max = mesh.vertices[i].cwiseAbs().maxCoeff();
    if (max <= kMaxCoordinate) continue;
    throw InputError("vertex " + std::to_string(i) + " (counted from 0) has a coordinate of size " + text_of(max) +
                     ", beyond the limit of " + text_of(kMaxCoordinate) +
                     "; scale the mesh down, or use a larger unit");
  }
  const double extent = box.sizes().maxCoeff();
  if (extent > 0 && extent < kMinExtent)
    throw InputError("the mesh is only " + text_of(extent) + " long, below the limit of " + text_of(kMinExtent) +
                     "; scale the mesh up, or use a smaller unit");
}

void validate(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.vertices.size();
  if (mesh.triangles.empty()) throw InputError("the mesh has no triangles");
  // An Index also has to number half-edges, of which each triangle has three.
  if (vertices >= kNone || mesh.triangles.size() > kNone / 3) {
    throw InputError("the mesh is too large: " + std::to_string(vertices) + " vertices and " +
                     std::to_string(mesh.triangles.size()) + " triangles do not fit 32-bit indices");
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    if (!mesh.vertices[i].allFinite()) {
      throw InputError("vertex " + std::to_string(i) +
                       " (counted from 0) has a coordinate that is not a finite number");
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const Index corner : mesh.triangles[i]) {
      if (corner < vertices) continue;
      throw InputError("triangle " + std::to_string(i) + " names vertex " + std::to_string(corner) +
                       ", but the mesh has " + std::to_string(vertices) + " vertices (all counted from 0)");
    }
  }
}

}  // namespace orchard
