#include <cmath>
#include <cstring>
#include <optional>

#include "mesh_formats.h"
#include "text_scan.h"

namespace orchard {
namespace {

bool separates(char c) { return is_blank(c) || c == ',' || c == ';'; }

// Reads the file in one pass. A statement is a line.
class XyzReader {
 public:
  XyzReader(std::string_view bytes, const std::string& name, MeshReadReport& report)
      : bytes_(bytes), name_(name), report_(report), at_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  TriangleMesh read() {
    if (const void* zero = bytes_.empty() ? nullptr : std::memchr(bytes_.data(), 0, bytes_.size()))
      fail_at_byte(name_, offset(static_cast<const char*>(zero)), "a zero byte; this is not a text file of points");
    if (bytes_.starts_with("\xef\xbb\xbf")) at_ += 3;  // byte order mark
    while (at_ != end_) {
      skip_separators();
      if (!at_line_end()) read_line();
      while (at_ != end_ && !is_line_end(*at_)) ++at_;
      while (at_ != end_ && is_line_end(*at_)) ++at_;
    }
    // what looked like a header is all that the file contains
    if (header_) fail(*header_);
    if (mesh_.vertices.empty())
      throw InputError(name_ + ": there are no points in the " + std::to_string(bytes_.size()) + " bytes of XYZ");
    return std::move(mesh_);
  }

 private:
  struct Fault {
    std::size_t at;
    std::string text;
  };
  [[noreturn]] void fail(const Fault& fault) const { fail_at_line(name_, bytes_, fault.at, fault.text); }
  std::size_t offset(const char* position) const { return static_cast<std::size_t>(position - bytes_.data()); }
  bool at_line_end() const { return at_ == end_ || is_line_end(*at_) || *at_ == '#'; }
  void skip_separators() {
    while (at_ != end_ && separates(*at_)) ++at_;
  }

  // Lines before the first point that are not points themselves are a header: names of columns, or the number of
  // points.
  void read_line() {
    if (mesh_.vertices.size() + 1 >= kNone)
      fail_at_line(name_, bytes_, offset(at_), "too many points for 32-bit indices");
    const std::size_t line = offset(at_);
    Point point;
    if (const std::optional<Fault> fault = read_point(point)) {
      if (points_ > 0) fail(*fault);
      if (report_.header_lines++ == 0) header_ = fault;
      return;
    }
    header_.reset();
    ++points_;
    if (point.allFinite()) {
      mesh_.vertices.push_back(point);
    } else if (report_.vertices_skipped.count++ == 0) {
      report_.vertices_skipped.first = line_place(bytes_, line);
    }
  }

  // Returns what is wrong with the line, if anything.
  std::optional<Fault> read_point(Point& point) {
    const char* line = at_;
    for (int axis = 0; axis < 3; ++axis) {
      skip_separators();
      if (at_line_end()) return Fault{offset(line), "a point has " + std::to_string(axis) + " coordinates; it needs 3"};
      const char* number = at_;
      if (scan_any_double(at_, end_, point[axis]) && (at_line_end() || separates(*at_))) continue;
      while (!at_line_end() && !separates(*at_)) ++at_;
      return Fault{offset(number), "coordinate " + in_quotes({number, at_}) + " is not a number"};
    }
    return std::nullopt;
  }

  std::string_view bytes_;
  const std::string& name_;
  MeshReadReport& report_;
  const char* at_;
  const char* end_;
  std::uint64_t points_ = 0;     // including those that are skipped
  std::optional<Fault> header_;  // why the first line is not a point; empty once a point has been read
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_xyz(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return XyzReader(bytes, name, report).read();
}

}  // namespace orchard
