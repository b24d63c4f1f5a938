#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "fit_samples.h"
#include "foot.h"
#include "orchard/medial/simplify.h"

namespace orchard::detail {

// For places of a surface (samples), their feet: the balls of a medial mesh that come nearest to them.
struct Assignment {
  std::vector<Foot> feet;  // one for each sample; with the sample's depth added, its value is what the balls miss
                           // there, or protrude if negative
  double max = 0;          // largest |value|

  double max_protrusion = 0;  // largest protrusion of the balls that the last fit() tested

  double worst() const { return std::max(max, max_protrusion); }
  // Finds all feet. Deterministic; parallel.
  void find(const ContractibleMesh& mesh, std::span<const FitSample> samples);
  // The same, several times as fast, but exact only for values of at least `enough` or at most -`enough`; other values
  // are only known to lie between these. Starts from the present feet, if there is one for each sample. If there is
  // not, it is faster if consecutive samples are neighbours on the surface. Deterministic; parallel.
  void find_off(const ContractibleMesh& mesh, std::span<const FitSample> samples, double enough);
  // Searches feet only near the present ones.
  void walk(std::span<const FitSample> samples, const FootWalker& walker);

 private:
  void find_max();
};

struct FitOptions {
  double power = 2;  // of the distances in the sum that is minimized; at least 2
  int steps = 5;
  // Whether feet are searched among all cells. Otherwise they are only followed to places nearby, and a ball from
  // elsewhere that has come to protrude there is not found.
  bool search = true;
  bool middles = true;  // also test balls in the middles of cells, which may protrude where no sample is
};

// Moves the balls of a medial mesh, whose cells stay, so that its envelope comes near the samples and
// no vertex's ball protrudes. It takes Levenberg-Marquardt steps in which every sample keeps its foot; powers above 2
// are reached by changing the samples' weights. If balls have to be medial, they are made so again after each step. The
// volume, as far as all samples together determine it, counts, too. `feet` must be on cells of the mesh, or empty; they
// are searched if they are empty or with options.search, and followed in any case. Deterministic; parallel.
void fit(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet,
         SimplifiedBalls balls, const FitOptions& options);

// A ball near the given one, about the nearest, whose centre is not outside the solid and whose radius differs from the
// distance to the surface by at most `error`.
Ball4 medial_ball(const Surface& surface, const Ball4& ball, double error);
// Replaces all balls of a mesh by their medial_ball().
void make_medial(const Surface& surface, ContractibleMesh& mesh, double error);

}  // namespace orchard::detail
