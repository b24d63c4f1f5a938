#include <cmath>
#include <cstring>

#include "mesh_formats.h"
#include "text_scan.h"

namespace orchard {
namespace {

bool separates(char c) { return is_blank(c) || c == ','; }

// One pass over the bytes; a statement is a line.
class XyzReader {
 public:
  XyzReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), at_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  TriangleMesh read() {
    if (const void* zero = bytes_.empty() ? nullptr : std::memchr(bytes_.data(), 0, bytes_.size()))
      fail_at_byte(name_, offset(static_cast<const char*>(zero)), "a zero byte; this is not a text file of points");
    if (bytes_.starts_with("\xef\xbb\xbf")) at_ += 3;  // byte order mark
    while (at_ != end_) {
      skip_separators();
      if (!at_line_end()) read_point();
      while (at_ != end_ && !is_line_end(*at_)) ++at_;
      while (at_ != end_ && is_line_end(*at_)) ++at_;
    }
    if (mesh_.vertices.empty())
      throw InputError(name_ + ": no points in " + std::to_string(bytes_.size()) + " bytes of XYZ");
    return std::move(mesh_);
  }

 private:
  std::size_t offset(const char* position) const { return static_cast<std::size_t>(position - bytes_.data()); }
  bool at_line_end() const { return at_ == end_ || is_line_end(*at_) || *at_ == '#'; }
  void skip_separators() {
    while (at_ != end_ && separates(*at_)) ++at_;
  }

  void read_point() {
    if (mesh_.vertices.size() + 1 >= kNone)
      fail_at_line(name_, bytes_, offset(at_), "too many points for 32-bit indices");
    Point& point = mesh_.vertices.emplace_back();
    const char* line = at_;
    for (int axis = 0; axis < 3; ++axis) {
      skip_separators();
      if (at_line_end())
        fail_at_line(name_, bytes_, offset(line), "a point has " + std::to_string(axis) + " coordinates; it needs 3");
      const char* number = at_;
      const bool good = scan_double(at_, end_, point[axis]) && (at_line_end() || separates(*at_));
      if (good && std::isfinite(point[axis])) continue;
      while (!at_line_end() && !separates(*at_)) ++at_;
      fail_at_line(name_, bytes_, offset(number), "coordinate " + in_quotes({number, at_}) + " is not a finite number");
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  const char* at_;
  const char* end_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_xyz(std::string_view bytes, const std::string& name) { return XyzReader(bytes, name).read(); }

}  // namespace orchard
