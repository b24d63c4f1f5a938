#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

// The basic types of orchard's geometry: points, spheres and triangle meshes.
namespace orchard {

// An index into the array that the comment of a declaration names.
using Index = std::uint32_t;
// The index that stands for "none".
inline constexpr Index kNone = 0xffffffffu;
using Point = Eigen::Vector3d;
using Vector = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

struct Sphere {
  Point center = Point::Zero();
  double radius = 0;
};

// A mesh of vertices and triangles. The corners of a triangle run counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Point> vertices;
  std::vector<std::array<Index, 3>> triangles;  // Indices into `vertices`.
};

// Throws InputError unless all indices are in range, all coordinates are finite and there is at least one triangle.
void validate(const TriangleMesh& mesh);

// The range of usable mesh sizes, in mesh units: no coordinate is larger than kMaxCoordinate, and the longest side of
// the bounding box is at least kMinExtent. The run-time computes with the squares of lengths in floats, which overflow
// or lose their digits beyond these limits. read_mesh() checks them.
inline constexpr double kMaxCoordinate = 1e15, kMinExtent = 1e-12;

// Throws InputError, which names the limit, unless the size of the mesh is in that range. A mesh without extent, which
// is a fault of another kind, passes. Precondition: validate(mesh) passes.
void require_usable_size(const TriangleMesh& mesh);

// Rows of different lengths in two flat arrays: row i is items[offsets[i] .. offsets[i + 1]).
struct Rows {
  std::vector<Index> offsets{0};
  std::vector<Index> items;

  Index size() const { return static_cast<Index>(offsets.size() - 1); }
  std::span<const Index> operator[](Index row) const {
    return {items.data() + offsets[row], items.data() + offsets[row + 1]};
  }
  // Ends a row. The row consists of the items that were appended since the last call.
  void close_row() { offsets.push_back(static_cast<Index>(items.size())); }
};

}  // namespace orchard
