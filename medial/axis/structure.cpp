#include "orchard/medial/structure.h"

#include <algorithm>
#include <utility>

#include "axis_complex.h"
#include "incidence.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/text_lines.h"

namespace orchard {
namespace {

// A medial mesh with the interface of AxisComplex.
class MeshComplex {
 public:
  explicit MeshComplex(const MedialMesh& mesh) : mesh_(mesh), at_(mesh.edges, mesh.triangles, mesh.size()) {}
  Index face_count() const { return static_cast<Index>(mesh_.triangles.size()); }
  std::span<const Index> corners(Index face) const { return mesh_.triangles[face]; }
  const std::vector<std::array<Index, 2>>& edges() const { return mesh_.edges; }
  std::span<const Index> sides(Index face) const { return at_.sides[face]; }
  std::span<const Index> faces_at(Index edge) const { return at_.triangles_at[edge]; }
  std::span<const Index> edges_at(Index vertex) const { return at_.edges_at[vertex]; }

 private:
  const MedialMesh& mesh_;
  detail::CellIncidence at_;
};

template <class Complex>
class StructureFinder {
 public:
  StructureFinder(const Complex& complex, Index vertices)
      : complex_(complex), vertices_(vertices), edges_(static_cast<Index>(complex.edges().size())) {}

  MedialStructure run() {
    number_sheets();
    find_junctions();
    number_lines();
    number_junctions();
    collect_vertices();
    return std::move(result_);
  }

 private:
  StructureKind kind_of_edge(Index edge) const {
    switch (complex_.faces_at(edge).size()) {
      case 0:
        return StructureKind::curve;
      case 1:
        return StructureKind::border;
      case 2:
        return StructureKind::sheet;
      default:
        return StructureKind::seam;
    }
  }
  Index open(StructureKind kind) {
    result_.parts.push_back({.kind = kind, .cells = 0, .vertices = {}});
    return static_cast<Index>(result_.parts.size() - 1);
  }

  // Adds a part for each set of the items that count, in the order of their first items, and numbers the items.
  template <class Counts, class Kind>
  std::vector<Index> number(DisjointSets& sets, Index items, const Counts& counts, const Kind& kind) {
    std::vector<Index> part_of_root(items, kNone), part(items, kNone);
    for (Index item = 0; item < items; ++item) {
      if (!counts(item)) continue;
      Index& own = part_of_root[sets.root(item)];
      if (own == kNone) own = open(kind(item));
      part[item] = own;
      ++result_.parts[own].cells;
    }
    return part;
  }

  void number_sheets() {
    DisjointSets sheets(complex_.face_count());
    for (Index edge = 0; edge < edges_; ++edge) {
      const auto faces = complex_.faces_at(edge);
      if (faces.size() == 2) sheets.unite(faces[0], faces[1]);
    }
    result_.of_face = number(
        sheets, complex_.face_count(), [](Index) { return true; }, [](Index) { return StructureKind::sheet; });
  }

  // Finds the junctions. A vertex is no junction if its faces are connected around it and either exactly two line edges
  // meet there, both of one kind (it is inside a line), or none (it is inside a sheet).
  void find_junctions() {
    junction_.assign(vertices_, 0);
    for (Index vertex = 0; vertex < vertices_; ++vertex) {
      std::size_t lines = 0;
      bool alike = true;
      StructureKind kind = StructureKind::sheet;
      for (const Index edge : complex_.edges_at(vertex)) {
        const StructureKind own = kind_of_edge(edge);
        if (own == StructureKind::sheet) continue;
        alike = alike && (lines == 0 || own == kind);
        kind = own;
        ++lines;
      }
      const bool inside = (lines == 0 && !complex_.edges_at(vertex).empty()) || (lines == 2 && alike);
      junction_[vertex] = inside && hangs_together(vertex, kind == StructureKind::curve) ? 0 : 1;
    }
  }
  bool hangs_together(Index vertex, bool on_curve) const {
    const auto edges = complex_.edges_at(vertex);
    if (on_curve) return edges.size() == 2;
    const auto number = [&](Index edge) {
      return static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
    };
    DisjointSets joined(edges.size());
    for (const Index edge : edges) {
      for (const Index face : complex_.faces_at(edge)) {
        for (const Index side : complex_.sides(face)) {
          if (side == edge) continue;
          const Index other = number(side);
          if (other < edges.size() && edges[other] == side) joined.unite(number(edge), other);
        }
      }
    }
    for (Index i = 1; i < edges.size(); ++i) {
      if (joined.root(i) != 0) return false;
    }
    return true;
  }

  void number_lines() {
    DisjointSets lines(edges_);
    const auto on_line = [&](Index edge) { return kind_of_edge(edge) != StructureKind::sheet; };
    for (Index vertex = 0; vertex < vertices_; ++vertex) {
      if (junction_[vertex] != 0) continue;
      Index first = kNone;
      for (const Index edge : complex_.edges_at(vertex)) {
        if (!on_line(edge)) continue;
        if (first != kNone) lines.unite(first, edge);
        first = edge;
      }
    }
    result_.of_edge = number(lines, edges_, on_line, [&](Index edge) { return kind_of_edge(edge); });
  }

  void number_junctions() {
    for (Index vertex = 0; vertex < vertices_; ++vertex) {
      if (junction_[vertex] != 0) {
        result_.of_vertex.push_back(open(StructureKind::junction));
        result_.parts.back().cells = 1;
        result_.parts.back().vertices = {vertex};
        continue;
      }
      const auto edges = complex_.edges_at(vertex);
      const auto line =
          std::find_if(edges.begin(), edges.end(), [&](Index edge) { return result_.of_edge[edge] != kNone; });
      result_.of_vertex.push_back(line != edges.end() ? result_.of_edge[*line]
                                                      : result_.of_face[complex_.faces_at(edges.front()).front()]);
    }
  }

  void collect_vertices() {
    for (Index face = 0; face < complex_.face_count(); ++face) {
      for (const Index corner : complex_.corners(face)) result_.parts[result_.of_face[face]].vertices.push_back(corner);
    }
    for (Index edge = 0; edge < edges_; ++edge) {
      if (result_.of_edge[edge] == kNone) continue;
      for (const Index end : complex_.edges()[edge]) result_.parts[result_.of_edge[edge]].vertices.push_back(end);
    }
    for (MedialStructure::Part& part : result_.parts) {
      std::sort(part.vertices.begin(), part.vertices.end());
      part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
    }
  }

  const Complex& complex_;
  const Index vertices_, edges_;
  std::vector<std::uint8_t> junction_;  // of each vertex
  MedialStructure result_;
};

}  // namespace

const char* name_of(StructureKind kind) {
  switch (kind) {
    case StructureKind::sheet:
      return "sheet";
    case StructureKind::seam:
      return "seam";
    case StructureKind::border:
      return "border";
    case StructureKind::junction:
      return "junction";
    case StructureKind::curve:
      return "curve";
  }
  return "";
}

std::size_t MedialStructure::count(StructureKind kind) const {
  return static_cast<std::size_t>(
      std::count_if(parts.begin(), parts.end(), [&](const Part& part) { return part.kind == kind; }));
}

bool MedialStructure::on_curve(Index edge) const {
  return of_edge[edge] != kNone && parts[of_edge[edge]].kind == StructureKind::curve;
}

MedialStructure medial_structure(const MedialAxis& axis) {
  const detail::AxisComplex complex(axis);
  return StructureFinder(complex, axis.size()).run();
}

MedialStructure medial_structure(const MedialMesh& mesh) {
  const MeshComplex complex(mesh);
  return StructureFinder(complex, mesh.size()).run();
}

std::string to_structure_section(const MedialStructure& structure) {
  std::vector<StructurePart> parts(structure.parts.size());
  for (Index i = 0; i < parts.size(); ++i) {
    parts[i].number = i;
    parts[i].kind = static_cast<Index>(structure.parts[i].kind);
    if (structure.parts[i].kind == StructureKind::junction) parts[i].cells = structure.parts[i].vertices;
  }
  for (Index t = 0; t < structure.of_face.size(); ++t) parts[structure.of_face[t]].cells.push_back(t);
  for (Index e = 0; e < structure.of_edge.size(); ++e) {
    if (structure.of_edge[e] != kNone) parts[structure.of_edge[e]].cells.push_back(e);
  }
  return to_structure_section(parts);
}

}  // namespace orchard
