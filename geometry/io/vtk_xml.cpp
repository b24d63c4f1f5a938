#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh_formats.h"
#include "text_scan.h"
#include "vtk_cells.h"
#include "vtk_xml_data.h"
#include "xml_tags.h"

namespace orchard {
namespace {

// A <Piece> with its arrays, by the name of their section and their own name, such as "Polys/connectivity".
struct VtkPiece {
  std::size_t at = 0;
  std::uint64_t points = 0;
  std::map<std::string, VtkArray, std::less<>> arrays;
};

class VtkXmlReader {
 public:
  VtkXmlReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name), tags_(bytes, name) {}

  TriangleMesh read(MeshReadReport& report) {
    read_head();
    while (tags_.next() && take_tag()) {
    }
    if (!closed_) fail(bytes_.size(), "the file ends before </VTKFile>; it may be cut off");
    if (pieces_.empty()) throw InputError(name_ + ": the file has no <Piece>");
    for (const VtkPiece& piece : pieces_) add(piece);
    return std::move(mesh_).finish(
        name_, [&](std::size_t at) { fail(at, "a point needs three finite numbers, since a cell uses it"); },
        [&](std::size_t at) { return line_place(bytes_, at); }, report);
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& fault) const { fail_at_line(name_, bytes_, at, fault); }

  void read_head() {
    if (!tags_.next() || tags_.tag().name != "VTKFile")
      fail(0, "this is no XML file of VTK, since it does not begin with <VTKFile>");
    const XmlTags::Tag& tag = tags_.tag();
    const std::string_view type = tag.value("type"), compressor = tag.value("compressor");
    grid_ = type == "UnstructuredGrid";
    if (!grid_ && type != "PolyData")
      fail(tag.at, "the file has the type " + in_quotes(type) +
                       ", but only PolyData and UnstructuredGrid can be read; save its surface as .vtp");
    if (tag.value("byte_order") == "BigEndian") encoding_.order = std::endian::big;
    encoding_.wide_heads = tag.value("header_type") == "UInt64";
    encoding_.compressed = !compressor.empty();
    if (encoding_.compressed && compressor != "vtkZLibDataCompressor")
      fail(tag.at,
           "the data are compressed by " + in_quotes(compressor) + "; save it with zlib or without compression");
  }

  // Returns false where appended data begin, because the text ends there.
  bool take_tag() {
    const XmlTags::Tag& tag = tags_.tag();
    if (tag.name == "VTKFile") return closed_ = tag.closes, !closed_;
    if (tag.name == "AppendedData" && tag.opens) return begin_appended(), false;
    if (tag.name == "Piece") {
      section_.clear();
      if (tag.opens) pieces_.push_back({tag.at, number_of(tag, "NumberOfPoints"), {}});
    } else if (tag.name == "DataArray") {
      if (tag.opens && !pieces_.empty() && !section_.empty()) take_array();
    } else if (is_section(tag.name)) {
      section_ = tag.opens && !tag.closes ? std::string(tag.name) : std::string();
    }
    return true;
  }

  // Other tags, such as the <InformationKey> of an array, belong to the array or section that contains them.
  static bool is_section(std::string_view name) {
    for (const std::string_view section :
         {"Points", "Polys", "Strips", "Lines", "Verts", "Cells", "PointData", "CellData", "FieldData"})
      if (name == section) return true;
    return false;
  }

  void begin_appended() {
    const XmlTags::Tag tag = tags_.tag();
    encoding_.base64 = tag.value("encoding", "base64") != "raw";
    const std::size_t mark = bytes_.find_first_not_of(" \t\r\n", tag.end);
    if (mark == std::string_view::npos || bytes_[mark] != '_')
      fail(tag.at, "the appended data do not begin with an underscore");
    encoding_.appended = mark + 1;
    closed_ = true;  // the end of the data of an array is where this tag begins
  }

  std::uint64_t number_of(const XmlTags::Tag& tag, std::string_view attribute) const {
    const std::string_view text = tag.value(attribute, "0");
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size())
      fail(tag.at, std::string(attribute) + " is " + in_quotes(text) + ", which is no number");
    return value;
  }

  void take_array() {
    const XmlTags::Tag tag = tags_.tag();
    VtkArray array{.type = tag.value("type"), .format = tag.value("format", "ascii"), .at = tag.at, .offset = {}};
    if (array.format == "appended") array.offset = number_of(tag, "offset");
    array.begin = array.end = tag.end;
    if (!tag.closes) {
      array.end = std::min(bytes_.find('<', tag.end), bytes_.size());
      if (array.end == bytes_.size()) fail(tag.at, "the file ends within this array; it may be cut off");
    }
    const std::string name = section_ == "Points" ? "" : std::string(tag.value("Name"));
    pieces_.back().arrays.try_emplace(section_ + "/" + name, array);
  }

  static const VtkArray* find(const VtkPiece& piece, std::string_view name) {
    const auto found = piece.arrays.find(name);
    return found == piece.arrays.end() ? nullptr : &found->second;
  }

  void add_points(const VtkPiece& piece, const VtkXmlData& data) {
    const VtkArray* array = find(piece, "Points/");
    if (array == nullptr) fail(piece.at, "the piece has no <Points>");
    const std::vector<double> numbers = data.reals(*array);
    if (numbers.size() % 3 != 0 || numbers.size() / 3 != piece.points)
      fail(array->at,
           std::to_string(numbers.size()) + " coordinates do not fit " + std::to_string(piece.points) + " points");
    if (mesh_.vertices.size() + piece.points >= kNone)
      fail(piece.at, "the file has too many points for 32-bit indices");
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      const Point point(numbers[i], numbers[i + 1], numbers[i + 2]);
      if (!point.allFinite()) mesh_.vertex_faults.add(static_cast<Index>(mesh_.vertices.size()), array->at);
      mesh_.vertices.push_back(point);
    }
  }

  std::optional<VtkCells> cells_of(const VtkPiece& piece, const VtkXmlData& data, const std::string& section) const {
    const VtkArray* connectivity = find(piece, section + "/connectivity");
    const VtkArray* offsets = find(piece, section + "/offsets");
    if (connectivity == nullptr || offsets == nullptr) return std::nullopt;
    VtkCells cells;
    cells.connectivity = data.integers(*connectivity);
    const std::vector<std::int64_t> ends = data.integers(*offsets);
    cells.offsets.insert(cells.offsets.end(), ends.begin(), ends.end());
    cells.first_point = static_cast<Index>(mesh_.vertices.size() - piece.points);
    cells.points = static_cast<Index>(piece.points);
    cells.at = connectivity->at;
    cells.fail = [this](std::size_t at, const std::string& fault) { fail(at, fault); };
    return cells;
  }

  void add(const VtkPiece& piece) {
    if (piece.points == 0) return;
    const VtkXmlData data(bytes_, name_, encoding_);
    add_points(piece, data);
    if (grid_) return add_grid(piece, data);
    for (const auto& [section, shape] :
         {std::pair{"Polys", CellShape::polygon}, std::pair{"Strips", CellShape::strip},
          std::pair{"Lines", CellShape::ignored}, std::pair{"Verts", CellShape::ignored}})
      if (const auto cells = cells_of(piece, data, section)) add_vtk_polygons(*cells, shape, mesh_);
  }

  void add_grid(const VtkPiece& piece, const VtkXmlData& data) {
    const std::optional<VtkCells> cells = cells_of(piece, data, "Cells");
    const VtkArray* types = find(piece, "Cells/types");
    if (!cells || types == nullptr) fail(piece.at, "the piece lacks the connectivity, offsets or types of <Cells>");
    const VtkArray *faces = find(piece, "Cells/faces"), *ends = find(piece, "Cells/faceoffsets");
    using Numbers = std::vector<std::int64_t>;
    add_vtk_cells(*cells, data.integers(*types), faces == nullptr ? Numbers() : data.integers(*faces),
                  ends == nullptr ? Numbers() : data.integers(*ends), mesh_);
  }

  std::string_view bytes_;
  const std::string& name_;
  XmlTags tags_;
  VtkEncoding encoding_;
  bool grid_ = false, closed_ = false;
  std::string section_;
  std::vector<VtkPiece> pieces_;
  CellMesh mesh_;
};

}  // namespace

TriangleMesh read_vtk_xml(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return VtkXmlReader(bytes, name).read(report);
}

}  // namespace orchard
