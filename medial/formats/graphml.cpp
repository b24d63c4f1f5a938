#include <array>
#include <string>

#include "orchard/geometry/text_lines.h"
#include "orchard/medial/medial_mesh_formats.h"
#include "orchard/medial/structure.h"

namespace orchard {
namespace {

void add_data(std::string& text, const char* key, double value) {
  std::string digits;
  append_number(digits, value);
  text += "<data key=\"" + std::string(key) + "\">" + digits.substr(1) + "</data>";
}

}  // namespace

std::string to_graphml(const MedialMesh& mesh) {
  const MedialStructure structure = medial_structure(mesh);
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n";
  const auto declare = [&](const char* key, const char* of, const char* type) {
    text += "  <key id=\"" + std::string(key) + "\" for=\"" + of + "\" attr.name=\"" + key + "\" attr.type=\"" + type +
            "\"/>\n";
  };
  for (const char* key : {"x", "y", "z", "radius"}) declare(key, "node", "double");
  declare("length", "edge", "double");
  declare("kind", "edge", "string");
  text += "  <graph id=\"axis\" edgedefault=\"undirected\">\n";
  for (Index i = 0; i < mesh.size(); ++i) {
    text += "    <node id=\"n" + std::to_string(i) + "\">";
    const Point& center = mesh.centers[i];
    add_data(text, "x", center.x()), add_data(text, "y", center.y()), add_data(text, "z", center.z());
    add_data(text, "radius", mesh.radii[i]);
    text += "</node>\n";
  }
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b] = mesh.edges[e];
    const Index part = structure.of_edge[e];
    text += "    <edge source=\"n" + std::to_string(a) + "\" target=\"n" + std::to_string(b) + "\">";
    add_data(text, "length", (mesh.centers[a] - mesh.centers[b]).norm());
    text += "<data key=\"kind\">" +
            std::string(name_of(part == kNone ? StructureKind::sheet : structure.parts[part].kind)) +
            "</data></edge>\n";
  }
  return text + "  </graph>\n</graphml>\n";
}

}  // namespace orchard
