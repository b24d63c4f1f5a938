#pragma once
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "medial/axis_arrays.h"
#include "orchard/medial/medial_mesh.h"
#include "output/outputs.h"

// An axis in other formats.
namespace orchard::apps {

// The kinds that --export takes.
std::vector<std::string> axis_export_kinds();
// The names of the files that --export asks for.
std::vector<std::string> axis_export_names(const MedialCommand& command);
// Throws InputError if a kind needs what the program was built without.
void check_axis_exports(const MedialCommand& command);
void write_axis_exports(const MedialCommand& command, const MedialMesh& mesh, const AxisContacts& contacts,
                        const std::vector<ImportanceArray>& importance, Outputs& outputs);

}  // namespace orchard::apps
