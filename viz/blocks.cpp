#include "blocks.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
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

}  // namespace orchard::detail
