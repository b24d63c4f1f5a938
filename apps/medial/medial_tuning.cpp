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
      whole("samples", "5000", 20, 1e7,
            "Number of surface points. More points follow the shape more closely and take longer",
            [](T& t, double x) { t.samples = static_cast<Index>(x); }),
      whole("edge-samples", "a fifth", 0, 1e7,
            "Number of these points along edges. With more, sheets reach sharp edges; with fewer, the faces get more "
            "points",
            [](T& t, double x) { t.edge_samples = static_cast<Index>(x); }),
      choice("relaxation", {"automatic", "clusters", "neighbors"},
             "Which points repel each other: those of one flat cluster (clusters, for designed parts), all near ones "
             "across "
             "faces (neighbors, for scans), or those that suit the mesh (automatic)",
             set_relaxation),
      whole("iterations", "40", 0, 1000,
            "Rounds of relaxation. More rounds space the points more evenly and give smoother sheets",
            [](T& t, double x) { t.options.sampling.iterations = static_cast<int>(x); }),
      real("cluster-angle", "0.0057", 0, 90,
           "Largest angle in degrees between the normals of one cluster. Higher values treat curved regions as one "
           "face without edges",
           [](T& t, double x) { t.cluster_degrees = x; }),
      unused_where(
          real("crease-angle", "28.6", 0, 180, "Smallest angle in degrees at which an edge of a scan gets edge points",
               [](T& t, double x) { t.options.sampling.crease_angle = x * kRadians; }),
          no_creases),
      whole("seed", "1", 0, 4294967295.0,
            "Seed of the random points. Another seed gives another sample of the same density",
            [](T& t, double x) { t.options.sampling.seed = static_cast<std::uint64_t>(x); })};
}

std::vector<TuningFlag> diagram_flags() {
  return {choice("algorithm", {"highest-first", "inagaki", "bowyer", "exact"},
                 "Algorithm of the Voronoi diagram. inagaki and bowyer are the dissertation's, for comparison, and "
                 "need well-spread points",
                 [](T& t, const std::string& text) { t.options.algorithm = *voronoi_algorithm_named(text); }),
          choice("gaps", {"connected", "loose", "strict", "none"},
                 "Which gaps to repair: connected (default), loose (misses some), strict (adds most points) or none "
                 "(breaks thin parts)",
                 set_gaps),
          unused_where(real("joined-radius", "0", 0, 1000,
                            "Ignore gap crossings whose sides are connected within this many point distances. Higher "
                            "values add fewer points and give up the guarantee",
                            [](T& t, double x) { t.options.gap_repair.joined_radius = x; }),
                       no_repair),
          unused_where(
              whole("max-passes", "20", 0, 1000, "Largest number of passes of gap repair. Lower values may leave gaps",
                    [](T& t, double x) { t.options.gap_repair.max_passes = static_cast<int>(x); }),
              no_repair),
          unused_where(choice("thin", {"no", "yes"},
                              "Remove pairs of facing points that gap repair crowded into thin parts. Gives fewer "
                              "points and a coarser axis there",
                              [](T& t, const std::string& text) { t.options.gap_repair.thin = text == "yes"; }),
                       no_thinning)};
}

std::vector<TuningFlag> axis_flags() {
  return {
      real("coalesce", "1e-7", 1e-12, 0.01,
           "Merge vertices nearer than this, in bounding radii. Higher values lose detail and may lose loops",
           [](T& t, double x) { t.options.axis.coalesce = x; }),
      choice("topology", {"keep", "free"},
             "What to do where gaps that cannot be repaired would change the topology: replace faces by single edges "
             "(keep), or leave the faces (free)",
             [](T& t, const std::string& text) { t.keep_topology = text == "keep"; })};
}

std::vector<TuningFlag> pruning_flags() {
  return {
      real("prune angle", "0", 0, 180,
           "Remove spurs whose contacts are seen at less than this angle, in degrees. Higher values also remove sheets "
           "that run into shallow edges",
           [](T& t, double x) { t.prune_degrees = x; }),
      real("prune scale", "1", 1, 10,
           "Remove balls that lie in others when all are scaled by this factor. Higher values remove small features",
           [](T& t, double x) { t.options.prune.scale = x; }),
      real("prune border-loss", "0", 0, 100,
           "Remove borders beyond which less than this of the surface is left open, in percent of the diagonal; this "
           "shortens every sheet into a sharp edge",
           [](T& t, double x) { t.options.prune.border_loss = x / 100; }),
      real("prune lambda", "0", 0, 100,
           "Remove balls whose contacts fit into a ball of this radius, in percent of the diagonal. Higher values also "
           "remove thin parts",
           [](T& t, double x) { t.options.prune.lambda = x / 100; }),
      real("prune erosion", "0", 0, 100,
           "Remove places with less than this erosion thickness, in percent of the diagonal: how much longer a fire "
           "from the border of the axis takes to arrive than from the surface. Higher values remove short branches, "
           "however thick, and shorten the others",
           [](T& t, double x) { t.options.prune.erosion = x / 100; }),
      real(
          "prune geodesic", "0", 0, 400,
          "Remove balls whose contacts are joined by a shorter path on the surface, in percent of the diagonal. Higher "
          "values leave only the middle of thick parts. Takes longest",
          [](T& t, double x) { t.options.prune.geodesic = x / 100; })};
}

std::vector<TuningFlag> refining_flags() {
  return {
      choice("refine", {"yes", "no"},
             "Whether to make every ball exact and to mesh the sheets evenly (yes), or to keep the axis of the Voronoi "
             "diagram "
             "(no, the same as --raw)",
             [](T& t, const std::string& text) { t.refine = text == "yes"; }),
      unused_where(real("border-loss", "0.1", 0, 100,
                        "How much of the surface the border of a sheet may lose, in percent of the diagonal. Higher "
                        "values remove more spurs",
                        [](T& t, double x) { t.refinement.border_loss = x / 100; }),
                   no_refining),
      unused_where(real("linear-error", "0.05", 1e-4, 100,
                        "Largest error of balls that are interpolated between two vertices, in percent of the "
                        "diagonal. Lower values make more vertices",
                        [](T& t, double x) { t.refinement.tolerance = x / 100; }),
                   no_refining),
      unused_where(whole("reach-rounds", "9", 0, 100,
                         "Rounds in which sheets extend to places that they leave open by more than 1.65 border "
                         "losses. 0 leaves out blunt edges and ridges without surface points",
                         [](T& t, double x) { t.refinement.reach_rounds = static_cast<int>(x); }),
                   no_refining),
      unused_where(real("feature-loss", "0.165", 1e-4, 100,
                        "Extend sheets to convex edges where more than this is lost otherwise, in percent of the "
                        "diagonal. Lower values give more sheets",
                        [](T& t, double x) { t.refinement.feature_loss = x / 100; }),
                   no_refining),
      unused_where(real("edge-length", "3", 0.05, 100,
                        "Target length of the edges of the axis, in percent of the diagonal. Lower values make more "
                        "and smaller triangles",
                        [](T& t, double x) { t.refinement.edge_length = x / 100; }),
                   no_refining)};
}

std::vector<TuningFlag> open_place_flags() {
  return {unused_where(whole("open-rounds", "1", 0, 20,
                             "Rounds in which points are added where the surface is left open and the axis is rebuilt. "
                             "More rounds resolve thin parts and take longer",
                             [](T& t, double x) { t.options.open_rounds = static_cast<int>(x); }),
                       no_refining)};
}

std::vector<TuningFlag> report_flags() {
  return {real(
      "segment-angle", "60", 0, 180,
      "Smallest angle in degrees between the contacts of a face that is not a spur; spurs do not divide the axis into "
      "segments. Higher values make fewer segments",
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
