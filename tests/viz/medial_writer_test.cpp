#include "orchard/viz/medial_writer.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>

#include "orchard/medial/build.h"
#include "orchard/viz/vtk_writer.h"
#include "read_vtk.h"
#include "support/shapes.h"
#include "values.h"

namespace orchard {
namespace {

using test::TestFolder;
using test::values;

// A triangle, a topology face beside it, and a tail.
MedialAxis small_complex() {
  MedialAxis axis;
  axis.points = {{0.3, 0.3, 1}, {0.3, 0.3, -1}, {0.6, 0.6, 1}, {0.6, 0.6, -1}};
  axis.origins = {PointOrigin::face, PointOrigin::face, PointOrigin::edge, PointOrigin::repair};
  axis.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 2, 0}};
  axis.radii = {1, 2, 3, 4, 5};
  for (const auto& row : std::vector<std::vector<Index>>{{1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 4}, {3}}) {
    axis.neighbors.items.insert(axis.neighbors.items.end(), row.begin(), row.end());
    axis.neighbors.close_row();
  }
  for (const auto& row : std::vector<std::vector<Index>>{{0, 1}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2, 3}, {2, 3}}) {
    axis.forming_points.items.insert(axis.forming_points.items.end(), row.begin(), row.end());
    axis.forming_points.close_row();
  }
  axis.faces.items = {0, 1, 2};
  axis.faces.close_row();
  axis.face_points = {{0, 1}};
  axis.topology_faces.items = {1, 3, 2};
  axis.topology_faces.close_row();
  axis.topology_face_points = {{2, 3}};
  return axis;
}

TEST(MedialGrid, HoldsEveryCellWithItsArrays) {
  const TestFolder folder;
  const MedialAxis axis = small_complex();
  const auto file = folder.path() / "medial.vtu";
  write_medial_grid(file, axis, medial_segments(axis, {.touching = 0.1}));
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  EXPECT_EQ(grid->GetNumberOfPoints(), 5);
  ASSERT_EQ(grid->GetNumberOfCells(), 3);
  vtkCellData* cells = grid->GetCellData();
  EXPECT_EQ(values(cells, "topology_face"), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(values(cells, "has_faces"), (std::vector<double>{1, 1, 0}));
  EXPECT_EQ(values(cells, "point_b"), (std::vector<double>{1, 3, -1}));
  EXPECT_EQ(values(cells, "added"), (std::vector<double>{0, 1, 0}));
  EXPECT_NEAR(values(cells, "contact_angle")[0], 178, 6);
  EXPECT_TRUE(std::isnan(values(cells, "contact_angle")[2])) << "lines have none";
  EXPECT_EQ(values(cells, "trunk").size(), 3u);
  EXPECT_EQ(values(cells, "structure_kind"), (std::vector<double>{0, 0, 4})) << "one sheet and a curve";
  EXPECT_EQ(values(cells, "structure")[0], values(cells, "structure")[1]);
  vtkPointData* points = grid->GetPointData();
  EXPECT_EQ(values(points, "radius"), axis.radii);
  EXPECT_EQ(values(points, "added"), (std::vector<double>{0, 0, 0, 1, 1}));
  EXPECT_EQ(values(points, "forming_count"), (std::vector<double>{2, 3, 3, 4, 2}));
  EXPECT_EQ(values(points, "forming_points", 2), (std::vector<double>{-1, 2, 2, 2, -1}));
  EXPECT_EQ(values(points, "component"), (std::vector<double>{0, 0, 0, 0, 0}));
  EXPECT_EQ(values(points, "segment").size(), 5u);
  EXPECT_EQ(values(points, "structure_kind").back(), 3) << "where the curve ends";
}

// Of an axis whose faces have contacts and normals, which the angle must take into account.
TEST(MedialGrid, AndTheFilesByPartsGiveAFaceTheSameAngle) {
  const TestFolder folder;
  for (const TriangleMesh& mesh : {test::l_shape(), test::torus(16, 10), test::u_shape(0.1)}) {
    MedialBuildOptions options;
    options.sampling.face_points = 400;
    options.sampling.edge_points = 100;
    const MedialAxis axis = build_medial_axis(Surface(mesh), options).axis;
    ASSERT_FALSE(axis.angles.empty());
    write_medial_grid(folder.path() / "axis.vtu", axis, medial_segments(axis, {.touching = 0.1}));
    write_medial_axis(folder.path() / "axis", axis);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((folder.path() / "axis.vtu").c_str());
    reader->Update();
    std::vector<double> in_grid = values(reader->GetOutput()->GetCellData(), "contact_angle");
    ASSERT_GE(in_grid.size(), axis.faces.size());
    in_grid.resize(axis.faces.size());  // topology faces and lines follow
    EXPECT_EQ(values(test::read_poly_data(folder.path() / "axis-faces.vtp")->GetCellData(), "contact_angle"), in_grid);
  }
}

TEST(Thickness, IsTwiceTheMedialRadius) {
  const TestFolder folder;
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  write_thickness(folder.path() / "thickness.vtp", surface, {1, 2, 3, 4, 5, 6, 7, 8});
  const auto data = test::read_poly_data(folder.path() / "thickness.vtp");
  EXPECT_EQ(data->GetNumberOfPolys(), 12);
  EXPECT_EQ(values(data->GetPointData(), "thickness"), (std::vector<double>{2, 4, 6, 8, 10, 12, 14, 16}));
}

TEST(StructureGraphFile, HasALineForEachArc) {
  const TestFolder folder;
  const MedialAxis axis = small_complex();
  const StructureGraph graph = structure_graph(axis);
  write_structure_graph(folder.path() / "structure.vtp", axis, graph);
  const auto data = test::read_poly_data(folder.path() / "structure.vtp");
  EXPECT_EQ(static_cast<std::size_t>(data->GetNumberOfLines()), graph.arcs.size());
  EXPECT_EQ(values(data->GetCellData(), "kind").size(), graph.arcs.size());
  EXPECT_EQ(values(data->GetPointData(), "radius").size(), static_cast<std::size_t>(data->GetNumberOfPoints()));
}

}  // namespace
}  // namespace orchard
