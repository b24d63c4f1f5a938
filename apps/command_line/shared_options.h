#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "command_line/command_line.h"

// Options that several commands have, so that they read the same everywhere.
namespace orchard::apps {

// The options on the command line, by their long names.
std::vector<std::string> given_of(const std::vector<const CLI::Option*>& options);
std::vector<std::string> given_of(const CLI::App& command);

// The argument "mesh", and how it is read.
void add_mesh(CLI::App& command, Request& request, std::filesystem::path& mesh, MeshInput& input);
// How a mesh is read: --format, --scale, --unit.
void add_mesh_input(CLI::App& command, MeshInput& input);
// What the argument of a command that reads a mesh says in --help.
std::string mesh_help(const std::string& what);
void add_mesh_options(CLI::App& command, MeshOptions& options);
CLI::Option* add_join(CLI::App& command, std::optional<double>& join);
void add_threads(CLI::App& command, Request& request);
CLI::Option* add_up(CLI::App& command, std::string& up);
void add_accept(CLI::App& command, bool& accept);
CLI::Option* add_report(CLI::App& command, bool& report);
// Adds the export that a file named by -o is of, if it is one: "npz" for .npz.
void export_single_file(const std::filesystem::path& output, const std::vector<std::string>& kinds,
                        std::vector<std::string>& exports);
CLI::Option* add_force(CLI::App& command, Output& output);
void add_output_flags(CLI::App& command, Output& output);
// Whether the axis is that of the solid or of the space around it.
void add_side(CLI::App& command, MedialCommand& medial);
// A measure of significance that --prune takes, MEASURE=VALUE.
struct PruneMeasure {
  std::string name, help, standard, range;
  std::function<std::string(const std::string&)> fault;  // why a value cannot be; empty if it can
  std::function<void(const std::string&)> set;
};
// How axes are tuned: all of it, or what trees have a use for. --prune takes `measures` beside those of axes.
void add_tuning(CLI::App& command, MedialTuning& tuning, bool for_tree, std::vector<PruneMeasure> measures = {});
void add_axis_source(CLI::App& command, AxisSource& source);

}  // namespace orchard::apps
