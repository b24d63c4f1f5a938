#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh_formats.h"
#include "ply_body.h"
#include "ply_header.h"
#include "polygons.h"
#include "text_scan.h"
#include "vertex_faults.h"

namespace orchard {
namespace {

template <typename Body>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, std::string_view bytes, const std::string& name, Body body, MeshReadReport& report)
      : header_(header), bytes_(bytes), name_(name), body_(body), report_(report) {}

  TriangleMesh read(bool needs_faces) {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") vertex_count_ = element.rows;
    }
    for (const PlyElement& element : header_.elements) read_element(element);
    if (needs_faces && faces_.empty()) throw InputError(name_ + ": the PLY file has no faces");
    if (mesh_.vertices.empty()) throw InputError(name_ + ": the PLY file has no vertices");
    const auto place = [&](std::size_t at) { return body_.place(at); };
    vertex_faults_.settle(
        mesh_.vertices, faces_,
        [&](std::size_t at) { body_.fail(at, "a coordinate of a vertex that a face uses is not a finite number"); },
        place, report_);
    if (mesh_.vertices.empty()) throw InputError(name_ + ": the PLY file has no vertices with finite coordinates");
    mesh_.triangles = split_faces(std::move(faces_), mesh_.vertices, place, report_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail_in_header(const PlyElement& element, const std::string& fault) const {
    fail_at_line(name_, bytes_, element.at, "element " + in_quotes(element.name) + " " + fault);
  }

  void read_element(const PlyElement& element) {
    // The count in a header is limited by the number of bytes that follow.
    const std::size_t row_bytes = element.min_row_bytes(header_.encoding);
    if (row_bytes > 0 && element.rows > body_.remaining() / row_bytes + (header_.encoding == PlyEncoding::ascii)) {
      fail_in_header(element, "promises " + std::to_string(element.rows) + " rows, but only " +
                                  std::to_string(body_.remaining()) + " bytes are left for them");
    }
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_corner_lists(element, &PlyReader::read_face);
    if (element.name == "tristrips") return read_corner_lists(element, &PlyReader::read_strips);
    if (row_bytes == 0) return;
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      for (const PlyProperty& property : element.properties) skip(property);
    }
  }

  void skip(const PlyProperty& property) {
    body_.skip(property.type, property.length_type ? list_length(property) : 1);
  }

  std::uint64_t list_length(const PlyProperty& property) {
    const std::size_t start = body_.position();
    const std::int64_t length = body_.integer(*property.length_type);
    if (length < 0 || static_cast<std::uint64_t>(length) > body_.remaining() / body_.min_bytes(property.type)) {
      body_.fail(start, "a list of " + std::to_string(length) + " items, which the rest of the file cannot hold");
    }
    return static_cast<std::uint64_t>(length);
  }

  void read_vertices(const PlyElement& element) {
    std::vector<int> axes(element.properties.size(), -1);  // the coordinate that each property holds
    for (const int axis : {0, 1, 2}) {
      const std::string coordinate(1, "xyz"[axis]);
      const std::optional<std::size_t> property = element.find(coordinate);
      if (!property || element.properties[*property].length_type) {
        fail_in_header(element, "has no number \"" + coordinate + "\"");
      }
      axes[*property] = axis;
    }
    if (element.rows >= kNone) fail_in_header(element, "has too many rows for 32-bit indices");
    mesh_.vertices.resize(element.rows);
    for (Point& vertex : mesh_.vertices) {
      bool finite = true;
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (axes[i] < 0) {
          skip(property);
          continue;
        }
        const std::size_t start = body_.position();
        vertex[axes[i]] = body_.number(property.type);
        if (std::isfinite(vertex[axes[i]]) || !finite) continue;
        vertex_faults_.add(static_cast<Index>(&vertex - mesh_.vertices.data()), start);
        finite = false;
      }
    }
  }

  void read_corner_lists(const PlyElement& element, void (PlyReader::*read_list)(const PlyProperty&)) {
    std::optional<std::size_t> indices = element.find("vertex_indices");
    if (!indices) indices = element.find("vertex_index");
    if (!indices || !element.properties[*indices].length_type) {
      fail_in_header(element, "has no list \"vertex_indices\"");
    }
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        i == *indices ? (this->*read_list)(element.properties[i]) : skip(element.properties[i]);
      }
    }
  }

  void read_face(const PlyProperty& property) {
    const std::size_t start = body_.position();
    const std::uint64_t length = list_length(property);
    if (length < 3) {
      body_.skip(property.type, length);
      if (report_.faces_skipped.count++ == 0) report_.faces_skipped.first = body_.place(start);
      return;
    }
    corners_.clear();
    for (std::uint64_t i = 0; i < length; ++i) {
      const std::size_t at = body_.position();
      corners_.push_back(corner(at, body_.integer(property.type), "face"));
    }
    faces_.add(corners_, start);
  }

  // Reads strips of triangles one after another. Each ends with -1 or with the list. Every corner after the second
  // forms a triangle with the two before it, and every second triangle of a strip is reversed, so that all face the
  // same way. Repeated corners connect a strip to another place; their triangles have no area and belong to no face.
  void read_strips(const PlyProperty& property) {
    const std::uint64_t length = list_length(property);
    std::uint64_t place = 0;  // position in the strip
    Index before = 0, last = 0;
    for (std::uint64_t i = 0; i < length; ++i) {
      const std::size_t at = body_.position();
      const std::int64_t vertex = body_.integer(property.type);
      if (vertex == -1) {
        place = 0;
        continue;
      }
      const Index next = corner(at, vertex, "strip of triangles");
      if (place >= 2 && before != last && last != next && next != before) {
        const bool turned = place % 2 != 0;
        faces_.add(std::array{turned ? last : before, turned ? before : last, next});
      }
      before = last;
      last = next;
      ++place;
    }
  }

  Index corner(std::size_t at, std::int64_t vertex, const char* of) const {
    if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertex_count_) {
      body_.fail(at, "a " + std::string(of) + " names vertex " + std::to_string(vertex) + ", but the file has " +
                         std::to_string(vertex_count_) + " vertices, counted from 0");
    }
    return static_cast<Index>(vertex);
  }

  const PlyHeader& header_;
  std::string_view bytes_;
  const std::string& name_;
  Body body_;
  MeshReadReport& report_;
  std::uint64_t vertex_count_ = 0;
  TriangleMesh mesh_;
  FaceCollector faces_;
  VertexFaults vertex_faults_;
  std::vector<Index> corners_;
};

}  // namespace

namespace {

TriangleMesh read(std::string_view bytes, const std::string& name, bool needs_faces, MeshReadReport& report) {
  const PlyHeader header = read_ply_header(bytes, name);
  if (header.encoding == PlyEncoding::ascii) {
    return PlyReader(header, bytes, name, AsciiBody(bytes, header.body, name), report).read(needs_faces);
  }
  const std::endian order = header.encoding == PlyEncoding::little_endian ? std::endian::little : std::endian::big;
  return PlyReader(header, bytes, name, BinaryBody(bytes, header.body, order, name), report).read(needs_faces);
}

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return read(bytes, name, true, report);
}

TriangleMesh read_ply_or_points(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return read(bytes, name, false, report);
}

}  // namespace orchard
