#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// A PLY file as it is: a table for each element. For files that hold more than a mesh; read_mesh() reads meshes.
class PlyTables {
 public:
  struct Column {
    std::string name;
    bool list = false;
    std::vector<double> numbers;    // of a row after another
    std::vector<std::size_t> ends;  // of a list: where the numbers of each row end
    std::size_t begin(std::size_t row) const { return row == 0 ? 0 : ends[row - 1]; }
  };
  struct Table {
    std::string name;
    std::vector<Column> columns;
    std::vector<std::size_t> at;  // the byte of each row
    std::size_t rows() const { return at.size(); }
    const Column* find(std::string_view column) const;  // null: there is none
  };

  // Reads ASCII and binary files, little- and big-endian. Memory is bounded by the size of the file: 16 bytes for each
  // number. Throws InputError, which names the line or byte.
  explicit PlyTables(const std::filesystem::path& file);
  PlyTables(std::string name, std::string bytes);

  const Table* find(std::string_view element) const;  // null: there is none
  // Throws InputError naming the file and the line or byte of a row.
  [[noreturn]] void fail(const Table& table, std::size_t row, const std::string& fault) const;

 private:
  std::string name_, bytes_;
  bool ascii_ = true;
  std::vector<Table> tables_;
};

}  // namespace orchard
