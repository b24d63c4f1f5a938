// From a mesh file to a certified sphere-tree, and the distance of two copies of it:  build_tree model.obj
#include <cstdio>
#include <exception>

#include "orchard/geometry/mesh_io.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/spheretree/build.h"

int main(int argc, char** argv) try {
  if (argc != 2) return std::fputs("usage: build_tree model.obj\n", stderr), 2;
  const orchard::Surface surface(orchard::read_mesh(argv[1]));
  const orchard::SphereTreeBuild build =
      orchard::build_sphere_tree(surface, {.tree = orchard::TightenOptions{.depth = 2}});
  std::printf("%u medial vertices, %u spheres, certified: %s\n", build.medial->axis.size(), build.packed.node_count,
              build.certificate.ok() ? "yes" : "no");

  const orchard::runtime::PreparedTree body(build.packed);
  orchard::runtime::NarrowPhase query(body, body);
  query.start({}, *orchard::runtime::pose_from_quaternion({1, 0, 0, 0}, {3 * surface.bounding_radius(), 0, 0}));
  query.refine({});
  const bool apart = query.answer() == orchard::runtime::Answer::no;
  std::printf("three radii apart: %s\n", apart ? "no contact" : "contact");
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
