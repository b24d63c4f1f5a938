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

// In diagonals: a refined axis does not reach for places of the surface that it leaves open by less than this.
// `points`: the number of points that the axis was built from.
double left_open(const Surface& surface, const RefineOptions& options, Index points);

// The steps of refine_axis(), for callers that need the result of the first ones before the last ones run. Arguments
// that are given by reference must outlive it and not change. The surface must be a solid.
class Refiner {
 public:
  // Throws InputError if an option is out of range.
  Refiner(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis, const RefineOptions& options,
          const Progress& progress);

  // Runs all steps before those of finish(). Must be called once, and first. If `found` is given, takes exact balls
  // from it and adds those that are not there.
  void refine(FoundBalls* found = nullptr);
  // The axis so far.
  MedialMesh mesh() const { return complex_.mesh(); }
  // The value of the function above, in mesh units.
  double left_open() const;
  // Divides cells along which the balls are not linear, reaches for places that are left open, removes degenerate
  // cells, and returns the result. Must be called once, and last.
  RefinedAxis finish();

 private:
  BallSolver solver() const;
  ClosestPoint place(Index point) const;
  const std::array<Index, 2>& points_of(Index face) const;
  std::span<const Index> corners_of(Index face) const;
  bool has_single_contact(Index face, BallSolver& solver) const;
  BorderOptions border_options() const;
  SplitOptions split_options() const;

  void make_complex();
  void seeds_of(Index vertex, const std::vector<Index>& face_of_middle, std::vector<ClosestPoint>& seeds) const;
  void find_balls(FoundBalls* found);
  void drop_single_contact_faces();
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
  const CoverGuard guard_;                     // keeps the surface points covered whatever is removed
  std::vector<Point> places_;                  // places of the surface: those that are covered stay covered
  std::vector<std::array<double, 3>> evened_;  // centres of the vertices after evening out, ascending
  const FeatureEdges features_;
  SplitErrors split_errors_;
  std::vector<Index> face_of_triangle_;  // face of the given axis, for each triangle
  RefineReport report_;
};

}  // namespace orchard::detail
