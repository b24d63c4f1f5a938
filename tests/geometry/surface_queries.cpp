#include "surface_queries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard::test {
namespace {

TriangleMesh random_soup(std::uint64_t seed) {
  Random random(seed, 1);
  TriangleMesh mesh;
  for (int i = 0; i < 120; ++i) {
    const Point corner(random.uniform(), random.uniform(), random.uniform());
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(corner + 0.2 * Vector(random.uniform(), random.uniform(), random.uniform()));
  }
  for (Index t = 0; t < 120; ++t) mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  return mesh;
}

}  // namespace

TriangleMesh degenerate_soup() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0},     {0, 1, 0}, {1, 1e-9, 0},       {0.5, 0.5, 0.5}, {0.25, 0.25, 0.25},
                   {2, 2, 2}, {1, 1e-16, 0}, {3, 0, 0}, {0.3, 1e-12, 1e-3}, {-1, 0.1, 7}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 5, 4}, {6, 6, 6}, {0, 4, 6}, {1, 2, 0},
                    {0, 1, 7}, {1, 8, 0}, {2, 2, 8}, {0, 8, 9}, {4, 9, 10}};
  return mesh;
}

std::vector<NamedMesh> solids() {
  return {{"box", box({0, 0, 0}, {1, 2, 3})}, {"l_shape", l_shape()},      {"u_shape", u_shape(0.1)},
          {"torus", torus(24, 12)},           {"icosphere", icosphere(2)}, {"two_boxes", two_boxes(0.01)}};
}

std::vector<NamedMesh> all_meshes() {
  std::vector<NamedMesh> meshes = solids();
  meshes.push_back({"open_box", open_box()});
  meshes.push_back({"degenerate_soup", degenerate_soup()});
  meshes.push_back({"random_soup", random_soup(7)});
  meshes.push_back({"one_triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}});
  meshes.push_back({"one_point", {{{1, 2, 3}}, {{0, 0, 0}}}});
  std::vector<NamedMesh> placed;
  for (const auto& [name, mesh] : meshes) {
    placed.push_back({name, mesh});
    placed.push_back({name + " scaled by 1e-6", transformed(mesh, 1e-6, Vector::Zero())});
    placed.push_back({name + " scaled by 1e6", transformed(mesh, 1e6, Vector::Zero())});
    placed.push_back({name + " offset by 1e6", transformed(mesh, 1, {1e6, -1e6, 1e6})});
    placed.push_back({name + " scaled by 1e-30", transformed(mesh, 1e-30, Vector::Zero())});
    placed.push_back({name + " scaled by 1e30", transformed(mesh, 1e30, Vector::Zero())});
  }
  return placed;
}

std::vector<Point> queries_for(const Surface& surface, int count, std::uint64_t seed) {
  const Box& box = surface.bounding_box();
  const double size = std::max(surface.bounding_radius(), 1e-40);
  std::vector<Point> queries;
  for (int i = 0; i < count; ++i) {
    Random random(seed, 2, static_cast<std::uint64_t>(i));
    const auto in_cube = [&] { return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    const auto [a, b, c] = surface.corners(static_cast<Index>(random.below(surface.mesh().triangles.size())));
    const double u = random.uniform(), v = random.uniform(0, 1 - u);
    const Vector normal = (b - a).cross(c - a).normalized();
    const Vector away = (std::isfinite(normal.x()) ? normal : Vector::UnitZ()) * size * std::ldexp(1.0, -(i % 60));
    switch (i % 8) {
      case 0:
        queries.push_back(box.center() + 0.6 * Vector(in_cube().cwiseProduct(box.sizes())));
        break;
      case 1:
        queries.push_back(a);
        break;
      case 2:
        queries.push_back(a + u * (b - a));
        break;
      case 3:
        queries.push_back(a + u * (b - a) + v * (c - a));
        break;
      case 4:
        queries.push_back(a + u * (b - a) + v * (c - a) + away);
        break;
      case 5:
        queries.push_back(a - away);
        break;
      case 6:
        queries.push_back(b + u * (c - b) + away);
        break;
      default:
        queries.push_back(box.center() + size * std::pow(10, random.uniform(0, 12)) * in_cube());
    }
  }
  return queries;
}

ClosestPoint closest_by_brute_force(const Surface& surface, const Point& query) {
  ClosestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    ClosestPoint candidate = closest_point_of_triangle(query, a, b, c);
    if (candidate.distance >= best.distance) continue;
    best = candidate;
    best.triangle = t;
  }
  return best;
}

double winding_number(const Surface& surface, const Point& query) {
  double sum = 0;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    auto [a, b, c] = surface.corners(t);
    a -= query, b -= query, c -= query;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace orchard::test
