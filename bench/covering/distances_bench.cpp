// Certified distances of a sphere-tree's 585 spheres: inaccuracy, farthest point of the ball from the solid, and signed
// distance of the centre, on one thread, beside the plain closest-point query that they are made of.
// Usage: orchard_distances_bench MESH..
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <vector>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/repair.h"
#include "orchard/geometry/surface.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/octree.h"

namespace {

using namespace orchard;

constexpr std::size_t kSpheres = 585;  // 1 + 8 + 64 + 512

double seconds_of(const std::function<void()>& work) {
  double best = 1e300;
  for (int run = 0; run < 3; ++run) {
    const std::clock_t start = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best;
}

// Spheres of the sizes of a merged tree's: inside balls around octree cells, shrunken towards the surface.
std::vector<Sphere> spheres_of(const Surface& surface) {
  std::vector<Sphere> spheres;
  const SphereTree tree = octree(surface, {.depth = 4});
  for (const SphereNode& node : tree.nodes) {
    if (spheres.size() == kSpheres) break;
    spheres.push_back({node.sphere.center, node.level == 0 ? node.sphere.radius : 0.7 * node.sphere.radius});
  }
  return spheres;
}

void measure(const char* file) {
  TriangleMesh mesh = read_mesh(file);
  repair_mesh(mesh);
  const Surface surface(std::move(mesh));
  const std::vector<Sphere> spheres = spheres_of(surface);
  const double radius = surface.bounding_radius();
  double widest = 0, sum = 0;
  const auto all = [&](const std::function<Bounds(const Sphere&)>& query) {
    return seconds_of([&] {
      widest = 0;
      for (const Sphere& s : spheres) {
        const Bounds bounds = query(s);
        widest = std::max(widest, bounds.upper - bounds.lower);
        sum += bounds.upper;
      }
    });
  };
  constexpr int kQueries = 200'000;
  Random random(1, 1);
  std::vector<Point> points;
  for (int i = 0; i < kQueries; ++i) {
    const Sphere& s = spheres[static_cast<std::size_t>(random.below(spheres.size()))];
    const Vector v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    points.push_back(s.center + s.radius * v.normalized());
  }
  const double query = seconds_of([&] {
                         for (const Point& p : points) sum += surface.signed_distance(p);
                       }) /
                       kQueries;
  std::printf("%s: %zu triangles, %zu spheres; a signed distance takes %.2f us\n",
              std::filesystem::path(file).stem().c_str(), surface.mesh().triangles.size(), spheres.size(), 1e6 * query);
  double total = 0;
  const auto row = [&](const char* name, double seconds) {
    total += seconds;
    std::printf("  %-32s %8.4f s  = %6.1f queries a sphere, bounds at most %.1e R apart\n", name, seconds,
                seconds / query / static_cast<double>(spheres.size()), widest / radius);
  };
  row("inaccuracy", all([&](const Sphere& s) { return inaccuracy(surface, s); }));
  row("farthest point of the ball", all([&](const Sphere& s) { return farthest_from_solid(surface, s); }));
  row("signed distance of the centre", all([&](const Sphere& s) {
        const double d = surface.signed_distance(s.center);
        return Bounds{d, d};
      }));
  std::printf("  %-32s %8.4f s\n", "all three", total);
  if (sum == 0.125) std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) measure(argv[i]);
}
