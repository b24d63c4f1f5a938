#pragma once
#include "batch/manifest.h"
#include "batch/worker_command.h"
#include "command_line/commands.h"

namespace orchard::apps {

// The expected processor time of one thread and the expected peak of resident memory for one mesh.
struct MeshCost {
  double seconds = 0, bytes = 0;
};

// `triangles` is the number of triangles of the mesh. The formulas are fitted to docs/results/build-cost.md for trees
// and to docs/results/growth.md for axes; sets of spheres differ most between shapes. The result is right within a
// factor of two to four. Meshes that are refused cost less.
MeshCost expected_cost(const WorkerCommand& worker, double triangles);

// `orchard batch .. --cost`: prints what each shard is expected to take, the most expensive one first, and the lines
// that Slurm needs for it. Runs no command. Cost: reads every .obj file, and the headers of the others.
void print_batch_cost(const BatchCommand& command, const WorkerCommand& worker, const Manifest& manifest,
                      const Shard& shard);

}  // namespace orchard::apps
