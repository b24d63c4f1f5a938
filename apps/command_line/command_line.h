#pragma once
#include <CLI/CLI.hpp>
#include <functional>

#include "command_line/commands.h"
#include "command_line/exit_code.h"

// What the user may write after the program's name.
namespace orchard::apps {

// What the user asked for, once parsed.
struct Request {
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
  ViewCommand view;
  ReportCommand report;
  std::string shell, format;  // of completion and reference
  ProfileCommand profile;
  SimulateCommand simulate;
  BatchCommand batch;
  std::string misbehavior;  // of misbehave
  std::string typed;        // the whole command line
  int threads = 0;          // 0: as many as the machine has
  std::function<void()> run;
  int exit_code = kSucceeded;  // set by a command whose result is not what was asked for
};

// Every command with its options; parsing one sets request.run.
void add_commands(CLI::App& app, Request& request);

}  // namespace orchard::apps
