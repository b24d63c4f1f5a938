#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "query/triangle_tree.h"  // private
#include "support/effort.h"
#include "surface_queries.h"

namespace orchard {
namespace {

Box box_of(const TriangleMesh& mesh, Index triangle) {
  Box box;
  for (const Index vertex : mesh.triangles[triangle]) box.extend(mesh.vertices[vertex]);
  return box;
}

TEST(TriangleTree, VisitsEveryPairWhoseBoxesMeetOnce) {
  for (const auto& [name, mesh] : test::all_meshes()) {
    std::set<std::pair<Index, Index>> visited;
    detail::TriangleTree(mesh).visit_pairs([&, &name = name](Index a, Index b) {
      EXPECT_NE(a, b) << name;
      EXPECT_TRUE(visited.insert(std::minmax(a, b)).second) << name << ": " << a << " and " << b << " twice";
    });
    std::size_t met = 0;
    for (Index a = 0; a < mesh.triangles.size(); ++a)
      for (Index b = a + 1; b < mesh.triangles.size(); ++b) {
        if (box_of(mesh, a).intersection(box_of(mesh, b)).isEmpty()) continue;
        ++met;
        EXPECT_TRUE(visited.contains({a, b})) << name << ": " << a << " and " << b;
      }
    EXPECT_LE(visited.size(), 2 * met + 50) << name;  // or the boxes say nothing
  }
}

// What is out is asked about boxes that hold the triangles: it must not matter that they are a tree's.
TEST(Surface, LeavesOutOfNearTrianglesWhatLiesInBoxesThatAreOut) {
  for (const auto& [name, mesh] : test::all_meshes()) {
    const Surface surface(mesh);
    const double size = std::max(surface.bounding_radius(), 1e-40);
    Index left_out = 0;
    for (std::uint64_t k = 0; k < 20 * test::more(); ++k) {
      Random random(test::first_seed() + k, 21);
      const auto somewhere = [&](double low, double high) {  // in parts of the box's sides
        const Point at(random.uniform(low, high), random.uniform(low, high), random.uniform(low, high));
        return Point(surface.bounding_box().min() + Vector(at.cwiseProduct(surface.bounding_box().sizes())));
      };
      const Sphere ball{somewhere(0, 1), size * random.uniform(0, 1)};
      const Box hidden(somewhere(-0.2, 0.4), somewhere(0.6, 1.2));
      std::vector<Index> all, some;
      surface.triangles_near(ball, all);
      surface.triangles_near(
          ball, [&](const Box& box) { return hidden.contains(box); }, some);
      EXPECT_TRUE(std::is_sorted(some.begin(), some.end())) << name;
      EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end())) << name;
      for (const Index triangle : all) {
        const bool found = std::binary_search(some.begin(), some.end(), triangle);
        EXPECT_TRUE(found || hidden.contains(box_of(mesh, triangle))) << name << ": " << triangle;
      }
      left_out += static_cast<Index>(all.size() - some.size());
    }
    const bool may_be_none = mesh.triangles.size() <= 100 || name.find("1e") != std::string::npos;
    EXPECT_TRUE(may_be_none || left_out > 0) << name;
  }
}

}  // namespace
}  // namespace orchard
