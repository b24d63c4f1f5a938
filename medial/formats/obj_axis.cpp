#include <algorithm>
#include <array>
#include <charconv>

#include "axis_text.h"

namespace orchard::detail {
namespace {

// The words that begin lines without information about an axis.
constexpr std::array<std::string_view, 15> kOther{"vn", "vt",     "vp",     "p",    "o",   "g",    "s",  "usemtl",
                                                  "mg", "mtllib", "cstype", "curv", "deg", "parm", "end"};

class ObjReader {
 public:
  ObjReader(TextLines lines, bool cg) : lines_(std::move(lines)), cg_(cg) {}

  ForeignAxis run() {
    while (lines_.next()) read_line(lines_.word());
    if (axis_.mesh.centers.empty())
      lines_.fail("the file has no vertices; lines \"v x y z\", or \"v x y z r\", are expected");
    const std::vector<double>& radii = axis_.mesh.radii;
    axis_.has_radii = columns_ == 4;
    if (columns_ == 4 && !cg_ && std::all_of(radii.begin(), radii.end(), [](double r) { return r == 1; })) {
      axis_.has_radii = false;
      axis_.notes.push_back("the fourth number of each vertex is 1, the weight of OBJ, not a radius");
    }
    if (!axis_.has_radii) axis_.mesh.radii.assign(axis_.mesh.centers.size(), 0);
    return std::move(axis_);
  }

 private:
  void read_line(std::string_view kind) {
    if (kind == "v") return read_vertex();
    if (kind == "f" && !cg_) return read_face();
    if (kind == (cg_ ? "e" : "l")) return read_polyline();
    if (std::find(kOther.begin(), kOther.end(), kind) == kOther.end())
      lines_.fail(std::string("this is no line of ") + (cg_ ? "a .cg" : "an .obj") +
                  " file; it may be of another kind");
  }

  void read_vertex() {
    const double x = lines_.real(), y = lines_.real(), z = lines_.real();
    std::array<double, 5> more{};
    std::size_t count = 0;
    while (count < more.size() && lines_.real_if_any(more[count])) ++count;
    if (!lines_.word().empty()) lines_.fail("the vertex has something that is not a finite number");
    // Three or four further numbers are a colour.
    const int columns = count == 1 ? 4 : 3;
    if (count == 2 || count == 5)
      lines_.fail("the vertex has " + std::to_string(3 + count) + " numbers; 3 or 4 are expected");
    if (columns_ != 0 && columns != columns_)
      lines_.fail(columns == 4 ? "the vertex has a radius, but those before it have none"
                               : "the vertex has no radius, but others have one");
    columns_ = columns;
    if (columns == 4 && more[0] < 0) lines_.fail("the radius is negative; it must be 0 or more");
    axis_.mesh.centers.emplace_back(x, y, z);
    axis_.mesh.radii.push_back(columns == 4 ? more[0] : 0);
  }

  // Returns the vertex of a word such as "7", "-1" or "7/2/3". Vertices are counted from 1, negative numbers from the
  // last one backwards.
  Index corner(std::string_view word) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || (end != word.data() + word.size() && *end != '/'))
      lines_.fail("expected the number of a vertex");
    const auto size = static_cast<std::int64_t>(axis_.mesh.centers.size());
    if (number < 0) number += size + 1;
    if (number < 1 || number > size)
      lines_.fail("the vertex number is beyond those read so far, " + std::to_string(size) + " (they count from 1)");
    return static_cast<Index>(number - 1);
  }
  std::vector<Index> corners(std::size_t min) {
    std::vector<Index> all;
    for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) all.push_back(corner(word));
    if (all.size() < min) lines_.fail("the line or face has fewer than " + std::to_string(min) + " vertices");
    return all;
  }

  void read_polyline() {
    const std::vector<Index> all = corners(2);
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      if (all[i] == all[i + 1]) lines_.fail("the line or face names a vertex twice");
      axis_.mesh.edges.push_back({all[i], all[i + 1]});
    }
  }
  // Reads a polygon, and divides it into a fan of triangles.
  void read_face() {
    const std::vector<Index> all = corners(3);
    std::vector<Index> sorted = all;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      lines_.fail("the line or face names a vertex twice");
    for (std::size_t i = 1; i + 1 < all.size(); ++i) axis_.mesh.triangles.push_back({all[0], all[i], all[i + 1]});
  }

  TextLines lines_;
  bool cg_;
  int columns_ = 0;  // how many numbers of each vertex count
  ForeignAxis axis_;
};

}  // namespace

ForeignAxis parse_obj_axis(TextLines lines, bool cg) {
  ForeignAxis axis = ObjReader(std::move(lines), cg).run();
  complete(axis.mesh);
  return axis;
}

}  // namespace orchard::detail
