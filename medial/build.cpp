#include "orchard/medial/build.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "orchard/geometry/error.h"
#include "reach/open_places.h"
#include "refine/refiner.h"

namespace orchard {
namespace {

// As a fraction of the points. If gap repair and open places add fewer points, hardly any part is thinner than the
// point spacing. Reaching then closes open places nearly as well as points do, in a fraction of the time.
constexpr double kFewAdded = 1.0 / 32;
constexpr double kOnFeature = 1e-6;  // diagonals: a ball of radius 0 that is this near to an edge lies on it
// In border losses: if sheets cannot reach a place that is open by more, points have to be added there.
constexpr double kAlmost = 3;

class MedialBuilder {
 public:
  MedialBuilder(const Surface& surface, const MedialBuildOptions& options, const Progress& progress)
      : surface_(surface), options_(options), progress_(progress) {}

  MedialBuild run(MedialBuildInput input) {
    if (input.mesh) {
      import(*input.mesh);
      prune_axis();
      return std::move(build_);
    }
    const int rounds = input.sampling || input.diagram ? 0 : options_.open_rounds;
    if (input.diagram) {
      build_.sampling = std::move(input.diagram->sampling);
      build_.diagram = std::move(input.diagram->diagram);
      build_.points = build_.sampling.size();
    } else {
      make_diagram(std::move(input.sampling));
    }
    make_axis();
    if (options_.refine) refine(rounds);
    prune_axis();
    if (options_.check_promise) check_promise();
    return std::move(build_);
  }

 private:
  template <class Function>
  void stage(const char* name, Function&& function) {
    time_stage(build_.seconds, name, std::forward<Function>(function));
    // Stages of the same name are added up over all rounds.
    const auto last = std::prev(build_.seconds.end());
    const auto first =
        std::find_if(build_.seconds.begin(), last, [&](const auto& stage) { return stage.first == name; });
    if (first == last) return;
    first->second += last->second;
    build_.seconds.pop_back();
  }

  void sample(std::optional<SurfaceSampling> own) {
    stage("surface points", [&] {
      build_.sampling = own ? std::move(*own) : sample_surface(surface_, options_.sampling, progress_);
      build_.points = build_.sampling.size();
    });
  }

  void make_diagram(std::optional<SurfaceSampling> own) {
    sample(std::move(own));
    stage("Voronoi diagram", [&] {
      VoronoiBuild voronoi_build = voronoi(build_.sampling.points, options_.algorithm, progress_);
      build_.diagram = std::move(voronoi_build.diagram);
      build_.voronoi = std::move(voronoi_build.report);
    });
    if (!options_.repair_gaps) return;
    stage("gap repair", [&] {
      GapRepair repair = repair_gap_crossings(surface_, std::move(build_.sampling), std::move(build_.diagram),
                                              options_.gap_repair, progress_);
      build_.sampling = std::move(repair.sampling);
      build_.diagram = std::move(repair.diagram);
      build_.gap_repair = std::move(repair.report);
    });
  }

  void import(const MedialMesh& mesh) {
    sample(std::nullopt);
    stage("importing the axis", [&] {
      ImportedAxis imported = import_axis(surface_, mesh, std::move(build_.sampling), progress_);
      build_.axis = std::move(imported.axis);
      build_.sampling = std::move(imported.sampling);
      build_.balls_refused = imported.refused;
      build_.balls_adjusted = imported.adjusted;
      build_.ball_adjustment = imported.adjustment;
    });
  }

  void make_axis() {
    stage("medial axis",
          [&] { build_.axis = medial_axis(surface_, build_.sampling, build_.diagram, options_.axis, progress_); });
  }

  // The last step: refining would reach again for what pruning takes away.
  void prune_axis() {
    build_.unpruned_vertices = build_.axis.size();
    if (options_.prune.removes_nothing()) return;
    stage("pruning", [&] { build_.axis = prune(surface_, build_.axis, options_.prune, progress_); });
    keep_reached_features();
  }

  // Keeps those edges of the mesh on which a sheet still ends in balls of radius 0.
  void keep_reached_features() {
    const double near = kOnFeature * surface_.bounding_box().diagonal().norm();
    const std::vector<Point>& at = surface_.mesh().vertices;
    std::erase_if(build_.features, [&](const std::array<Index, 2>& edge) {
      const Point &a = at[edge[0]], along = at[edge[1]] - a;
      for (Index v = 0; v < build_.axis.size(); ++v) {
        if (build_.axis.radii[v] > 0) continue;
        const Vector apart = build_.axis.centers[v] - a;
        const double t = std::clamp(apart.dot(along) / along.squaredNorm(), 0.0, 1.0);
        if ((apart - t * along).norm() <= near) return false;
      }
      return true;
    });
  }

  void check_promise() {
    stage("promise", [&] {
      const AxisPromise promise = axis_promise(surface_, options_, build_.sampling.size());
      build_.promise = orchard::check_promise(surface_, medial_mesh(build_.axis), promise, progress_);
    });
  }

  // Refines the axis. In this many rounds, places that it leaves open become surface points before sheets are extended
  // to those that remain.
  void refine(int rounds) {
    std::optional<detail::Refiner> refiner;
    detail::FoundBalls found;
    for (int round = 0;; ++round) {
      stage("refining", [&] {
        refiner.emplace(surface_, build_.sampling, build_.axis, *options_.refine, progress_);
        refiner->refine(rounds > 0 ? &found : nullptr);
      });
      if (round == rounds || !add_open_places(*refiner)) break;
      make_axis();
    }
    stage("refining", [&] {
      RefinedAxis refined = refiner->finish();
      build_.axis = std::move(refined.axis);
      build_.refinement = refined.report;
      build_.features = std::move(refined.features);
    });
  }

  // Adds the places that a refined axis leaves open as points, and rebuilds the diagram. Returns false if they are so
  // few that reaching deals with them.
  bool add_open_places(const detail::Refiner& refiner) {
    SurfaceSampling added;
    const double limit = options_.refine->border_loss * surface_.bounding_box().diagonal().norm();
    stage("open places", [&] { added = detail::open_places(surface_, refiner.mesh(), build_.sampling, limit); });
    if (added.size() == 0) return false;
    const auto& origins = build_.sampling.origins;
    const auto needed = added.size() + std::count(origins.begin(), origins.end(), PointOrigin::repair);
    const bool is_reached = options_.refine->reach_rounds > 0 && refiner.left_open() <= kAlmost * limit;
    if (is_reached && static_cast<double>(needed) <= kFewAdded * build_.sampling.size()) return false;
    build_.open_places += added.size();
    SurfaceSampling all = std::move(build_.sampling);
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(all.points, added.points);
    append(all.triangles, added.triangles);
    append(all.features, added.features);
    append(all.origins, added.origins);
    const Index points = build_.points, added_before = build_.gap_repair.points_added,
                removed_before = build_.gap_repair.points_removed;
    make_diagram(std::move(all));
    build_.points = points;
    build_.gap_repair.points_added += added_before;
    build_.gap_repair.points_removed += removed_before;
    return true;
  }

  const Surface& surface_;
  const MedialBuildOptions& options_;
  const Progress& progress_;
  MedialBuild build_;
};

}  // namespace

MedialBuild build_medial_axis(const Surface& surface, const MedialBuildOptions& options, const Progress& progress,
                              MedialBuildInput input) {
  if (!surface.solid())
    throw InputError("the medial axis needs a solid: " + surface.report().faults() + "; repair the mesh first");
  if (options.open_rounds < 0)
    throw InputError("the number of rounds that add points at open places must be at least 0");
  if (input.sampling.has_value() + input.diagram.has_value() + input.mesh.has_value() > 1)
    throw InputError(
        "a medial axis is built from given points, a given diagram or a given axis, but not from several of these");
  return MedialBuilder(surface, options, progress).run(std::move(input));
}

AxisPromise axis_promise(const Surface& surface, const MedialBuildOptions& options, Index points) {
  AxisPromise promise{.open = {}, .protrusion = {}, .topology = options.axis.keep_topology};
  if (!options.refine) return promise;
  const RefineOptions& refine = *options.refine;
  promise.protrusion = detail::kMaxStickingOut * refine.tolerance;
  if (refine.reach_rounds > 0 && options.prune.removes_nothing())
    promise.open = detail::left_open(surface, refine, points) + refine.tolerance;
  return promise;
}

std::vector<int> repair_passes(const MedialBuild& build) {
  std::vector<int> pass_of_point(build.sampling.size(), 0);
  for (Index i = 0; i < pass_of_point.size(); ++i) {
    if (build.sampling.origins[i] == PointOrigin::repair) pass_of_point[i] = -1;
  }
  if (build.gap_repair.points_removed > 0) return pass_of_point;
  // The points of the last passes are the last points of the sampling, in the same order.
  const std::vector<GapRepairPass>& passes = build.gap_repair.passes;
  auto at = pass_of_point.rbegin();
  for (std::size_t pass = passes.size(); pass > 0; --pass) {
    const GapRepairPass& made = passes[pass - 1];
    at = std::fill_n(at, made.added_by_projection + made.added_by_snapping + made.added_at_necks,
                     static_cast<int>(pass));
  }
  return pass_of_point;
}

}  // namespace orchard
