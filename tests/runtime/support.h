#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"
#include "split_mix.h"

// Meshes, trees and slow oracles for the run-time's tests: nothing here uses the construction libraries.
namespace orchard::runtime::test {

using Vec = std::array<double, 3>;

struct Mesh {
  std::vector<Vec> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool closed = true;  // bounds a solid, oriented outward
};

Mesh box(const Vec& lower, const Vec& upper);
Mesh uv_sphere(int around, int across, double radius);
Mesh torus(int around, int across, double major_radius, double minor_radius);
Mesh l_shape();                                           // nonconvex, coplanar faces
Mesh spikes(std::uint64_t seed, int around, int across);  // a sphere whose vertices moved radially: deep dents
Mesh soup(std::uint64_t seed, int triangles);             // open, self-intersecting, some triangles degenerate
Mesh scaled(Mesh mesh, double scale);

class Draw : public SplitMix {
 public:
  using SplitMix::SplitMix;
  Vec direction();
  Pose pose(double distance);  // a random rotation, and a translation of that length
};

struct TreeOptions {
  std::uint32_t branching = 8;
  std::uint32_t leaf_triangles = 4;  // split while a node has more
  std::uint32_t max_depth = 100;
  Vec origin = {0, 0, 0};
  bool bounds = true;  // else all `depth` and `error` are unknown: brute force is slow on large meshes
};

// A conservative tree by median splits: a node's ball holds all of its triangles, so every ancestor of a leaf holds the
// leaf's triangles. Vertices are rounded to float first (vertex_error is 0: the stored mesh is the mesh); bounds come
// from brute force, with 1-Lipschitz signed distance: error = max(0, radius + depth).
PackedSphereTree build_tree(const Mesh& mesh, const TreeOptions& options = {});

// All of a tree's triangles, at most eight, in one leaf, in their order. The tree itself may have them in several.
TriangleBlock one_block(const PackedSphereTree& tree);

// The triangles as the tree stores them, placed in the world.
using Triangle = std::array<std::array<long double, 3>, 3>;
std::vector<Triangle> placed_triangles(const PackedSphereTree& tree, const Pose& pose);

// Those of the placed triangles that are below a node of the tree's ball slabs.
std::vector<Triangle> triangles_below(const PackedSphereTree& tree, std::uint32_t node,
                                      const std::vector<Triangle>& placed);

bool triangles_intersect(const Triangle& a, const Triangle& b);       // separating axes, long double
long double triangle_distance(const Triangle& a, const Triangle& b);  // 0 if they intersect
bool surfaces_intersect(const std::vector<Triangle>& a, const std::vector<Triangle>& b);
long double surface_distance(const std::vector<Triangle>& a, const std::vector<Triangle>& b);
long double point_distance(const std::array<long double, 3>& point, const Triangle& triangle);

}  // namespace orchard::runtime::test
