#include "orchard/geometry/text_lines.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {
namespace {

class MaReader {
 public:
  explicit MaReader(const std::filesystem::path& file) : lines_(file) {}

  MedialMesh run() {
    if (!lines_.next()) lines_.fail("is empty; a .ma file starts with its numbers of vertices, edges and faces");
    vertices_ = lines_.index();
    const Index edges = lines_.index(), faces = lines_.index();
    if (vertices_ == 0) lines_.fail("promises no vertices");
    for (Index i = 0; i < vertices_; ++i) read_vertex();
    for (Index i = 0; i < edges; ++i) mesh_.edges.push_back(corners<2>("e"));
    for (Index i = 0; i < faces; ++i) mesh_.triangles.push_back(corners<3>("f"));
    complete(mesh_);
    return std::move(mesh_);
  }

 private:
  void read_vertex() {
    lines_.expect("v");
    const double x = lines_.real(), y = lines_.real(), z = lines_.real(), radius = lines_.real();
    if (radius < 0) lines_.fail("a negative radius");
    mesh_.centers.emplace_back(x, y, z);
    mesh_.radii.push_back(radius);
  }
  template <std::size_t kCorners>
  std::array<Index, kCorners> corners(std::string_view kind) {
    lines_.expect(kind);
    std::array<Index, kCorners> result;
    for (std::size_t k = 0; k < kCorners; ++k) {
      result[k] = lines_.index();
      if (result[k] >= vertices_) lines_.fail("a vertex number beyond the last vertex (they count from 0)");
      for (std::size_t before = 0; before < k; ++before) {
        if (result[before] == result[k]) lines_.fail("a vertex number twice");
      }
    }
    return result;
  }

  TextLines lines_;
  Index vertices_ = 0;
  MedialMesh mesh_;
};

}  // namespace

std::string to_ma(const MedialMesh& mesh) {
  std::string text = std::to_string(mesh.centers.size()) + ' ' + std::to_string(mesh.edges.size()) + ' ' +
                     std::to_string(mesh.triangles.size()) + '\n';
  for (std::size_t i = 0; i < mesh.centers.size(); ++i) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) append_number(text, mesh.centers[i][axis]);
    append_number(text, mesh.radii[i]);
    text += '\n';
  }
  for (const auto& [a, b] : mesh.edges) {
    text += 'e';
    append_number(text, a), append_number(text, b);
    text += '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += 'f';
    append_number(text, a), append_number(text, b), append_number(text, c);
    text += '\n';
  }
  return text;
}

MedialMesh read_ma(const std::filesystem::path& file) { return MaReader(file).run(); }

}  // namespace orchard
