#include "broken_meshes.h"

#include <algorithm>
#include <numeric>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard::test {

using Triangle = std::array<Index, 3>;

TriangleMesh unit_box() { return box(Point(0, 0, 0), Point(1, 1, 1)); }

TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (Triangle t : mesh.triangles) {
    for (Index& vertex : t) {
      const auto at = std::ranges::find(result.vertices, mesh.vertices[vertex]);
      const Index number = static_cast<Index>(at - result.vertices.begin());
      if (at == result.vertices.end()) result.vertices.push_back(mesh.vertices[vertex]);
      vertex = number;
    }
    result.triangles.push_back(t);
  }
  return result;
}

TriangleMesh turned(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh with(TriangleMesh mesh, std::initializer_list<Triangle> triangles) {
  mesh.triangles.insert(mesh.triangles.end(), triangles);
  return mesh;
}

namespace {

TriangleMesh without(TriangleMesh mesh, std::size_t triangle) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
  return mesh;
}

TriangleMesh turned_triangles(TriangleMesh mesh, std::uint64_t seed) {
  Random random(seed, 0);
  for (Triangle& t : mesh.triangles)
    if (random.uniform() < 0.3) std::swap(t[0], t[1]);
  return mesh;
}

// A box with a vertex in the middle of the edge between vertices 0 and 1, on one side of it only.
TriangleMesh box_with_t_junction(double depth = 0) {
  TriangleMesh mesh = unit_box();
  mesh.vertices.emplace_back(0.5, 0, depth);
  const auto at = std::ranges::find(mesh.triangles, Triangle{0, 1, 5});
  *at = {0, 8, 5};
  mesh.triangles.push_back({8, 1, 5});
  return mesh;
}

// The same, closed by a triangle without area.
TriangleMesh box_with_flat_triangle() { return with(box_with_t_junction(), {{0, 1, 8}}); }

// A ball without two triangles that share a vertex but no edge.
TriangleMesh without_opposite_triangles() {
  TriangleMesh ball = icosphere(2);
  const Index vertex = 20;
  std::vector<std::size_t> fan;
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    if (std::ranges::count(ball.triangles[t], vertex) > 0) fan.push_back(t);
  const auto shared = [&](std::size_t a, std::size_t b) {
    return std::ranges::count_if(ball.triangles[a],
                                 [&](Index v) { return std::ranges::count(ball.triangles[b], v) > 0; });
  };
  const auto other = std::ranges::find_if(fan, [&](std::size_t t) { return shared(fan[0], t) == 1; });
  return without(without(ball, *other), fan[0]);
}

// Whose triangles are wrong.
std::vector<BrokenMesh> broken_triangles() {
  const TriangleMesh ball = icosphere(2);
  const double ball_volume = check_mesh(ball).volume;
  TriangleMesh unused = unit_box();
  unused.vertices.emplace_back(9, 9, 9);
  return {
      {"a bag of triangles", soup(unit_box()), 1, {.vertices_welded = 28}},
      {"inside out", turned(unit_box()), 1, {.parts_turned_outward = 1}},
      {"a triangle turned round", turned_triangles(ball, 1), ball_volume, {}},
      {"a triangle twice", with(unit_box(), {{2, 3, 0}}), 1, {.duplicates_dropped = 1}},
      {"all triangles in both orientations",
       joined({unit_box(), turned(unit_box())}),
       1,
       {.vertices_welded = 8, .duplicates_dropped = 12}},
      {"all triangles twice",
       joined({unit_box(), unit_box()}),
       1,
       {.unused_vertices_dropped = 8, .duplicates_dropped = 12}},
      {"a vertex near an edge", box_with_t_junction(1e-5), 1, {.cracks_closed = 1, .cracks_triangles = 1}},
      {"a triangle off a bag",
       without(soup(ball), 3),
       ball_volume,
       {.vertices_welded = 3 * 319 - 162, .unused_vertices_dropped = 3, .holes_filled = 1, .triangles_added = 1}},
      {"holes that touch at a vertex",
       without_opposite_triangles(),
       ball_volume,
       {.holes_filled = 2, .triangles_added = 2}},
      {"a repeated corner", with(unit_box(), {{3, 3, 5}}), 1, {.degenerate_dropped = 1}},
      {"a triangle without area", box_with_flat_triangle(), 1, {.degenerate_dropped = 1, .neighbors_split = 1}},
      {"a vertex on an edge",
       box_with_t_junction(),
       1,
       {.degenerate_dropped = 1, .neighbors_split = 1, .cracks_closed = 1, .cracks_triangles = 1}},
      {"a hole", without(ball, 17), ball_volume, {.holes_filled = 1, .triangles_added = 1}},
      {"unused vertices", unused, 1, {.unused_vertices_dropped = 1}},
  };
}

// Whose parts meet, or lie in each other, as they should not.
std::vector<BrokenMesh> broken_parts() {
  const TriangleMesh inner = box(Point(0.2, 0.2, 0.2), Point(0.7, 0.7, 0.7));
  const TriangleMesh innermost = box(Point(0.3, 0.3, 0.3), Point(0.5, 0.5, 0.5));
  return {
      {"boxes that touch at a vertex",
       welded(joined({unit_box(), box(Point(1, 1, 1), Point(2, 2, 2))})),
       2,
       {.vertices_split = 1}},
      {"boxes that touch along an edge",
       welded(joined({unit_box(), box(Point(1, 1, 0), Point(2, 2, 1))})),
       2,
       {.edges_cut = 1, .vertices_split = 2}},
      {"boxes that share a side",
       welded(joined({unit_box(), box(Point(1, 0, 0), Point(2, 1, 1))})),
       2,
       {.edges_cut = 5, .vertices_split = 4}},
      {"a part inside out beside another",
       joined({unit_box(), turned(box(Point(3, 0, 0), Point(4, 1, 1)))}),
       2,
       {.parts_turned_outward = 1}},
      {"a part inside another one", joined({inner, unit_box()}), 1 - 0.125, {.cavities_turned_inward = 1}},
      {"a hollow box inside out",
       joined({inner, turned(unit_box())}),
       1 - 0.125,
       {.parts_turned_outward = 1, .cavities_turned_inward = 1}},
      {"a box in the cavity of a box, all inside out",
       joined({turned(innermost), inner, turned(unit_box())}),
       1 - 0.125 + 0.008,
       {.parts_turned_outward = 2, .cavities_turned_inward = 1}},
      {"parts that poke out of each other",
       joined({unit_box(), turned(box(Point(0.5, 0.5, 0.5), Point(1.5, 1.5, 1.5)))}),
       2,
       {.parts_turned_outward = 1}},
  };
}

}  // namespace

std::vector<BrokenMesh> repairable() {
  std::vector<BrokenMesh> meshes = broken_triangles();
  for (BrokenMesh& mesh : broken_parts()) meshes.push_back(std::move(mesh));
  return meshes;
}

}  // namespace orchard::test
