#include "orchard/spheretree/octree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "octants.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
SphereTree octree(const Surface& surface, const OctreeOptions& options, const Progress& progress) {
  if (options.branching < 2 || options.branching > 64) throw InputError("branching must lie between 2 and 64");
  const double margin = tolerance::kCoverMargin * surface.bounding_radius();
  SphereTree tree;
  tree.branching = options.branching;
  tree.nodes.push_back({.sphere = surface.bounding_ball()});
  tree.nodes[0].sphere.radius += margin;
  std::vector<Octant> level{{surface.bounding_box(), {}, 0}};
  level[0].triangles.resize(surface.mesh().triangles.size());
  std::iota(level[0].triangles.begin(), level[0].triangles.end(), Index{0});
  for (Index depth = 1; depth <= options.depth; ++depth) {
    report_progress(progress, "octree", static_cast<double>(depth - 1) / options.depth);
    std::vector<Octant> next;
    for (Index i = 0; i < level.size(); ++i) {
      SphereNode& parent = tree.nodes[level[i].node];
      if (!wants_children(options.refinement, surface, parent.sphere)) continue;
      auto children = occupied_parts(surface, level[i], options.branching);
      parent.first_child = static_cast<Index>(tree.nodes.size());
      parent.child_count = static_cast<Index>(children.size());
      for (Octant& child : children) {
        const Sphere ball{child.box.center(), child.box.diagonal().norm() / 2 + margin};
        child.node = static_cast<Index>(tree.nodes.size());
        tree.nodes.push_back({.sphere = ball, .parent = level[i].node, .level = depth});
        next.push_back(std::move(child));
      }
    }
    level = std::move(next);
  }
  return tree;
}

}  // namespace orchard
