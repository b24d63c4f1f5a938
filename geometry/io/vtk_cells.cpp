#include "vtk_cells.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace orchard {
namespace {

using VtkType = std::pair<std::int64_t, CellKind>;
constexpr CellKind kVtkTriangle{CellShape::polygon, 3}, kVtkQuad{CellShape::polygon, 4},
    kVtkTetrahedron{CellShape::tetrahedron, 4}, kVtkHexahedron{CellShape::prism, 8}, kVtkWedge{CellShape::prism, 6},
    kVtkPyramid{CellShape::pyramid, 5};
constexpr CellKind vtk_curved(CellKind kind) { return {kind.shape, kind.corners, true}; }
const std::array kVtkTypes{
    VtkType{0, {}}, VtkType{1, {}}, VtkType{2, {}}, VtkType{3, {}}, VtkType{4, {}}, VtkType{21, {}}, VtkType{35, {}},
    VtkType{68, {}}, VtkType{75, {}}, VtkType{5, kVtkTriangle}, VtkType{6, {CellShape::strip, 0}},
    VtkType{7, {CellShape::polygon, 0}}, VtkType{8, {CellShape::pixel, 4}}, VtkType{9, kVtkQuad},
    VtkType{10, kVtkTetrahedron}, VtkType{11, {CellShape::voxel, 8}}, VtkType{12, kVtkHexahedron},
    VtkType{13, kVtkWedge}, VtkType{14, kVtkPyramid}, VtkType{15, {CellShape::prism, 10}},
    VtkType{16, {CellShape::prism, 12}},
    // Curved cells: quadratic ones, and those of Lagrange and Bezier of any degree.
    VtkType{22, vtk_curved(kVtkTriangle)}, VtkType{34, vtk_curved(kVtkTriangle)}, VtkType{69, vtk_curved(kVtkTriangle)},
    VtkType{76, vtk_curved(kVtkTriangle)}, VtkType{23, vtk_curved(kVtkQuad)}, VtkType{28, vtk_curved(kVtkQuad)},
    VtkType{30, vtk_curved(kVtkQuad)}, VtkType{70, vtk_curved(kVtkQuad)}, VtkType{77, vtk_curved(kVtkQuad)},
    VtkType{24, vtk_curved(kVtkTetrahedron)}, VtkType{71, vtk_curved(kVtkTetrahedron)},
    VtkType{78, vtk_curved(kVtkTetrahedron)}, VtkType{25, vtk_curved(kVtkHexahedron)},
    VtkType{29, vtk_curved(kVtkHexahedron)}, VtkType{33, vtk_curved(kVtkHexahedron)},
    VtkType{72, vtk_curved(kVtkHexahedron)}, VtkType{79, vtk_curved(kVtkHexahedron)},
    VtkType{26, vtk_curved(kVtkWedge)}, VtkType{31, vtk_curved(kVtkWedge)}, VtkType{32, vtk_curved(kVtkWedge)},
    VtkType{73, vtk_curved(kVtkWedge)}, VtkType{80, vtk_curved(kVtkWedge)}, VtkType{27, vtk_curved(kVtkPyramid)},
    VtkType{37, vtk_curved(kVtkPyramid)}, VtkType{74, vtk_curved(kVtkPyramid)}, VtkType{81, vtk_curved(kVtkPyramid)}};

}  // namespace

const CellKind* vtk_cell_kind(std::int64_t type) {
  const auto found = std::ranges::find(kVtkTypes, type, &VtkType::first);
  return found == kVtkTypes.end() ? nullptr : &found->second;
}

void VtkCells::check() const {
  if (!std::ranges::is_sorted(offsets) || offsets.front() < 0) fail(at, "the offsets of cells do not ascend");
  if (offsets.back() > static_cast<std::int64_t>(connectivity.size()))
    fail(at, "the offsets of cells go to " + std::to_string(offsets.back()) + ", but the connectivity has " +
                 std::to_string(connectivity.size()) + " numbers");
}

Index VtkCells::point(std::size_t cell, std::int64_t id) const {
  if (id < 0 || id >= static_cast<std::int64_t>(points))
    fail(at, "cell " + std::to_string(cell) + " of those that begin here names point " + std::to_string(id) +
                 ", but there are " + std::to_string(points) + "; both are counted from 0");
  return first_point + static_cast<Index>(id);
}

void VtkCells::corners_of(std::size_t cell, std::vector<Index>& out) const {
  out.clear();
  for (std::int64_t i = offsets[cell]; i < offsets[cell + 1]; ++i)
    out.push_back(point(cell, connectivity[static_cast<std::size_t>(i)]));
}

void add_vtk_polygons(const VtkCells& cells, CellShape shape, CellMesh& mesh) {
  cells.check();
  std::vector<Index> corners;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    cells.corners_of(cell, corners);
    mesh.add({shape, 0}, corners, cells.at);
  }
}

void add_vtk_polyhedron(const VtkCells& cells, std::size_t cell, std::span<const std::int64_t> stream, CellMesh& mesh) {
  const auto cut_short = [&] {
    cells.fail(cells.at, "the numbers of a polyhedron end within its faces; the file is damaged");
  };
  if (stream.empty()) cut_short();
  std::int64_t faces = stream.front();
  std::vector<Index> corners;
  mesh.begin_cell(cells.at);
  for (stream = stream.subspan(1); faces > 0; --faces) {
    if (stream.empty() || stream[0] < 0 || static_cast<std::uint64_t>(stream[0]) > stream.size() - 1) cut_short();
    const auto count = static_cast<std::size_t>(stream[0]);
    corners.clear();
    for (const std::int64_t id : stream.subspan(1, count)) corners.push_back(cells.point(cell, id));
    mesh.add_face(corners);
    stream = stream.subspan(count + 1);
  }
}

void add_vtk_cells(const VtkCells& cells, std::span<const std::int64_t> types, std::span<const std::int64_t> faces,
                   std::span<const std::int64_t> face_ends, CellMesh& mesh) {
  cells.check();
  if (types.size() != cells.size())
    cells.fail(cells.at, std::to_string(cells.size()) + " cells have " + std::to_string(types.size()) + " types");
  std::vector<Index> corners;
  std::size_t face_from = 0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (types[cell] == kVtkPolyhedron) {
      const std::int64_t end = cell < face_ends.size() ? face_ends[cell] : -1;
      if (end < static_cast<std::int64_t>(face_from) || end > static_cast<std::int64_t>(faces.size()))
        cells.fail(cells.at, "polyhedron " + std::to_string(cell) + " has no faces");
      add_vtk_polyhedron(cells, cell, faces.subspan(face_from, static_cast<std::size_t>(end) - face_from), mesh);
      face_from = static_cast<std::size_t>(end);
      continue;
    }
    const CellKind* kind = vtk_cell_kind(types[cell]);
    if (kind == nullptr)
      cells.fail(cells.at,
                 "cells of type " + std::to_string(types[cell]) + " of VTK cannot be read; save the surface as .vtp");
    cells.corners_of(cell, corners);
    mesh.add(*kind, corners, cells.at);
  }
}

}  // namespace orchard
