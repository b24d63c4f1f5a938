#pragma once
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLWriter.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <span>
#include <string>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh.h"
#include "orchard/viz/vtk_writer.h"

// Functions that all writers share: they copy values into VTK's containers, and write these to files.
namespace orchard::detail {

// Files have angles in degrees, the library has them in radians.
inline double in_degrees(double radians) { return radians * (180 / std::numbers::pi); }

// The value for "not defined" in arrays of numbers. Colour scales leave it out, while -1 or infinity would change their
// range.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
inline double finite_or_no_value(double value) { return std::isfinite(value) ? value : kNoValue; }

inline int as_int(Index index) { return index == kNone ? -1 : static_cast<int>(index); }

// Makes an array of that name with value(i) for i in [0, count).
template <typename Array, typename Value>
vtkSmartPointer<Array> make_array(const char* name, std::size_t count, const Value& value) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) array->SetValue(static_cast<vtkIdType>(i), value(i));
  return array;
}

template <typename Value>
void add_ints(vtkFieldData* data, const char* name, std::size_t count, const Value& value) {
  data->AddArray(make_array<vtkIntArray>(name, count, value));
}

template <typename Value>
void add_doubles(vtkFieldData* data, const char* name, std::size_t count, const Value& value) {
  data->AddArray(make_array<vtkDoubleArray>(name, count, value));
}

template <typename Position>
void set_points(vtkPointSet* data, std::size_t count, const Position& position) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) points->SetPoint(static_cast<vtkIdType>(i), position(i).data());
  data->SetPoints(points);
}

inline void add_cell(vtkCellArray* cells, std::span<const Index> corners) {
  cells->InsertNextCell(static_cast<int>(corners.size()));
  for (const Index corner : corners) cells->InsertCellPoint(static_cast<vtkIdType>(corner));
}

inline void set_mesh(vtkPolyData* data, const TriangleMesh& mesh) {
  set_points(data, mesh.vertices.size(), [&](std::size_t i) { return mesh.vertices[i]; });
  vtkNew<vtkCellArray> triangles;
  for (const auto& triangle : mesh.triangles) add_cell(triangles, triangle);
  data->SetPolys(triangles);
}

// Adds the first `count` values of each array.
inline void add_all(vtkFieldData* data, const ViewArrays& arrays, std::size_t count) {
  for (const ViewArray& array : arrays) {
    const char* const name = array.name.c_str();
    if (array.counts) {
      add_ints(data, name, count, [&](std::size_t i) { return static_cast<int>(array.values.at(i)); });
    } else {
      add_doubles(data, name, count, [&](std::size_t i) { return array.values.at(i); });
    }
  }
}

// Adds a vertex cell for each point, so that points are drawn without a filter.
inline void set_vertex_cells(vtkPolyData* data) {
  vtkNew<vtkCellArray> cells;
  for (Index i = 0; i < data->GetNumberOfPoints(); ++i) add_cell(cells, {&i, 1});
  data->SetVerts(cells);
}

// Stores data compressed, as text (base64) within each array's element. VTK's default, data after all elements, is a
// quarter smaller. But VTK and ParaView up to 5.12 cannot read it if Expat is 2.6 or newer, or has its security fixes,
// as in Debian 12 and Ubuntu 24.04, because they then learn too late where that data begins.
inline void set_encoding(vtkXMLWriter* writer) {
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->SetByteOrderToLittleEndian();
}

// `Writer` is vtkXMLPolyDataWriter, or the writer of another kind of data.
template <typename Writer, typename Data>
void write_with(const std::filesystem::path& file, Data* data) {
  vtkNew<Writer> writer;
  writer->SetInputData(data);
  set_encoding(writer);
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1) throw Error(file.string() + ": VTK cannot encode the data; the memory may be full");
  write_file(file, writer->GetOutputString());
}

inline void write(const std::filesystem::path& vtp, vtkPolyData* data) { write_with<vtkXMLPolyDataWriter>(vtp, data); }

}  // namespace orchard::detail
