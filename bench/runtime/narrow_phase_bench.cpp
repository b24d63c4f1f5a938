// The narrow phase on poses of 7.2's kind, from touching bounding spheres to shallow penetration, against FCL on the
// same poses in the same run:  narrow_phase_bench body.obj|body.orchard [poses per class]
// An .obj gets a tree by median splits. Times are the best of five passes over each pose, in microseconds.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/tree_file.h"
#include "support.h"
#ifdef ORCHARD_HAS_FCL
#include "fcl_query.h"
#endif

namespace {

using namespace orchard::runtime;

test::Mesh read_obj(const std::string& path) {  // triangles only
  test::Mesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind, word;
    words >> kind;
    if (kind == "v") {
      auto& v = mesh.vertices.emplace_back();
      words >> v[0] >> v[1] >> v[2];
    } else if (kind == "f") {
      auto& t = mesh.triangles.emplace_back();
      for (auto& index : t) words >> word, index = static_cast<std::uint32_t>(std::stoul(word)) - 1;
    }
  }
  return mesh;
}

struct Query {
  Pose a, b;
  int pose_class;
};

constexpr const char* kClasses[] = {"spheres touch", "half-way",          "gap 1 % R",
                                    "gap 0.1 % R",   "penetration 0.1 %", "penetration 1 %"};

bool touches(NarrowPhase& pair, const Pose& a, const Pose& b) {
  pair.start(a, b);
  pair.refine_exactly();
  return pair.answer() == Answer::yes;
}

// Both bodies turned at random, the second one moved along a random line through the first one's root centre.
std::vector<Query> approaches(const PackedSphereTree& tree, int count) {
  const SiblingBlock& root = tree.blocks[0];
  const double r = double{root.radius[0]};
  const test::Vec center = {tree.origin[0] + root.x[0], tree.origin[1] + root.y[0], tree.origin[2] + root.z[0]};
  NarrowPhase pair(tree, tree);
  std::vector<Query> result;
  for (std::uint64_t seed = 0; static_cast<int>(result.size()) < 6 * count; ++seed) {
    test::Draw draw(seed);
    const auto centered = [&](Pose pose, double distance, const test::Vec& way) {
      const auto moved = rotate(pose, center);
      for (std::size_t i = 0; i < 3; ++i) pose.translation[i] = distance * way[i] - moved[i];
      return pose;
    };
    const test::Vec way = draw.direction();
    const Pose a = centered(draw.pose(0), 0, way), turned = draw.pose(0);
    double near = 0, far = 2 * r;
    if (!touches(pair, a, centered(turned, near, way))) continue;
    for (double d = far; d > 0; d -= 0.01 * r) {
      if (touches(pair, a, centered(turned, d, way))) {
        near = d;
        break;
      }
      far = d;
    }
    while (far - near > 1e-9 * r) {
      const double middle = (near + far) / 2;
      (touches(pair, a, centered(turned, middle, way)) ? near : far) = middle;
    }
    const double at[] = {2 * r, (2 * r + far) / 2, far + 0.01 * r, far + 0.001 * r, near - 0.001 * r, near - 0.01 * r};
    for (int c = 0; c < 6; ++c) result.push_back({a, centered(turned, at[c], way), c});
  }
  return result;
}

constexpr int kPasses = 5, kRepeats = 8;  // the clock alone takes some 30 ns

double best_microseconds(const std::function<void()>& run) {
  double best = 1e300;
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kRepeats; ++i) run();
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count() / kRepeats);
  }
  return best;
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

void report(const char* name, const std::vector<Query>& queries, const std::vector<double>& times) {
  std::printf("%-22s", name);
  for (int c = 0; c < 6; ++c) {
    std::vector<double> of_class;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (queries[i].pose_class == c) of_class.push_back(times[i]);
    }
    std::printf(" %8.3f", summary(of_class).median);
  }
  const Summary all = summary(times);
  std::printf(" | %8.3f %8.3f %8.3f %8.3f\n", all.median, all.mean, all.p99, all.most);
}

std::vector<double> measure(const std::vector<Query>& queries, const std::function<void(const Query&)>& run) {
  std::vector<double> times;
  for (const Query& q : queries) times.push_back(best_microseconds([&] { run(q); }));
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: narrow_phase_bench body.obj|body.orchard [poses per class]\n"), 2;
  const std::string path = argv[1];
  PackedSphereTree tree;
  if (path.ends_with(".orchard")) {
    if (const auto status = load_file(argv[1], tree); status != LoadStatus::ok) {
      return std::fprintf(stderr, "%s: %s\n", argv[1], message(status)), 2;
    }
  } else {
    tree = test::build_tree(read_obj(path), {.leaf_triangles = 4, .bounds = false});
  }
  std::printf("%zu triangles, %u nodes, %u levels, branching %u\n", tree.triangles.size(), tree.node_count,
              tree.depth + 1, tree.branching);
  const auto queries = approaches(tree, argc > 2 ? std::atoi(argv[2]) : 100);

  std::printf("%-22s", "median per class:");
  for (const char* name : kClasses) std::printf(" %8.8s", name);
  std::printf(" | %8s %8s %8s %8s\n", "median", "mean", "p99", "max");
  NarrowPhase pair(tree, tree);
  std::uint64_t tests = 0, triangle_tests = 0;
  for (std::uint32_t levels = 1; levels <= tree.depth + 1; ++levels) {
    tests = triangle_tests = 0;
    const auto times = measure(queries, [&](const Query& q) {
      pair.start(q.a, q.b);
      for (std::uint32_t level = 0; level < levels; ++level) pair.refine();
      tests += pair.pair_tests();
      triangle_tests += pair.triangle_tests();
    });
    report((levels > tree.depth ? "exact" : "level " + std::to_string(levels)).c_str(), queries, times);
    double sum = 0;
    for (const double t : times) sum += t;
    const double share = 1 / (kPasses * kRepeats * static_cast<double>(queries.size()));
    std::printf("%-22s %.1f sphere tests and %.1f triangle tests a query, %.2f ns a sphere test in all\n", "",
                static_cast<double>(tests) * share, static_cast<double>(triangle_tests) * share,
                sum * 1000 * kPasses * kRepeats / static_cast<double>(tests));
  }
  tests = triangle_tests = 0;
  report("exact, directly", queries, measure(queries, [&](const Query& q) {
           pair.start(q.a, q.b);
           pair.refine_exactly();
           tests += pair.pair_tests(), triangle_tests += pair.triangle_tests();
         }));
  const double n = kPasses * kRepeats * static_cast<double>(queries.size());
  std::printf("%-22s %.1f patch tests and %.1f triangle tests a query\n", "", double(tests) / n,
              double(triangle_tests) / n);
#ifdef ORCHARD_HAS_FCL
  const orchard::bench::FclPair rival(tree, tree);
  int differ = 0;
  for (const Query& q : queries) differ += rival.collide(q.a, q.b) != touches(pair, q.a, q.b);
  report("FCL OBBRSS, float", queries, measure(queries, [&](const Query& q) { rival.collide(q.a, q.b); }));
  std::printf("answers that differ from FCL's: %d of %zu\n", differ, queries.size());
#endif
  return 0;
}
