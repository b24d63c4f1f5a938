#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "output/outputs.h"

// The medial axis that commands beside `orchard medial` start from.
namespace orchard::apps {

// The space around a solid, within a sphere of `radius` bounding radii, as a solid.
SolidMesh outside_of(const SolidMesh& solid, double radius);

// A solid, or the space around it, with its axis.
struct SolidAxis {
  SolidMesh solid;
  std::optional<MedialBuild> build;  // none for the axis of a file
  MedialMesh mesh;
  std::vector<std::string> notes;  // what reading a file decided
  Topology found, wanted;          // of the axis and of the solid
};
// Reads the mesh, prints what was done to it, and builds the axis that the command's tuning asks for, or reads that of
// --axis. Throws InputError if that is not an axis of the solid: if its balls do not lie near the surface, if centres
// are outside the solid, or if it has neither edges nor triangles.
SolidAxis solid_axis(const MedialCommand& command, const Progress& progress, ProgressBar& bar);
// The times of building it; empty for the axis of a file.
StageTimes axis_seconds(const SolidAxis& axis);
// What the report of a command says about it.
nlohmann::json axis_json(const MedialCommand& command, const SolidAxis& axis);

// Where the files of such a command go: the report of this name, the page of --report, named for the command as it is
// typed, and the others by their endings, and by whole names. Throws InputError if the mesh or the axis of --axis is
// missing, or files cannot be replaced or are those of another input.
Destination destination_of(const MedialCommand& command, const std::string& report, const char* typed,
                           std::span<const char* const> endings, const std::vector<std::string>& more_names = {});

// Completes the report by the solid and the times, writes it and its page, and puts all files in place. Then prints the
// report as JSON, or what `print` prints, the times and the files.
void finish(const MedialCommand& command, const char* typed, const SolidAxis& axis, const StageTimes& seconds,
            nlohmann::json report, Outputs& outputs, const std::function<void()>& print);

// What is wrong with the axis and what to do about it, in a line; empty if nothing is.
std::string axis_warning(const MedialCommand& command, const SolidAxis& axis);
// What a broken promise of its topology may be mended by.
std::string topology_remedy(const MedialCommand& command, const SolidAxis& axis);

}  // namespace orchard::apps
