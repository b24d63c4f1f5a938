#include "orchard/viz/voronoi_writer.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "orchard/geometry/error.h"
#include "orchard/voronoi/cell_polyhedron.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/inagaki.h"
#include "orchard/voronoi/quality.h"
#include "values.h"

namespace orchard {
namespace {

using test::TestFolder;

std::vector<Point> lattice() {
  std::vector<Point> points;
  for (int i = 0; i < 64; ++i) points.emplace_back(i % 4, i / 4 % 4, i / 16);
  return points;
}

std::vector<Point> random_points() {
  std::vector<Point> points;
  Random random(1, 1);
  for (int i = 0; i < 60; ++i) points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  return points;
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u) << file;
  return reader->GetOutput();
}

// The polyhedron that VTK has read, its corners numbered over all faces.
CellPolyhedron polyhedron(vtkCell* cell) {
  CellPolyhedron result;
  for (int f = 0; f < cell->GetNumberOfFaces(); ++f) {
    vtkCell* face = cell->GetFace(f);
    for (vtkIdType i = 0; i < face->GetNumberOfPoints(); ++i) {
      result.faces.items.push_back(static_cast<Index>(result.corners.size()));
      face->GetPoints()->GetPoint(i, result.corners.emplace_back().data());
    }
    result.faces.close_row();
  }
  return result;
}

double value(vtkUnstructuredGrid* grid, const char* array, vtkIdType cell) {
  return grid->GetCellData()->GetArray(array)->GetComponent(cell, 0);
}

TEST(WriteVoronoiCells, IsReadBackAsTheSamePolyhedra) {
  const TestFolder folder;
  const VoronoiDiagram diagram = highest_first_voronoi(random_points()).diagram;
  const VoronoiCells cells(diagram);
  const Box box(Point(-0.5, -0.5, -0.5), Point(1.5, 1.5, 1.5));
  EXPECT_EQ(write_voronoi_cells(folder / "cells.vtu", diagram, {.box = box, .points = {}}), 60u);
  const auto grid = read_grid(folder / "cells.vtu");
  ASSERT_EQ(grid->GetNumberOfCells(), 60);
  double sum = 0;
  for (vtkIdType c = 0; c < 60; ++c) {
    ASSERT_EQ(grid->GetCellType(c), VTK_POLYHEDRON);
    const auto point = static_cast<Index>(value(grid, "point", c));
    const CellPolyhedron expected = clipped_cell(diagram, cells, point, box), found = polyhedron(grid->GetCell(c));
    EXPECT_EQ(found.faces.size(), expected.faces.size());
    EXPECT_EQ(value(grid, "faces", c), expected.faces.size());
    EXPECT_NEAR(volume(found), volume(expected), 1e-12);
    sum += volume(found);
  }
  EXPECT_NEAR(sum, box.volume(), 1e-9);
}

TEST(WriteVoronoiCells, TakesTheInaccuracyOfEachCell) {
  const TestFolder folder;
  const VoronoiDiagram diagram = inagaki_voronoi(lattice()).diagram;
  const std::vector<double> expected = cell_inaccuracies(diagram);
  write_voronoi_cells(folder / "cells.vtu", diagram);
  const auto grid = read_grid(folder / "cells.vtu");
  double max = 0;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    EXPECT_EQ(value(grid, "inaccuracy", c), expected[static_cast<std::size_t>(value(grid, "point", c))]);
    max = std::max(max, value(grid, "inaccuracy", c));
  }
  EXPECT_GT(max, 0);
}

TEST(WriteVoronoiCells, ShowsTheCellsThatAreAskedForAndClipsThem) {
  const TestFolder folder;
  const VoronoiDiagram diagram = highest_first_voronoi(lattice()).diagram;
  const std::vector<Index> chosen{21, 3, 42};
  const Box box(Point(-0.5, -0.5, -0.5), Point(3.5, 1.5, 1.5));
  EXPECT_EQ(write_voronoi_cells(folder / "some.vtu", diagram, {.box = box, .points = chosen}), 2u) << "42 is outside";
  const auto grid = read_grid(folder / "some.vtu");
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  EXPECT_EQ(value(grid, "point", 0), 21);
  EXPECT_EQ(value(grid, "at_box", 0), 1);
  EXPECT_EQ(value(grid, "point", 1), 3);
  EXPECT_NEAR(volume(polyhedron(grid->GetCell(0))), 1, 1e-12);
  const std::vector<Index> none{64};
  EXPECT_THROW(write_voronoi_cells(folder / "none.vtu", diagram, {.box = {}, .points = none}), InputError);
}

TEST(WriteVoronoiCells, WritesTheSameBytesForTheSameDiagramAndAnEmptyFileForFlatPoints) {
  const TestFolder folder;
  const VoronoiDiagram diagram = highest_first_voronoi(random_points()).diagram;
  const auto bytes = [&](const char* name) {
    write_voronoi_cells(folder / name, diagram);
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.vtu"), bytes("b.vtu"));
  EXPECT_EQ(write_voronoi_cells(folder / "flat.vtu", highest_first_voronoi(std::vector<Point>{{0, 0, 0}}).diagram), 0u);
  EXPECT_EQ(read_grid(folder / "flat.vtu")->GetNumberOfCells(), 0);
}

}  // namespace
}  // namespace orchard
