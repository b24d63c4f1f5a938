#include "cell_mesh.h"

#include <algorithm>
#include <array>
#include <compare>
#include <numeric>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

constexpr std::array<std::array<Index, 3>, 4> kTetrahedron{{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
constexpr std::array<Index, 8> kVoxelAsPrism{0, 1, 3, 2, 4, 5, 7, 6};

std::size_t fewest_nodes(const CellKind& kind) {
  switch (kind.shape) {
    case CellShape::ignored:
      return 0;
    case CellShape::polygon:
    case CellShape::strip:
      return std::max<std::size_t>(3, kind.corners);
    case CellShape::pixel:
    case CellShape::tetrahedron:
      return 4;
    case CellShape::pyramid:
      return 5;
    case CellShape::prism:
    case CellShape::voxel:
      break;
  }
  return kind.corners;
}

}  // namespace

void CellMesh::begin_cell(std::size_t at) {
  if (cell_at_.size() + 1 >= kNone) throw InputError("too many cells for 32-bit indices");
  cell_at_.push_back(at);
}

void CellMesh::add_face(std::span<const Index> corners) {
  if (corners.size() < 3) return;
  faces_.push_back({corners_.size(), static_cast<Index>(corners.size()), static_cast<Index>(cell_at_.size() - 1)});
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  sorted_.insert(sorted_.end(), corners.begin(), corners.end());
  std::sort(sorted_.end() - static_cast<std::ptrdiff_t>(corners.size()), sorted_.end());
}

void CellMesh::add_surface_cell(const CellKind& kind, std::span<const Index> nodes, std::size_t at) {
  ++surface_cells_;
  if (kind.shape == CellShape::polygon) {
    surface_.add(kind.corners > 0 ? nodes.first(kind.corners) : nodes, at);
  } else if (kind.shape == CellShape::pixel) {
    surface_.add(std::array{nodes[0], nodes[1], nodes[3], nodes[2]}, at);
  } else {
    for (std::size_t i = 0; i + 2 < nodes.size(); ++i)
      surface_.add(std::array{nodes[i + i % 2], nodes[i + 1 - i % 2], nodes[i + 2]}, at);
  }
}

void CellMesh::add(const CellKind& kind, std::span<const Index> nodes, std::size_t at) {
  if (kind.shape == CellShape::ignored) {
    ++lines_;
    return;
  }
  if (nodes.size() < fewest_nodes(kind)) {
    if (skipped_.count++ == 0) first_skipped_ = at;
    return;
  }
  curved_ += kind.curved ? 1 : 0;
  if (kind.shape < CellShape::prism) return add_surface_cell(kind, nodes, at);
  begin_cell(at);
  std::array<Index, 8> reordered{};
  if (kind.shape == CellShape::voxel) {
    for (std::size_t i = 0; i < reordered.size(); ++i) reordered[i] = nodes[kVoxelAsPrism[i]];
    nodes = reordered;
  }
  if (kind.shape == CellShape::tetrahedron) {
    for (const auto& [a, b, c] : kTetrahedron) add_face(std::array{nodes[a], nodes[b], nodes[c]});
    return;
  }
  const std::size_t base = kind.shape == CellShape::pyramid ? 4 : kind.corners / 2;
  add_face(nodes.first(base));
  for (std::size_t i = 0; i < base; ++i) {
    const std::size_t next = (i + 1) % base;
    if (kind.shape == CellShape::pyramid) {
      add_face(std::array{nodes[i], nodes[next], nodes[base]});
    } else {
      add_face(std::array{nodes[i], nodes[next], nodes[base + next], nodes[base + i]});
    }
  }
  if (kind.shape != CellShape::pyramid) add_face(nodes.subspan(base, base));
}

std::vector<CellMesh::Face> CellMesh::outer_faces() {
  std::vector<std::size_t> order(faces_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto same = [&](std::size_t a, std::size_t b) {
    return std::ranges::equal(sorted(faces_[a]), sorted(faces_[b]));
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto x = sorted(faces_[a]), y = sorted(faces_[b]);
    const auto less = std::lexicographical_compare_three_way(x.begin(), x.end(), y.begin(), y.end());
    return std::is_eq(less) ? a < b : std::is_lt(less);
  });
  std::vector<std::size_t> outer;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && same(order[i], order[end])) ++end;
    if (end == i + 1) outer.push_back(order[i]);
    i = end;
  }
  std::sort(outer.begin(), outer.end());
  std::vector<Face> result;
  result.reserve(outer.size());
  for (const std::size_t face : outer) result.push_back(faces_[face]);
  return result;
}

// Returns the mean of the corners. A corner of several faces counts once for each.
Point CellMesh::middle_of_cell(Index cell, std::span<const std::size_t> first_face) const {
  Point sum = Point::Zero();
  double count = 0;
  for (std::size_t f = first_face[cell]; f < first_face[cell + 1]; ++f)
    for (const Index corner : corners(faces_[f])) {
      sum += vertices[corner];
      ++count;
    }
  return sum / count;
}

void CellMesh::take_outer_surface(MeshReadReport& report, const FailCell& fail) {
  std::vector<std::size_t> first_face(cell_at_.size() + 1, faces_.size());
  for (std::size_t f = faces_.size(); f-- > 0;) first_face[faces_[f].cell] = f;
  for (std::size_t cell = cell_at_.size(); cell-- > 0;)
    first_face[cell] = std::min(first_face[cell], first_face[cell + 1]);
  FaceCollector outer;
  std::vector<Index> turned;
  for (const Face& face : outer_faces()) {
    const auto around = corners(face);
    Vector normal = Vector::Zero();
    for (std::size_t i = 1; i + 1 < around.size(); ++i)
      normal += (vertices[around[i]] - vertices[around[0]]).cross(vertices[around[i + 1]] - vertices[around[0]]);
    turned.assign(around.begin(), around.end());
    const Point middle = middle_of_cell(face.cell, first_face);
    if (!middle.allFinite()) fail(cell_at_[face.cell], "a coordinate of this cell's vertices is not a finite number");
    if (normal.dot(vertices[around[0]] - middle) < 0) std::reverse(turned.begin(), turned.end());
    outer.add(turned, cell_at_[face.cell]);
  }
  if (outer.empty())
    fail(cell_at_.front(),
         "the volume cells from here on have no outer face; each of their faces belongs to two cells");
  report.volume_cells = static_cast<Index>(cell_at_.size());
  report.cells_beside = surface_cells_;
  surface_ = std::move(outer);
}

void CellMesh::drop_unused_vertices(TriangleMesh& mesh) const {
  std::vector<Index> number(mesh.vertices.size(), kNone);
  std::vector<Point> used;
  for (const auto& triangle : mesh.triangles)
    for (const Index corner : triangle) number[corner] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    number[v] = static_cast<Index>(used.size());
    used.push_back(mesh.vertices[v]);
  }
  for (auto& triangle : mesh.triangles)
    for (Index& corner : triangle) corner = number[corner];
  mesh.vertices = std::move(used);
}

TriangleMesh CellMesh::finish(const std::string& name, const std::function<void(std::size_t)>& fail,
                              const std::function<std::string(std::size_t)>& place, MeshReadReport& report) && {
  const bool of_volume = !faces_.empty();
  if (of_volume)
    take_outer_surface(
        report, [&](std::size_t at, const char* fault) { throw InputError(name + ", " + place(at) + ": " + fault); });
  if (surface_.empty())
    throw InputError(name + ": the file has no triangles, polygons or volume cells" +
                     (lines_ > 0 ? ", only points or lines" : ""));
  report.faces_skipped = skipped_;
  if (skipped_.count > 0) report.faces_skipped.first = place(first_skipped_);
  report.curved_cells = curved_;
  report.lines_skipped = lines_;
  vertex_faults.settle(vertices, surface_, fail, place, report);
  TriangleMesh mesh{std::move(vertices), {}};
  mesh.triangles = split_faces(std::move(surface_), mesh.vertices, place, report);
  if (of_volume) drop_unused_vertices(mesh);
  return mesh;
}

}  // namespace orchard
