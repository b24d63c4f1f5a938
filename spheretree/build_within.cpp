#include <chrono>
#include <optional>

#include "orchard/geometry/error.h"
#include "orchard/spheretree/build.h"

namespace orchard {
namespace {

using Clock = std::chrono::steady_clock;

// Builds one tree after another and keeps the tightest, until the time is over.
class Attempts {
 public:
  Attempts(double seconds, const Surface& surface, const SphereTreeOptions& options, const Progress& progress,
           const MedialBuildInput& input)
      : seconds_(seconds),
        surface_(surface),
        options_(options),
        tightening_(std::get<TightenOptions>(options.tree)),
        progress_(progress),
        input_(input) {}

  SphereTreeBuild run() {
    SphereTreeOptions octree = options_;
    octree.tree = OctreeOptions{.depth = depth_of(tightening_), .refinement = tightening_.refinement};
    best_.emplace(build_sphere_tree(surface_, octree, progress_));
    for (const Effort effort : {Effort::low, Effort::standard}) attempt(effort);
    for (; !over(); next_seed()) attempt(Effort::high);
    return std::move(*best_);
  }

 private:
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool over() const { return elapsed() >= seconds_; }

  // Also changes the seed of the steps that follow the builder.
  void next_seed() {
    ++tightening_.seed;
    if (options_.anneal) ++options_.anneal->seed;
    if (options_.descent) ++options_.descent->seed;
  }

  void attempt(Effort effort) {
    if (over()) return;
    tightening_.effort = effort;
    options_.tree = tightening_;
    const auto until_over = [&](std::string_view stage, double) {
      if (progress_ && !progress_(stage, std::min(1.0, elapsed() / seconds_))) stopped_ = true;
      return !stopped_ && !over();
    };
    try {
      keep_if_tighter(build_sphere_tree(surface_, options_, until_over, input_));
    } catch (const Cancelled&) {
      if (stopped_) throw;  // the application stopped it, not the clock
    }
  }

  // A tree with fewer levels than asked for, which happens if there are more spheres than surface points, is judged by
  // the levels that it has.
  void keep_if_tighter(SphereTreeBuild next) {
    const bool first = best_->tightening.levels.empty();
    if (first || overall_inaccuracy(next.tree) < overall_inaccuracy(best_->tree)) best_ = std::move(next);
  }

  const double seconds_;
  const Surface& surface_;
  SphereTreeOptions options_;
  TightenOptions tightening_;
  const Progress& progress_;
  const MedialBuildInput& input_;
  const Clock::time_point start_ = Clock::now();
  bool stopped_ = false;
  std::optional<SphereTreeBuild> best_;
};

}  // namespace

SphereTreeBuild build_sphere_tree_within(double seconds, const Surface& surface, const SphereTreeOptions& options,
                                         const Progress& progress, const MedialBuildInput& input) {
  if (!(seconds >= 0)) throw InputError("the time for a tree must be a finite number of seconds, at least 0");
  if (method_of(options.tree) != TreeMethod::tightened)
    throw InputError("a tree within a time limit is a tightened one: give the options of that method");
  return Attempts(seconds, surface, options, progress, input).run();
}

}  // namespace orchard
