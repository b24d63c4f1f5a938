#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "fit_samples.h"
#include "foot.h"
#include "orchard/medial/simplify.h"

namespace orchard::detail {

// Places of a surface and the balls of a medial mesh that come nearest to them.
struct Assignment {
  std::vector<Foot> feet;  // one for each sample, whose depth is added to the value: what is missing at it, or too much
  double max = 0;          // of |value|

  double max_protrusion = 0;  // as the last fit() left it, of the balls that it looked at

  double worst() const { return std::max(max, max_protrusion); }
  // Deterministic; parallel.
  void find(const ContractibleMesh& mesh, std::span<const FitSample> samples);
  // Exact where the value is `enough` or more, or its negative or less; the others are somewhere between. Begins where
  // the feet are, if there is one for each sample; else faster where samples follow each other over the surface.
  // Several times as fast. Deterministic; parallel.
  void find_off(const ContractibleMesh& mesh, std::span<const FitSample> samples, double enough);
  // Near where the feet are.
  void walk(std::span<const FitSample> samples, const FootWalker& walker);

 private:
  void find_max();
};

struct FitOptions {
  double power = 2;  // of the distances whose weighted sum is made small; at least 2
  int steps = 5;
  // Contractions follow feet to places nearby; what came to protrude there from elsewhere is seen by a search alone.
  bool search = true;
  bool middles = true;  // look at balls in the middles of cells, too, which protrude where no sample is
};

// Moves the balls of a medial mesh, which keeps its cells, so that the boundary of its envelope comes to the samples,
// and no vertex' ball protrudes: Levenberg-Marquardt steps with every sample held by its foot; powers above 2 by
// reweighting. Balls that are to be medial are brought back to what they may be after each step, and what all samples
// together say of the volume counts, too. `feet` are cells of the mesh, or none; they are searched for if there are
// none, or options.search, and followed. Deterministic; parallel.
void fit(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet,
         SimplifiedBalls balls, const FitOptions& options);

// The nearest ball, or next to it, whose centre is not outside and whose radius is off its distance to the surface by
// `error` at most.
Ball4 medial_ball(const Surface& surface, const Ball4& ball, double error);
// Makes all balls of a mesh so.
void make_medial(const Surface& surface, ContractibleMesh& mesh, double error);

}  // namespace orchard::detail
