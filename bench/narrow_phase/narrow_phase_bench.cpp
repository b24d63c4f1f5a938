// The narrow phase against other libraries at the same poses in the same run, from touching bounding spheres to shallow
// penetration:  narrow_phase_bench [-n approaches] body.obj|body.orchard ..
// Times are in microseconds of one thread; of each query the best of several passes through all, all engines in turn.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "bodies.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/narrow_phase.h"
#include "rival.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;

struct Engine {
  std::string name;
  std::function<void(std::size_t)> run;
  std::vector<double> times = {};  // per query
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// What the clock itself takes, which short queries take hardly longer than.
double clock_seconds() {
  double least = 1;
  for (int i = 0; i < 1000; ++i) least = std::min(least, seconds_since(Clock::now()));
  return least;
}

// A pass asks every query once: one that is asked again at once takes all its branches as foreseen, as none does that
// is asked for an answer. Engines that are slow get fewer passes.
void measure(std::vector<Engine>& engines, std::size_t queries) {
  constexpr int passes = 7, slow_passes = 2;
  constexpr double slow = 1e-4;
  const double clock = clock_seconds();
  for (Engine& engine : engines) engine.times.assign(queries, 1e300);
  for (int pass = 0; pass < passes; ++pass) {
    for (Engine& engine : engines) {
      if (pass >= slow_passes && *std::max_element(engine.times.begin(), engine.times.end()) > 1e6 * slow) continue;
      for (std::size_t i = 0; i < queries; ++i) {
        const auto start = Clock::now();
        engine.run(i);
        engine.times[i] = std::min(engine.times[i], 1e6 * std::max(0.0, seconds_since(start) - clock));
      }
    }
  }
}

struct Summary {
  double median, mean, p99, most;
};

Summary summary(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  double sum = 0;
  for (const double x : v) sum += x;
  return {v[v.size() / 2], sum / static_cast<double>(v.size()), v[v.size() * 99 / 100], v.back()};
}

std::vector<double> of_class(const std::vector<Query>& queries, const std::vector<double>& times, int pose_class) {
  std::vector<double> result;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (queries[i].pose_class == pose_class) result.push_back(times[i]);
  }
  return result;
}

void print_row(const std::string& name, const std::vector<double>& values) {
  std::printf("%-26s", name.c_str());
  for (const double v : values) std::printf(v < 0.9995 ? " %8.3f" : v < 99.95 ? " %8.2f" : " %8.0f", v);
  std::printf("\n");
}

std::vector<double> row_of(const std::vector<Query>& queries, const std::vector<double>& times) {
  std::vector<double> row;
  for (int c = 0; c < kClasses; ++c) row.push_back(summary(of_class(queries, times, c)).median);
  const Summary all = summary(times);
  row.insert(row.end(), {all.median, all.mean, all.p99, all.most});
  return row;
}

void print_table(const char* title, const std::vector<Query>& queries, const std::vector<Engine>& engines,
                 std::size_t ours, std::size_t rival) {
  std::printf("\n%-26s", title);
  for (const char* name : kClassNames) std::printf(" %8.8s", name);
  std::printf(" %8s %8s %8s %8s\n", "median", "mean", "p99", "max");
  for (const Engine& engine : engines) print_row(engine.name, row_of(queries, engine.times));
  if (rival >= engines.size()) return;
  for (std::size_t e = 0; e <= ours; ++e) {
    std::vector<double> ratio = row_of(queries, engines[e].times), base = row_of(queries, engines[rival].times);
    for (std::size_t i = 0; i < ratio.size(); ++i) ratio[i] /= base[i];
    print_row("ratio: " + engines[e].name, ratio);
  }
}

void boolean(const PackedSphereTree& tree, const std::vector<Query>& queries) {
  const PreparedTree body(tree);
  NarrowPhase pair(body, body);
  std::vector<Engine> engines;
  engines.push_back({"orchard, exact", [&](std::size_t i) {
                       pair.start(queries[i].a, queries[i].b);
                       pair.refine_exactly();
                     }});
  for (std::uint32_t levels = 1; levels <= std::min(4u, tree.depth); ++levels) {
    engines.push_back({"orchard, bounds at " + std::to_string(levels), [&, levels](std::size_t i) {
                         pair.start(queries[i].a, queries[i].b);
                         for (std::uint32_t l = 0; l < levels; ++l) pair.refine();
                       }});
  }
  const std::size_t ours = engines.size() - 1;
  std::vector<std::unique_ptr<PairRival>> rivals;
  constexpr std::size_t max_for_bsp = 10000;  // building takes the square of it
  const auto add = [&](std::unique_ptr<PairRival> rival) {
    if (!rival) return;
    rival->place(queries);
    engines.push_back({rival->name(), [r = rival.get()](std::size_t i) { r->collide(i); }});
    rivals.push_back(std::move(rival));
  };
  add(fcl_float(tree, tree));
  add(fcl_double(tree, tree));
  add(bullet(tree, tree));
  add(cgal(tree, tree));
  if (tree.triangles.size() <= max_for_bsp) add(bsp_trees(tree, tree));
  add(octree(tree, tree));
  measure(engines, queries.size());
  print_table("boolean", queries, engines, ours, ours + 1);
  for (const auto& rival : rivals) {
    int differ = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      pair.start(queries[i].a, queries[i].b);
      differ += (pair.refine_exactly() == Answer::yes) != rival->collide(i);
    }
    std::printf("answers that differ from %s: %d of %zu\n", rival->name().c_str(), differ, queries.size());
  }
}

void distance(const PackedSphereTree& tree, const std::vector<Query>& queries) {
  const PreparedTree body(tree);
  DistanceQuery query(body, body);
  std::vector<Engine> engines;
  engines.push_back({"orchard, exact", [&](std::size_t i) {
                       query.start(queries[i].a, queries[i].b, {.relative = 0});
                       query.refine();
                     }});
  engines.push_back({"orchard, to 1 %", [&](std::size_t i) {
                       query.start(queries[i].a, queries[i].b, {.relative = 0.01});
                       query.refine();
                     }});
  const auto rival = fcl_float(tree, tree);
  if (rival) {
    rival->place(queries);
    engines.push_back({rival->name(), [&](std::size_t i) { rival->distance(i); }});
  }
  measure(engines, queries.size());
  print_table("distance", queries, engines, 1, 2);
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 60;
  bool any = false;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-n" && i + 1 < argc) {
      count = static_cast<std::size_t>(std::atoi(argv[++i]));
      continue;
    }
    any = true;
    const PackedSphereTree tree = read_body(argv[i]);
    std::printf("\n%s: %zu triangles; %u spheres on %u levels, %.1f bytes each; %.0f bytes a triangle\n", argv[i],
                tree.triangles.size(), tree.node_count, tree.depth + 1,
                static_cast<double>(tree.blocks.size() * sizeof(SiblingBlock)) / tree.node_count,
                static_cast<double>(tree.vertices.size() * 12 + tree.triangles.size() * 12 +
                                    tree.leaf_triangles.size() * 4 + tree.obb_nodes.size() * sizeof(ObbNodeBlock) +
                                    tree.triangle_blocks.size() * sizeof(TriangleBlock)) /
                    static_cast<double>(tree.triangles.size()));
    const auto queries = approaches(tree, count, 0);
    boolean(tree, queries);
    distance(tree, queries);
    std::fflush(stdout);
  }
  if (!any) std::fprintf(stderr, "usage: narrow_phase_bench [-n approaches] body.obj|body.orchard ..\n");
  return any ? 0 : 2;
}
