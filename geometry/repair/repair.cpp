#include "orchard/geometry/repair.h"

#include <charconv>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/min_ball.h"
#include "repair_steps.h"

namespace orchard {
namespace {

std::string in_digits(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 3).ptr};
}

double radius_of_used(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& corners : mesh.triangles)
    for (const Index vertex : corners) used[vertex] = true;
  std::vector<Point> points;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) points.push_back(mesh.vertices[v]);
  return ritter_ball(points).radius;
}

void close(TriangleMesh& mesh, const RepairMeshOptions& options, MeshRepairReport& report) {
  const double radius = radius_of_used(mesh);
  detail::weld_vertices(mesh, report);
  detail::join_vertices(mesh, options.join_distance * radius, radius, report);
  detail::drop_degenerate(mesh, report);
  detail::drop_duplicates(mesh, report);
  if (mesh.triangles.empty()) return;
  detail::orient_components(mesh, report);
  // Holes are filled before the mesh is cut apart, while two holes that touch at a vertex still count as two; and
  // again after it, because a cut can open a hole.
  detail::fill_holes(mesh, options, radius, report);
  detail::cut_apart(mesh, report);
  detail::fill_holes(mesh, options, radius, report);
  // A hole between an edge and its two halves is filled with a triangle that has no area.
  detail::drop_degenerate(mesh, report);
  const MeshReport check = check_mesh(mesh);
  if (check.closed() && check.manifold() && check.misoriented_edges == 0 && check.degenerate_triangles == 0)
    detail::orient_parts(mesh, report);
}

}  // namespace

MeshRepairReport repair_mesh(TriangleMesh& mesh, const RepairMeshOptions& options) {
  validate(mesh);
  MeshRepairReport report;
  // check_mesh() does not report parts that lie on or in each other: orient_parts() looks for those.
  const MeshReport before = check_mesh(mesh);
  if (!before.solid()) {
    close(mesh, options, report);
  } else if (before.components > 1) {
    detail::orient_parts(mesh, report);
  }
  const bool untouched = before.solid() && before.components <= 1;
  const MeshReport after = untouched ? before : check_mesh(mesh);
  report.solid = after.solid();
  report.faults = after.faults();
  // If faults remain, their text names vertices by number: these must stay the numbers of the file.
  if (report.solid) detail::drop_unused_vertices(mesh, report);
  return report;
}

std::vector<std::string> MeshRepairReport::lines() const {
  std::vector<std::string> lines;
  const auto say = [&](Index count, const std::string& verb, const std::string& one, const std::string& many,
                       const std::string& rest) {
    if (count > 0) lines.push_back(verb + " " + std::to_string(count) + " " + (count == 1 ? one : many) + rest);
  };
  say(vertices_welded, "welded", "vertex", "vertices", " to another in the same place");
  say(vertices_joined, "joined", "vertex", "vertices",
      vertices_joined == 1 ? " to another " + in_digits(max_join) + " away"
                           : " to others no farther than " + in_digits(max_join) + " away");
  say(unused_vertices_dropped, "dropped", "vertex", "vertices", " that no triangle uses");
  say(degenerate_dropped, "dropped", "triangle", "triangles", " without area");
  say(neighbors_split, "split", "triangle", "triangles", " at a vertex that lay on an edge");
  say(duplicates_dropped, "dropped", "triangle", "triangles", " that lay on another");
  say(flipped, "turned", "triangle", "triangles", " round to agree with the neighbours");
  say(edges_cut, "cut", "edge", "edges", " where more than two triangles met");
  say(vertices_split, "split", "vertex", "vertices", " where parts of the surface touched");
  say(cracks_closed, "closed", "crack", "cracks",
      " with " + std::to_string(cracks_triangles) + (cracks_triangles == 1 ? " triangle" : " triangles") +
          ", no wider than corners are joined over");
  say(holes_filled, "filled", "hole", "holes",
      " with " + std::to_string(triangles_added) + (triangles_added == 1 ? " triangle" : " triangles") +
          (holes_filled == 1 ? ", " : ", the largest ") + in_digits(max_hole) + " across");
  say(parts_turned_outward, "turned", "part", "parts", " outward that faced inward");
  say(cavities_turned_inward, "turned", "part", "parts", " inside another inward: it bounds a cavity");
  return lines;
}

}  // namespace orchard
