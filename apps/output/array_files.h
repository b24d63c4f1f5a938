#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

// Arrays of numbers for other programs: NumPy's .npz, and .csv.
namespace orchard::apps {

// Rows of equally many numbers. values.size() is a multiple of columns.size().
struct NamedArray {
  std::string name;
  std::vector<std::string> columns;  // their names, in .csv files; one column makes an array of one dimension
  std::variant<std::vector<double>, std::vector<std::uint32_t>, std::vector<std::int32_t>> values;
};

// The bytes of a .npz file: a ZIP archive without compression, with a .npy file (version 1.0, little-endian) for each
// array. NumPy's load() reads it, and so does whatever reads ZIP archives. Throws Error for arrays beyond 4 GiB, where
// the format of ZIP ends.
std::string to_npz(std::span<const NamedArray> arrays);

// The text of a .csv file: the names of all columns, then a line a row, arrays side by side. Numbers are the shortest
// that read back the same. Precondition: all arrays have as many rows.
std::string to_csv(std::span<const NamedArray> arrays);

}  // namespace orchard::apps
