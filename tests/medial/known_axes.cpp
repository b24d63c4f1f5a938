#include "known_axes.h"

#include <cmath>
#include <numbers>

#include "support/shapes.h"

namespace orchard::test {
namespace {

Index add(MedialMesh& axis, const Point& center, double radius) {
  axis.centers.push_back(center);
  axis.radii.push_back(radius);
  return axis.size() - 1;
}

void add_quad(MedialMesh& axis, Index a, Index b, Index c, Index d) {
  axis.triangles.push_back({a, b, c});
  axis.triangles.push_back({a, c, d});
}

Point around(double angle, double radius, double z) { return {radius * std::cos(angle), radius * std::sin(angle), z}; }

}  // namespace

KnownAxis known_box(const std::array<double, 3>& sizes) {
  const auto [x, y, z] = sizes;
  const double r = x / 2;
  KnownAxis known{box({0, 0, 0}, {x, y, z}), {}};
  MedialMesh& axis = known.axis;
  const std::array<double, 2> xs{0, x}, ys{0, y}, zs{0, z};
  for (const double cy : {r, y - r}) {
    for (const double cz : {r, z - r}) add(axis, {r, cy, cz}, r);
  }
  const auto middle = [](unsigned j, unsigned k) { return 2 * j + k; };
  const auto corner = [](unsigned i, unsigned j, unsigned k) { return 4 + 4 * i + 2 * j + k; };
  for (const double cx : xs) {
    for (const double cy : ys) {
      for (const double cz : zs) add(axis, {cx, cy, cz}, 0);
    }
  }
  add_quad(axis, middle(0, 0), middle(0, 1), middle(1, 1), middle(1, 0));
  for (unsigned i = 0; i < 2; ++i) {
    for (unsigned k = 0; k < 2; ++k) {
      add_quad(axis, middle(0, k), middle(1, k), corner(i, 1, k), corner(i, 0, k));
      add_quad(axis, middle(k, 0), middle(k, 1), corner(i, k, 1), corner(i, k, 0));
      axis.triangles.push_back({middle(i, k), corner(0, i, k), corner(1, i, k)});
    }
  }
  complete(axis);
  return known;
}

KnownAxis known_sphere(int subdivisions) {
  KnownAxis known{icosphere(subdivisions), {}};
  add(known.axis, Point::Zero(), 1);
  return known;
}

KnownAxis known_cylinder(Index sides, double height) {
  KnownAxis known;
  const double step = 2 * std::numbers::pi / sides, outer = 1 / std::cos(step / 2);
  TriangleMesh& mesh = known.solid;
  MedialMesh& axis = known.axis;
  mesh.vertices = {{0, 0, 0}, {0, 0, height}};
  const Index low = add(axis, {0, 0, 1}, 1), high = add(axis, {0, 0, height - 1}, 1);
  axis.edges.push_back({low, high});
  for (Index i = 0; i < sides; ++i) {
    for (const double z : {0.0, height}) {
      mesh.vertices.push_back(around(step * i, outer, z));
      add(axis, mesh.vertices.back(), 0);
    }
  }
  for (Index i = 0; i < sides; ++i) {
    const Index a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % sides);
    mesh.triangles.push_back({0, b, a});
    mesh.triangles.push_back({1, a + 1, b + 1});
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
    axis.triangles.push_back({low, a, b});
    axis.triangles.push_back({high, a + 1, b + 1});
  }
  complete(axis);
  return known;
}

KnownAxis known_torus(Index around_count, Index across) {
  KnownAxis known{torus(static_cast<int>(around_count), static_cast<int>(across)), {}};
  // Seen from its own mesh: the middle of each ring of the torus' vertices.
  for (Index i = 0; i < around_count; ++i) {
    Point middle = Point::Zero();
    for (Index k = 0; k < across; ++k) middle += known.solid.vertices[i * across + k] / across;
    add(known.axis, middle, 0.35);
    known.axis.edges.push_back({i, (i + 1) % around_count});
  }
  complete(known.axis);
  return known;
}

}  // namespace orchard::test
