#include "medial/sweep_runs.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "input/load_solid.h"
#include "input/reading_report.h"
#include "medial/medial_run.h"
#include "medial/medial_simplify.h"
#include "medial/sweep_columns.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/medial/read_axis.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// Runs that differ only in these options share their axis.
constexpr const char* kAfterTheAxis[] = {"vertices", "error", "balls", "quality-samples", "tree", "tree-depth"};

// Returns everything that the numbers of a run depend on.
json decisive_of(const MedialCommand& run, const Destination& destination) {
  json decisive = decisive_json({.run = run.output.run, .inputs = destination.provenance.inputs});
  decisive.erase("command_line");
  return decisive;
}

std::string axis_key(const MedialCommand& run) {
  json options = run.output.run.options;
  for (const char* option : kAfterTheAxis) options.erase(option);
  return options.dump();
}

// Builds the tree from the same axis, whose diagram is reused.
SphereTreeBuild tree_of(const TreeRequest& wanted, const Surface& surface, const MedialBuildOptions& medial,
                        const MedialBuild& build, const Progress& progress) {
  SphereTreeOptions options = tree_options(wanted, medial.sampling.seed);
  options.medial = medial;
  options.samples_by_need = false;
  MedialBuildInput input;
  input.diagram = {build.diagram, build.sampling};
  return build_sphere_tree(surface, options, progress, std::move(input));
}

class SweepRunner {
 public:
  SweepRunner(const MedialCommand& command, const Destination& destination, ProgressBar& bar)
      : command_(command), destination_(destination), bar_(bar), progress_(bar.callback()) {
    std::ifstream in(destination.folder / sweep_rows_name(command));
    const json read = json::parse(in, nullptr, false);
    if (read.is_object() && read.contains("runs") && read["runs"].is_array()) kept_ = read["runs"];
  }

  SweepRuns run() {
    SweepRuns result;
    result.rows.resize(command_.runs.size());
    std::vector<bool> done(command_.runs.size(), false);
    for (std::size_t i = 0; i < command_.runs.size(); ++i) {
      const std::string key = axis_key(command_.runs[i]);
      for (std::size_t j = i; j < command_.runs.size(); ++j) {
        if (done[j] || axis_key(command_.runs[j]) != key) continue;
        done[j] = true;
        const MedialCommand& run = command_.runs[j];
        if (std::optional<json> row = row_of(run)) {
          result.rows[j] = *std::move(row);
          ++result.taken_over;
          continue;
        }
        result.rows[j] = make(run, key);
        keep(run, result.rows[j]);
      }
      build_.reset();
    }
    return result;
  }

 private:
  std::optional<json> row_of(const MedialCommand& run) const {
    if (command_.keep && !has_files(run)) return std::nullopt;
    const json decisive = decisive_of(run, destination_);
    for (const json& one : kept_)
      if (one.is_object() && one.value("run", json()) == decisive && one.value("measures", json()).is_object())
        return one["measures"];
    return std::nullopt;
  }

  void keep(const MedialCommand& run, const json& row) {
    const json decisive = decisive_of(run, destination_);
    json kept = json::array();
    for (const json& one : kept_)
      if (!one.is_object() || one.value("run", json()) != decisive) kept.push_back(one);
    kept.push_back({{"run", decisive}, {"measures", row}});
    kept_ = std::move(kept);
    const Writing writing;
    fs::create_directories(destination_.folder);
    write_file(destination_.folder / sweep_rows_name(command_),
               json{{"provenance", to_json(destination_.provenance)}, {"runs", kept_}}.dump(1) + "\n");
  }

  // samples=1000,vertices=50
  Destination destination_of(const MedialCommand& run) const {
    std::string name;
    for (std::size_t i = 0; i < run.choice.size(); ++i)
      name += (i > 0 ? "," : "") + command_.swept[i].name + "=" + run.choice[i];
    return {.folder = destination_.folder / sweep_runs_folder(command_) / name,
            .report = named(command_.mesh, "-medial.json"),
            .provenance = {.run = run.output.run, .inputs = destination_.provenance.inputs},
            .force = true};
  }
  bool has_files(const MedialCommand& run) const {
    const Destination destination = destination_of(run);
    std::ifstream in(destination.folder / destination.report);
    const json report = json::parse(in, nullptr, false);
    if (!report.is_object() || !report.contains("provenance")) return false;
    json provenance = report["provenance"];
    for (const char* other : {"command_line", "run", "schema_version"}) provenance.erase(other);
    return provenance == decisive_of(run, destination_) && fs::exists(destination.folder / named(command_.mesh, ".ma"));
  }

  const SolidMesh& solid_of(const MedialCommand& run) {
    if (solid_ && reading_ == run.reading) return *solid_;
    solid_.emplace(load_solid(run.mesh, run.reading, progress_));
    reading_ = run.reading;
    bar_.clear();
    if (!command_.output.quiet && !command_.output.json) print_solid(run.mesh, *solid_);
    print_hole_warning(run.mesh, solid_->repair, solid_->repair_distance, solid_->surface.bounding_radius());
    return *solid_;
  }

  json make(const MedialCommand& run, const std::string& key) {
    const SolidMesh& solid = solid_of(run);
    const Surface& surface = solid.surface;
    const MedialBuildOptions options = build_options(tuning_for(run, solid));
    if (!build_ || built_ != key) build_ = build_medial_axis(surface, options, progress_);
    built_ = key;
    const MedialMesh mesh = medial_mesh(build_->axis);
    const FewBalls few = make_few_balls(run, surface, mesh, progress_);
    MedialJudgement judgement;
    if (few.simplified) {
      judgement = judge_mesh(surface, few.simplified->mesh, quality_options(run), progress_);
    } else {
      judgement = judge(run, surface, *build_, mesh, options, progress_);
    }
    std::vector<double> numbers = axis_numbers(*build_, judgement, few.seconds);
    if (run.tree) {
      const SphereTreeBuild tree = tree_of(*run.tree, surface, options, *build_, progress_);
      const std::vector<double> more = tree_numbers(tree, surface, run.tree->depth);
      numbers.insert(numbers.end(), more.begin(), more.end());
    }
    if (command_.keep) write(run, solid, mesh, few, judgement);
    const std::vector<Column> columns = all_columns(run);
    json row = json::object();
    for (std::size_t i = 0; i < columns.size(); ++i)
      row[columns[i].name] = std::isfinite(numbers[i]) ? json(numbers[i]) : json();
    return row;
  }

  void write(const MedialCommand& run, const SolidMesh& solid, const MedialMesh& mesh, const FewBalls& few,
             const MedialJudgement& judgement) {
    bar_.clear();
    const Destination destination = destination_of(run);
    Outputs outputs(destination);
    MedialCommand quiet = run;
    quiet.output.quiet = true;
    quiet.views = false;
    json report = axis_report(quiet, solid, *build_, mesh);
    add_quality(judgement, report);
    write_axis(quiet, *build_, mesh, {}, "", outputs);
    write_few_balls(quiet, destination.provenance, few, report, outputs);
    outputs.add_report(report);
    outputs.commit();
  }

  const MedialCommand& command_;
  const Destination& destination_;
  ProgressBar& bar_;
  Progress progress_;
  json kept_ = json::array();
  std::optional<SolidMesh> solid_;
  MeshOptions reading_;
  std::optional<MedialBuild> build_;
  std::string built_;  // its key
};

}  // namespace

std::string sweep_rows_name(const MedialCommand& command) { return named(command.mesh, "-sweep-runs.json"); }
std::string sweep_runs_folder(const MedialCommand& command) { return named(command.mesh, "-sweep"); }

SweepRuns make_sweep_runs(const MedialCommand& command, const Destination& destination, ProgressBar& bar) {
  return SweepRunner(command, destination, bar).run();
}

}  // namespace orchard::apps
