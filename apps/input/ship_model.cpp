#include "input/ship_model.h"

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/build.h"

namespace orchard::apps {

runtime::PackedSphereTree ship_tree() {
  TriangleMesh mesh;
  const Point nose(2, 0, 0), right(-1.2, 0, -1.5), notch(-0.5, 0, 0), left(-1.2, 0, 1.5), top(0, 0.5, 0),
      bottom(0, -0.3, 0);
  mesh.vertices = {nose, right, notch, left, top, bottom};
  for (const Index i : {0u, 1u, 2u, 3u}) {
    const Index next = (i + 1) % 4;
    mesh.triangles.push_back({i, next, 4});
    mesh.triangles.push_back({next, i, 5});
  }
  return build_sphere_tree(Surface(std::move(mesh)), {.tree = OctreeOptions{.depth = 3}}).packed;
}

}  // namespace orchard::apps
