#include <chrono>
#include <optional>

#include "orchard/geometry/error.h"
#include "orchard/spheretree/build.h"

namespace orchard {
namespace {

using Clock = std::chrono::steady_clock;

// Builds one tree after the other and keeps the tightest, until the time is over.
class Attempts {
 public:
  Attempts(double seconds, const Surface& surface, const SphereTreeOptions& options, const Progress& progress,
           const MedialBuildInput& input)
      : seconds_(seconds), surface_(surface), options_(options), progress_(progress), input_(input) {}

  SphereTreeBuild run() {
    SphereTreeOptions octree = options_;
    octree.method = TreeMethod::octree;
    octree.branching = 8;
    octree.spheres.clear();
    best_.emplace(build_sphere_tree(surface_, octree, progress_));
    options_.method = TreeMethod::tightened;
    for (const Effort effort : {Effort::low, Effort::standard}) attempt(effort);
    for (; !over(); ++options_.seed) attempt(Effort::high);
    return std::move(*best_);
  }

 private:
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool over() const { return elapsed() >= seconds_; }

  void attempt(Effort effort) {
    if (over()) return;
    options_.effort = effort;
    const auto until_over = [&](std::string_view stage, double) {
      if (progress_ && !progress_(stage, std::min(1.0, elapsed() / seconds_))) stopped_ = true;
      return !stopped_ && !over();
    };
    try {
      keep_if_tighter(build_sphere_tree(surface_, options_, until_over, input_));
    } catch (const Cancelled&) {
      if (stopped_) throw;  // by who waits, not by the clock
    }
  }

  // A tree that has fewer levels than asked for, as where spheres ran out of surface points, is judged by those it has.
  void keep_if_tighter(SphereTreeBuild next) {
    const bool first = best_->tightening.levels.empty();
    if (first || overall_inaccuracy(next.tree) < overall_inaccuracy(best_->tree)) best_ = std::move(next);
  }

  const double seconds_;
  const Surface& surface_;
  SphereTreeOptions options_;
  const Progress& progress_;
  const MedialBuildInput& input_;
  const Clock::time_point start_ = Clock::now();
  bool stopped_ = false;
  std::optional<SphereTreeBuild> best_;
};

}  // namespace

SphereTreeBuild build_sphere_tree_within(double seconds, const Surface& surface, const SphereTreeOptions& options,
                                         const Progress& progress, const MedialBuildInput& input) {
  if (!(seconds >= 0)) throw InputError("the time for a tree: a number of seconds, at least 0");
  return Attempts(seconds, surface, options, progress, input).run();
}

}  // namespace orchard
