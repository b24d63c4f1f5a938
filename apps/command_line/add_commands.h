#pragma once
#include "command_line/command_line.h"

// Adds each command with its options. The files are divided by topic.
namespace orchard::apps {

// tree_commands.cpp
void add_build(CLI::App& app, Request& request);
void add_collide(CLI::App& app, Request& request);
void add_verify(CLI::App& app, Request& request);
void add_compare(CLI::App& app, Request& request);
void add_profile(CLI::App& app, Request& request);
void add_simulate(CLI::App& app, Request& request);

// axis_commands.cpp
void add_sample(CLI::App& app, Request& request);
void add_voronoi(CLI::App& app, Request& request);
void add_medial(CLI::App& app, Request& request);
void add_leaderboard(CLI::App& app, Request& request);
void add_thickness(CLI::App& app, Request& request);

// skeleton_commands.cpp
void add_skeleton(CLI::App& app, Request& request);
void add_segment(CLI::App& app, Request& request);

// offset_command.cpp
void add_offset(CLI::App& app, Request& request);

// set_commands.cpp
void add_spheres(CLI::App& app, Request& request);
void add_audit(CLI::App& app, Request& request);

// robot_commands.cpp
void add_robot(CLI::App& app, Request& request);
// Adds how a robot is read, for each command that reads one. Returns the options.
std::vector<CLI::Option*> add_robot_reading(CLI::App& command, RobotReading& reading);

// batch_commands.cpp
void add_batch(CLI::App& app, Request& request);
// Returns how many of the arguments belong to the program itself. Those after -- of a batch are the command that it
// runs, and are moved into the request.
int take_worker_words(int argc, const char* const* argv, Request& request);

}  // namespace orchard::apps
