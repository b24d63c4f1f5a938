#include <array>
#include <optional>
#include <vector>

#include "cell_mesh.h"
#include "mesh_formats.h"
#include "mixed_scanner.h"

namespace orchard {
namespace {

// Elements of the format: the name in .mesh files and the number in .meshb files. Their corners are in the order of
// VTK, except for differences that do not change the shape.
struct MeditElement {
  std::string_view name;
  std::int32_t code;
  std::size_t nodes;
  CellKind kind;
};
constexpr std::array kMeditElements{MeditElement{"Edges", 5, 2, {}},
                                    MeditElement{"Triangles", 6, 3, {CellShape::polygon, 3}},
                                    MeditElement{"Quadrilaterals", 7, 4, {CellShape::polygon, 4}},
                                    MeditElement{"Tetrahedra", 8, 4, {CellShape::tetrahedron, 4}},
                                    MeditElement{"Prisms", 9, 6, {CellShape::prism, 6}},
                                    MeditElement{"Hexahedra", 10, 8, {CellShape::prism, 8}},
                                    MeditElement{"Pyramids", 49, 5, {CellShape::pyramid, 5}}};
constexpr std::int32_t kMeditDimension = 3, kMeditVertices = 4, kMeditEnd = 54;

// Replaces comments of .mesh files by blanks, so that all bytes keep their positions.
std::string without_medit_comments(std::string_view bytes) {
  std::string text(bytes);
  bool comment = false;
  for (char& c : text) {
    comment = (comment || c == '#') && !is_line_end(c);
    if (comment) c = ' ';
  }
  return text;
}

class MeditReader {
 public:
  MeditReader(std::string_view bytes, const std::string& name) : size_(bytes.size()), name_(name), in_(bytes, name) {}

  TriangleMesh read_text(MeshReadReport& report) {
    if (in_.peek() != "MeshVersionFormatted") in_.fail(0, "a Medit file begins with MeshVersionFormatted");
    in_.word();
    in_.integer();
    while (in_.more()) {
      const std::size_t start = in_.position();
      const std::string_view keyword = in_.word();
      if (keyword == "End") break;
      if (keyword == "Dimension") {
        require_three_dimensions(in_.integer(), start);
      } else if (keyword == "Vertices") {
        read_vertices(in_.integer());
      } else if (const MeditElement* element = element_named(keyword)) {
        read_elements(*element, in_.integer());
      } else {
        skip_numbers(keyword, start);
      }
    }
    return finish(report);
  }

  TriangleMesh read_binary(MeshReadReport& report) {
    in_.set_binary(std::endian::little);
    if (in_.raw<std::int32_t>() != 1) {
      in_.move_to(0);
      in_.set_binary(std::endian::big);
      if (in_.raw<std::int32_t>() != 1) in_.fail(0, "a binary Medit file begins with the number 1");
    }
    version_ = in_.raw<std::int32_t>();
    if (version_ < 1 || version_ > 4)
      in_.fail(
          4, "version " + std::to_string(version_) + " of the format cannot be read; save the mesh in version 1 to 4");
    while (in_.remaining() > 0) {
      const std::size_t start = in_.position();
      const std::int32_t code = in_.raw<std::int32_t>();
      if (code == kMeditEnd) break;
      const std::int64_t next = version_ >= 3 ? in_.raw<std::int64_t>() : in_.raw<std::int32_t>();
      read_section(code, start);
      if (next == 0) break;
      if (next < static_cast<std::int64_t>(in_.position()) || next > static_cast<std::int64_t>(size_))
        in_.fail(start, "the next section's place is " + std::to_string(next) +
                            ", which does not come after this one; the file is damaged");
      in_.move_to(static_cast<std::size_t>(next));
    }
    return finish(report);
  }

 private:
  static const MeditElement* element_named(std::string_view name) {
    for (const MeditElement& element : kMeditElements)
      if (element.name == name) return &element;
    return nullptr;
  }

  void read_section(std::int32_t code, std::size_t start) {
    if (code == kMeditDimension) return require_three_dimensions(in_.raw<std::int32_t>(), start);
    if (code == kMeditVertices) return read_vertices(integer());
    for (const MeditElement& element : kMeditElements)
      if (element.code == code) return read_elements(element, integer());
  }

  void require_three_dimensions(std::int64_t dimension, std::size_t at) const {
    if (dimension != 3) in_.fail(at, std::to_string(dimension) + " dimensions cannot be read; a surface needs 3");
  }

  // Skips the numbers of a keyword that is not used.
  void skip_numbers(std::string_view keyword, std::size_t start) {
    const auto begins_number = [](std::string_view word) {
      return !word.empty() && (is_digit(word[0]) || word[0] == '-' || word[0] == '+' || word[0] == '.');
    };
    if (keyword.empty() || begins_number(keyword))
      in_.fail(start, in_quotes(keyword) + " stands where a keyword has to begin, such as Vertices");
    while (in_.more() && begins_number(in_.peek())) in_.word();
  }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }

  std::int64_t integer() {
    if (!in_.binary()) return in_.integer();
    return version_ >= 4 ? in_.raw<std::int64_t>() : in_.raw<std::int32_t>();
  }
  double real() {
    if (!in_.binary()) return in_.number();
    return version_ == 1 ? static_cast<double>(in_.raw<float>()) : in_.raw<double>();
  }
  std::size_t bytes_for(std::size_t numbers) const { return numbers * (in_.binary() ? 4 : 2); }

  void read_vertices(std::int64_t promised) {
    const std::uint64_t count = in_.checked_count(promised, bytes_for(4), "vertices");
    if (!mesh_.vertices.empty()) in_.fail(in_.position(), "the file defines its vertices twice");
    if (count >= kNone) in_.fail(in_.position(), "the file has too many vertices for 32-bit indices");
    for (std::uint64_t i = 0; i < count; ++i) {
      in_.more_of_text();
      const std::size_t at = in_.position();
      Point point;
      for (double& coordinate : point) coordinate = real();
      integer();  // skips the number of the region that the vertex belongs to
      if (!point.allFinite()) mesh_.vertex_faults.add(static_cast<Index>(i), at);
      mesh_.vertices.push_back(point);
    }
  }

  void read_elements(const MeditElement& element, std::int64_t promised) {
    const std::uint64_t count = in_.checked_count(promised, bytes_for(element.nodes + 1), "elements");
    std::vector<Index> corners(element.nodes);
    for (std::uint64_t i = 0; i < count; ++i) {
      in_.more_of_text();
      const std::size_t at = in_.position();
      for (Index& corner : corners) {
        const std::int64_t vertex = integer();
        if (vertex < 1 || vertex > static_cast<std::int64_t>(mesh_.vertices.size()))
          in_.fail(at, "an element names vertex " + std::to_string(vertex) + ", but those before it are 1 to " +
                           std::to_string(mesh_.vertices.size()));
        corner = static_cast<Index>(vertex - 1);
      }
      integer();
      mesh_.add(element.kind, corners, at);
    }
  }

  TriangleMesh finish(MeshReadReport& report) {
    return std::move(mesh_).finish(
        name_, [&](std::size_t at) { in_.fail(at, "the vertex needs three finite numbers, since an element uses it"); },
        [&](std::size_t at) { return in_.place(at); }, report);
  }

  std::size_t size_;
  const std::string& name_;
  MixedScanner in_;
  std::int32_t version_ = 2;
  CellMesh mesh_;
};

}  // namespace

TriangleMesh read_medit(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  const std::string text = without_medit_comments(bytes);
  return MeditReader(text, name).read_text(report);
}

TriangleMesh read_binary_medit(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return MeditReader(bytes, name).read_binary(report);
}

}  // namespace orchard
