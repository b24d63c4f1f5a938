#pragma once
#include <CLI/CLI.hpp>
#include <functional>

#include "command_line/commands.h"
#include "command_line/exit_code.h"
#include "input/standard_input.h"

// What the user may write after the program's name.
namespace orchard::apps {

// What the user asked for, once parsed.
struct Request {
  // A mesh that a command reads, with what is said of it.
  struct MeshArgument {
    std::filesystem::path* file;
    const MeshInput* input;
  };
  std::vector<MeshArgument> meshes;
  BuildCommand build;
  CollideCommand collide;
  VerifyCommand verify;
  InspectCommand inspect;
  SpheresCommand spheres;
  AuditCommand audit;
  RobotCommand robot;
  CompareCommand compare;
  SampleCommand sample;
  VoronoiCommand voronoi;
  MedialCommand medial;
  LeaderboardCommand leaderboard;
  ThicknessCommand thickness;
  SkeletonCommand skeleton;
  SegmentCommand segment;
  OffsetCommand offset;
  ViewCommand view;
  ReportCommand report;
  std::string shell, format;  // of completion and reference
  ProfileCommand profile;
  SimulateCommand simulate;
  BatchCommand batch;
  std::string misbehavior;                      // of misbehave
  std::optional<StandardInput> standard_input;  // if one of the meshes is "-"
  std::string typed;                            // the whole command line
  int threads = 0;                              // 0: as many as the machine has
  std::function<void()> run;
  int exit_code = kSucceeded;  // set by a command whose result is not what was asked for
};

// Every command with its options; parsing one sets request.run.
void add_commands(CLI::App& app, Request& request);

// Reads standard input if a mesh is "-", and puts a file in its place. Throws InputError if its format is not given, or
// as StandardInput does.
void take_standard_input(Request& request);

}  // namespace orchard::apps
