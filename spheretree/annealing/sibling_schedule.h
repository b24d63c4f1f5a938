#pragma once
#include <vector>

#include "orchard/covering/incremental_cover.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/annealing.h"

namespace orchard::detail {

// Whether annealing returns the best state of the siblings or the last one.
enum class KeepBest : bool { no, yes };

// Anneals the children of one node (dissertation 5.3.1).
class SiblingSchedule {
 public:
  SiblingSchedule(SphereTree& tree, Index parent, const Surface& surface, const AnnealingOptions& options,
                  IncrementalCover& cover, AnnealingReport& report);

  void run(int iterations, KeepBest keep);

 private:
  enum class Outcome { accepted, rejected, uncovering };

  SphereNode& child(Index k) { return tree_.nodes[parent_.first_child + k]; }
  double energy_of(const Sphere& ball) const;
  double energy_of_set() const;
  Sphere changed(const Sphere& ball);
  double first_temperature();
  void run_at(double temperature);
  Outcome try_change(double temperature);
  void note_best();
  void restore_best();

  SphereTree& tree_;
  const SphereNode parent_;
  const Surface& surface_;
  const AnnealingOptions& options_;
  IncrementalCover& cover_;
  AnnealingReport& report_;
  Random random_;
  std::vector<double> energies_;
  double energy_ = 0, best_energy_ = 0;
  std::vector<Sphere> best_;
};

}  // namespace orchard::detail
