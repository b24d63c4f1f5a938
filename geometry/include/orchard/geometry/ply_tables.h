#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh.h"

// Reads PLY files as tables, for files that contain more than a mesh. read_mesh() reads meshes.
namespace orchard {

// The contents of a PLY file: one table for each element.
class PlyTables {
 public:
  struct Column {
    std::string name;
    bool list = false;
    std::vector<double> numbers;    // The numbers of all rows, one row after another.
    std::vector<std::size_t> ends;  // For a list, the positions in `numbers` where each row ends.
    std::size_t begin(std::size_t row) const { return row == 0 ? 0 : ends[row - 1]; }
  };
  struct Table {
    std::string name;
    std::vector<Column> columns;
    std::vector<std::size_t> at;  // The byte position of each row in the file.
    std::size_t rows() const { return at.size(); }
    const Column* find(std::string_view column) const;  // Returns null if there is none.
  };

  // Reads an ASCII or binary file, little- or big-endian. Throws InputError, which names the line or byte. The memory
  // is bounded by the size of the file: 16 bytes for each number.
  explicit PlyTables(const std::filesystem::path& file);
  PlyTables(std::string name, std::string bytes);

  const Table* find(std::string_view element) const;  // Returns null if there is none.
  // Throws InputError, which names the file and the line or byte of a row.
  [[noreturn]] void fail(const Table& table, std::size_t row, const std::string& fault) const;

 private:
  std::string name_, bytes_;
  bool ascii_ = true;
  std::vector<Table> tables_;
};

}  // namespace orchard
