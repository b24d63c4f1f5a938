#include <algorithm>
#include <cmath>

#include "axis_text.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/ply_tables.h"

namespace orchard::detail {
namespace {

using Table = PlyTables::Table;
using Column = PlyTables::Column;

class PlyAxisReader {
 public:
  PlyAxisReader(const PlyTables& tables, const std::string& name) : tables_(tables), name_(name) {}

  ForeignAxis run() {
    const Table* vertices = tables_.find("vertex");
    if (vertices == nullptr || vertices->rows() == 0) throw InputError(name_ + ": the PLY file has no vertices");
    if (vertices->rows() >= kNone) throw InputError(name_ + ": the file has too many vertices for 32-bit indices");
    read_vertices(*vertices);
    if (const Table* edges = tables_.find("edge")) read_edges(*edges);
    if (const Table* faces = tables_.find("face")) read_faces(*faces);
    complete(axis_.mesh);
    return std::move(axis_);
  }

 private:
  const Column* number(const Table& table, std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      const Column* column = table.find(name);
      if (column != nullptr && !column->list) return column;
    }
    return nullptr;
  }

  void read_vertices(const Table& table) {
    const Column* place[3] = {number(table, {"x"}), number(table, {"y"}), number(table, {"z"})};
    for (const Column* column : place) {
      if (column == nullptr) tables_.fail(table, 0, "the vertices lack the properties x, y and z");
    }
    const Column* radius = number(table, {"radius", "Radius", "r", "radii", "scalar_radius"});
    axis_.has_radii = radius != nullptr;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const Point center(place[0]->numbers[row], place[1]->numbers[row], place[2]->numbers[row]);
      if (!center.allFinite()) tables_.fail(table, row, "a coordinate is not finite");
      const double own = radius != nullptr ? radius->numbers[row] : 0;
      if (!std::isfinite(own)) tables_.fail(table, row, "the radius is not finite");
      if (own < 0) tables_.fail(table, row, "the radius is negative; it must be 0 or more");
      axis_.mesh.centers.push_back(center);
      axis_.mesh.radii.push_back(own);
    }
  }

  Index corner(const Table& table, std::size_t row, double value) const {
    if (!(value >= 0 && value < axis_.mesh.size()) || value != std::floor(value))
      tables_.fail(table, row, "a vertex number is not from 0 to " + std::to_string(axis_.mesh.size() - 1));
    return static_cast<Index>(value);
  }

  void read_edges(const Table& table) {
    const Column *first = number(table, {"vertex1", "v1"}), *second = number(table, {"vertex2", "v2"});
    if (table.rows() == 0) return;
    if (first == nullptr || second == nullptr)
      tables_.fail(table, 0, "the edges lack the properties vertex1 and vertex2");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const Index a = corner(table, row, first->numbers[row]), b = corner(table, row, second->numbers[row]);
      if (a == b) tables_.fail(table, row, "the edge leads from a vertex to itself");
      axis_.mesh.edges.push_back({a, b});
    }
  }

  void read_faces(const Table& table) {
    if (table.rows() == 0) return;
    const Column* column = table.find("vertex_indices");
    if (column == nullptr) column = table.find("vertex_index");
    if (column == nullptr || !column->list) tables_.fail(table, 0, "the faces lack the list vertex_indices");
    std::vector<Index> corners;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      corners.clear();
      for (std::size_t i = column->begin(row); i < column->ends[row]; ++i)
        corners.push_back(corner(table, row, column->numbers[i]));
      add_face(table, row, corners);
    }
  }

  // Adds a face: one of two corners is an edge, and a polygon becomes a fan of triangles.
  void add_face(const Table& table, std::size_t row, const std::vector<Index>& corners) {
    if (corners.size() < 2) tables_.fail(table, row, "the face has fewer than two corners");
    std::vector<Index> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      tables_.fail(table, row, "the face names a vertex twice");
    if (corners.size() == 2) axis_.mesh.edges.push_back({corners[0], corners[1]});
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      axis_.mesh.triangles.push_back({corners[0], corners[i], corners[i + 1]});
  }

  const PlyTables& tables_;
  const std::string& name_;
  ForeignAxis axis_;
};

}  // namespace

ForeignAxis parse_ply_axis(std::string_view bytes, const std::string& name) {
  const PlyTables tables(name, std::string(bytes));
  return PlyAxisReader(tables, name).run();
}

}  // namespace orchard::detail
