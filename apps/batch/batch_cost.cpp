#include "batch/batch_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "batch/batch_progress.h"
#include "batch/mebibyte.h"
#include "batch/triangle_count.h"
#include "command_line/command_line.h"
#include "command_line/text.h"
#include "trees/build_cost.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

// The time and memory to ask Slurm for, over those expected: Slurm kills what exceeds its limits.
constexpr double kMargin = 2;
constexpr double kLeastBytes = 64 * kMebibyte, kLeastSeconds = 60;

// Seconds and bytes of a raw axis (docs/results/growth.md), of a refined one (docs/results/medial-axes.md: 2 to 26 s
// there), and of a set: a minimum, and an amount for each surface point or sphere, and for each triangle.
struct MeshRates {
  double seconds, per_item, per_triangle;
  double bytes, bytes_per_item, bytes_per_triangle;
};
constexpr MeshRates kRawAxis{0.05, 9e-5, 1.7e-5, 2.4e7, 5000, 430};
constexpr MeshRates kRefinedAxis{3, 8e-4, 1e-4, 4e7, 8000, 430};
constexpr MeshRates kSphereSet{0.8, 0.035, 1.7e-5, 2.8e7, 2.2e5, 430};

MeshCost cost_of(const MeshRates& rates, double items, double triangles) {
  return {rates.seconds + items * rates.per_item + triangles * rates.per_triangle,
          rates.bytes + items * rates.bytes_per_item + triangles * rates.bytes_per_triangle};
}

struct ShardCost {
  std::size_t meshes = 0;
  double seconds = 0, bytes = 0;
};

// Runs `jobs` meshes at a time; the memory is that of the largest ones together.
ShardCost cost_of(const std::vector<MeshCost>& meshes, const std::vector<std::size_t>& positions, std::size_t jobs) {
  ShardCost cost{.meshes = positions.size()};
  std::vector<double> bytes;
  double longest = 0;
  for (const std::size_t position : positions) {
    cost.seconds += meshes[position].seconds;
    longest = std::max(longest, meshes[position].seconds);
    bytes.push_back(meshes[position].bytes);
  }
  cost.seconds = std::max(longest, cost.seconds / static_cast<double>(jobs));
  std::sort(bytes.begin(), bytes.end(), std::greater<>());
  bytes.resize(std::min(bytes.size(), jobs));
  cost.bytes = std::accumulate(bytes.begin(), bytes.end(), 0.0);
  return cost;
}

std::string in_clock(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds / 60) * 60);
  return fmt::format("{:02}:{:02}:00", whole / 3600, whole / 60 % 60);
}

std::vector<std::string> sbatch_lines(std::size_t shards, std::size_t jobs, const ShardCost& longest,
                                      double most_bytes) {
  return {fmt::format("#SBATCH --array=1-{}", shards), fmt::format("#SBATCH --cpus-per-task={}", jobs),
          fmt::format("#SBATCH --time={}", in_clock(std::max(kLeastSeconds, kMargin * longest.seconds))),
          fmt::format("#SBATCH --mem={:.0f}M", std::ceil(std::max(kLeastBytes, kMargin * most_bytes) / kMebibyte))};
}

}  // namespace

MeshCost expected_cost(const WorkerCommand& worker, double triangles) {
  if (worker.name == "build") {
    const BuildCost cost = expected_cost(worker.request->build, triangles);
    return {cost.seconds, cost.bytes};
  }
  if (worker.name == "medial") {
    const MedialTuning& tuning = worker.request->medial.tuning;
    const double points = tuning.samples.value_or(kStandardSamples);
    return cost_of(tuning.refine ? kRefinedAxis : kRawAxis, points, triangles);
  }
  return cost_of(kSphereSet, worker.request->spheres.options.spheres, triangles);
}

void print_batch_cost(const BatchCommand& command, const WorkerCommand& worker, const Manifest& manifest,
                      const Shard& shard) {
  const auto jobs = static_cast<std::size_t>(std::max(1, command.jobs));
  std::vector<MeshCost> meshes;
  std::uint64_t triangles = 0;
  for (const BatchMesh& mesh : manifest.meshes) {
    const std::uint64_t own = count_triangles(mesh.file);
    triangles += own;
    meshes.push_back(expected_cost(worker, static_cast<double>(own)));
  }
  ShardCost longest;
  double seconds = 0, most_bytes = 0;
  for (const MeshCost& mesh : meshes) seconds += mesh.seconds;
  for (std::size_t i = 1; i <= shard.count; ++i) {
    const ShardCost cost = cost_of(meshes, positions_of({i, shard.count}, meshes.size()), jobs);
    most_bytes = std::max(most_bytes, cost.bytes);
    if (cost.seconds > longest.seconds) longest = cost;
  }
  const std::vector<std::string> lines = sbatch_lines(shard.count, jobs, longest, most_bytes);
  if (command.output.json) {
    const json report{{"meshes", meshes.size()},
                      {"triangles", triangles},
                      {"shards", shard.count},
                      {"jobs", jobs},
                      {"seconds", seconds},
                      {"seconds_of_longest_shard", longest.seconds},
                      {"bytes_of_largest_shard", most_bytes},
                      {"sbatch", lines}};
    fmt::print("{}\n", report.dump(2));
    return;
  }
  fmt::print("{} meshes of {} triangles: about {} of processor time in all\n", meshes.size(), triangles,
             in_units_of_time(seconds));
  fmt::print(
      "{} shard{} with --jobs {}: the longest has {} meshes and takes about {}; the largest needs about {:.0f} MiB\n",
      shard.count, shard.count == 1 ? "" : "s", jobs, longest.meshes, in_units_of_time(longest.seconds),
      most_bytes / kMebibyte);
  fmt::print("for Slurm, with a margin of {:g}:\n{}\n", kMargin, joined(lines, "\n"));
}

}  // namespace orchard::apps
