#include "orchard/medial/simplify.h"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "descent.h"
#include "least_vertices.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

using detail::ContractibleMesh;
using detail::Descent;
using detail::Stage;

constexpr const char* kSimplifyingStage = "simplifying the axis";

void check(const Surface& surface, const MedialMesh& mesh, const SimplifyOptions& options) {
  if (!surface.solid()) {
    throw InputError("a medial mesh is simplified for a solid: " + surface.report().faults() +
                     "; repair the mesh first");
  }
  validate(mesh);
  if (options.samples == 0 || options.check == 0)
    throw InputError("the number of samples for simplifying must be at least 1");
  if (options.rounds < 0) throw InputError("the number of rounds of simplifying must be at least 0");
}

// Whether a component consists of a single ball.
bool is_single_ball(const ContractibleMesh& mesh) { return mesh.living() == 1; }

SimplifiedMedialMesh finish(const Surface& surface, const MedialMesh& whole, const Descent& descent, Stage stage) {
  if (is_single_ball(stage.mesh)) {
    const Sphere ball = max_inscribed_ball(surface, whole);
    MedialMesh single;
    single.centers.push_back(ball.center);
    single.radii.push_back(ball.radius);
    return descent.measured({ContractibleMesh(single), {}, {}, {}});
  }
  return descent.measured(descent.finished(std::move(stage)));
}

std::string too_few(Index wanted, Index reached, Index least) {
  const std::string start = std::to_string(wanted) + " vertices are fewer than ";
  if (reached == least) return start + "the topology of the axis allows; at least " + std::to_string(least);
  return start + (wanted < least ? "the topology of the axis allows: " : "this axis was brought down to: ") +
         "contractions led to " + std::to_string(reached) +
         ", no complex with these loops and cavities has fewer than " + std::to_string(least) + "; at least " +
         std::to_string(reached);
}

// Returns a number of vertices, a half power of 2, that is tried for every larger number as well. Otherwise more
// vertices might give a worse result than fewer did; in this way, the distance does not rise with the number of
// vertices.
Index rung_below(Index count) {
  Index rung = 1;
  for (int k = 0;; ++k) {
    const auto next = static_cast<Index>(std::lround(std::exp2(0.5 * k)));
    if (next >= count) return rung;
    rung = next;
  }
}

std::vector<SimplifiedBalls> ways(const SimplifyOptions& options) {
  if (options.balls == SimplifiedBalls::free) return {SimplifiedBalls::free};
  return {SimplifiedBalls::free, SimplifiedBalls::medial};
}

SimplifiedMedialMesh nearer(SimplifiedMedialMesh more, SimplifiedMedialMesh fewer) {
  return fewer.report.upper <= more.report.upper ? std::move(fewer) : std::move(more);
}

// Finds the fewest vertices whose two-sided distance is proved to be within the limit, to a fiftieth, by bisection of
// their number, since the distance usually falls as the number grows. To tell 20,000 from 20,001 would take as long as
// all the steps before.
class FewestWithin {
 public:
  FewestWithin(const Surface& surface, const MedialMesh& mesh, const SimplifyOptions& options, const Progress& progress)
      : surface_(surface),
        mesh_(mesh),
        options_(options),
        progress_(progress),
        descent_(surface, mesh, options, progress) {}

  SimplifiedMedialMesh run() {
    Index high = mesh_.size(), low = 1;  // `high` vertices suffice as far as is known, and `low - 1` do not
    std::optional<SimplifiedMedialMesh> best;
    double min = std::numeric_limits<double>::infinity();
    // The first steps go from few to many, because few vertices take less time.
    Index next = std::min<Index>(high, kFirst);
    while (low <= high && !(best && high - low < low / kFiftieth)) {
      report_progress(progress_, kSimplifyingStage, progress_of(low, high));
      SimplifiedMedialMesh result = finish(surface_, mesh_, descent_, stage_of(next));
      min = std::min(min, result.report.upper);
      if (result.report.upper <= options_.error) {
        high = next - 1;
        const bool fewest = result.report.vertices > next || next == 1;  // the topology does not allow fewer
        best = std::move(result);
        if (fewest) break;
      } else {
        low = std::max(next, result.report.vertices) + 1;
      }
      next = best ? middle(low, high) : std::max(low, std::min<Index>(high, next * 2));
    }
    if (!best) {
      throw InputError(
          "error " + percent(options_.error) +
          " of the diagonal cannot be kept: no number of vertices of this axis is proved to come nearer than " +
          percent(min) + "; allow more, or refine the axis further");
    }
    return std::move(*best);
  }

 private:
  static constexpr Index kFirst = 256, kFiftieth = 50;

  static Index middle(Index low, Index high) {
    const double mean = std::sqrt(static_cast<double>(low) * static_cast<double>(high));
    return std::min(high, std::max(low, static_cast<Index>(mean)));
  }
  static std::string percent(double share) { return std::to_string(100 * share) + " %"; }
  double progress_of(Index low, Index high) const {
    return 1 - std::log(static_cast<double>(high) / low + 1) / std::log(static_cast<double>(mesh_.size()) + 1);
  }

  // Starts at the nearest stage with more vertices that has been reached before.
  Stage stage_of(Index count) {
    const auto found = stages_.lower_bound(count);
    Stage stage = found == stages_.end() ? descent_.start(SimplifiedBalls::free) : found->second;
    if (stage.mesh.living() > count) descent_.go_down(stage, count);
    stages_.insert_or_assign(stage.mesh.living(), stage);
    return stage;
  }

  const Surface& surface_;
  const MedialMesh& mesh_;
  const SimplifyOptions& options_;
  const Progress& progress_;
  const Descent descent_;
  std::map<Index, Stage> stages_;
};

}  // namespace

SimplifiedMedialMesh simplify_medial_mesh(const Surface& surface, const MedialMesh& mesh,
                                          const SimplifyOptions& options, const Progress& progress) {
  check(surface, mesh, options);
  if (options.vertices == 0) {
    if (!(options.error > 0)) throw InputError("simplifying needs a number of vertices, or an error above 0");
    return FewestWithin(surface, mesh, options, progress).run();
  }
  report_progress(progress, kSimplifyingStage, 0);
  const Descent descent(surface, mesh, options, progress);
  std::optional<SimplifiedMedialMesh> best;
  Index reached = mesh.size();
  for (const SimplifiedBalls contracted : ways(options)) {
    Stage stage = descent.start(contracted);
    for (const Index count : {options.vertices, rung_below(options.vertices)}) {
      const Index before = stage.mesh.living();
      descent.go_down(stage, count);
      reached = std::min(reached, stage.mesh.living());
      if (stage.mesh.living() > count) break;
      if (best && stage.mesh.living() == before) break;  // it is the same stage again
      SimplifiedMedialMesh result = finish(surface, mesh, descent, stage);
      best = best ? nearer(std::move(*best), std::move(result)) : std::move(result);
    }
  }
  if (!best) throw InputError(too_few(options.vertices, reached, detail::least_vertices(mesh)));
  report_progress(progress, kSimplifyingStage, 1);
  return std::move(*best);
}

std::vector<SimplifiedMedialMesh> simplify_to_each(const Surface& surface, const MedialMesh& mesh,
                                                   std::span<const Index> vertices, const SimplifyOptions& options,
                                                   const Progress& progress) {
  check(surface, mesh, options);
  const Descent descent(surface, mesh, options, progress);
  std::vector<SimplifiedMedialMesh> results;
  const std::vector<SimplifiedBalls> all_ways = ways(options);
  double done = 0;
  for (const SimplifiedBalls contracted : all_ways) {
    Stage stage = descent.start(contracted);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      report_progress(progress, kSimplifyingStage, done++ / static_cast<double>(all_ways.size() * vertices.size()));
      descent.go_down(stage, vertices[i]);
      if (stage.mesh.living() > vertices[i]) break;
      SimplifiedMedialMesh result = finish(surface, mesh, descent, stage);
      if (i < results.size()) {
        results[i] = nearer(std::move(results[i]), std::move(result));
      } else if (i == results.size()) {
        results.push_back(std::move(result));
      }
    }
  }
  for (std::size_t i = results.size(); i-- > 1;) results[i - 1] = nearer(std::move(results[i - 1]), results[i]);
  report_progress(progress, kSimplifyingStage, 1);
  return results;
}

}  // namespace orchard
