#include "orchard/medial/structure.h"

#include <gtest/gtest.h>

#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "support/shapes.h"

namespace orchard {
namespace {

MedialMesh mesh_of(Index vertices, std::vector<std::array<Index, 3>> triangles,
                   std::vector<std::array<Index, 2>> edges = {}) {
  MedialMesh mesh;
  for (Index v = 0; v < vertices; ++v) {
    mesh.centers.emplace_back(v, v * v, v % 3);
    mesh.radii.push_back(1);
  }
  mesh.triangles = std::move(triangles);
  mesh.edges = std::move(edges);
  complete(mesh);
  return mesh;
}

TEST(MedialStructure, OfOneTriangleIsASheetWithOneClosedBorder) {
  const MedialStructure structure = medial_structure(mesh_of(3, {{0, 1, 2}}));
  ASSERT_EQ(structure.parts.size(), 2u);
  EXPECT_EQ(structure.parts[0].kind, StructureKind::sheet);
  EXPECT_EQ(structure.parts[1].kind, StructureKind::border);
  EXPECT_EQ(structure.parts[1].cells, 3u);
  EXPECT_EQ(structure.of_vertex, (std::vector<Index>{1, 1, 1}));
}

TEST(MedialStructure, ThreeSheetsAtAnEdgeMakeASeamThatEndsInJunctions) {
  const MedialStructure structure = medial_structure(mesh_of(5, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}));
  EXPECT_EQ(structure.count(StructureKind::sheet), 3u);
  EXPECT_EQ(structure.count(StructureKind::seam), 1u);
  EXPECT_EQ(structure.count(StructureKind::border), 3u);
  EXPECT_EQ(structure.count(StructureKind::junction), 2u);
  EXPECT_EQ(structure.parts[structure.of_vertex[0]].kind, StructureKind::junction);
  EXPECT_EQ(structure.parts[structure.of_vertex[2]].kind, StructureKind::border);
}

TEST(MedialStructure, ACurveBetweenTwoSheetsEndsWhereTheyBegin) {
  const MedialStructure structure = medial_structure(mesh_of(8, {{0, 1, 2}, {5, 6, 7}}, {{2, 3}, {3, 4}, {4, 5}}));
  EXPECT_EQ(structure.count(StructureKind::sheet), 2u);
  ASSERT_EQ(structure.count(StructureKind::curve), 1u);
  EXPECT_EQ(structure.count(StructureKind::junction), 2u);
  const Index curve = structure.of_vertex[3];
  EXPECT_EQ(structure.parts[curve].kind, StructureKind::curve);
  EXPECT_EQ(structure.parts[curve].cells, 3u);
  EXPECT_EQ(structure.parts[curve].vertices, (std::vector<Index>{2, 3, 4, 5}));
}

TEST(MedialStructure, SheetsThatTouchInOneVertexHaveAJunctionThere) {
  const MedialStructure structure = medial_structure(mesh_of(5, {{0, 1, 2}, {2, 3, 4}}));
  EXPECT_EQ(structure.count(StructureKind::sheet), 2u);
  EXPECT_EQ(structure.parts[structure.of_vertex[2]].kind, StructureKind::junction);
  EXPECT_EQ(structure.count(StructureKind::junction), 1u);
}

TEST(MedialStructure, ALoneBallIsAJunction) {
  const MedialStructure structure = medial_structure(mesh_of(1, {}));
  ASSERT_EQ(structure.parts.size(), 1u);
  EXPECT_EQ(structure.parts[0].kind, StructureKind::junction);
}

TEST(MedialStructure, AClosedRingOfTrianglesIsOneSheetWithoutJunctions) {
  // An octahedron's faces: every edge has two of them.
  const MedialStructure structure = medial_structure(
      mesh_of(6, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 1, 4}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {1, 4, 5}}));
  ASSERT_EQ(structure.parts.size(), 1u);
  EXPECT_EQ(structure.parts[0].cells, 8u);
  EXPECT_EQ(structure.parts[0].vertices.size(), 6u);
}

TEST(MedialStructure, OfARefinedAxisIsThatOfItsMeshNumberForNumber) {
  MedialBuildOptions options;
  options.sampling.face_points = 120;
  options.sampling.edge_points = 30;
  options.refine.emplace();
  const MedialAxis axis = build_medial_axis(Surface(test::l_shape()), options).axis;
  const MedialStructure own = medial_structure(axis), of_mesh = medial_structure(medial_mesh(axis));
  EXPECT_GT(own.count(StructureKind::seam), 0u);
  EXPECT_EQ(own.of_face, of_mesh.of_face);
  EXPECT_EQ(own.of_edge, of_mesh.of_edge);
  EXPECT_EQ(own.of_vertex, of_mesh.of_vertex);
  EXPECT_EQ(to_structure_section(own), to_structure_section(of_mesh));
}

TEST(MedialStructure, ASectionListsNumberKindAndCellsOfEachPart) {
  const MedialStructure structure = medial_structure(mesh_of(4, {{0, 1, 2}}, {{2, 3}}));
  // The sheet, its border, the curve, and two junctions: where the curve begins and where it ends.
  EXPECT_EQ(to_structure_section(structure), "5\n0 0 1 0\n1 2 3 0 1 2\n2 4 1 3\n3 3 1 2\n4 3 1 3\n");
}

}  // namespace
}  // namespace orchard
