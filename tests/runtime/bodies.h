#pragma once
#include <string>
#include <utility>
#include <vector>

#include "orchard/runtime/pose.h"
#include "support.h"

// The bodies that the narrow phase's tests share: shallow and deep, closed and open, narrow and wide.
namespace orchard::runtime::test {

struct Body {
  std::string name;
  PackedSphereTree tree;
  bool closed;
};

inline std::vector<Body> bodies() {
  const auto make = [](std::string name, const Mesh& mesh, const TreeOptions& options = {}) {
    return Body{std::move(name), build_tree(mesh, options), mesh.closed};
  };
  return {
      make("box in one node", box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), {.leaf_triangles = 12}),
      make("box, one triangle a leaf", box({0, 0, 0}, {1, 2, 0.25}), {.branching = 2, .leaf_triangles = 1}),
      make("torus", torus(12, 6, 1, 0.3)),
      make("torus, 13 children", torus(14, 6, 1, 0.3), {.branching = 13, .leaf_triangles = 2}),
      make("deep binary sphere", uv_sphere(8, 6, 1), {.branching = 2, .leaf_triangles = 1}),
      make("spikes", spikes(5, 9, 7), {.branching = 5, .leaf_triangles = 2}),
      make("l-shape off its origin", l_shape(), {.branching = 4, .leaf_triangles = 1, .origin = {1000, -2000, 500}}),
      make("soup", soup(11, 60), {.branching = 8, .leaf_triangles = 1}),
      make("cut-off soup", soup(12, 60), {.branching = 3, .leaf_triangles = 1, .max_depth = 2}),
  };
}

// Puts the tree's own middle, not its mesh's origin, `offset` away from the world's.
inline Pose centered(const PackedSphereTree& tree, Pose pose) {
  const SiblingBlock& root = tree.blocks[0];
  const Vec middle = {tree.origin[0] + root.x[0], tree.origin[1] + root.y[0], tree.origin[2] + root.z[0]};
  const Vec moved = rotate(pose, middle);
  for (std::size_t i = 0; i < 3; ++i) pose.translation[i] -= moved[i];
  return pose;
}

}  // namespace orchard::runtime::test
