#include "medial/medial_tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "command_line/number_text.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

template <class Set>
TuningFlag real(const char* name, const char* standard, double low, double high, const char* help, Set set) {
  return {.name = name,
          .help = help,
          .standard = standard,
          .choices = {},
          .low = low,
          .high = high,
          .set = [set](MedialTuning& tuning, const std::string& text) { set(tuning, *finite_number(text)); }};
}

template <class Set>
TuningFlag whole(const char* name, const char* standard, double low, double high, const char* help, Set set) {
  TuningFlag flag = real(name, standard, low, high, help, set);
  flag.whole = true;
  return flag;
}

TuningFlag choice(const char* name, std::vector<std::string> choices, const char* help,
                  std::function<void(MedialTuning&, const std::string&)> set) {
  return {.name = name, .help = help, .standard = choices.front(), .choices = choices, .set = std::move(set)};
}

TuningFlag unused_where(TuningFlag flag, std::function<std::string(const MedialTuning&)> unused) {
  flag.unused = std::move(unused);
  return flag;
}

void set_relaxation(MedialTuning& tuning, const std::string& text) {
  tuning.options.sampling.relaxation = text == "clusters"    ? Relaxation::clusters
                                       : text == "neighbors" ? Relaxation::neighbors
                                                             : Relaxation::automatic;
}

void set_gaps(MedialTuning& tuning, const std::string& text) {
  tuning.options.repair_gaps = text != "none";
  tuning.options.gap_repair.definition = text == "loose"    ? GapDefinition::loose
                                         : text == "strict" ? GapDefinition::strict
                                                            : GapDefinition::connected;
}

using T = MedialTuning;

// Only relaxation across faces has creases, and only edge points lie on them.
std::string no_creases(const T& t) {
  if (t.options.sampling.relaxation == Relaxation::clusters) return "--relaxation clusters";
  return t.edge_samples == Index{0} ? "--edge-samples 0" : "";
}

std::string no_repair(const T& t) { return t.options.repair_gaps ? "" : "--gaps none"; }

// Only where points were added are points taken out.
std::string no_thinning(const T& t) {
  return t.options.repair_gaps && t.options.gap_repair.max_passes == 0 ? "--max-passes 0" : no_repair(t);
}

std::string no_refining(const T& t) { return t.refine ? "" : "--refine no (--raw)"; }

std::vector<TuningFlag> point_flags() {
  return {
      whole("samples", "5000", 20, 1e7, "Surface points: more follow the shape better, and take longer",
            [](T& t, double x) { t.samples = static_cast<Index>(x); }),
      whole("edge-samples", "a fifth", 0, 1e7,
            "Of them along edges: more make sheets reach sharp edges, fewer resolve the faces better",
            [](T& t, double x) { t.edge_samples = static_cast<Index>(x); }),
      choice("relaxation", {"automatic", "clusters", "neighbors"},
             "Points keep apart within flat clusters (designed parts) or across faces (scans)", set_relaxation),
      whole("iterations", "40", 0, 1000, "Of relaxation: more even points give smoother sheets",
            [](T& t, double x) { t.options.sampling.iterations = static_cast<int>(x); }),
      real("cluster-angle", "0.0057", 0, 90,
           "Degrees that a cluster may turn: more treats curved parts as one face without edges",
           [](T& t, double x) { t.cluster_degrees = x; }),
      unused_where(real("crease-angle", "28.6", 0, 180, "Degrees from which a scan has an edge that gets edge points",
                        [](T& t, double x) { t.options.sampling.crease_angle = x * kRadians; }),
                   no_creases),
      whole("seed", "1", 0, 4294967295.0, "Of the random points: another draw of the same density",
            [](T& t, double x) { t.options.sampling.seed = static_cast<std::uint64_t>(x); })};
}

std::vector<TuningFlag> diagram_flags() {
  return {
      choice("algorithm", {"highest-first", "inagaki", "bowyer", "exact"},
             "Of the Voronoi diagram; inagaki and bowyer are for comparison, and need well-spread points",
             [](T& t, const std::string& text) { t.options.algorithm = *voronoi_algorithm_named(text); }),
      choice("gaps", {"connected", "loose", "strict", "none"},
             "What counts as a gap to mend: loose misses some, strict adds most points, none breaks thin parts",
             set_gaps),
      unused_where(real("joined-radius", "0", 0, 1000,
                        "Crossings joined within so many point distances are forgiven: fewer points, no guarantee",
                        [](T& t, double x) { t.options.gap_repair.joined_radius = x; }),
                   no_repair),
      unused_where(whole("max-passes", "20", 0, 1000, "Of gap repair at most: fewer leave gaps that need more",
                         [](T& t, double x) { t.options.gap_repair.max_passes = static_cast<int>(x); }),
                   no_repair),
      unused_where(choice("thin", {"no", "yes"},
                          "Whether pairs of facing points that crowd thin parts go again: fewer points, coarser there",
                          [](T& t, const std::string& text) { t.options.gap_repair.thin = text == "yes"; }),
                   no_thinning)};
}

std::vector<TuningFlag> axis_flags() {
  return {real("coalesce", "1e-7", 1e-12, 0.01,
               "Vertices nearer than this, in bounding radii, become one: more loses detail and may lose loops",
               [](T& t, double x) { t.options.axis.coalesce = x; }),
          choice("topology", {"keep", "free"},
                 "Whether single edges may stand for faces where gaps that cannot be mended spoil the topology",
                 [](T& t, const std::string& text) { t.keep_topology = text == "keep"; })};
}

std::vector<TuningFlag> pruning_flags() {
  return {real("prune-angle", "0", 0, 180,
               "Degrees: cuts spurs whose two contacts are nearer in angle; more loses sheets into shallow edges",
               [](T& t, double x) { t.prune_degrees = x; }),
          real("prune-scale", "1", 1, 10,
               "Cuts balls that others hold when all are so many times larger; more loses small features",
               [](T& t, double x) { t.options.prune.scale = x; })};
}

std::vector<TuningFlag> refining_flags() {
  return {
      choice("refine", {"yes", "no"},
             "Whether balls are made exact and sheets end smoothly, or the axis stays as the diagram has it (--raw)",
             [](T& t, const std::string& text) { t.refine = text == "yes"; }),
      unused_where(
          real("border-loss", "0.1", 0, 100,
               "Percent of the diagonal that a sheet's border may lose of the surface: more cuts more spurs off",
               [](T& t, double x) { t.refinement.border_loss = x / 100; }),
          no_refining),
      unused_where(real("linear-error", "0.05", 1e-4, 100,
                        "Percent of the diagonal that balls between two vertices may be off: less makes more vertices",
                        [](T& t, double x) { t.refinement.tolerance = x / 100; }),
                   no_refining),
      unused_where(
          whole("reach-rounds", "9", 0, 100,
                "Times that sheets reach for what they leave open by more than 1.65 border losses: 0 leaves out blunt "
                "edges and ridges that no point shows",
                [](T& t, double x) { t.refinement.reach_rounds = static_cast<int>(x); }),
          no_refining),
      unused_where(real("feature-loss", "0.165", 1e-4, 100,
                        "Percent of the diagonal: sheets reach to convex edges beyond which so much is lost otherwise",
                        [](T& t, double x) { t.refinement.feature_loss = x / 100; }),
                   no_refining),
      unused_where(
          real("edge-length", "3", 0.05, 100,
               "Percent of the diagonal that edges of the axis are long: less makes more and smaller triangles",
               [](T& t, double x) { t.refinement.edge_length = x / 100; }),
          no_refining)};
}

std::vector<TuningFlag> open_place_flags() {
  return {
      unused_where(whole("open-rounds", "1", 0, 20,
                         "Times that points are added where the surface is left open, and everything is rebuilt: more "
                         "resolve thin parts, and take longer",
                         [](T& t, double x) { t.options.open_rounds = static_cast<int>(x); }),
                   no_refining)};
}

std::vector<TuningFlag> report_flags() {
  return {real("segment-angle", "60", 0, 180,
               "Degrees: faces with nearer contacts do not divide sheets; more makes fewer segments",
               [](T& t, double x) { t.segment_degrees = x; })};
}

std::vector<TuningFlag> make_flags() {
  std::vector<TuningFlag> flags;
  const auto add = [&flags](TuningStep step, std::vector<TuningFlag> some) {
    for (TuningFlag& flag : some) {
      flag.step = step;
      flags.push_back(std::move(flag));
    }
  };
  add(TuningStep::points, point_flags());
  add(TuningStep::diagram, diagram_flags());
  add(TuningStep::axis, axis_flags());
  add(TuningStep::pruning, pruning_flags());
  add(TuningStep::refining, refining_flags());
  add(TuningStep::open_places, open_place_flags());
  add(TuningStep::report, report_flags());
  return flags;
}

}  // namespace

MedialBuildOptions build_options(const MedialTuning& tuning) {
  MedialBuildOptions options = tuning.options;
  const Index samples = tuning.samples.value_or(kStandardSamples), edges = tuning.edge_samples.value_or(samples / 5);
  if (edges > samples) throw InputError("--edge-samples: more than --samples");
  options.sampling.edge_points = edges;
  options.sampling.face_points = samples - edges;
  if (tuning.cluster_degrees) options.sampling.cluster_angle = *tuning.cluster_degrees * kRadians;
  options.prune.angle = std::min(tuning.prune_degrees * kRadians, std::numbers::pi);
  options.axis.keep_topology = tuning.keep_topology;
  if (tuning.refine) options.refine.emplace(tuning.refinement);
  return options;
}

std::string TuningFlag::range() const {
  return choices.empty() ? fmt::format("{} to {}", low, high) : fmt::format("{}", fmt::join(choices, ", "));
}

std::string TuningFlag::fault(const std::string& value) const {
  bool good = false;
  if (choices.empty()) {
    const std::optional<double> x = finite_number(value);
    good = x && *x >= low && *x <= high && (!whole || *x == std::floor(*x));
  } else {
    good = std::find(choices.begin(), choices.end(), value) != choices.end();
  }
  if (good) return {};
  return fmt::format("{} is not {}{}", value,
                     !choices.empty() ? "one of "
                     : whole          ? "a whole number from "
                                      : "a number from ",
                     range());
}

const std::vector<TuningFlag>& tuning_flags() {
  static const std::vector<TuningFlag> flags = make_flags();
  return flags;
}

}  // namespace orchard::apps
