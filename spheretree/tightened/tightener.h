#pragma once
#include <optional>
#include <span>
#include <vector>

#include "level_reference.h"
#include "level_samples.h"
#include "level_solver.h"
#include "orchard/spheretree/tightened.h"
#include "partial_tree.h"
#include "tree_looseness.h"

namespace orchard::detail {

// The work for each level. Several candidates are built at each step, and the best ones are kept.
struct Work {
  double trials;         // trials of the neighbourhood search, as a multiple of the standard number
  int searching_rounds;  // rounds of closing a level during which the search continues
  double closed_trials;  // trials in a level that covers the surface, for each of its balls
  Index explored;        // starts of the first level that are tried on a few samples, if the level has few balls
  Index starts[2];       // starts that are completed, of the first level if it has few balls, and of the second
};

// Builds a tree level by level. Each level is fitted within the balls of the level above, and the best of several
// covers is kept. One rule holds for all of them: neither the mean nor the maximum inaccuracy of a level may exceed
// that of the level above, or that of a level of the octree with at most as many spheres. Of the covers that satisfy
// the rule, the one with the smallest product of mean, maximum and outside volume is taken.
//
// The first starts are the usual ones. If their covers break the rule, or if the measure by which balls are fitted
// differs much from the inaccuracy, starts with other measures and from the octree are tried, too. If all covers break
// the rule, the levels above are replaced by those of the octree, so that the next level of the octree can follow.
class Tightener {
 public:
  // Keeps references to all arguments except the root. `samples` is the result of surface_samples().
  Tightener(const Surface& surface, const Samples& samples, const Sphere& root, const TightenOptions& options,
            const Work& work, const WeightField& weights, const Progress& progress);
  TightenBuild run();
  // Builds a tree that is nowhere looser than that of another tightener, which has run on the same surface with less
  // work. `allowed` is the looseness of the levels of its tree, as looseness_by_level() returns it for `octree`; no
  // level gets looser. The first `same` levels are copied from its tree.
  TightenBuild run_beside(const Tightener& other, Index same, std::span<const LevelLooseness> allowed,
                          const SphereTree& octree);

 private:
  // The initial balls of a search for a level, and its options. Starts of the same kind have the same unit of cost.
  struct Start {
    LevelOptions options;
    std::vector<LevelBall> balls;  // if empty, the search begins with random balls
    int kind = 0;
  };
  // The looseness that a level may have, and the octree for is_loosened().
  struct AllowedLooseness {
    const LevelLooseness& level;
    const SphereTree& octree;
  };
  // A level that covers the surface.
  struct Candidate {
    PartialTree partial;
    double looseness = 0;                    // the value by which candidates are compared
    double excess = 0;                       // relative to what the rule allows; at most 0 if the rule holds
    bool is_octree = false;                  // whether octree_level() made it
    bool measures_well = true;               // whether the measure of the balls is near their inaccuracy
    std::vector<double> center_distances{};  // signed distances of the last level's centres
    std::vector<double> inaccuracies{};      // of the last level's balls, in mesh units; empty if not measured
    TightenReport::Level report{};
  };
  TightenBuild result();
  bool build_level(Index level);
  void build_level_beside(Index level, const Tightener& other, const AllowedLooseness& allowed);
  bool take_cover_within(Index level, const PartialTree& usual, const AllowedLooseness& allowed);
  void restore_from(const Tightener& other, Index level);
  void hold_to(const AllowedLooseness& allowed, std::vector<Candidate>& all) const;
  void take_tightest(std::vector<Candidate>& all);
  std::optional<LevelOptions> next_level(Index level) const;
  LevelOptions options_for(Index level, Index balls) const;
  LevelCost cost_by(Objective objective, Index level) const;
  void add_candidates(std::vector<Start> starts, std::vector<Candidate>& all);
  void add_other_candidates(const LevelOptions& options, std::vector<Candidate>& all);
  static Candidate& tightest(std::vector<Candidate>& all);
  void cap(Candidate& candidate) const;
  double excess(const LevelTightness& level, Index balls);
  double excess_above(const Candidate& candidate) const;
  void take(Candidate best);
  std::vector<Start> usual_starts(const LevelOptions& options) const;
  std::vector<Start> other_starts(const LevelOptions& options) const;
  std::vector<std::vector<LevelBall>> promising_starts(LevelOptions options, Index wanted) const;
  std::vector<Candidate> candidates(std::vector<Start> starts, const Progress& progress) const;
  Candidate octree_level(Index level) const;
  void search_and_finish(LevelSolver& solver, const LevelOptions& options, const Progress& progress,
                         Candidate& result) const;
  void judge(Candidate& candidate, Index balls, bool by_looseness);

  const Surface& surface_;
  const Samples& samples_;
  const TightenOptions& options_;
  const Work work_;
  const WeightField& weights_;
  const Progress& progress_;
  std::vector<Index> spheres_;  // the maximum number of spheres of each level
  Sphere root_;
  OctreeReference octree_;
  PartialTree partial_;
  TightenReport report_;
  bool differs_ = false;              // whether the levels so far differ from those of the other tightener's tree
  Index octree_levels_ = 0;           // the number of levels of partial_ that are the octree's
  std::vector<double> excesses_{-1};  // of the levels so far
  std::vector<double> inaccuracies_;  // of the last level's balls, in mesh units
};

}  // namespace orchard::detail
