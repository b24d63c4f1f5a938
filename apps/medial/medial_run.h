#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/load_solid.h"
#include "medial/axis_importance.h"
#include "medial/medial_measures.h"
#include "orchard/medial/build.h"
#include "output/outputs.h"

// The parts of `orchard medial`.
namespace orchard::apps {

// What the command asks for: all counts go with --quality-samples.
QualityOptions quality_options(const MedialCommand& command);

// How the axis of the solid is tuned. Where noise was smoothed away, borders and features may lose more, unless the
// command says how much.
MedialTuning tuning_for(const MedialCommand& command, const SolidMesh& solid);

MedialJudgement judge(const MedialCommand& command, const Surface& surface, const MedialBuild& build,
                      const MedialMesh& mesh, const MedialBuildOptions& options, const Progress& progress);

// Of an axis that was not built here, with its distance from `first`.
MedialJudgement judge_beside(const MedialCommand& command, const Surface& surface, const MedialMesh& mesh,
                             const MedialMesh& first, const Progress& progress);

// Throws InputError if a combination of the values of command.sweep cannot be run.
void check_sweep(const MedialCommand& command);
// The options that command.sweep varies, by their names.
std::vector<std::string> swept_flags(const MedialCommand& command);
// The tuning of every combination of the values of command.sweep, its last one's fastest; without a sweep, that of the
// command.
std::vector<MedialTuning> tunings_of(const MedialCommand& command);
// The files of a sweep, but for its report.
std::vector<std::string> sweep_names(const MedialCommand& command);
// Every combination of the values of command.sweep, each judged: MODEL-sweep.csv, in the order of the combinations, and
// plots of what is gained for what it costs; in the report and printed with the best by command.best first.
void sweep_medial(const MedialCommand& command, const Destination& destination, ProgressBar& bar);

// The report of an axis that was built, without its quality, and its files: MODEL.ma, which ends with `last_line`, and
// those of --export.
nlohmann::json axis_report(const MedialCommand& command, const SolidMesh& solid, const MedialBuild& build,
                           const MedialMesh& mesh);
void write_axis(const MedialCommand& command, const MedialBuild& build, const MedialMesh& mesh,
                const std::vector<ImportanceArray>& importance, const std::string& last_line, Outputs& outputs);
// Sets "quality" and "diagonal".
void add_quality(const MedialJudgement& judgement, nlohmann::json& report);

}  // namespace orchard::apps
