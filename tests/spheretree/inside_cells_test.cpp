#include "inside_cells.h"  // private

#include <gtest/gtest.h>

#include "support.h"

namespace orchard {
namespace {

using namespace test;

TEST(InsideCells, SayWhatTheSurfaceSaysEverywhere) {
  for (const TriangleMesh& mesh : {torus(24, 12), u_shape(0.05), transformed(l_shape(), 1e-5, Vector(1e3, 0, 0))}) {
    const Surface surface(mesh);
    const Box& box = surface.bounding_box();
    for (const int depth : {0, 1, 4}) {
      const detail::InsideCells cells(surface, depth);
      Random random(1, 1, static_cast<std::uint64_t>(depth));
      for (int i = 0; i < 5000; ++i) {
        Point point;
        for (int axis = 0; axis < 3; ++axis)
          point[axis] = box.min()[axis] + random.uniform(-0.1, 1.1) * box.sizes()[axis];
        ASSERT_EQ(cells.inside(point), surface.inside(point));
      }
      for (const Point& vertex : surface.mesh().vertices) ASSERT_EQ(cells.inside(vertex), surface.inside(vertex));
    }
  }
}

}  // namespace
}  // namespace orchard
