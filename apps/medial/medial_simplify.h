#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "orchard/geometry/stage_times.h"
#include "orchard/medial/envelope.h"
#include "orchard/medial/simplify.h"
#include "output/outputs.h"

// `orchard medial` with --vertices, --error, --error-curve or --envelope: the axis in few balls, and what it stands
// for.
namespace orchard::apps {

// What became of an axis.
struct FewBalls {
  std::optional<SimplifiedMedialMesh> simplified = {};  // with --vertices or --error
  std::vector<SimplifiedMedialMesh> error_curve = {};   // with --error-curve
  std::optional<EnvelopeMesh> envelope = {};            // with --envelope: of the simplified mesh, or else of the axis
  StageTimes seconds = {};
};

// Every name that it may have in the folder.
std::vector<std::string> few_balls_names(const MedialCommand& command);
// Throws InputError if the options contradict each other, or the envelope's file cannot be written.
void check_few_balls(const MedialCommand& command, const Destination& destination,
                     const std::vector<std::filesystem::path>& inputs);

// The same of the options of --vertices, --error and --balls alone.
void check_simplification(const MedialCommand& command);

// What the command asks of the axis in few balls.
SimplifyOptions few_balls_options(const MedialCommand& command);

FewBalls make_few_balls(const MedialCommand& command, const Surface& surface, const MedialMesh& axis,
                        const Progress& progress);
// Into the report and the folder, and for people unless the command is quiet.
void write_few_balls(const MedialCommand& command, const Provenance& provenance, const FewBalls& few,
                     nlohmann::json& report, Outputs& outputs);

}  // namespace orchard::apps
