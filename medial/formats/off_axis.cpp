#include <algorithm>

#include "axis_text.h"

namespace orchard::detail {
namespace {

// Reads the numbers of an OFF file, whose lines may be broken anywhere.
class OffReader {
 public:
  explicit OffReader(TextLines lines) : lines_(std::move(lines)) {}

  ForeignAxis run() {
    if (!lines_.next() || lines_.word() != "OFF") lines_.fail("expected a file that begins with \"OFF\"");
    vertices_ = count("the number of vertices");
    const Index faces = count("the number of faces");
    count("the number of edges");
    if (vertices_ == 0) lines_.fail("the file promises no vertices");
    axis_.has_radii = false;
    for (Index i = 0; i < vertices_; ++i) {
      if (!lines_.next()) lines_.fail("the file ends after " + std::to_string(i) + " vertices; it may be cut off");
      const double x = lines_.real(), y = lines_.real(), z = lines_.real();
      axis_.mesh.centers.emplace_back(x, y, z);
      axis_.mesh.radii.push_back(0);
    }
    for (Index i = 0; i < faces; ++i) read_face();
    return std::move(axis_);
  }

 private:
  Index count(std::string_view what) { return lines_.index_on_any_line(what); }

  void read_face() {
    const Index size = count("the number of corners of a face");
    if (size < 2) lines_.fail("the face has fewer than two corners");
    std::vector<Index> corners;
    for (Index k = 0; k < size; ++k) {
      corners.push_back(count("the corner of a face"));
      if (corners.back() >= vertices_) lines_.fail("the vertex number is beyond the last vertex (they count from 0)");
      if (std::find(corners.begin(), corners.end() - 1, corners.back()) != corners.end() - 1)
        lines_.fail("the face names a vertex twice");
      if (corners.size() > 64) lines_.fail("the face has more than 64 corners");
    }
    lines_.skip_line();  // skips the colour of a face
    if (size == 2) axis_.mesh.edges.push_back({corners[0], corners[1]});
    for (Index k = 1; k + 1 < size; ++k) axis_.mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
  }

  TextLines lines_;
  Index vertices_ = 0;
  ForeignAxis axis_;
};

}  // namespace

ForeignAxis parse_off_axis(TextLines lines) {
  ForeignAxis axis = OffReader(std::move(lines)).run();
  complete(axis.mesh);
  return axis;
}

}  // namespace orchard::detail
