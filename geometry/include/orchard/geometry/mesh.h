#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace orchard {

using Index = std::uint32_t;  // into the array that its comment names
inline constexpr Index kNone = 0xffffffffu;
using Point = Eigen::Vector3d;
using Vector = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

struct Sphere {
  Point center = Point::Zero();
  double radius = 0;
};

// Vertices and triangles, nothing else. Corners run counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Point> vertices;
  std::vector<std::array<Index, 3>> triangles;  // into vertices
};

// Throws InputError unless all indices are in range, all coordinates finite and there is a triangle at all.
void validate(const TriangleMesh& mesh);

// The sizes of meshes that all of orchard works with, in mesh units: no coordinate is larger, and the longest side of
// the bounding box is no shorter. The run-time computes with the squares of lengths in floats; beyond either limit
// these overflow or lose their digits. read_mesh() checks it.
inline constexpr double kMaxCoordinate = 1e15, kMinExtent = 1e-12;

// Throws InputError, naming the limit, unless the mesh has a size in that range. A mesh without extent, which is a
// fault of another kind, passes. Precondition: validate(mesh) passes.
void require_usable_size(const TriangleMesh& mesh);

// Rows of different lengths in two flat arrays: row i is items[offsets[i] .. offsets[i + 1]).
struct Rows {
  std::vector<Index> offsets{0};
  std::vector<Index> items;

  Index size() const { return static_cast<Index>(offsets.size() - 1); }
  std::span<const Index> operator[](Index row) const {
    return {items.data() + offsets[row], items.data() + offsets[row + 1]};
  }
  // Ends the row that the items pushed since the last call make up.
  void close_row() { offsets.push_back(static_cast<Index>(items.size())); }
};

}  // namespace orchard
