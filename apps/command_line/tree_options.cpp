#include "command_line/tree_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "command_line/list_option.h"
#include "command_line/number_validator.h"

namespace orchard::apps {
namespace {

const std::map<std::string, TreeMethod> kMethods{{"tightened", TreeMethod::tightened},
                                                 {"merging", TreeMethod::merging},
                                                 {"annealing", TreeMethod::annealing},
                                                 {"octree", TreeMethod::octree}};
const std::map<std::string, SetEnergy> kEnergies{{"maximum", SetEnergy::maximum}, {"sum", SetEnergy::sum}};
const std::map<std::string, SphereEnergy> kDistances{{"lemma", SphereEnergy::lemma},
                                                     {"samples", SphereEnergy::samples},
                                                     {"corrected-samples", SphereEnergy::corrected_samples}};
const std::map<std::string, Effort> kEfforts{
    {"low", Effort::low}, {"default", Effort::standard}, {"high", Effort::high}};
const std::map<std::string, Objective> kObjectives{{"balanced", Objective::balanced},
                                                   {"maximum", Objective::maximum},
                                                   {"mean", Objective::mean},
                                                   {"volume", Objective::volume}};

const std::map<std::string, Selection> kSelections{
    {"independent", Selection::independent}, {"acyclic", Selection::acyclic}, {"exhaustive", Selection::exhaustive}};
const std::map<std::string, MergeClosing> kClosings{{"refit", MergeClosing::refit}, {"growth", MergeClosing::growth}};

constexpr const char* kSchedule = "Annealing schedule (in place of --effort; defaults are the dissertation's)";

template <class Value>
const char* key_of(const std::map<std::string, Value>& names, Value value) {
  for (const auto& [key, candidate] : names)
    if (candidate == value) return key.c_str();
  return "";
}

template <class Value>
std::vector<std::string> keys(const std::map<std::string, Value>& names) {
  std::vector<std::string> list;
  list.reserve(names.size());
  for (const auto& entry : names) list.push_back(entry.first);
  return list;
}

template <class Value>
CLI::Option* add_choice(CLI::App& command, const char* option, const std::map<std::string, Value>& names, Value& value,
                        const char* what) {
  return command
      .add_option_function<std::string>(
          option, [&names, &value](const std::string& key) { value = names.at(key); }, what)
      ->check(CLI::IsMember(keys(names)));
}

// "x,y,z,r=E".
Refinement::Region parse_region(const std::string& text) {
  std::array<double, 5> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, values[i]);
    const char separator = i == 3 ? '=' : ',';
    const bool last = i + 1 == values.size();
    if (error != std::errc() || (last ? next != end : next == end || *next != separator))
      throw CLI::ValidationError("--region " + text +
                                 ": give a ball and the error allowed there as x,y,z,r=E in mesh units");
    at = next + 1;
  }
  const bool finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  if (!finite || !(values[3] > 0) || !(values[4] > 0))
    throw CLI::ValidationError("--region " + text + ": r and E must be above 0, all numbers finite");
  return {{Point(values[0], values[1], values[2]), values[3]}, values[4]};
}

// A number of the annealing schedule, which is kept until the effort is known.
template <class Number>
void add_schedule(CLI::App& command, TreeRequest& tree, const char* option, Number AnnealingOptions::*number,
                  const char* what, const CLI::Validator& check) {
  command
      .add_option_function<Number>(
          option,
          [&tree, number](const Number& value) {
            tree.schedule.push_back([number, value](AnnealingOptions& options) { options.*number = value; });
          },
          what)
      ->check(check)
      ->group(kSchedule);
}

// Adds the numbers of dissertation 5.3.1, which replace those of the effort.
void add_annealing_options(CLI::App& command, TreeRequest& tree) {
  const auto share = NumberValidator(CLI::Range(1e-6, 1 - 1e-6));
  const auto count = CLI::Range(1, 1'000'000);
  const auto add = [&](const char* option, auto number, const char* what, const auto& check) {
    add_schedule(command, tree, option, number, what, check);
  };
  add_choice(command, "--anneal-distance", kDistances, tree.distance,
             "How to estimate the looseness of a sphere: by Lemma 5.1 (lemma, default), by the largest distance at 20 "
             "points (samples), or by that distance corrected to an upper bound (corrected-samples)")
      ->group(kSchedule);
  add("--anneal-move", &AnnealingOptions::move, "Longest translation of one change, in radii of the parent [0.035]",
      NumberValidator(CLI::Range(0.0, 1.0)));
  add("--anneal-min-scale", &AnnealingOptions::min_scale, "Smallest factor of one change of a radius [0.95]",
      NumberValidator(CLI::Range(0.01, 1.0)));
  add("--anneal-max-scale", &AnnealingOptions::max_scale, "Largest factor of one change of a radius [1.053]",
      NumberValidator(CLI::Range(1.0, 100.0)));
  add("--anneal-first-trials", &AnnealingOptions::first_trials,
      "Changes from which the first temperature is estimated [40]", count);
  add("--anneal-first-acceptance", &AnnealingOptions::first_acceptance,
      "Probability that a rise of average size is accepted at the first temperature [0.9]", share);
  add("--anneal-max-accepted", &AnnealingOptions::max_accepted,
      "Largest number of accepted changes at one temperature [200]", count);
  add("--anneal-max-rejected", &AnnealingOptions::max_rejected,
      "Largest number of rejected changes at one temperature [200]", count);
  add("--anneal-max-uncovering", &AnnealingOptions::max_uncovering,
      "Largest number of changes at one temperature that uncover the surface and are retried [20000]", count);
  add("--anneal-cooling", &AnnealingOptions::cooling, "Factor from one temperature to the next [0.9]", share);
  add("--anneal-first-iterations", &AnnealingOptions::iterations_first,
      "Number of temperatures on the first level [100]", count);
  add("--anneal-iterations", &AnnealingOptions::iterations, "Number of temperatures on each level below [50]", count);
}

}  // namespace

const char* name(TreeMethod method) { return key_of(kMethods, method); }
const char* name(Effort effort) { return key_of(kEfforts, effort); }
const char* name(Objective objective) { return key_of(kObjectives, objective); }
const char* name(Selection selection) { return key_of(kSelections, selection); }

void add_tree_options(CLI::App& command, TreeRequest& tree) {
  add_choice(command, "--method", kMethods, tree.method,
             "Construction method: tightened (default, the tightest trees), merging (along the medial axis), annealing "
             "(as in the dissertation) or octree (the fastest)");
  auto* depth =
      command
          .add_option("--depth", tree.depth,
                      "Largest number of levels below the root. Each level costs about --branching times the one above")
          ->check(CLI::Range(1, 20))
          ->capture_default_str();
  auto* branching = command
                        .add_option("--branching", tree.branching,
                                    "Children per sphere: the average for tightened and merging, which distribute them "
                                    "by need, and the maximum for the others. Above 64 for tightened only")
                        ->check(CLI::Range(2, static_cast<int>(kMaxBranching)))
                        ->capture_default_str();
  add_list(command, "--spheres", tree.spheres,
           "tightened: largest number of spheres of each level, N1,N2,.., in place of --depth and --branching")
      ->excludes(depth)
      ->excludes(branching);
  add_choice(
      command, "--effort", kEfforts, tree.effort,
      "How long to search. The times of low, default and high are about 1 : 2 : 6 for tightened and 1 : 3 : 17 for "
      "annealing, where high is the dissertation's schedule");
  add_choice(
      command, "--objective", kObjectives, tree.objective,
      "tightened: what to minimise: the maximum inaccuracy (maximum), the mean inaccuracy (mean), the outside volume "
      "(volume) or a compromise of these (balanced, default)");
  add_choice(
      command, "--closing", kClosings, tree.closing,
      "merging: how spheres are made to cover the surface: by fitting them again (refit, default) or by enlarging "
      "them by a tenth at a time (growth, as in the dissertation)");
  add_choice(
      command, "--energy", kEnergies, tree.energy,
      "annealing: what to minimise in a set of siblings: the looseness of the loosest sphere (maximum, default) or the "
      "sum of all (sum)");
  add_annealing_options(command, tree);
  add_choice(
      command, "--redundant", kSelections, tree.redundancy,
      "Which redundant spheres to remove: all that the cover does not need (exhaustive, default); those that siblings "
      "and aunts cover, where removed spheres may depend on each other without cycles (acyclic); or those on "
      "which no other removed sphere depends (independent, as in the dissertation)");
  command.add_flag("--anneal", tree.anneal,
                   "Tighten the finished tree by annealing each set of siblings. No set becomes looser. Takes about as "
                   "long as --method annealing");
  command
      .add_option("--descent", tree.descent_trials,
                  "Tighten the finished tree by a random descent with this many trials per sphere. More trials "
                  "tighten it a little more and take longer")
      ->check(CLI::Range(0, 100'000))
      ->capture_default_str();
  command
      .add_option(
          "--error", tree.refinement.error,
          "Do not refine spheres whose inaccuracy is at most this, in mesh units (default: refine all down to --depth)")
      ->check(NumberValidator(CLI::NonNegativeNumber));
  command
      .add_option_function<std::vector<std::string>>(
          "--region",
          [&tree](const std::vector<std::string>& regions) {
            for (const std::string& region : regions) tree.refinement.regions.push_back(parse_region(region));
          },
          "x,y,z,r=E: use E in place of --error for spheres that meet the ball with centre x,y,z and radius r. May be "
          "repeated")
      ->allow_extra_args(false);
}

}  // namespace orchard::apps
