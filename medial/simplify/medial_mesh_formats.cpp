#include "orchard/medial/medial_mesh_formats.h"

#include <string>

#include "../axis/incidence.h"
#include "orchard/geometry/text_lines.h"
#include "orchard/medial/structure.h"

namespace orchard {
namespace {

void append_place(std::string& text, const Point& place) {
  for (int axis = 0; axis < 3; ++axis) append_number(text, place[axis]);
}

}  // namespace

FlaggedMedialMesh with_feature_flags(const MedialMesh& mesh) {
  FlaggedMedialMesh flagged{mesh, std::vector<CellFlags>(mesh.centers.size()),
                            std::vector<CellFlags>(mesh.edges.size()), std::vector<CellFlags>(mesh.triangles.size())};
  const detail::CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  for (CellFlags& vertex : flagged.vertices) vertex.type = -1;
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b] = mesh.edges[e];
    const std::size_t triangles = at.triangles_at[e].size();
    if (!(mesh.radii[a] > 0) && !(mesh.radii[b] > 0)) {
      flagged.edges[e].type = 2;
    } else if (triangles != 1 && triangles != 2) {
      flagged.edges[e].type = 1;
    }
  }
  return flagged;
}

namespace {

std::string contact_elements(const AxisContacts& contacts) {
  return "element contact " + std::to_string(contacts.balls.size()) +
         "\nproperty int ball\nproperty int sample\nelement sample " + std::to_string(contacts.sample_places.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nproperty int ball\n";
}

void append_contacts(std::string& text, const AxisContacts& contacts) {
  for (std::size_t i = 0; i < contacts.balls.size(); ++i)
    text += std::to_string(contacts.balls[i]) + ' ' + std::to_string(contacts.samples[i]) + '\n';
  for (std::size_t i = 0; i < contacts.sample_places.size(); ++i) {
    std::string line;
    append_place(line, contacts.sample_places[i]);
    text.append(line, 1);
    const Index ball = contacts.sample_balls[i];
    text += ball == kNone ? " -1\n" : ' ' + std::to_string(ball) + '\n';
  }
}

}  // namespace

std::string to_ply(const MedialMesh& mesh, const AxisContacts* contacts) {
  const std::vector<Index> sheet = medial_structure(mesh).of_face;
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.centers.size()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nproperty double radius\n"
                     "element face " +
                     std::to_string(mesh.triangles.size()) +
                     "\nproperty list uchar int vertex_indices\nproperty int sheet\nelement edge " +
                     std::to_string(mesh.edges.size()) + "\nproperty int vertex1\nproperty int vertex2\n" +
                     (contacts == nullptr ? std::string() : contact_elements(*contacts)) + "end_header\n";
  for (Index v = 0; v < mesh.size(); ++v) {
    std::string line;
    append_place(line, mesh.centers[v]);
    append_number(line, mesh.radii[v]);
    text.append(line, 1);  // skips the first blank
    text += '\n';
  }
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    text += '3';
    for (const Index corner : mesh.triangles[t]) append_number(text, corner);
    append_number(text, sheet[t]);
    text += '\n';
  }
  for (const auto& [a, b] : mesh.edges) text += std::to_string(a) + ' ' + std::to_string(b) + '\n';
  if (contacts != nullptr) append_contacts(text, *contacts);
  return text;
}

std::string to_obj(const MedialMesh& mesh) {
  const MedialStructure structure = medial_structure(mesh);
  const std::vector<Index>& sheet = structure.of_face;
  std::string text;
  for (const Point& center : mesh.centers) {
    text += 'v';
    append_place(text, center);
    text += '\n';
  }
  Index sheets = 0;
  for (const Index own : sheet) sheets = std::max(sheets, own + 1);
  std::vector<std::string> groups(sheets);
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    std::string& group = groups[sheet[t]];
    group += 'f';
    for (const Index corner : mesh.triangles[t]) append_number(group, corner + 1);
    group += '\n';
  }
  for (Index i = 0; i < sheets; ++i) text += "g sheet" + std::to_string(i) + '\n' + groups[i];
  std::string curves;
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    if (!structure.on_curve(e)) continue;
    curves += 'l';
    for (const Index corner : mesh.edges[e]) append_number(curves, corner + 1);
    curves += '\n';
  }
  if (!curves.empty()) text += "g curves\n" + curves;
  return text;
}

}  // namespace orchard
