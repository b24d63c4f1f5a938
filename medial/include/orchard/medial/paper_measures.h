#pragma once
#include <cstdint>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

// Quality measures of published papers on medial axes, by the definitions of these papers.
namespace orchard {

// The options of paper_measures().
struct PaperOptions {
  Index samples = 10'000;  // Samples of the surface, and of the boundary of the reconstruction.
  double dilation = 0.02;  // The growth of the radii, over the longest side of the solid's box.
  // The maximum number of seam and junction vertices that are examined; they are chosen evenly.
  Index structure_cells = 20'000;
  std::uint64_t seed = 1;
};

// The measures that papers on medial axes report, by their own definitions, so that their numbers can be recomputed.
// They are sampled values and no bounds, and change with the samples; medial_quality() returns bounds.
// docs/reference/medial-measures.md lists the sources. A value is NaN if there is nothing to measure.
struct PaperMeasures {
  // Point2Skeleton (Lin et al. 2021): distances from samples of the surface and of the reconstruction's boundary, each
  // to the nearest sample of the other set, over the diagonal of the box. The sum of the two mean distances.
  double chamfer = 0;
  double sampled_hausdorff = 0;  // The largest of these distances.
  // Coverage Axis (Dou et al. 2022), which uses the balls alone, without the cones and slabs between them. The share of
  // the surface's samples that lie in balls whose radii are enlarged by the dilation.
  double covered = 0;
  // The smallest dilation that covers all samples, over the longest side; 0 if none is needed.
  double dilation_needed = 0;
  // MATStruct (Wang et al. 2025): the share of the balls on seams and at junctions that touch the surface at fewer
  // places than expected. The expected number is three on a seam and four where three or more seams meet.
  double wrong_structure = 0;
  Index structure_balls = 0;  // The number of balls that this share refers to.
};
// Computes the measures of a medial mesh for a solid. Throws InputError unless surface.solid() and validate(mesh)
// passes. The result is deterministic for a seed; the work is parallel.
PaperMeasures paper_measures(const Surface& surface, const MedialMesh& mesh, const PaperOptions& options = {});

}  // namespace orchard
