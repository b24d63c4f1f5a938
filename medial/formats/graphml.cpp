#include <array>
#include <string>

#include "graphml_text.h"
#include "orchard/medial/medial_mesh_formats.h"
#include "orchard/medial/structure.h"

namespace orchard {

std::string to_graphml(const MedialMesh& mesh) {
  const MedialStructure structure = medial_structure(mesh);
  constexpr std::array kNumbers{"length"};
  detail::GraphmlText text("axis", kNumbers);
  for (Index i = 0; i < mesh.size(); ++i) text.add_node(mesh.centers[i], mesh.radii[i]);
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b] = mesh.edges[e];
    const Index part = structure.of_edge[e];
    const std::array length{(mesh.centers[a] - mesh.centers[b]).norm()};
    text.add_edge(a, b, length, name_of(part == kNone ? StructureKind::sheet : structure.parts[part].kind));
  }
  return text.finished();
}

}  // namespace orchard
