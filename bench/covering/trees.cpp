#include "trees.h"

#include <ctime>

#include "orchard/geometry/sampling.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/gap_crossing.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/merging.h"
#include "orchard/voronoi/highest_first.h"

namespace orchard::bench {

SphereTree merged_tree(const Surface& surface) {
  SurfaceSampling sampling = sample_surface(surface);
  VoronoiDiagram diagram = highest_first_voronoi(sampling.points).diagram;
  const GapRepair repaired = repair_gap_crossings(surface, std::move(sampling), std::move(diagram));
  SphereTree tree =
      merge_tree(surface, medial_axis(surface, repaired.sampling, repaired.diagram), {.closing = MergeClosing::growth})
          .tree;
  cover(tree, surface);
  return tree;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace orchard::bench
