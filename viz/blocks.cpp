#include "blocks.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSet.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLMultiBlockDataReader.h>

#include <algorithm>
#include <stdexcept>

namespace orchard::detail {

Blocks::Blocks(const std::filesystem::path& vtm) {
  if (!std::filesystem::exists(vtm)) throw std::runtime_error("there is no file " + vtm.string());
  vtkNew<vtkXMLMultiBlockDataReader> reader;
  reader->SetFileName(vtm.c_str());
  reader->Update();
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  for (unsigned i = 0; blocks != nullptr && i < blocks->GetNumberOfBlocks(); ++i) {
    auto* data = vtkDataSet::SafeDownCast(blocks->GetBlock(i));
    const char* name = blocks->HasMetaData(i) != 0 ? blocks->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()) : nullptr;
    if (data != nullptr && name != nullptr && data->GetNumberOfPoints() > 0) blocks_.emplace_back(name, data);
  }
}

Data Blocks::operator[](const std::string& name) const {
  const auto block = std::find_if(blocks_.begin(), blocks_.end(), [&](const auto& own) { return own.first == name; });
  return block == blocks_.end() ? nullptr : vtkPolyData::SafeDownCast(block->second);
}

Data as_poly_data(vtkUnstructuredGrid* grid) {
  auto result = Data::New();
  result->SetPoints(grid->GetPoints());
  result->GetPointData()->ShallowCopy(grid->GetPointData());
  vtkNew<vtkCellArray> lines, polygons;
  vtkNew<vtkIdList> corners;
  std::vector<vtkIdType> order;  // in PolyData, lines come before other cells
  const auto add = [&](bool line, vtkCellArray* cells) {
    for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) {
      const int type = grid->GetCellType(i);
      const bool is_line = type == VTK_LINE || type == VTK_POLY_LINE;
      const bool is_polygon = type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON;
      if (!(line ? is_line : is_polygon)) continue;
      grid->GetCellPoints(i, corners);
      cells->InsertNextCell(corners);
      order.push_back(i);
    }
  };
  add(true, lines);
  add(false, polygons);
  result->SetLines(lines);
  result->SetPolys(polygons);
  vtkCellData* from = grid->GetCellData();
  result->GetCellData()->CopyAllocate(from, static_cast<vtkIdType>(order.size()));
  for (std::size_t i = 0; i < order.size(); ++i)
    result->GetCellData()->CopyData(from, order[i], static_cast<vtkIdType>(i));
  return result;
}

}  // namespace orchard::detail
