#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/load_tree.h"
#include "input/ship_model.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"
#include "paraview.h"
#include "report/report_page.h"
#include "simulation.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
using simulation::FrameRecord;
using simulation::Recording;
using simulation::Simulation;

constexpr std::size_t kControlFrames = 20;  // for which the steered ship's controls stay

// "20000": so much counted work a frame; "2ms", "500us": so much time.
runtime::Budget parse_budget(const std::string& text) {
  if (text.empty()) return {};
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, number);
  const std::string unit(at, end);
  runtime::Budget budget;
  if (error != std::errc() || number == 0 || number > 1'000'000'000'000 ||
      (!unit.empty() && unit != "ms" && unit != "us"))
    throw InputError("--budget " + text +
                     ": expected a number of tests a frame, \"20000\", or a time, \"2ms\" or \"500us\"");
  if (unit.empty())
    budget.work = number;
  else
    budget.time = unit == "ms" ? std::chrono::nanoseconds(std::chrono::milliseconds(number))
                               : std::chrono::nanoseconds(std::chrono::microseconds(number));
  return budget;
}

Recording read_recording(const std::filesystem::path& file) {
  check_input(file);
  try {
    std::ifstream stream(file, std::ios::binary);
    return simulation::parse_recording({std::istreambuf_iterator<char>(stream), {}});
  } catch (const std::runtime_error& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

std::vector<std::string> names_of(const SimulateCommand& command, std::size_t frames) {
  std::vector<std::string> names{command.scene + "-trace.csv", command.scene + "-times.csv",
                                 page_name(command.scene, "simulate")};
  if (!command.views) return names;
  names.push_back(command.scene + "-run.pvd");
  for (std::size_t frame = 0; frame < frames; ++frame)
    for (const char* part : {"bodies", "bounds"})
      names.push_back(command.scene + "-" + simulation::frame_file(frame, part));
  return names;
}

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

json microseconds(const std::vector<FrameRecord>& frames, double (*seconds)(const FrameRecord&)) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FrameRecord& frame : frames) values.push_back(1e6 * seconds(frame));
  return {{"p50", percentile(values, 0.5)},
          {"p99", percentile(values, 0.99)},
          {"p99.9", percentile(values, 0.999)},
          {"max", percentile(values, 1)}};
}

json report_of(const SimulateCommand& command, const Simulation& simulation, const std::vector<FrameRecord>& frames) {
  std::size_t pairs = 0, no = 0, maybe = 0, yes = 0;
  std::uint64_t work = 0, motions = 0, left_over = 0;
  double worst = 0;
  std::vector<std::size_t> stopped(simulation::kLevels, 0);
  for (const FrameRecord& frame : frames) {
    pairs += frame.pairs, no += frame.no, maybe += frame.maybe, yes += frame.yes;
    work += frame.work, motions += frame.motions, left_over += frame.left_over;
    worst = std::max(worst, frame.worst_bound);
    for (std::size_t level = 0; level < simulation::kLevels; ++level) stopped[level] += frame.stopped[level];
  }
  while (stopped.size() > 1 && stopped.back() == 0) stopped.pop_back();
  return {{"scene", command.scene},
          {"seed", simulation.recording().seed},
          {"frames", frames.size()},
          {"steps_per_frame", simulation.steps_per_frame()},
          {"bodies", frames.empty() ? 0 : frames.back().bodies},
          {"pairs", pairs},
          {"no", no},
          {"maybe", maybe},
          {"yes", yes},
          {"maybe_by_level", stopped},
          {"worst_bound", worst},
          {"work", work},
          {"motions_asked", motions},
          {"left_over", left_over},
          {"state", frames.empty() ? 0 : frames.back().state},
          {"microseconds",
           {{"detection", microseconds(frames, [](const FrameRecord& f) { return f.seconds_detection; })},
            {"other", microseconds(frames, [](const FrameRecord& f) { return f.seconds_other; })}}}};
}

void print_simulation(const json& report) {
  fmt::print("{}: {} frames of {} steps, {} bodies at the end\n", report["scene"].get<std::string>(),
             report["frames"].get<std::size_t>(), report["steps_per_frame"].get<int>(),
             report["bodies"].get<std::size_t>());
  fmt::print("pairs whose bounding spheres overlap: {}; no {}, maybe {}, yes {}\n", report["pairs"].get<std::size_t>(),
             report["no"].get<std::size_t>(), report["maybe"].get<std::size_t>(), report["yes"].get<std::size_t>());
  if (report["maybe"] != 0) {
    fmt::print("\"maybe\" by the level where the budget ended:");
    for (const json& count : report["maybe_by_level"]) fmt::print(" {}", count.get<std::size_t>());
    fmt::print("; the largest bound left: {:.4g}\n", report["worst_bound"].get<double>());
  }
  fmt::print("microseconds a frame      p50      p99    p99.9      max\n");
  for (const char* kind : {"detection", "other"}) {
    const json& times = report["microseconds"][kind];
    fmt::print("{:20} {:8.1f} {:8.1f} {:8.1f} {:8.1f}\n", kind, times["p50"].get<double>(), times["p99"].get<double>(),
               times["p99.9"].get<double>(), times["max"].get<double>());
  }
}

// The frames one after the other, and their traces.
class SimulationRun {
 public:
  SimulationRun(const SimulateCommand& command, Simulation& simulation, Outputs* outputs)
      : command_(command), simulation_(simulation), outputs_(outputs), draw_(command.seed ^ 0x5eed5u) {}

  void frame(const runtime::Budget& budget) {
    if (frames_.size() % kControlFrames == 0)
      steering_ = {draw_.uniform(0, 1), draw_.uniform(-1, 1), draw_.uniform(-1, 1)};
    frames_.push_back(simulation_.frame(budget, steering_));
    trace_ += simulation::trace_row(frames_.back());
    times_ += simulation::times_row(frames_.back());
    if (outputs_ == nullptr || !command_.views) return;
    moments_.push_back(frames_.back().time);
    const auto write = [&](const char* part, const std::string& text) {
      write_file(outputs_->add(command_.scene + "-" + simulation::frame_file(frames_.size() - 1, part)), text);
    };
    write("bodies", simulation::bodies_vtp(simulation_));
    write("bounds", simulation::bounds_vtp(simulation_));
  }

  void write_traces() {
    if (outputs_ == nullptr) return;
    write_file(outputs_->add(command_.scene + "-trace.csv", "what was counted, frame by frame"), trace_);
    write_file(outputs_->add(command_.scene + "-times.csv", "what was timed"), times_);
    if (command_.views)
      write_file(outputs_->add(command_.scene + "-run.pvd", "open this in ParaView: the run over time"),
                 simulation::run_pvd(moments_, command_.scene + "-"));
  }

  const std::vector<FrameRecord>& frames() const { return frames_; }

 private:
  const SimulateCommand& command_;
  Simulation& simulation_;
  Outputs* outputs_;
  simulation::Draw draw_;
  simulation::Steering steering_;
  std::vector<FrameRecord> frames_;
  std::vector<double> moments_;
  std::string trace_ = simulation::trace_header(), times_ = simulation::times_header();
};

}  // namespace

void simulate(const SimulateCommand& asked) {
  SimulateCommand command = asked;
  std::optional<Recording> replay;
  if (!command.replay.empty()) {
    replay = read_recording(command.replay);
    if (replay->scene != command.scene)
      throw InputError(fmt::format("{}: this is a recording of the scene {}; replay that scene",
                                   command.replay.string(), replay->scene));
    command.bodies = replay->bodies;
    command.seed = replay->seed;
    if (!command.frames) command.frames = replay->steering.size();
    if (*command.frames > replay->steering.size())
      throw InputError(fmt::format("--frames {}: {} has only {} frames", *command.frames, command.replay.string(),
                                   replay->steering.size()));
  }
  const std::size_t frames = command.frames.value_or(100);
  const runtime::Budget budget = parse_budget(command.budget);
  std::vector<std::filesystem::path> inputs;
  for (const auto* file : {&command.tree, &command.replay})
    if (!file->empty()) inputs.push_back(*file);
  if (!command.tree.empty()) check_input(command.tree);
  if (!command.record.empty()) check_output(command.record, inputs);
  Destination destination{.folder = command.folder,
                          .report = command.scene + "-run.json",
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  if (replay) destination.provenance.run.seed = command.seed;  // the recorded one
  if (!command.folder.empty()) check_outputs(destination, names_of(command, frames), inputs);
  const runtime::PackedSphereTree tree = command.tree.empty() ? ship_tree() : load_tree(command.tree);
  const std::vector<simulation::Shape> shapes{simulation::shape_of(tree)};
  if (replay && replay->shape != simulation::checksum(tree))
    throw InputError(command.replay.string() + ": this was recorded with another tree; name that with --tree");

  Simulation simulation(command.scene, shapes, command.bodies, command.seed, replay ? &*replay : nullptr);
  std::optional<Outputs> outputs;
  if (!command.folder.empty()) outputs.emplace(destination);
  SimulationRun run(command, simulation, outputs ? &*outputs : nullptr);
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const Progress progress = bar.callback();
  for (std::size_t frame = 0; frame < frames; ++frame) {
    report_progress(progress, command.scene, static_cast<double>(frame) / static_cast<double>(frames));
    run.frame(budget);
  }
  bar.clear();
  run.write_traces();
  json report = report_of(command, simulation, run.frames());
  report["provenance"] = to_json(destination.provenance);
  if (outputs) {
    outputs->add_report(report, "this report as JSON");
    if (command.report) write_report_page(page_name(command.scene, "simulate"), {.report = report}, *outputs);
    outputs->commit();
  }
  if (!command.record.empty()) {
    std::optional<Writing> writing;
    if (!outputs) writing.emplace();  // they are of that kind themselves
    write_file(command.record, simulation::to_text(simulation.recording()));
  }
  if (command.output.json) {
    fmt::print("{}\n", report.dump(2));
  } else if (!command.output.quiet) {
    print_simulation(report);
    if (!command.record.empty()) fmt::print("  {}  (to be given to --replay)\n", command.record.string());
    if (outputs) outputs->print();
  }
}

}  // namespace orchard::apps
