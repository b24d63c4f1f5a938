#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "mesh_formats.h"
#include "polygons.h"
#include "text_scan.h"
#include "vertex_faults.h"

namespace orchard {
namespace {

// Reads the bytes in one pass. Lines are counted only when there is a fault to report.
class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& name, MeshReadReport& report)
      : bytes_(bytes), name_(name), report_(report), at_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  TriangleMesh read(bool needs_faces) {
    if (const void* zero = bytes_.empty() ? nullptr : std::memchr(bytes_.data(), 0, bytes_.size())) {
      fail_at_byte(name_, offset(static_cast<const char*>(zero)), "a zero byte; this is not an OBJ text file");
    }
    if (bytes_.starts_with("\xef\xbb\xbf")) at_ += 3;  // byte order mark
    while (at_ != end_) read_statement();
    for (const ForwardReference& face : forward_references_) {
      if (face.vertex >= mesh_.vertices.size()) {
        fail(face.at, "face names vertex " + std::to_string(face.vertex + std::uint64_t{1}) + ", but the file has " +
                          std::to_string(mesh_.vertices.size()) + " vertices");
      }
    }
    if (!needs_faces && mesh_.vertices.empty())
      throw InputError(name_ + ": no vertices (lines that begin with \"v\") in " + std::to_string(bytes_.size()) +
                       " bytes of OBJ");
    if (needs_faces && faces_.empty())
      throw InputError(name_ + ": no faces (lines that begin with \"f\" and name three corners or more) in " +
                       std::to_string(bytes_.size()) + " bytes of OBJ");
    const auto place = [&](std::size_t at) { return line_place(bytes_, at); };
    vertex_faults_.settle(
        mesh_.vertices, faces_,
        [&](std::size_t at) {
          fail(bytes_.data() + at, "vertex coordinate " + token(bytes_.data() + at) +
                                       " is not a finite number, and a face uses the vertex");
        },
        place, report_);
    if (mesh_.vertices.empty()) throw InputError(name_ + ": no vertices with finite coordinates in this OBJ file");
    mesh_.triangles = split_faces(std::move(faces_), mesh_.vertices, place, report_);
    return std::move(mesh_);
  }

 private:
  struct ForwardReference {
    const char* at;
    Index vertex;
  };

  std::size_t offset(const char* position) const { return static_cast<std::size_t>(position - bytes_.data()); }
  [[noreturn]] void fail(const char* position, const std::string& fault) const {
    fail_at_line(name_, bytes_, offset(position), fault);
  }
  std::string token(const char* position) const {
    const char* stop = position;
    while (stop != end_ && !is_blank(*stop) && !is_line_end(*stop)) ++stop;
    return in_quotes({position, stop});
  }

  // The place after the line end that follows a backslash at at_, which continues the line; 0 if there is none.
  std::ptrdiff_t continuation_length() const {
    if (end_ - at_ < 2 || *at_ != '\\') return 0;
    if (at_[1] == '\r' && end_ - at_ > 2 && at_[2] == '\n') return 3;
    return is_line_end(at_[1]) ? 2 : 0;
  }
  void skip_blanks() {
    while (at_ != end_) {
      if (is_blank(*at_)) {
        ++at_;
      } else if (const std::ptrdiff_t length = continuation_length()) {
        at_ += length;
      } else {
        return;
      }
    }
  }
  bool at_token_end() const { return at_statement_end() || is_blank(*at_) || continuation_length() != 0; }
  bool at_statement_end() const { return at_ == end_ || is_line_end(*at_) || *at_ == '#'; }

  // Moves to the end of the statement. A comment ends with its line even if that ends with a backslash.
  void skip_statement() {
    bool comment = false;
    while (at_ != end_ && !is_line_end(*at_)) {
      comment = comment || *at_ == '#';
      const std::ptrdiff_t length = *at_ == '\\' && !comment ? continuation_length() : 0;
      at_ += length > 0 ? length : 1;
    }
    while (at_ != end_ && is_line_end(*at_)) ++at_;
  }

  void read_statement() {
    skip_blanks();
    if (at_ == end_) return;
    const char* keyword = at_;
    const char first = *at_;
    if (first == 'v' || first == 'f') {
      ++at_;
      if (first == 'f' && at_ != end_ && *at_ == 'o') ++at_;  // the older name of "f"
      if (at_token_end()) first == 'v' ? read_vertex(keyword) : read_face(keyword);
    }
    skip_statement();
  }

  void read_vertex(const char* statement) {
    Point& vertex = mesh_.vertices.emplace_back();
    bool finite = true;
    for (int i = 0; i < 3; ++i) {
      skip_blanks();
      if (at_statement_end()) fail(statement, "vertex has " + std::to_string(i) + " coordinates; it needs 3");
      const char* number = at_;
      if (!scan_any_double(at_, end_, vertex[i]) || !at_token_end()) {
        fail(number, "vertex coordinate " + token(number) + " is not a number");
      }
      if (!std::isfinite(vertex[i]) && finite) {
        vertex_faults_.add(static_cast<Index>(mesh_.vertices.size() - 1), offset(number));
        finite = false;
      }
    }
    if (mesh_.vertices.size() >= kNone) fail(statement, "the file has too many vertices for 32-bit indices");
  }

  void read_face(const char* statement) {
    corners_.clear();
    Index highest = 0;
    for (skip_blanks(); !at_statement_end(); skip_blanks()) {
      corners_.push_back(read_corner());
      highest = std::max(highest, corners_.back());
    }
    if (corners_.size() < 3) {
      if (report_.faces_skipped.count++ == 0) report_.faces_skipped.first = line_place(bytes_, offset(statement));
      return;
    }
    // A later face is worth remembering only if it names a higher vertex.
    if (highest >= mesh_.vertices.size() &&
        (forward_references_.empty() || highest > forward_references_.back().vertex)) {
      forward_references_.push_back({statement, highest});
    }
    faces_.add(corners_, offset(statement));
  }

  // v, v/vt, v//vn or v/vt/vn. Texture and normal indices must be integers, but they are not looked up.
  Index read_corner() {
    const char* corner = at_;
    std::int64_t vertex = 0, unused = 0;
    bool good = scan_integer(at_, end_, vertex);
    for (int i = 0; good && i < 2 && at_ != end_ && *at_ == '/'; ++i) {
      ++at_;
      if (!at_token_end() && *at_ != '/') good = scan_integer(at_, end_, unused);
    }
    if (!good || !at_token_end()) {
      fail(corner, "face corner " + token(corner) + " is none of v, v/vt, v//vn, v/vt/vn");
    }
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    if (vertex == 0) fail(corner, "face names vertex 0; OBJ counts from 1");
    if (vertex < -count) {
      fail(corner, "face names vertex " + std::to_string(vertex) + ", but only " + std::to_string(count) +
                       " vertices come before it");
    }
    if (vertex >= kNone) fail(corner, "face names vertex " + std::to_string(vertex) + ", beyond 32-bit indices");
    return static_cast<Index>(vertex > 0 ? vertex - 1 : count + vertex);
  }

  std::string_view bytes_;
  const std::string& name_;
  MeshReadReport& report_;
  const char* at_;
  const char* end_;
  TriangleMesh mesh_;
  FaceCollector faces_;
  VertexFaults vertex_faults_;
  std::vector<Index> corners_;
  std::vector<ForwardReference> forward_references_;  // ascending by vertex
};

}  // namespace

TriangleMesh read_obj(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return ObjReader(bytes, name, report).read(true);
}

TriangleMesh read_obj_or_points(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return ObjReader(bytes, name, report).read(false);
}

}  // namespace orchard
