#include "axis_export.h"

#include <algorithm>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/medial_mesh_formats.h"
#include "orchard/medial/structure.h"
#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/medial_writer.h"
#endif

namespace orchard::apps {
namespace {

std::string file_name(const MedialCommand& command, const std::string& kind) {
  return named(command.axis, "-converted." + kind);
}

}  // namespace

std::vector<std::string> axis_export_kinds() { return {"ma", "ply", "obj", "graphml", "vtp"}; }

std::vector<std::string> axis_export_names(const MedialCommand& command) {
  std::vector<std::string> names;
  for (const std::string& kind : command.exports) names.push_back(file_name(command, kind));
  return names;
}

void check_axis_exports(const MedialCommand& command) {
#ifndef ORCHARD_HAS_VIZ
  if (std::find(command.exports.begin(), command.exports.end(), "vtp") != command.exports.end())
    throw InputError("--export vtp: this program was built without VTK");
#else
  (void)command;
#endif
}

void write_axis_exports(const MedialCommand& command, const MedialMesh& mesh, Outputs& outputs) {
  for (const std::string& kind : command.exports) {
    const std::filesystem::path file = outputs.add(file_name(command, kind), "the axis as " + kind);
    if (kind == "ma") write_file(file, to_ma(mesh) + to_structure_section(medial_structure(mesh)));
    if (kind == "ply") write_file(file, to_ply(mesh));
    if (kind == "obj") write_file(file, to_obj(mesh));
    if (kind == "graphml") write_file(file, to_graphml(mesh));
#ifdef ORCHARD_HAS_VIZ
    if (kind == "vtp") write_medial_mesh(file, mesh);
#endif
  }
}

}  // namespace orchard::apps
