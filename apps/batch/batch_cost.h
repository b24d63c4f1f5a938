#pragma once
#include "batch/manifest.h"
#include "batch/worker_command.h"
#include "command_line/commands.h"

namespace orchard::apps {

// What one mesh will take: processor time of one thread, and resident memory at its peak.
struct MeshCost {
  double seconds = 0, bytes = 0;
};

// triangles: of the mesh. Fitted to docs/results/build-cost.md for trees and to docs/results/growth.md for axes; sets
// of spheres differ most among shapes. Within a factor of two to four; meshes that are refused cost less.
MeshCost expected_cost(const WorkerCommand& worker, double triangles);

// `orchard batch .. --cost`: what the shards will take, the longest one first, and the lines that Slurm needs for that.
// Runs nothing. Cost: reads every .obj file, and the headers of the others.
void print_batch_cost(const BatchCommand& command, const WorkerCommand& worker, const Manifest& manifest,
                      const Shard& shard);

}  // namespace orchard::apps
