#include "orchard/geometry/outside_solid.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

constexpr int kHalvings = 3;        // of the icosahedron's edges
constexpr double kMinRadius = 1.1;  // bounding radii: nearer, the sphere's facets would cut the solid

// Its vertices lie on the unit sphere; its triangles are counter-clockwise when seen from outside.
TriangleMesh icosahedron() {
  const double t = std::numbers::phi;
  TriangleMesh mesh{.vertices = {{-1, t, 0},
                                 {1, t, 0},
                                 {-1, -t, 0},
                                 {1, -t, 0},
                                 {0, -1, t},
                                 {0, 1, t},
                                 {0, -1, -t},
                                 {0, 1, -t},
                                 {t, 0, -1},
                                 {t, 0, 1},
                                 {-t, 0, -1},
                                 {-t, 0, 1}},
                    .triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (Point& vertex : mesh.vertices) vertex.normalize();
  return mesh;
}

// Divides each triangle into four; the new vertices lie on the unit sphere.
TriangleMesh in_four(const TriangleMesh& coarse) {
  TriangleMesh mesh{.vertices = coarse.vertices, .triangles = {}};
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [found, first] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(mesh.vertices.size()));
    if (first) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
    return found->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      mesh.triangles.push_back(part);
  }
  return mesh;
}

}  // namespace

TriangleMesh outside_solid(const Surface& solid, double radius) {
  if (!solid.solid())
    throw InputError("the surface has no outside: " + solid.report().faults() + "; repair the mesh first");
  if (!(radius >= kMinRadius) || !std::isfinite(radius))
    throw InputError("the sphere around a solid needs a radius of at least 1.1 bounding radii");
  TriangleMesh mesh = solid.mesh();
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  TriangleMesh sphere = icosahedron();
  for (int i = 0; i < kHalvings; ++i) sphere = in_four(sphere);
  const Sphere& ball = solid.bounding_ball();
  const auto first = static_cast<Index>(mesh.vertices.size());
  for (const Point& vertex : sphere.vertices) mesh.vertices.push_back(ball.center + radius * ball.radius * vertex);
  for (const auto& [a, b, c] : sphere.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

SurfaceSampling sample_outside(const Surface& solid, const Surface& outside, const SamplingOptions& options,
                               const Progress& progress) {
  SurfaceSampling sampling = sample_surface(solid, options, progress);
  const auto place = [&](std::size_t i, const ClosestPoint& closest) {
    sampling.triangles[i] = closest.triangle;
    sampling.features[i] = closest.feature;
  };
  for (std::size_t i = 0; i < sampling.points.size(); ++i) place(i, outside.closest(sampling.points[i]));
  const auto& vertices = outside.mesh().vertices;
  for (std::size_t v = solid.mesh().vertices.size(); v < vertices.size(); ++v) {
    sampling.points.push_back(vertices[v]);
    sampling.triangles.push_back(kNone);
    sampling.features.push_back(Feature::face);
    sampling.origins.push_back(PointOrigin::face);
    place(sampling.points.size() - 1, outside.closest(vertices[v]));
  }
  return sampling;
}

}  // namespace orchard
