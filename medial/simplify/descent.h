#pragma once
#include <span>
#include <vector>

#include "fit.h"
#include "orchard/medial/simplify.h"

namespace orchard::detail {

// A medial mesh on its way to fewer vertices, with the feet of the samples on it.
struct Stage {
  ContractibleMesh mesh;
  std::vector<FitSample> samples;
  Assignment feet;  // of the samples
  // The kind of balls that contractions make before they are fitted.
  SimplifiedBalls contracted = SimplifiedBalls::free;
};

// Reduces a medial mesh to fewer and fewer vertices.
class Descent {
 public:
  Descent(const Surface& surface, const MedialMesh& mesh, const SimplifyOptions& options, const Progress& progress);

  // Starts with all vertices. Contractions to free balls optimise over more balls, and those to medial balls leave less
  // to repair afterwards. Either may lead to the better result.
  Stage start(SimplifiedBalls contracted) const;
  // Contracts until `count` vertices are left or no edge may be contracted, and fits the balls in between.
  void go_down(Stage& stage, Index count) const;
  // Returns the stage with balls that are fitted as well as possible, and with vertices moved to where they reduce the
  // error. Their number does not grow.
  Stage finished(Stage stage) const;
  SimplifiedMedialMesh measured(const Stage& stage) const;

 private:
  void contract(Stage& stage, Index count) const;
  // Examines other places of the surface, new ones in each round, and adds the worst of them to the samples.
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
  std::vector<Sphere> axis_balls_;  // the balls of the mesh at the beginning
};

}  // namespace orchard::detail
