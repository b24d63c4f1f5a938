#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "polygons.h"
#include "vertex_faults.h"

namespace orchard {

// The shape of a cell in a mesh for simulations. Its corners are in the order of VTK.
enum class CellShape : std::uint8_t { ignored, polygon, strip, pixel, prism, tetrahedron, pyramid, voxel };

// A kind of cell in a format. `corners` is the number of its nodes that are corners, which come first; 0 means all of
// them.
struct CellKind {
  CellShape shape = CellShape::ignored;
  std::uint8_t corners = 0;
  bool curved = false;  // further nodes bend the cell
};

// Collects cells of any dimension and turns them into triangles: the outer surface of the volume cells, or the surface
// cells if there are no volume cells. The outer surface consists of the faces that belong to a single volume cell,
// turned away from its middle. So neither the order of a cell's corners nor a border between two materials matters.
class CellMesh {
 public:
  std::vector<Point> vertices;
  VertexFaults vertex_faults;

  // Adds a cell. Its `nodes` are below vertices.size(), and `at` is its byte in the file. A cell with too few nodes is
  // counted as skipped.
  void add(const CellKind& kind, std::span<const Index> nodes, std::size_t at);
  // Begins a volume cell that is given by its faces.
  void begin_cell(std::size_t at);
  void add_face(std::span<const Index> corners);

  // Returns the triangles, and adds what was left out to the report. `fail` reports a fault at a byte and does not
  // return; `place` names a byte. Throws InputError, beginning with `name`, if there is no face.
  TriangleMesh finish(const std::string& name, const std::function<void(std::size_t)>& fail,
                      const std::function<std::string(std::size_t)>& place, MeshReadReport& report) &&;

 private:
  struct Face {
    std::size_t first = 0;  // position in corners_ and sorted_
    Index count = 0, cell = 0;
  };
  std::span<const Index> sorted(const Face& face) const { return {sorted_.data() + face.first, face.count}; }
  std::span<const Index> corners(const Face& face) const { return {corners_.data() + face.first, face.count}; }
  void add_surface_cell(const CellKind& kind, std::span<const Index> nodes, std::size_t at);
  std::vector<Face> outer_faces();
  using FailCell = std::function<void(std::size_t, const char*)>;
  void take_outer_surface(MeshReadReport& report, const FailCell& fail);
  Point middle_of_cell(Index cell, std::span<const std::size_t> first_face) const;
  void drop_unused_vertices(TriangleMesh& mesh) const;

  FaceCollector surface_;
  std::vector<Face> faces_;              // of volume cells, by cell
  std::vector<Index> corners_, sorted_;  // the corners of these faces, in order around each, and ascending
  std::vector<std::size_t> cell_at_;     // of each volume cell
  Index surface_cells_ = 0, lines_ = 0, curved_ = 0;
  MeshReadReport::Occurrences skipped_;
  std::size_t first_skipped_ = 0;
};

}  // namespace orchard
