// Local thickness does not depend on how the triangles of a mesh are numbered.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "orchard/geometry/mesh_io.h"
#include "orchard/medial/thickness.h"
#include "support/shapes.h"

namespace orchard {
namespace {

// A torus whose tube is thicker and thinner by turns, so that balls end at edges and corners between facets that turn
// by different angles.
TriangleMesh bumpy_torus() {
  TriangleMesh mesh = test::torus(72, 24);
  for (Point& vertex : mesh.vertices)
    vertex += 0.02 * Point(std::sin(9 * vertex.y()), std::sin(9 * vertex.z()), std::sin(9 * vertex.x()));
  return mesh;
}

TEST(ThicknessOrder, OfTrianglesDoesNotMatterWhereABallEndsBetweenThem) {
  const std::string data = ORCHARD_DATA_DIR;
  for (const TriangleMesh& mesh : {bumpy_torus(), read_mesh(data + "/faucet.obj"), read_mesh(data + "/ship.obj")}) {
    TriangleMesh other = mesh;
    std::reverse(other.triangles.begin(), other.triangles.end());
    const ThicknessOptions options{.samples = 1, .work = 1'000'000};
    const ThicknessValues a = local_thickness(Surface(mesh), options).at_vertices,
                          b = local_thickness(Surface(other), options).at_vertices;
    for (std::size_t i = 0; i < a.thickness.size(); ++i) {
      EXPECT_NEAR(a.ball_diameter[i], b.ball_diameter[i], 1e-9 * a.ball_diameter[i]) << i;
      EXPECT_EQ(std::isnan(a.thickness[i]), std::isnan(b.thickness[i])) << i;
      if (!std::isnan(a.thickness[i]) && !std::isnan(b.thickness[i])) {
        EXPECT_NEAR(a.thickness[i], b.thickness[i], 1e-9 * a.thickness[i]) << i;
      }
    }
  }
}

}  // namespace
}  // namespace orchard
