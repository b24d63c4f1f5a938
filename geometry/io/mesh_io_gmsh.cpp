#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>
#include <vector>

#include "cell_mesh.h"
#include "mesh_formats.h"
#include "mixed_scanner.h"

namespace orchard {
namespace {

struct GmshType {
  int number = 0;
  std::size_t nodes = 0;
  CellKind kind;
};

// The element types of Gmsh's manual, section "Node ordering". Corners come before other nodes.
constexpr CellKind kGmshTriangle{CellShape::polygon, 3}, kGmshQuad{CellShape::polygon, 4},
    kGmshTetrahedron{CellShape::tetrahedron, 4}, kGmshHexahedron{CellShape::prism, 8}, kGmshPrism{CellShape::prism, 6},
    kGmshPyramid{CellShape::pyramid, 5};
constexpr CellKind gmsh_curved(CellKind kind) { return {kind.shape, kind.corners, true}; }
const std::array kGmshTypes{GmshType{15, 1, {}},
                            GmshType{1, 2, {}},
                            GmshType{8, 3, {}},
                            GmshType{26, 4, {}},
                            GmshType{27, 5, {}},
                            GmshType{28, 6, {}},
                            GmshType{2, 3, kGmshTriangle},
                            GmshType{9, 6, gmsh_curved(kGmshTriangle)},
                            GmshType{20, 9, gmsh_curved(kGmshTriangle)},
                            GmshType{21, 10, gmsh_curved(kGmshTriangle)},
                            GmshType{22, 12, gmsh_curved(kGmshTriangle)},
                            GmshType{23, 15, gmsh_curved(kGmshTriangle)},
                            GmshType{24, 15, gmsh_curved(kGmshTriangle)},
                            GmshType{25, 21, gmsh_curved(kGmshTriangle)},
                            GmshType{3, 4, kGmshQuad},
                            GmshType{10, 9, gmsh_curved(kGmshQuad)},
                            GmshType{16, 8, gmsh_curved(kGmshQuad)},
                            GmshType{36, 16, gmsh_curved(kGmshQuad)},
                            GmshType{37, 25, gmsh_curved(kGmshQuad)},
                            GmshType{4, 4, kGmshTetrahedron},
                            GmshType{11, 10, gmsh_curved(kGmshTetrahedron)},
                            GmshType{29, 20, gmsh_curved(kGmshTetrahedron)},
                            GmshType{30, 35, gmsh_curved(kGmshTetrahedron)},
                            GmshType{31, 56, gmsh_curved(kGmshTetrahedron)},
                            GmshType{5, 8, kGmshHexahedron},
                            GmshType{12, 27, gmsh_curved(kGmshHexahedron)},
                            GmshType{17, 20, gmsh_curved(kGmshHexahedron)},
                            GmshType{92, 64, gmsh_curved(kGmshHexahedron)},
                            GmshType{93, 125, gmsh_curved(kGmshHexahedron)},
                            GmshType{6, 6, kGmshPrism},
                            GmshType{13, 18, gmsh_curved(kGmshPrism)},
                            GmshType{18, 15, gmsh_curved(kGmshPrism)},
                            GmshType{7, 5, kGmshPyramid},
                            GmshType{14, 14, gmsh_curved(kGmshPyramid)},
                            GmshType{19, 13, gmsh_curved(kGmshPyramid)}};

class GmshReader {
 public:
  GmshReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name), in_(bytes, name) {}

  TriangleMesh read(MeshReadReport& report) {
    if (in_.peek() != "$MeshFormat") in_.fail(0, "a Gmsh file begins with $MeshFormat");
    bool nodes = false, elements = false;
    while (in_.more()) {
      const std::size_t start = in_.position();
      const std::string_view section = in_.word();
      if (section == "$MeshFormat") {
        read_format();
      } else if (section == "$Nodes") {
        read_nodes();
        nodes = true;
      } else if (section == "$Elements") {
        if (!nodes) in_.fail(start, "$Elements come before $Nodes; they have to come after them");
        read_elements();
        elements = true;
      } else if (!section.starts_with('$')) {
        in_.fail(start, in_quotes(section) + " stands where a section has to begin, such as $Nodes");
      }
      end_section(section, start);
    }
    if (!nodes || !elements) in_.fail(bytes_.size(), nodes ? "there are no $Elements" : "there are no $Nodes");
    return std::move(mesh_).finish(
        name_, [&](std::size_t at) { in_.fail(at, "the node needs three finite numbers, since an element uses it"); },
        [&](std::size_t at) { return in_.place(at); }, report);
  }

 private:
  // Skips the rest of a section and the line that ends it.
  void end_section(std::string_view section, std::size_t start) {
    const std::string end = "$End" + std::string(section.substr(1));
    const std::size_t found = bytes_.find(end, in_.position());
    if (found == std::string_view::npos) {
      in_.fail(start, "the file ends within " + in_quotes(section) + ", which needs the line " + in_quotes(end));
    }
    in_.move_to(found + end.size());
  }

  void read_format() {
    const std::size_t at = in_.position();
    const double version = in_.number();
    four_ = version >= 4;
    one_ = version >= 4.1;
    if (!((version >= 2 && version < 3) || (version >= 4 && version < 4.2)))
      in_.fail(at, "version " + std::to_string(version) +
                       " of the format cannot be read; save the mesh in version 2, 2.2, 4 or 4.1");
    const bool binary = in_.integer() != 0;
    const std::int64_t size = in_.integer();
    if (!binary) return;
    in_.line();
    if (in_.remaining() < 4) in_.fail_at_end();
    const bool little = MixedScanner::value_at<std::int32_t>(bytes_.data() + in_.position(), false) == 1;
    in_.set_binary(little == (std::endian::native == std::endian::little) ? std::endian::little : std::endian::big);
    if (in_.raw<std::int32_t>() != 1)
      in_.fail(in_.position() - 4, "the number 1, which tells the order of bytes, is missing");
    if (size != 8)
      in_.fail(at, "numbers of " + std::to_string(size) + " bytes cannot be read; save the mesh with 8 bytes");
  }

  // Reads a number as text, or as so many bytes.
  std::int64_t number32() { return in_.binary() ? in_.raw<std::int32_t>() : in_.integer(); }
  std::int64_t number64() { return in_.binary() ? in_.raw<std::int64_t>() : in_.integer(); }
  std::int64_t tag() { return one_ ? number64() : number32(); }
  double real() { return in_.binary() ? in_.raw<double>() : in_.number(); }
  // Reads a number of items in a header of version 2, which is text even in binary files.
  std::int64_t text_count() {
    const std::int64_t count = in_.integer();
    if (in_.binary()) in_.line();
    return count;
  }
  std::size_t bytes_each(std::size_t binary, std::size_t text) const { return in_.binary() ? binary : text; }

  void add_node(std::int64_t number) {
    const std::size_t at = in_.position();
    Point point;
    for (double& coordinate : point) coordinate = real();
    if (mesh_.vertices.size() + 1 >= kNone) in_.fail(at, "the file has too many nodes for 32-bit indices");
    const auto index = static_cast<Index>(mesh_.vertices.size());
    if (!nodes_.try_emplace(number, index).second) in_.fail(at, "node " + std::to_string(number) + " is defined twice");
    if (!point.allFinite()) mesh_.vertex_faults.add(index, at);
    mesh_.vertices.push_back(point);
  }

  void read_nodes() {
    if (!four_) {
      const std::uint64_t count = in_.checked_count(text_count(), bytes_each(28, 8), "nodes");
      for (std::uint64_t i = 0; i < count; ++i) add_node(number32());
      return;
    }
    if (in_.binary()) in_.line();
    const std::uint64_t blocks = in_.checked_count(number64(), 8, "blocks of nodes");
    const std::uint64_t all = in_.checked_count(number64(), bytes_each(24, 6), "nodes");
    if (one_) number64(), number64();
    std::vector<std::int64_t> numbers;
    for (std::uint64_t block = 0; block < blocks; ++block) {
      std::array<std::int64_t, 3> head{number32(), number32(), number32()};
      const std::int64_t dimension = one_ ? head[0] : head[1];
      const std::uint64_t count = in_.checked_count(number64(), bytes_each(24, 6), "nodes");
      if (count > all) in_.fail(in_.position(), "the block has more nodes than the section promises in all");
      numbers.resize(one_ ? count : 0);
      for (std::int64_t& number : numbers) number = number64();
      for (std::uint64_t i = 0; i < count; ++i) {
        add_node(one_ ? numbers[i] : number32());
        if (head[2] != 0)
          for (std::int64_t k = 0; k < std::clamp<std::int64_t>(dimension, 0, 3); ++k) real();
      }
    }
  }

  const GmshType& type_of(std::int64_t number, std::size_t at) const {
    const auto found = std::ranges::find_if(kGmshTypes, [&](const GmshType& type) { return type.number == number; });
    if (found == kGmshTypes.end())
      in_.fail(at,
               "elements of type " + std::to_string(number) + " of Gmsh cannot be read; save the mesh with order 1");
    return *found;
  }

  void add_element(const GmshType& type, std::size_t at) {
    corners_.clear();
    for (std::size_t i = 0; i < type.nodes; ++i) {
      const std::int64_t node = tag();
      const auto found = nodes_.find(node);
      if (found == nodes_.end())
        in_.fail(at, "an element names node " + std::to_string(node) + ", which the file does not have");
      corners_.push_back(found->second);
    }
    mesh_.add(type.kind, corners_, at);
  }

  void read_elements() {
    if (four_) return read_blocks();
    const std::uint64_t count = in_.checked_count(text_count(), bytes_each(8, 6), "elements");
    for (std::uint64_t done = 0; done < count;) {
      in_.more_of_text();
      const std::size_t at = in_.position();
      if (!in_.binary()) number32();
      const GmshType& type = type_of(number32(), at);
      const std::uint64_t rows = in_.binary() ? in_.checked_count(number32(), 8, "elements") : 1;
      const std::int64_t tags = number32();
      in_.checked_count(tags, bytes_each(4, 2), "tags");
      if (rows == 0 || rows > count - done)
        in_.fail(at, "the block has no elements, or more than the section promises in all");
      for (std::uint64_t row = 0; row < rows; ++row, ++done) {
        if (in_.binary()) number32();
        for (std::int64_t i = 0; i < tags; ++i) number32();
        add_element(type, at);
      }
    }
  }

  void read_blocks() {
    if (in_.binary()) in_.line();
    const std::uint64_t blocks = in_.checked_count(number64(), 8, "blocks of elements");
    number64();
    if (one_) number64(), number64();
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const std::size_t at = in_.position();
      number32(), number32();
      const GmshType& type = type_of(number32(), at);
      const std::size_t each = (type.nodes + 1) * (in_.binary() ? (one_ ? 8 : 4) : 2);
      const std::uint64_t count = in_.checked_count(number64(), each, "elements");
      for (std::uint64_t i = 0; i < count; ++i) {
        in_.more_of_text();
        const std::size_t element = in_.position();
        tag();
        add_element(type, element);
      }
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  MixedScanner in_;
  bool four_ = false, one_ = false;  // whether it is version 4 or later, and 4.1 or later
  CellMesh mesh_;
  std::unordered_map<std::int64_t, Index> nodes_;
  std::vector<Index> corners_;
};

}  // namespace

TriangleMesh read_gmsh(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return GmshReader(bytes, name).read(report);
}

}  // namespace orchard
