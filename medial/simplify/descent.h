#pragma once
#include <span>
#include <vector>

#include "fit.h"
#include "orchard/medial/simplify.h"

namespace orchard::detail {

// A medial mesh on its way down, and where it stands to the samples.
struct Stage {
  ContractibleMesh mesh;
  std::vector<FitSample> samples;
  Assignment feet;                                     // of the samples
  SimplifiedBalls contracted = SimplifiedBalls::free;  // what balls contractions make, before they are fitted
};

// The way from a medial mesh to ever fewer vertices.
class Descent {
 public:
  Descent(const Surface& surface, const MedialMesh& mesh, const SimplifyOptions& options, const Progress& progress);

  // Contractions that make free balls see farther, those that make medial ones leave less to be mended: either may come
  // nearer in the end.
  Stage start(SimplifiedBalls contracted) const;
  // Contracts until `count` vertices are left, or nothing may be contracted; fits in between.
  void go_down(Stage& stage, Index count) const;
  // The balls fitted as well as they can be, and vertices moved to where they are needed: no more than there are.
  Stage finished(Stage stage) const;
  SimplifiedMedialMesh measured(const Stage& stage) const;

 private:
  void contract(Stage& stage, Index count) const;
  // Looks at other places of the surface, new ones in each round, and adds those that are off the most to the samples.
  void look_closer(Stage& stage, int round) const;
  void add_dents(Stage& stage, int round, double min_depth) const;
  void add(Stage& stage, std::span<const FitSample> samples) const;
  void refine(Stage& stage, std::span<const FitOptions> passes) const;

  const Surface& surface_;
  const SimplifyOptions& options_;
  const Progress& progress_;
  const double diagonal_;
  Index vertices_before_ = 0;
  ContractibleMesh whole_;
  std::vector<Sphere> axis_balls_;  // of the mesh at the beginning
};

}  // namespace orchard::detail
