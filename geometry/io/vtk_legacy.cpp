#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh_formats.h"
#include "mixed_scanner.h"
#include "vtk_cells.h"

namespace orchard {
namespace {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

// The width of a number in the file, by the name of its type.
struct LegacyNumber {
  std::string_view name;
  std::size_t bytes;
  double (*real)(MixedScanner&);
  std::int64_t (*integer)(MixedScanner&);
};
template <typename T>
constexpr LegacyNumber legacy_number(std::string_view name) {
  return {name, sizeof(T), [](MixedScanner& in) { return static_cast<double>(in.raw<T>()); },
          [](MixedScanner& in) { return static_cast<std::int64_t>(in.raw<T>()); }};
}
const std::array kLegacyNumbers{legacy_number<std::uint8_t>("unsigned_char"),
                                legacy_number<std::int8_t>("char"),
                                legacy_number<std::int8_t>("signed_char"),
                                legacy_number<std::uint16_t>("unsigned_short"),
                                legacy_number<std::int16_t>("short"),
                                legacy_number<std::uint32_t>("unsigned_int"),
                                legacy_number<std::int32_t>("int"),
                                legacy_number<std::uint64_t>("unsigned_long"),
                                legacy_number<std::int64_t>("long"),
                                legacy_number<std::int64_t>("vtktypeint64"),
                                legacy_number<std::uint64_t>("vtktypeuint64"),
                                legacy_number<std::int64_t>("vtkidtype"),
                                legacy_number<float>("float"),
                                legacy_number<double>("double")};

class LegacyVtkReader {
 public:
  LegacyVtkReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name), in_(bytes, name) {}

  TriangleMesh read(MeshReadReport& report) {
    read_head();
    while (in_.more() && read_section()) {
    }
    if (!types_.empty() || grid_) add_cells();
    return std::move(mesh_).finish(
        name_, [&](std::size_t at) { in_.fail(at, "the point needs three finite numbers, since a cell uses it"); },
        [&](std::size_t at) { return in_.place(at); }, report);
  }

 private:
  void read_head() {
    if (!bytes_.starts_with("# vtk DataFile Version "))
      in_.fail(0, "a legacy VTK file begins with \"# vtk DataFile Version\"");
    const std::string version(in_.line().substr(23));
    five_ = version.starts_with("5");
    in_.line();
    const std::size_t at = in_.position();
    const std::string encoding = lower_case(in_.word());
    if (encoding != "ascii" && encoding != "binary")
      in_.fail(at, in_quotes(encoding) + " stands in place of ASCII or BINARY");
    const std::size_t dataset = in_.position();
    if (lower_case(in_.word()) != "dataset") in_.fail(dataset, "the line DATASET is missing");
    const std::string kind = lower_case(in_.word());
    grid_ = kind == "unstructured_grid";
    if (!grid_ && kind != "polydata")
      in_.fail(dataset, "the dataset is of the kind " + in_quotes(kind) +
                            ", but only POLYDATA and UNSTRUCTURED_GRID can be read; save its surface as .vtp or .stl");
    in_.line();
    if (encoding == "binary") in_.set_binary(std::endian::big);
  }

  // Returns false at the end of the geometry.
  bool read_section() {
    const std::size_t at = in_.position();
    const std::string keyword = lower_case(in_.word());
    if (keyword == "point_data" || keyword == "cell_data") return false;
    if (keyword == "points") return read_points(), true;
    if (keyword == "polygons") return read_polygons(CellShape::polygon, at), true;
    if (keyword == "triangle_strips") return read_polygons(CellShape::strip, at), true;
    if (keyword == "vertices" || keyword == "lines") return read_polygons(CellShape::ignored, at), true;
    if (keyword == "cells") return read_cells(at), true;
    if (keyword == "cell_types") return read_types(), true;
    if (keyword == "field") return skip_field(), true;
    if (keyword == "metadata") return skip_metadata(), true;
    in_.fail(at, in_quotes(keyword) + " stands where a section such as POINTS has to begin");
  }

  const LegacyNumber& type_named(std::string_view name, std::size_t at) const {
    const std::string lower = lower_case(name);
    const auto found = std::ranges::find(kLegacyNumbers, lower, &LegacyNumber::name);
    if (found == kLegacyNumbers.end()) in_.fail(at, in_quotes(name) + " is no type of numbers that can be read");
    return *found;
  }
  std::size_t bytes_each(std::size_t binary) const { return in_.binary() ? binary : 2; }
  double real(const LegacyNumber& type) { return in_.binary() ? type.real(in_) : in_.number(); }
  std::int64_t integer(const LegacyNumber& type) { return in_.binary() ? type.integer(in_) : in_.integer(); }

  void read_points() {
    const std::int64_t promised = in_.integer();
    const std::size_t at = in_.position();
    const LegacyNumber& type = type_named(in_.word(), at);
    in_.line();
    const std::uint64_t count = in_.checked_count(promised, bytes_each(type.bytes) * 3, "points");
    if (!mesh_.vertices.empty() || count >= kNone)
      in_.fail(at, "the points are defined twice, or are too many for 32-bit indices");
    for (std::uint64_t i = 0; i < count; ++i) {
      in_.more_of_text();
      const std::size_t place = in_.position();
      Point point;
      for (double& coordinate : point) coordinate = real(type);
      if (!point.allFinite()) mesh_.vertex_faults.add(static_cast<Index>(i), place);
      mesh_.vertices.push_back(point);
    }
  }

  VtkCells empty_cells(std::size_t at) const {
    VtkCells cells;
    cells.points = static_cast<Index>(mesh_.vertices.size());
    cells.at = at;
    cells.fail = [this](std::size_t where, const std::string& fault) { in_.fail(where, fault); };
    return cells;
  }

  std::vector<std::int64_t> integers(std::int64_t promised, const LegacyNumber& type) {
    std::vector<std::int64_t> numbers(in_.checked_count(promised, bytes_each(type.bytes), "numbers"));
    for (std::int64_t& number : numbers) number = integer(type);
    return numbers;
  }
  // Reads "OFFSETS vtktypeint64" and the numbers, in the form of version 5.
  std::vector<std::int64_t> named_integers(const char* name, std::int64_t promised) {
    in_.more();
    const std::size_t at = in_.position();
    if (lower_case(in_.word()) != name) in_.fail(at, "no " + std::string(name));
    const LegacyNumber& type = type_named(in_.word(), at);
    in_.line();
    return integers(promised, type);
  }

  // Reads cells in the form of version 5, or each as its number of points followed by the points.
  VtkCells read_cell_arrays(std::size_t at) {
    const std::int64_t first = in_.integer(), second = in_.integer();
    in_.line();
    VtkCells cells = empty_cells(at);
    if (five_) {
      cells.offsets = named_integers("offsets", first);
      if (cells.offsets.empty()) cells.offsets = {0};
      cells.connectivity = named_integers("connectivity", second);
      return cells;
    }
    const std::vector<std::int64_t> numbers = integers(second, type_named("int", at));
    if (first < 0 || static_cast<std::uint64_t>(first) > numbers.size())
      in_.fail(at, std::to_string(first) + " cells of " + std::to_string(numbers.size()) + " numbers in all");
    std::size_t next = 0;
    for (std::int64_t i = 0; i < first; ++i) {
      if (next >= numbers.size() || numbers[next] < 0 ||
          static_cast<std::uint64_t>(numbers[next]) > numbers.size() - next - 1)
        in_.fail(at, "the numbers of these cells end within cell " + std::to_string(i));
      const auto count = static_cast<std::size_t>(numbers[next]);
      const auto start = numbers.begin() + static_cast<std::ptrdiff_t>(next + 1);
      cells.connectivity.insert(cells.connectivity.end(), start, start + static_cast<std::ptrdiff_t>(count));
      cells.offsets.push_back(static_cast<std::int64_t>(cells.connectivity.size()));
      next += count + 1;
    }
    return cells;
  }

  void read_polygons(CellShape shape, std::size_t at) { add_vtk_polygons(read_cell_arrays(at), shape, mesh_); }
  void read_cells(std::size_t at) { cells_ = read_cell_arrays(at); }
  void read_types() {
    const std::int64_t promised = in_.integer();
    in_.line();
    types_ = integers(promised, type_named("int", in_.position()));
  }

  // Polyhedra have the numbers of their faces where other cells have their points.
  void add_cells() {
    if (!cells_) in_.fail(bytes_.size(), "the section CELLS is missing");
    cells_->check();
    if (types_.size() != cells_->size())
      in_.fail(cells_->at,
               std::to_string(cells_->size()) + " cells have " + std::to_string(types_.size()) + " CELL_TYPES");
    std::vector<Index> corners;
    for (std::size_t cell = 0; cell < cells_->size(); ++cell) {
      const auto from = static_cast<std::size_t>(cells_->offsets[cell]),
                 to = static_cast<std::size_t>(cells_->offsets[cell + 1]);
      if (types_[cell] == kVtkPolyhedron) {
        add_vtk_polyhedron(*cells_, cell, std::span(cells_->connectivity).subspan(from, to - from), mesh_);
        continue;
      }
      const CellKind* kind = vtk_cell_kind(types_[cell]);
      if (kind == nullptr)
        in_.fail(cells_->at,
                 "cells of type " + std::to_string(types_[cell]) + " of VTK cannot be read; save the surface as .vtp");
      cells_->corners_of(cell, corners);
      mesh_.add(*kind, corners, cells_->at);
    }
  }

  // Skips "FIELD name arrays", and then "name components tuples type" with the numbers of each array.
  void skip_field() {
    in_.word();
    const std::uint64_t arrays = in_.checked_count(in_.integer(), 8, "arrays");
    for (std::uint64_t i = 0; i < arrays; ++i) {
      in_.word();
      if (lower_case(in_.peek()) == "metadata") in_.word(), skip_metadata(), in_.word();
      const std::size_t at = in_.position();
      const std::int64_t components = in_.integer(), tuples = in_.integer();
      const std::string_view name = in_.word();
      in_.line();
      if (lower_case(name) == "string" && !in_.binary()) {
        for (std::uint64_t k = in_.checked_count(tuples, 1, "strings"); k > 0; --k) in_.line();
        continue;
      }
      const LegacyNumber& type = type_named(name, at);
      const std::uint64_t rows = in_.checked_count(tuples, 1, "rows"),
                          columns = in_.checked_count(components, 1, "columns");
      for (std::uint64_t row = 0; row < rows; ++row)
        for (std::uint64_t column = 0; column < columns; ++column) real(type);
    }
  }
  // Skips everything up to the next empty line.
  void skip_metadata() {
    in_.line();
    while (in_.remaining() > 0 && !in_.line().empty()) {
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  MixedScanner in_;
  bool five_ = false, grid_ = false;
  CellMesh mesh_;
  std::optional<VtkCells> cells_;
  std::vector<std::int64_t> types_;
};

}  // namespace

TriangleMesh read_legacy_vtk(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return LegacyVtkReader(bytes, name).read(report);
}

}  // namespace orchard
