#include <algorithm>
#include <limits>
#include <numeric>

#include "ma_text.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

template <std::size_t kCorners>
using Cells = std::vector<std::array<Index, kCorners>>;

// Sorts cells and removes repeated ones. Of these, the first that is not deleted stays, or else the first. Returns the
// new number of each cell.
template <std::size_t kCorners>
std::vector<Index> sort_and_deduplicate(Cells<kCorners>& cells, std::vector<CellFlags>& flags) {
  std::vector<Index> order(cells.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return cells[a] != cells[b] ? cells[a] < cells[b] : flags[a].deleted < flags[b].deleted;
  });
  Cells<kCorners> sorted;
  std::vector<CellFlags> sorted_flags;
  std::vector<Index> number(cells.size());
  for (const Index i : order) {
    if (sorted.empty() || sorted.back() != cells[i]) {
      sorted.push_back(cells[i]);
      sorted_flags.push_back(flags[i]);
    }
    number[i] = static_cast<Index>(sorted.size() - 1);
  }
  cells = std::move(sorted);
  flags = std::move(sorted_flags);
  return number;
}

class MaReader {
 public:
  explicit MaReader(TextLines lines) : lines_(std::move(lines)) {}

  FlaggedMedialMesh run() {
    if (!lines_.next())
      lines_.fail("the file is empty; a .ma file starts with its numbers of vertices, edges and faces");
    vertices_ = lines_.index();
    const Index edges = lines_.index(), faces = lines_.index(), tetrahedra = fourth_count();
    if (vertices_ == 0) lines_.fail("the file promises no vertices");
    for (Index i = 0; i < vertices_; ++i) read_vertex();
    if (std::all_of(flagged_.vertices.begin(), flagged_.vertices.end(),
                    [](const CellFlags& own) { return own.deleted; }))
      lines_.fail("every vertex is flagged as deleted; nothing is left of this medial mesh");
    for (Index i = 0; i < edges; ++i) {
      flagged_.mesh.edges.push_back(corners<2>("e"));
      flagged_.edges.push_back(flags_with_type());
    }
    for (Index i = 0; i < faces; ++i) {
      flagged_.mesh.triangles.push_back(corners<3>("f"));
      flagged_.triangles.push_back(flag_without_type());
    }
    in_tetrahedra_ = true;
    for (Index i = 0; i < tetrahedra; ++i) {
      corners<4>("t");
      if (!flag_without_type().deleted) ++flagged_.tetrahedra;
    }
    read_structure();
    complete_with_flags();
    if (!any_flags_) flagged_.vertices.clear(), flagged_.edges.clear(), flagged_.triangles.clear();
    return std::move(flagged_);
  }

 private:
  // Reads the fourth number of the header, which MATTopo uses for its tetrahedra.
  Index fourth_count() {
    std::array<std::int64_t, 1> number{};
    if (lines_.whole_numbers_to_the_end(number) == 0) return 0;
    has_copies_ = true;
    if (number[0] < 0 || number[0] > std::numeric_limits<Index>::max())
      lines_.fail("the number of tetrahedra is not a whole number of 0 or more");
    return static_cast<Index>(number[0]);
  }
  void read_vertex() {
    lines_.expect("v");
    const double x = lines_.real(), y = lines_.real(), z = lines_.real(), radius = lines_.real();
    if (radius < 0) lines_.fail("the radius is negative; it must be 0 or more");
    flagged_.mesh.centers.emplace_back(x, y, z);
    flagged_.mesh.radii.push_back(radius);
    flagged_.vertices.push_back(flags_with_type());
  }
  template <std::size_t kCorners>
  std::array<Index, kCorners> corners(std::string_view kind) {
    lines_.expect(kind);
    std::array<Index, kCorners> result;
    for (std::size_t k = 0; k < kCorners; ++k) {
      result[k] = lines_.index();
      if (result[k] >= vertices_) lines_.fail("a vertex number is beyond the last vertex (they count from 0)");
      for (std::size_t before = 0; before < k; ++before) {
        if (result[before] == result[k]) lines_.fail("the cell names a vertex twice");
      }
    }
    std::sort(result.begin(), result.end());
    return result;
  }
  // Reads the flags at the end of a line: "type", "type deleted", MATTopo's "type deleted copies", or none. Other text
  // at the end of a line is ignored.
  CellFlags flags_with_type() {
    std::array<std::int64_t, 3> numbers{};
    const std::size_t count = lines_.whole_numbers_to_the_end(numbers);
    if (count == 0 || (count == 3 && !has_copies_)) return {};
    if (numbers[0] != static_cast<int>(numbers[0])) lines_.fail("the type does not fit into 32 bits");
    return {static_cast<int>(numbers[0]), deleted(numbers[1])};
  }
  // Reads the flags of a line without a type: "deleted" or none; from MATTopo "importance deleted [copies]", and for
  // its tetrahedra "deleted [copies]".
  CellFlags flag_without_type() {
    std::array<std::int64_t, 2> numbers{};
    std::size_t count = lines_.whole_numbers_to_the_end(numbers);
    if (count == 1) return {0, deleted(numbers[0])};
    if (!has_copies_) return {};
    if (count == 2 && in_tetrahedra_) return {0, deleted(numbers[0])};
    if (count == 2) return {0, deleted(numbers[1])};
    double importance = 0;
    if (!lines_.real_if_any(importance)) return {};
    count = lines_.whole_numbers_to_the_end(numbers);
    return count == 0 ? CellFlags() : CellFlags{0, deleted(numbers[0])};
  }
  bool deleted(std::int64_t flag) {
    if (flag != 0 && flag != 1) lines_.fail("the flag \"deleted\" is neither 0 nor 1");
    any_flags_ = true;
    return flag == 1;
  }

  // Reads MATStruct's section if the next line is just the number of parts. Other text is ignored.
  void read_structure() {
    std::array<std::int64_t, 1> parts{};
    if (!lines_.next() || lines_.whole_numbers_to_the_end(parts) == 0) return;
    if (parts[0] < 0) lines_.fail("the number of parts of the structure is negative");
    for (std::int64_t i = 0; i < parts[0]; ++i) {
      StructurePart part;
      part.number = lines_.index_on_any_line("the number of a part of the structure");
      part.kind = lines_.index_on_any_line("the kind of a part of the structure");
      if (part.kind > 4) lines_.fail("the kind of the part is none of 0 sheet, 1 seam, 2 border, 3 junction, 4 curve");
      const std::size_t cells = part.kind == 0   ? flagged_.mesh.triangles.size()
                                : part.kind == 3 ? flagged_.mesh.centers.size()
                                                 : flagged_.mesh.edges.size();
      const Index count = lines_.index_on_any_line("the number of cells of a part of the structure");
      for (Index k = 0; k < count; ++k) {
        part.cells.push_back(lines_.index_on_any_line("a cell of a part of the structure"));
        if (part.cells.back() >= cells) lines_.fail("a part of the structure names a cell beyond the last one");
      }
      flagged_.structure.push_back(std::move(part));
    }
  }

  // Renumbers the cells of the parts, sorts them and removes repeated ones.
  void renumber(const std::vector<Index>& edges, const std::vector<Index>& triangles) {
    for (StructurePart& part : flagged_.structure) {
      if (part.kind != 3) {
        for (Index& cell : part.cells) cell = (part.kind == 0 ? triangles : edges)[cell];
      }
      std::sort(part.cells.begin(), part.cells.end());
      part.cells.erase(std::unique(part.cells.begin(), part.cells.end()), part.cells.end());
    }
  }

  void complete_with_flags() {
    MedialMesh& mesh = flagged_.mesh;
    std::vector<Index> edges = sort_and_deduplicate(mesh.edges, flagged_.edges);
    const std::vector<Index> triangles = sort_and_deduplicate(mesh.triangles, flagged_.triangles);
    // Adds the missing edges of triangles. Such an edge counts as deleted if all of its triangles are deleted.
    const std::size_t listed = mesh.edges.size();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto& [a, b, c] = mesh.triangles[i];
      for (const std::array<Index, 2>& side : {std::array{a, b}, std::array{a, c}, std::array{b, c}}) {
        if (std::binary_search(mesh.edges.begin(), mesh.edges.begin() + static_cast<std::ptrdiff_t>(listed), side))
          continue;
        mesh.edges.push_back(side);
        flagged_.edges.push_back({0, flagged_.triangles[i].deleted});
      }
    }
    const std::vector<Index> completed = sort_and_deduplicate(mesh.edges, flagged_.edges);
    for (Index& edge : edges) edge = completed[edge];
    renumber(edges, triangles);
  }

  TextLines lines_;
  Index vertices_ = 0;
  bool any_flags_ = false, in_tetrahedra_ = false;
  bool has_copies_ = false;  // whether it is a file of MATTopo with its extra columns
  FlaggedMedialMesh flagged_;
};

// Whether a cell is not deleted, as far as its own flag says.
bool kept(const std::vector<CellFlags>& flags, std::size_t i) { return flags.empty() || !flags[i].deleted; }

bool any_deleted(const std::vector<CellFlags>& flags) {
  return std::any_of(flags.begin(), flags.end(), [](const CellFlags& cell) { return cell.deleted; });
}

void append_flag(std::string& text, int value) { text += ' ' + std::to_string(value); }

}  // namespace

FlaggedMedialMesh detail::parse_ma(TextLines lines) { return MaReader(std::move(lines)).run(); }

MedialMesh without_deleted(const FlaggedMedialMesh& flagged) {
  const MedialMesh& all = flagged.mesh;
  MedialMesh mesh;
  std::vector<Index> number(all.centers.size(), kNone);
  for (std::size_t i = 0; i < all.centers.size(); ++i) {
    if (!kept(flagged.vertices, i)) continue;
    number[i] = mesh.size();
    mesh.centers.push_back(all.centers[i]);
    mesh.radii.push_back(all.radii[i]);
  }
  if (mesh.centers.empty()) throw InputError("medial mesh: every vertex is deleted");
  Cells<2> deleted;
  for (std::size_t i = 0; i < all.edges.size(); ++i) {
    const auto& [a, b] = all.edges[i];
    if (!kept(flagged.edges, i)) {
      deleted.push_back(all.edges[i]);
    } else if (number[a] != kNone && number[b] != kNone) {
      mesh.edges.push_back({number[a], number[b]});
    }
  }
  const auto is_deleted = [&](Index a, Index b) {
    return std::binary_search(deleted.begin(), deleted.end(), std::array{a, b});
  };
  for (std::size_t i = 0; i < all.triangles.size(); ++i) {
    const auto& [a, b, c] = all.triangles[i];
    if (!kept(flagged.triangles, i) || number[a] == kNone || number[b] == kNone || number[c] == kNone) continue;
    if (is_deleted(a, b) || is_deleted(a, c) || is_deleted(b, c)) continue;
    mesh.triangles.push_back({number[a], number[b], number[c]});
  }
  return mesh;
}

std::string to_ma(const FlaggedMedialMesh& flagged) {
  const MedialMesh& mesh = flagged.mesh;
  const bool flags = !flagged.vertices.empty() || !flagged.edges.empty() || !flagged.triangles.empty();
  const bool edges_deleted = any_deleted(flagged.edges), triangles_deleted = any_deleted(flagged.triangles);
  const auto of = [](const std::vector<CellFlags>& cells, std::size_t i) {
    return cells.empty() ? CellFlags() : cells[i];
  };
  std::string text = std::to_string(mesh.centers.size()) + ' ' + std::to_string(mesh.edges.size()) + ' ' +
                     std::to_string(mesh.triangles.size()) + '\n';
  for (std::size_t i = 0; i < mesh.centers.size(); ++i) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) append_number(text, mesh.centers[i][axis]);
    append_number(text, mesh.radii[i]);
    const CellFlags own = of(flagged.vertices, i);
    if (flags) append_flag(text, own.type), append_flag(text, own.deleted);
    text += '\n';
  }
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    text += 'e';
    for (const Index corner : mesh.edges[i]) append_number(text, corner);
    const CellFlags own = of(flagged.edges, i);
    if (flags) append_flag(text, own.type);
    if (edges_deleted) append_flag(text, own.deleted);
    text += '\n';
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    text += 'f';
    for (const Index corner : mesh.triangles[i]) append_number(text, corner);
    if (triangles_deleted) append_flag(text, of(flagged.triangles, i).deleted);
    text += '\n';
  }
  if (!flagged.structure.empty()) text += to_structure_section(flagged.structure);
  return text;
}

std::string to_ma(const MedialMesh& mesh) { return to_ma(FlaggedMedialMesh{.mesh = mesh}); }

std::string to_structure_section(const std::vector<StructurePart>& parts) {
  std::string text = std::to_string(parts.size()) + '\n';
  for (const StructurePart& part : parts) {
    text += std::to_string(part.number) + ' ' + std::to_string(part.kind) + ' ' + std::to_string(part.cells.size());
    for (const Index cell : part.cells) append_number(text, cell);
    text += '\n';
  }
  return text;
}

FlaggedMedialMesh read_flagged_ma(const std::filesystem::path& file) { return detail::parse_ma(TextLines(file)); }

MedialMesh read_ma(const std::filesystem::path& file) { return without_deleted(read_flagged_ma(file)); }

}  // namespace orchard
