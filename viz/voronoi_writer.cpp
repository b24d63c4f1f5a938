#include "orchard/viz/voronoi_writer.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/voronoi/cell_polyhedron.h"
#include "orchard/voronoi/quality.h"
#include "vtk_data.h"

namespace orchard {
namespace {

Box default_box(const VoronoiDiagram& diagram) {
  Box box;
  for (const Point& p : diagram.points) box.extend(p);
  if (box.isEmpty()) return box;
  const Vector margin = Vector::Constant(0.05 * box.sizes().maxCoeff());
  return {box.min() - margin, box.max() + margin};
}

std::vector<Index> all_points(const VoronoiDiagram& diagram) {
  std::vector<Index> points(diagram.points.size());
  std::iota(points.begin(), points.end(), Index{0});
  return points;
}

// Collects polyhedra and their arrays.
class CellGrid {
 public:
  CellGrid() {
    points_->SetDataTypeToDouble();
    name(point_, "point");
    name(inaccuracy_, "inaccuracy");
    name(faces_, "faces");
    name(at_box_, "at_box");
  }

  void add(const CellPolyhedron& cell, Index point, double inaccuracy) {
    const vtkIdType first = points_->GetNumberOfPoints();
    for (const Point& corner : cell.corners) points_->InsertNextPoint(corner.data());
    // The number of faces, then for each face the number of its corners followed by the corners.
    vtkNew<vtkIdList> stream;
    stream->InsertNextId(cell.faces.size());
    for (Index face = 0; face < cell.faces.size(); ++face) {
      stream->InsertNextId(static_cast<vtkIdType>(cell.faces[face].size()));
      for (const Index corner : cell.faces[face]) stream->InsertNextId(first + corner);
    }
    grid_->InsertNextCell(VTK_POLYHEDRON, stream);
    point_->InsertNextValue(static_cast<int>(point));
    inaccuracy_->InsertNextValue(inaccuracy);
    faces_->InsertNextValue(static_cast<int>(cell.faces.size()));
    at_box_->InsertNextValue(std::count(cell.neighbors.begin(), cell.neighbors.end(), kNone) > 0);
  }

  Index size() const { return static_cast<Index>(point_->GetNumberOfTuples()); }

  std::string xml() {
    grid_->SetPoints(points_);
    grid_->GetCellData()->SetScalars(inaccuracy_);
    for (vtkIntArray* array : {point_.Get(), faces_.Get(), at_box_.Get()}) grid_->GetCellData()->AddArray(array);
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid_);
    detail::set_encoding(writer);
    writer->WriteToOutputStringOn();
    return writer->Write() == 1 ? writer->GetOutputString() : std::string();
  }

 private:
  template <class Array>
  static void name(vtkNew<Array>& array, const char* name) {
    array->SetName(name);
  }

  vtkNew<vtkUnstructuredGrid> grid_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkIntArray> point_, faces_, at_box_;
  vtkNew<vtkDoubleArray> inaccuracy_;
};

}  // namespace

Index write_voronoi_cells(const std::filesystem::path& vtu, const VoronoiDiagram& diagram,
                          const VoronoiCellsView& view) {
  const Box box = view.box.value_or(default_box(diagram));
  const std::vector<Index> all = view.points ? std::vector<Index>() : all_points(diagram);
  const std::span<const Index> points = view.points.value_or(all);
  for (const Index point : points)
    if (point >= diagram.points.size())
      throw InputError("there is no point " + std::to_string(point) + " whose cell could be shown: the diagram has " +
                       std::to_string(diagram.points.size()) + " points, counted from 0");
  const VoronoiCells cells(diagram);
  const std::vector<double> inaccuracy = cell_inaccuracies(diagram);
  CellGrid grid;
  for (const Index point : points) {
    const CellPolyhedron cell = clipped_cell(diagram, cells, point, box);
    if (!cell.corners.empty()) grid.add(cell, point, inaccuracy[point]);
  }
  const std::string xml = grid.xml();
  if (xml.empty()) throw Error(vtu.string() + ": VTK cannot encode the data; the memory may be full");
  write_file(vtu, xml);
  return grid.size();
}

}  // namespace orchard
