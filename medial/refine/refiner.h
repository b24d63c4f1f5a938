#pragma once
#include <array>
#include <span>
#include <vector>

#include "../balls/ball_complex.h"
#include "../balls/found_balls.h"
#include "../balls/split.h"
#include "../extend/borders.h"
#include "../reach/dents_below.h"
#include "../reach/uncovered.h"
#include "cover_guard.h"
#include "orchard/medial/refine.h"

namespace orchard::detail {

// Diagonals: places of the surface that a refined axis leaves open by less are not reached for. `points`: how many the
// axis was built from.
double left_open(const Surface& surface, const RefineOptions& options, Index points);

// The steps of refine_axis(), for who looks at what the first ones make before the last ones run. What is given by
// reference must outlive it, unchanged. The surface must be a solid.
class Refiner {
 public:
  // Throws InputError if an option is out of range.
  Refiner(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis, const RefineOptions& options,
          const Progress& progress);

  // All steps but dividing what is not linear and reaching for places left open. To be called once, first. Takes
  // balls from `found`, if given, and adds those that it has to find.
  void refine(FoundBalls* found = nullptr);
  // What there is so far.
  MedialMesh mesh() const { return complex_.mesh(); }
  // Mesh units: what is left open by less is not reached for.
  double left_open() const;
  // Divides, reaches, takes degenerate cells away, and gives the result. To be called once, last.
  RefinedAxis finish();

 private:
  BallSolver solver() const;
  ClosestPoint place(Index point) const;
  const std::array<Index, 2>& points_of(Index face) const;
  std::span<const Index> corners_of(Index face) const;
  bool folded(Index face, BallSolver& solver) const;
  BorderOptions border_options() const;
  SplitOptions split_options() const;

  void make_complex();
  void seeds_of(Index vertex, const std::vector<Index>& face_of_middle, std::vector<ClosestPoint>& seeds) const;
  void find_balls(FoundBalls* found);
  void drop_folded();
  void reach_edges();
  void divide();
  void even_out();
  bool reach();
  Index reach_for(const Reconstruction& reconstruction, const std::vector<UncoveredPlace>& places, BallSolver& solver);
  RefinedAxis result();

  const Surface& surface_;
  const SurfaceSampling& sampling_;
  const MedialAxis& axis_;
  const RefineOptions& options_;
  const Progress& progress_;
  const double diagonal_, level_;  // mesh units
  BallComplex complex_;
  const CoverGuard guard_;                     // of the surface points, against all that is taken away
  std::vector<Point> places_;                  // of the surface: what is covered of them stays covered
  std::vector<std::array<double, 3>> evened_;  // centres of the vertices after evening out, ascending
  const FeatureEdges features_;
  SplitErrors split_errors_;
  std::vector<Index> face_of_triangle_;  // of the axis as it came
  RefineReport report_;
};

}  // namespace orchard::detail
