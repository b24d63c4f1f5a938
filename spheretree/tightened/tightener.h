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

// How much work the levels get; of everything, the best of some is kept.
struct Work {
  double trials;         // of the neighbourhood search, as a multiple of the standard number
  int searching_rounds;  // of closing a level: those in which the search goes on
  double closed_trials;  // for each ball of a level, of the search in closed levels
  Index explored;        // starts of the first level that are tried on a few samples, if it has few balls
  Index starts[2];       // of the first level, if it has few balls, and of the second, that are carried through
};

// Builds a tree level by level, each on the balls of the one above. Of each level the best of several covers is kept,
// and there is one rule for all of them: no level is looser, in the mean or the maximum of the inaccuracy, than the one
// above it, nor than any level of the octree for which it has the spheres. Of those that keep to it, the one with the
// lowest product of mean, maximum and outside volume is taken. Starts are the usual ones; where these break the rule,
// or where the balls' reach that they are fitted by is far from the inaccuracy, those of other measures and of the
// octree, too; and where all break it, the levels above are replaced by the octree's own, which leaves room for its
// next one.
class Tightener {
 public:
  // Keeps references to all but the root. Samples as surface_samples() gives them.
  Tightener(const Surface& surface, const Samples& samples, const Sphere& root, const TightenOptions& options,
            const Work& work, const WeightField& weights, const Progress& progress);
  TightenBuild run();
  // The same beside another one that has run on the same surface with less work: no level gets looser than allowed,
  // which is what its tree's levels are (as looseness_by_level() has it, beside this octree). Its first levels, as many
  // as `same`, are taken as they are.
  TightenBuild run_beside(const Tightener& other, Index same, std::span<const LevelLooseness> allowed,
                          const SphereTree& octree);

 private:
  // What a level's balls are searched from, and how; those with the same number have the same unit of cost.
  struct Start {
    LevelOptions options;
    std::vector<LevelBall> balls;  // none: seeded ones
    int kind = 0;
  };
  // What a level may have, and the octree that is_loosened() asks after.
  struct AllowedLooseness {
    const LevelLooseness& level;
    const SphereTree& octree;
  };
  // A level that covers the surface.
  struct Candidate {
    PartialTree partial;
    double looseness = 0;                    // what candidates are compared by
    double excess = 0;                       // over what the level may have, as a part of that; <= 0: it keeps to it
    bool is_octree = false;                  // as octree_level() makes it
    bool measures_well = true;               // whether the balls' reach is about their inaccuracy
    std::vector<double> center_distances{};  // signed distances of the last level's centres
    std::vector<double> inaccuracies{};      // of the last level's balls, in mesh units; none: not measured
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
  std::vector<Index> spheres_;  // that each level may have
  Sphere root_;
  OctreeReference octree_;
  PartialTree partial_;
  TightenReport report_;
  bool differs_ = false;              // whether the levels so far are others than those of the tree that this is beside
  Index octree_levels_ = 0;           // of partial_, which are the octree's own
  std::vector<double> excesses_{-1};  // of the levels so far
  std::vector<double> inaccuracies_;  // of the last level's balls, in mesh units
};

}  // namespace orchard::detail
