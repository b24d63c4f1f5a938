#include "orchard/viz/arrays_writer.h"

#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include "vtk_data.h"

namespace orchard {

void write_mesh_with_arrays(const std::filesystem::path& vtp, const TriangleMesh& mesh, const ViewArrays& of_points,
                            const ViewArrays& of_cells, const std::string& unit) {
  vtkNew<vtkPolyData> data;
  detail::set_mesh(data, mesh);
  detail::add_all(data->GetPointData(), of_points, mesh.vertices.size());
  detail::add_all(data->GetCellData(), of_cells, mesh.triangles.size());
  if (!unit.empty()) {
    vtkNew<vtkStringArray> name;
    name->SetName("unit");
    name->InsertNextValue(unit);
    data->GetFieldData()->AddArray(name);
  }
  detail::write(vtp, data);
}

}  // namespace orchard
