#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "line_scanner.h"
#include "orchard/geometry/error.h"
#include "soup_guards.h"

namespace orchard {
namespace {

class OffChecker {
 public:
  OffChecker(std::string_view bytes, const std::string& name, MeshReadReport& report)
      : bytes_(bytes),
        name_(name),
        report_(report),
        line_(bytes, bytes.starts_with("\xef\xbb\xbf") ? 3 : 0, '#', name) {}

  CheckedOff run() {
    read_counts();
    std::string vertices;
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      if (!line_.next()) fail_at_end(i, vertices_, "vertices");
      std::array<double, 3> point = line_.point();
      if (!std::ranges::all_of(point, [](double coordinate) { return std::isfinite(coordinate); })) {
        checked_.vertex_faults.add(static_cast<Index>(i), line_.start());
        point = {0, 0, 0};
      }
      append_point(vertices, point);
    }
    for (std::uint64_t i = 0; i < faces_; ++i) {
      if (!line_.next()) fail_at_end(i, faces_, "faces");
      read_face();
    }
    if (checked_.face_at.empty()) throw InputError(name_ + ": the file has no faces with three or more corners");
    checked_.bytes = "OFF\n" + std::to_string(vertices_) + " " + std::to_string(checked_.face_at.size()) + " 0\n" +
                     vertices + face_lines_;
    return std::move(checked_);
  }

 private:
  [[noreturn]] void fail_at_end(std::uint64_t found, std::uint64_t promised, const char* what) const {
    std::string fault = "the file ends after " + std::to_string(found) + " of " + std::to_string(promised) + " " + what;
    if (first_continued_ > 0) {
      const std::size_t at = line_number(bytes_, first_continued_);
      fault += "; the face of line " + std::to_string(at) + " has too few corners there and took the next lines' words";
    }
    line_.fail(fault);
  }

  // Reads "OFF", which may be missing, and the numbers of vertices and faces after it. They may follow with or without
  // a blank, or on the next line.
  void read_counts() {
    if (!line_.next()) throw InputError(name_ + ": the file has nothing but comments; this is not an OFF file");
    std::optional<std::uint64_t> vertices = line_.count();
    if (!vertices) {
      vertices = count_after(line_.word());
      if (!vertices) vertices = line_.count();
    }
    if (!vertices) {
      const std::string_view other = line_.word();
      if (!other.empty())
        line_.fail(in_quotes(other) + " follows OFF, but only text files can be read; save the mesh as text");
      if (!line_.next()) line_.fail("the file ends after its first line; it may be cut off");
      vertices = line_.count();
    }
    const std::optional<std::uint64_t> faces = line_.count();
    if (!vertices || !faces) line_.fail("expected the numbers of vertices, faces and edges");
    // The shortest vertex is "0 0 0" and the shortest face "3 0 0 0", each with a line end; the last may be missing.
    if (*vertices > line_.left() / 6 || *faces > line_.left() / 8 + 1) {
      line_.fail("the file promises " + std::to_string(*vertices) + " vertices and " + std::to_string(*faces) +
                 " faces, but only " + std::to_string(line_.left()) + " bytes are left");
    }
    vertices_ = *vertices;
    faces_ = *faces;
  }

  // The number that follows the keyword without a blank, as in "OFF8 6 12"; nothing if there is none.
  std::optional<std::uint64_t> count_after(std::string_view keyword) const {
    // The prefix announces normals, colours or texture coordinates after each vertex's position. Without the prefix
    // they are ignored.
    const std::size_t prefix = std::min(keyword.find_first_not_of("STCN"), keyword.size());
    const std::string_view number = keyword.substr(std::min(prefix + 3, keyword.size()));
    std::int64_t count = 0;
    const char* at = number.data();
    const bool good =
        number.empty() || (scan_integer(at, number.data() + number.size(), count) && at == number.end() && count >= 0);
    if (!keyword.substr(prefix).starts_with("OFF") || !good) {
      line_.fail("expected OFF instead of " + in_quotes(keyword) + "; files of other dimensions cannot be read");
    }
    if (number.empty()) return std::nullopt;
    return static_cast<std::uint64_t>(count);
  }

  // A face may take several lines. What follows its last corner on the same line is its colour.
  void read_face() {
    const std::size_t start = line_.start();
    const std::optional<std::uint64_t> corners = line_.count();
    if (!corners) line_.fail("a face has to begin with the number of its corners, 3 or more");
    const bool skipped = *corners < 3;
    std::string face;
    append_digits(face, *corners);
    for (std::uint64_t j = 0; j < *corners; ++j) {
      const bool found = line_.more();
      if (first_continued_ == 0 && line_.start() != start) first_continued_ = start;
      const std::optional<std::uint64_t> vertex = found ? line_.count() : std::nullopt;
      if (!vertex || *vertex >= vertices_) {
        if (!found) line_.fail("the file ends before corner " + std::to_string(j + 1) + " of the face");
        line_.fail("corner " + std::to_string(j + 1) + " of the face is none of the " + std::to_string(vertices_) +
                   " vertices, counted from 0");
      }
      append_digits(face += ' ', *vertex);
    }
    if (skipped) {
      if (report_.faces_skipped.count++ == 0) report_.faces_skipped.first = line_place(bytes_, start);
      return;
    }
    checked_.face_at.push_back(start);
    face_lines_ += face += '\n';
  }

  std::string_view bytes_;
  const std::string& name_;
  MeshReadReport& report_;
  LineScanner line_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  std::size_t first_continued_ = 0;  // where the first face begins that takes several lines; 0 if there is none
  CheckedOff checked_;
  std::string face_lines_;
};

}  // namespace

CheckedOff checked_off(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return OffChecker(bytes, name, report).run();
}

}  // namespace orchard
