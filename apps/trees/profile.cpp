// One command: what is measured of a pose, its sums, and their table, plot and JSON, hence more than 300 lines.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/load_tree.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/runtime/narrow_phase.h"
#include "output/outputs.h"
#include "output/stamp.h"
#include "report/report_page.h"
#include "report/report_plots.h"
#include "svg_plot.h"
#include "trees/profile_poses.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
using runtime::Answer;

constexpr int kPasses = 3;  // over each pose, of which the fastest counts
constexpr std::size_t kBoundBins = 40;

// What is known of one pose after a level, and how long that took since the beginning.
struct AtLevel {
  Answer answer = Answer::maybe;
  double bound = 0;
  std::uint64_t tests = 0;
  double microseconds = 0;
};

struct PoseProfile {
  std::vector<AtLevel> levels;  // the roots first; up to the one that decided, or the last of spheres
  AtLevel exact;                // after those
  bool separated = false;
};

PoseProfile profile_pose(runtime::NarrowPhase& pair, const PosePair& pose) {
  using Clock = std::chrono::steady_clock;
  PoseProfile best;
  for (int pass = 0; pass <= kPasses; ++pass) {  // the first one warms up
    PoseProfile now;
    const auto begin = Clock::now();
    const auto keep = [&] {
      return AtLevel{pair.answer(), pair.separation_bound(), pair.progress().pair_tests,
                     std::chrono::duration<double, std::micro>(Clock::now() - begin).count()};
    };
    pair.start(pose.a, pose.b);
    now.levels.push_back(keep());
    now.exact = now.levels.back();
    while (!pair.finished()) {
      pair.refine();
      now.exact = keep();
      if (!pair.progress().exact) now.levels.push_back(now.exact);
    }
    now.separated = pair.answer() == Answer::no;
    if (pass <= 1) {
      best = std::move(now);
      continue;
    }
    for (std::size_t i = 0; i < best.levels.size(); ++i)
      best.levels[i].microseconds = std::min(best.levels[i].microseconds, now.levels[i].microseconds);
    best.exact.microseconds = std::min(best.exact.microseconds, now.exact.microseconds);
  }
  return best;
}

double quantile(const std::vector<double>& sorted, double part) {
  if (sorted.empty()) return 0;
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(part * static_cast<double>(sorted.size())))];
}

json bound_quantiles(std::vector<double> values) {
  if (values.empty()) return json();
  std::sort(values.begin(), values.end());
  return {{"p10", quantile(values, 0.1)},
          {"median", quantile(values, 0.5)},
          {"p90", quantile(values, 0.9)},
          {"max", values.back()}};
}

json times(std::vector<double> values) {
  if (values.empty()) return json();
  std::sort(values.begin(), values.end());
  double sum = 0;
  for (const double value : values) sum += value;
  return {{"median", quantile(values, 0.5)},
          {"mean", sum / static_cast<double>(values.size())},
          {"p99", quantile(values, 0.99)}};
}

std::vector<std::size_t> histogram(const std::vector<double>& values, double width) {
  std::vector<std::size_t> bins(kBoundBins, 0);
  for (const double value : values)
    ++bins[width > 0 ? std::min(kBoundBins - 1, static_cast<std::size_t>(value / width)) : 0];
  return bins;
}

// All poses that reached a level.
struct LevelProfile {
  std::size_t reached = 0, decided = 0, maybe_separated = 0;
  double tests = 0;
  std::vector<double> bounds, microseconds;  // bounds of "maybe", over the radius
};

class Profile {
 public:
  Profile(const std::vector<PoseProfile>& poses, double radius) : radius_(radius) {
    for (const PoseProfile& pose : poses) {
      separated_ += pose.separated;
      if (levels_.size() < pose.levels.size()) levels_.resize(pose.levels.size());
      for (std::size_t i = 0; i < pose.levels.size(); ++i) add(levels_[i], pose.levels[i], pose.separated);
      if (pose.levels.back().answer != Answer::no) add(exact_, pose.exact, pose.separated);
    }
    poses_ = poses.size();
    for (std::size_t i = 1; i < levels_.size(); ++i)
      for (const double bound : levels_[i].bounds) width_ = std::max(width_, bound / kBoundBins);
  }

  json report() const {
    json levels = json::array();
    std::size_t decided = 0;
    for (std::size_t i = 0; i < levels_.size(); ++i) levels.push_back(row(std::to_string(i), levels_[i], decided));
    levels.push_back(row("exact", exact_, decided));
    return {{"poses", poses_}, {"separated", separated_}, {"radius", radius_}, {"levels", levels}};
  }

 private:
  void add(LevelProfile& level, const AtLevel& at, bool separated) const {
    ++level.reached;
    level.decided += at.answer == Answer::no;
    level.tests += static_cast<double>(at.tests);
    level.microseconds.push_back(at.microseconds);
    if (at.answer != Answer::maybe) return;
    level.maybe_separated += separated;
    if (std::isfinite(at.bound)) level.bounds.push_back(at.bound / radius_);
  }

  json row(const std::string& name, const LevelProfile& level, std::size_t& decided) const {
    decided += level.decided;
    const auto share = [](std::size_t part, std::size_t whole) {
      return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
    };
    const std::size_t at_roots = levels_.front().decided;
    return {{"level", name},
            {"poses", level.reached},
            {"decided_no", level.decided},
            {"decided_of_separated", share(decided, separated_)},
            {"decided_of_left_by_roots", share(decided - at_roots, separated_ - at_roots)},
            {"maybe_though_separated", level.maybe_separated},
            {"bound_over_radius", bound_quantiles(level.bounds)},
            {"bound_histogram", histogram(level.bounds, width_)},
            {"bound_histogram_bin", width_},
            {"sphere_tests", level.reached > 0 ? level.tests / static_cast<double>(level.reached) : 0.0},
            {"microseconds", times(level.microseconds)}};
  }

  double radius_, width_ = 0;
  std::size_t poses_ = 0, separated_ = 0;
  std::vector<LevelProfile> levels_;
  LevelProfile exact_;
};

std::string four_digits(const json& value) {
  return value.is_number() ? fmt::format("{:.4f}", value.get<double>()) : "-";
}

void print_profile(const json& report) {
  fmt::print("{} poses of {} flights, {} of them apart; bounds over R = {:.6g}, the radius of {}\n",
             report["poses"].get<std::size_t>(), report["flights"].get<std::size_t>(),
             report["separated"].get<std::size_t>(), report["radius"].get<double>(), report["a"].get<std::string>());
  fmt::print(
      "level   reached  decided \"no\"  of all apart  of what the roots leave  bound of \"maybe\": p10  median     p90 "
      " sphere tests  "
      "microseconds  p99\n");
  for (const json& level : report["levels"]) {
    const json &bound = level["bound_over_radius"], &time = level["microseconds"];
    const auto of = [](const json& values, const char* name) { return values.is_null() ? json() : values[name]; };
    fmt::print("{:>5} {:9} {:13} {:11.1f} % {:21.1f} % {:>23} {:>7} {:>7} {:13.0f} {:>13} {:>5}\n",
               level["level"].get<std::string>(), level["poses"].get<std::size_t>(),
               level["decided_no"].get<std::size_t>(), 100 * level["decided_of_separated"].get<double>(),
               100 * level["decided_of_left_by_roots"].get<double>(), four_digits(of(bound, "p10")),
               four_digits(of(bound, "median")), four_digits(of(bound, "p90")), level["sphere_tests"].get<double>(),
               time.is_null() ? "-" : fmt::format("{:.2f}", time["median"].get<double>()),
               time.is_null() ? "-" : fmt::format("{:.1f}", time["p99"].get<double>()));
  }
}

std::string chart(const json& report, const std::string& title) {
  std::vector<plot::Plot> plots = profile_plots(report);
  for (plot::Plot& plot : plots) plot.title = title + ": " + plot.title;
  return plot::to_svg(plots, 3);
}

// Every pose with what each level said, for other programs: a row a level.
std::string table(const std::vector<PosePair>& poses, const std::vector<PoseProfile>& profiles, double radius) {
  std::ostringstream out;
  out.precision(17);
  out << "pose,level,answer,bound_over_radius,sphere_tests,microseconds,rotation_a,translation_a,rotation_b,"
         "translation_b\n";
  const auto list = [](const auto& values) {
    std::ostringstream text;
    text.precision(17);
    for (std::size_t i = 0; i < values.size(); ++i) text << (i > 0 ? " " : "") << values[i];
    return text.str();
  };
  const auto row = [&](std::size_t i, const std::string& level, const AtLevel& at) {
    out << i << ',' << level << ','
        << (at.answer == Answer::no    ? "no"
            : at.answer == Answer::yes ? "yes"
                                       : "maybe")
        << ',';
    if (std::isfinite(at.bound)) out << at.bound / radius;
    out << ',' << at.tests << ',' << at.microseconds << ',' << list(poses[i].a.rotation) << ','
        << list(poses[i].a.translation) << ',' << list(poses[i].b.rotation) << ',' << list(poses[i].b.translation)
        << '\n';
  };
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const PoseProfile& p = profiles[i];
    for (std::size_t level = 0; level < p.levels.size(); ++level) row(i, std::to_string(level), p.levels[level]);
    if (p.levels.back().answer != Answer::no) row(i, "exact", p.exact);
  }
  return out.str();
}

}  // namespace

void profile(const ProfileCommand& command) {
  if (command.report && command.folder.empty())
    throw InputError("--report needs -o FOLDER, where the page is written to");
  const std::filesystem::path& second = command.b.empty() ? command.a : command.b;
  check_input(command.a);
  check_input(second);
  const std::vector<std::filesystem::path> inputs{command.a, second};
  for (const auto* file : {&command.plot, &command.csv})
    if (!file->empty()) check_output(*file, inputs);
  const Provenance provenance = provenance_of(command.output.run, inputs);
  const Destination destination{.folder = command.folder,
                                .report = named(command.a, "-profile.json"),
                                .provenance = provenance,
                                .force = command.output.force};
  if (!command.folder.empty()) check_outputs(destination, std::array{page_name(command.a, "profile")}, inputs);
  const runtime::PackedSphereTree a = load_tree(command.a), b = load_tree(second);
  if (a.triangles.empty() || b.triangles.empty())
    throw InputError(fmt::format("{}: the tree has no triangles, which decide which poses touch; build it again",
                                 (a.triangles.empty() ? command.a : second).string()));
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const Progress progress = bar.callback();
  report_progress(progress, "flights", 0);
  const std::vector<PosePair> poses = flight_poses(a, b, command.flights, command.seed);
  if (poses.empty()) throw InputError("no flight led to a pose; ask for more with --flights");
  constexpr std::size_t room = 1u << 20;
  const runtime::PreparedTree body_a(a), body_b(b);
  runtime::NarrowPhase pair(body_a, body_b, room);
  std::vector<PoseProfile> profiles;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i % 64 == 0) report_progress(progress, "poses", static_cast<double>(i) / static_cast<double>(poses.size()));
    profiles.push_back(profile_pose(pair, poses[i]));
  }
  bar.clear();
  const double radius = root_ball(a).radius;
  json report = Profile(profiles, radius).report();
  report["a"] = command.a.string();
  report["b"] = second.string();
  report["flights"] = command.flights;
  report["seed"] = command.seed;
  report["provenance"] = to_json(provenance);
  {
    const Writing writing;
    // Whatever ending the user's names have.
    const std::string line = line_of(provenance);
    if (!command.plot.empty())
      write_file(command.plot, stamped(chart(report, command.a.filename().string()), "plot.svg", line));
    if (!command.csv.empty()) write_file(command.csv, stamped(table(poses, profiles, radius), "table.csv", line));
  }
  std::optional<Outputs> outputs;
  if (!command.folder.empty()) {
    outputs.emplace(destination);
    outputs->add_report(report, "this report as JSON");
    if (command.report) write_report_page(page_name(command.a, "profile"), {.report = report}, *outputs);
    outputs->commit();
  }
  if (command.output.json) {
    fmt::print("{}\n", report.dump(2));
  } else if (!command.output.quiet) {
    print_profile(report);
    if (outputs) outputs->print();
    if (!command.plot.empty()) fmt::print("  {}  (the table as a plot)\n", command.plot.string());
    if (!command.csv.empty()) fmt::print("  {}  (every pose)\n", command.csv.string());
  }
}

}  // namespace orchard::apps
