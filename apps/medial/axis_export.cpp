#include "medial/axis_export.h"

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

// The name of a file with this ending: that of an axis that was built, or of one that was read.
std::string file_name(const MedialCommand& command, const std::string& ending) {
  return command.axis.empty() ? named(command.mesh, "-axis" + ending) : named(command.axis, "-converted" + ending);
}

std::vector<std::string> endings_of(const std::string& kind) {
  return kind == "csv" ? axis_table_endings() : std::vector<std::string>{"." + kind};
}

}  // namespace

std::vector<std::string> axis_export_kinds() { return {"ma", "ply", "obj", "graphml", "vtp", "npz", "csv"}; }

std::vector<std::string> axis_export_names(const MedialCommand& command) {
  std::vector<std::string> names;
  for (const std::string& kind : command.exports) {
    for (const std::string& ending : endings_of(kind)) names.push_back(file_name(command, ending));
  }
  return names;
}

void check_axis_exports(const MedialCommand& command) {
#ifndef ORCHARD_HAS_VIZ
  if (std::find(command.exports.begin(), command.exports.end(), "vtp") != command.exports.end())
    throw InputError(
        "--export vtp: this program was built without VTK; choose another format, or build it with ORCHARD_VIZ=ON");
#else
  (void)command;
#endif
}

void write_axis_exports(const MedialCommand& command, const MedialMesh& mesh, const AxisContacts& contacts,
                        const std::vector<ImportanceArray>& importance, Outputs& outputs) {
  for (const std::string& kind : command.exports) {
    if (kind == "csv") {
      for (const auto& [ending, text] : axis_tables(mesh, contacts, importance))
        write_file(outputs.add(file_name(command, ending), "a table of the axis"), text);
      continue;
    }
    const std::filesystem::path file = outputs.add(file_name(command, "." + kind), "the axis as " + kind);
    if (kind == "npz") write_file(file, to_npz(axis_arrays(mesh, contacts, importance)));
    if (kind == "ma") write_file(file, to_ma(mesh) + to_structure_section(medial_structure(mesh)));
    if (kind == "ply") write_file(file, to_ply(mesh, &contacts));
    if (kind == "obj") write_file(file, to_obj(mesh));
    if (kind == "graphml") write_file(file, to_graphml(mesh));
#ifdef ORCHARD_HAS_VIZ
    if (kind == "vtp") write_medial_mesh(file, mesh, {}, &contacts);
#endif
  }
}

}  // namespace orchard::apps
