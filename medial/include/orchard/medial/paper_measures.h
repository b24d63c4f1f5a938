#pragma once
#include <cstdint>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {

struct PaperOptions {
  Index samples = 10'000;          // of the surface, and of the boundary of the reconstruction
  double dilation = 0.02;          // of the longest side of the solid's box
  Index structure_cells = 20'000;  // seam and junction vertices at most that are looked at, evenly chosen
  std::uint64_t seed = 1;
};

// What papers on medial axes print, by their own definitions, so that their numbers can be recomputed. Sampled: what
// they find is no bound, and grows or falls with the samples; medial_quality() has bounds.
// docs/reference/medial-measures.md has the sources. NaN where there is nothing to measure.
struct PaperMeasures {
  // Point2Skeleton (Lin et al. 2021): of samples of the surface and of the reconstruction's boundary, each to its
  // nearest one of the other set. Over the diagonal of the box.
  double chamfer = 0;            // the sum of the two mean distances
  double sampled_hausdorff = 0;  // the largest distance
  // Coverage Axis (Dou et al. 2022): of the balls alone, without what is between them.
  double covered = 0;  // share of the surface's samples that lie in balls, whose radii are larger by the dilation
  double dilation_needed = 0;  // the least that covers all samples, over the longest side; 0: none is needed
  // MATStruct (Wang et al. 2025): of the balls on seams and at junctions, the share that touch the surface at fewer
  // places than such balls do: three on a seam, four where three or more seams meet.
  double wrong_structure = 0;
  Index structure_balls = 0;  // that these are
};
// Deterministic for a seed; parallel. Throws InputError unless surface.solid() and validate(mesh) passes.
PaperMeasures paper_measures(const Surface& surface, const MedialMesh& mesh, const PaperOptions& options = {});

}  // namespace orchard
