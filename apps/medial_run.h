#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "medial_report.h"

// The parts of `orchard medial`.
namespace orchard::apps {

// Points of a file (.xyz, or .ply or .obj, whose faces are not looked at), moved to the nearest place of the surface.
// Throws InputError, which names file and line.
struct OwnPoints {
  SurfaceSampling sampling;
  double farthest_moved = 0;  // mesh units
};
OwnPoints read_own_points(const std::filesystem::path& file, const Surface& surface);

// A .vor file whose points lie on the surface. Throws InputError.
OwnDiagram read_own_diagram(const std::filesystem::path& file, const Surface& surface);

// What the command asks for: all counts go with --quality-samples.
QualityOptions quality_options(const MedialCommand& command);

MedialJudgement judge(const MedialCommand& command, const Surface& surface, const MedialBuild& build,
                      const MedialMesh& mesh, const MedialBuildOptions& options, const Progress& progress);

// Throws InputError if a combination of the values of command.sweep cannot be run.
void check_sweep(const MedialCommand& command);
// The files of a sweep.
std::vector<std::string> sweep_names(const MedialCommand& command);
// Every combination of the values of command.sweep, each judged: MODEL-sweep.csv and a plot for each metric.
void sweep_medial(const MedialCommand& command, const Surface& surface, const Progress& progress);

}  // namespace orchard::apps
