#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "actors.h"

class vtkDataObject;
class vtkUnstructuredGrid;

namespace orchard::detail {

// The blocks of a .vtm with their names, in the order of the file. Empty ones are left out. Throws std::runtime_error
// if the file does not exist.
class Blocks {
 public:
  explicit Blocks(const std::filesystem::path& vtm);

  Data operator[](const std::string& name) const;  // null if there is no such block, or if it is not PolyData
  const std::vector<std::pair<std::string, vtkSmartPointer<vtkDataObject>>>& all() const { return blocks_; }

 private:
  std::vector<std::pair<std::string, vtkSmartPointer<vtkDataObject>>> blocks_;
};

// Returns the polygons and lines of a grid, with the arrays of its points and cells. Other cells are left out.
Data as_poly_data(vtkUnstructuredGrid* grid);

}  // namespace orchard::detail
