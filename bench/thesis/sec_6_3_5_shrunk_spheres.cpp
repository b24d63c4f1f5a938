// Section 6.3.5: Badler's and O'Rourke's spheres, shrunk inside a solid from points on its surface:
//   sec_6_3_5_shrunk_spheres MESH POINTS AXIS.ma
// Prints how well the spheres fit inside by the number of points, and how far the surface is from the spheres that are
// anchored at few of these; writes the spheres of all points, each adjacent to those of its six nearest anchors, as a
// medial axis, from which a tree can be built: orchard build MESH --from-axis AXIS.ma --method merging
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "construction_methods/shrunk_spheres.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/medial/medial_mesh.h"

namespace {

using namespace orchard;
using namespace orchard::construction_methods;

constexpr Index kNeighbors = 6;

SurfaceSampling points_of(const Surface& surface, Index count, std::uint64_t seed = 1) {
  return sample_surface(surface, {.face_points = count - count / 5, .edge_points = count / 5, .seed = seed});
}

std::vector<Index> all_of(const SurfaceSampling& sampling) {
  std::vector<Index> all(sampling.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

// How the spheres of all points fit, by the number of points.
void print_fit(const Surface& surface, Index points) {
  const SurfaceSampling sampling = points_of(surface, points);
  const auto begin = std::chrono::steady_clock::now();
  const auto spheres = shrunk_spheres(surface, sampling, all_of(sampling));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  double sum = 0, largest = 0, steps = 0;
  for (const ShrunkSphere& s : spheres) {
    const double out = std::max(0.0, s.sphere.radius + surface.signed_distance(s.sphere.center));
    sum += out, largest = std::max(largest, out), steps += s.steps;
  }
  const double n = static_cast<double>(spheres.size()), r = surface.bounding_radius();
  std::printf("| all of %u points | %zu | %.4f | %.4f | - | - | %.1f | %.3f |\n", points, spheres.size(), sum / n / r,
              largest / r, steps / n, seconds);
}

// How far the surface is from spheres that are anchored at few points but held back by all.
void print_subset(const Surface& surface, const SurfaceSampling& sampling, const SurfaceSampling& checked,
                  Index anchors) {
  const auto spheres = shrunk_spheres(surface, sampling, spread_anchors(sampling, anchors));
  double sum = 0, largest = 0, out = 0, most_out = 0;
  for (const Point& p : checked.points) {
    double nearest = surface.bounding_radius();
    for (const ShrunkSphere& s : spheres) nearest = std::min(nearest, (p - s.sphere.center).norm() - s.sphere.radius);
    sum += std::max(0.0, nearest), largest = std::max(largest, nearest);
  }
  for (const ShrunkSphere& s : spheres) {
    const double reach = std::max(0.0, s.sphere.radius + surface.signed_distance(s.sphere.center));
    out += reach, most_out = std::max(most_out, reach);
  }
  const double r = surface.bounding_radius();
  std::printf("| anchored at %u of %u | %zu | %.4f | %.4f | %.4f | %.4f | - | - |\n", anchors, sampling.size(),
              spheres.size(), out / static_cast<double>(spheres.size()) / r, most_out / r, sum / checked.size() / r,
              largest / r);
}

// Spheres with their centres inside, and proximity in place of the adjacency that the algorithm does not keep.
MedialMesh axis_of(const Surface& surface, const SurfaceSampling& sampling, Index& across) {
  MedialMesh mesh;
  std::vector<Index> vertex(sampling.size(), kNone);
  for (const ShrunkSphere& s : shrunk_spheres(surface, sampling, all_of(sampling))) {
    if (!(surface.signed_distance(s.sphere.center) < 0)) continue;
    vertex[s.anchor] = mesh.size();
    mesh.centers.push_back(s.sphere.center);
    mesh.radii.push_back(s.sphere.radius);
  }
  std::vector<Index> order = all_of(sampling);
  for (Index i = 0; i < sampling.size(); ++i) {
    if (vertex[i] == kNone) continue;
    const auto nearer = [&](Index a, Index b) {
      return (sampling.points[a] - sampling.points[i]).squaredNorm() <
             (sampling.points[b] - sampling.points[i]).squaredNorm();
    };
    std::partial_sort(order.begin(), order.begin() + kNeighbors + 1, order.end(), nearer);
    for (Index k = 1; k <= kNeighbors; ++k)
      if (const Index other = vertex[order[k]]; other != kNone)
        mesh.edges.push_back({std::min(vertex[i], other), std::max(vertex[i], other)});
  }
  complete(mesh);
  across = 0;
  for (const auto& [a, b] : mesh.edges) {
    bool outside = false;
    for (const double t : {0.25, 0.5, 0.75})
      outside = outside || surface.signed_distance((1 - t) * mesh.centers[a] + t * mesh.centers[b]) > 0;
    across += outside;
  }
  return mesh;
}

void run(const char* file, Index points, const char* out) {
  const Surface surface(read_mesh(file));
  std::printf(
      "| spheres | count | reach out of the solid / R, mean | max | surface beyond them / R, mean | max | shrinks, "
      "mean | seconds "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Index count : {points / 16, points / 4, points}) print_fit(surface, count);
  const SurfaceSampling sampling = points_of(surface, points), checked = points_of(surface, 4000, 2);
  for (const Index anchors : {8u, 64u, 512u, sampling.size()}) print_subset(surface, sampling, checked, anchors);
  Index across = 0;
  const MedialMesh mesh = axis_of(surface, sampling, across);
  write_file(out, to_ma(mesh));
  std::printf(
      "\n%u of %u spheres have their centre inside; of their %zu adjacencies by proximity, %u run outside of the "
      "solid.\n",
      mesh.size(), sampling.size(), mesh.edges.size(), across);
}

}  // namespace

int main(int argc, char** argv) {
  const Index points = argc == 4 ? static_cast<Index>(std::strtoul(argv[2], nullptr, 10)) : 0;
  if (points < 100) {
    std::fprintf(stderr, "usage: sec_6_3_5_shrunk_spheres MESH POINTS AXIS.ma, with 100 points or more\n");
    return 2;
  }
  try {
    run(argv[1], points, argv[3]);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
