#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/gap_crossing.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/annealing.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/descent.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/redundancy.h"
#include "orchard/spheretree/tightened.h"
#include "orchard/spheretree/tree.h"
#include "orchard/voronoi/highest_first.h"

namespace orchard::apps {

enum class Method { tightened, merging, annealing, octree };

struct BuildOptions {
  Method method = Method::tightened;
  Index depth = 3;      // levels below the root at most
  Index branching = 8;  // children of a node, see the builders; an octree has 8
  Effort effort = Effort::standard;
  Objective objective = Objective::balanced;
  SetEnergy energy = SetEnergy::maximum;
  MergeClosing closing = MergeClosing::refit;
  Refinement refinement;
  Index descent = 0;             // trials of random descent for each node, after any method
  std::optional<Index> samples;  // surface points, four fifths on faces, one fifth on edges; else samples_needed()
  std::uint64_t seed = 1;
};

// Surface points that a method and its depth need.
Index samples_needed(const BuildOptions& options);

// Everything that one run from a mesh to a packed tree made, and how long each stage took.
struct BuildResult {
  std::vector<std::pair<std::string, double>> seconds;  // stage, time
  SurfaceSampling sampling;
  InsertionReport voronoi;
  Index voronoi_vertices = 0;
  RepairReport repair;
  std::optional<MedialAxis> axis;  // not for an octree or annealing
  Index axis_components = 0;
  SphereTree tree;
  SphereTree octree;  // of the same depth, to compare with
  TightenReport tightening;
  MergeReport merging;
  AnnealingReport annealing;
  DescentReport descent;
  CoverReport cover;
  RedundancyReport redundancy;
  runtime::PackedSphereTree packed;
  Index bounds_weakened = 0;  // nodes with a bound that is weaker than measured, since only that is proven
};

// Throws InputError if the surface or an option does not allow it, and Error if the packed tree fails its certificate:
// what this returns is conservative.
BuildResult run_pipeline(const Surface& surface, const BuildOptions& options, const Progress& progress);

}  // namespace orchard::apps
