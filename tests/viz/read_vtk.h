#pragma once
#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <filesystem>
#include <vector>

namespace orchard::test {

inline vtkSmartPointer<vtkPolyData> read_poly_data(const std::filesystem::path& file) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u) << file;
  return reader->GetOutput();
}

// One component of all values of an array; empty if there is none of that name.
inline std::vector<double> values(vtkFieldData* data, const char* name, int component = 0) {
  std::vector<double> result;
  vtkDataArray* array = data->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  for (vtkIdType i = 0; array != nullptr && i < array->GetNumberOfTuples(); ++i)
    result.push_back(array->GetComponent(i, component));
  return result;
}

}  // namespace orchard::test
