#include "robot/primitive_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orchard::robot {
namespace {

using std::numbers::pi;

constexpr Index kAround = 48, kRings = 12;  // facets around the axis; rings of corners from the rim to the pole

TriangleMesh box(const Vector& sides) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back(((corner & 1) != 0 ? .5 : -.5) * sides.x(), ((corner & 2) != 0 ? .5 : -.5) * sides.y(),
                               ((corner & 4) != 0 ? .5 : -.5) * sides.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// Radius and height, from the lower pole, which has radius 0, to the upper one.
using Profile = std::vector<std::array<double, 2>>;

TriangleMesh turned(const Profile& profile) {
  TriangleMesh mesh;
  std::vector<Index> first;
  for (const auto& [radius, height] : profile) {
    first.push_back(static_cast<Index>(mesh.vertices.size()));
    const Index count = radius > 0 ? kAround : 1;
    for (Index k = 0; k < count; ++k)
      mesh.vertices.emplace_back(radius * std::cos(2 * pi * k / kAround), radius * std::sin(2 * pi * k / kAround),
                                 height);
  }
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    const auto at = [&](std::size_t row, Index k) { return first[row] + (profile[row][0] > 0 ? k % kAround : 0); };
    for (Index k = 0; k < kAround; ++k) {
      if (profile[ring][0] > 0) mesh.triangles.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k)});
      if (profile[ring + 1][0] > 0) mesh.triangles.push_back({at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)});
    }
  }
  return mesh;
}

// A ball cut in half, the halves `length` apart: corners on a sphere of radius 1.
Profile capsule_profile(double length) {
  Profile profile;
  for (Index ring = 0; ring <= kRings; ++ring) {
    const double angle = pi / 2 * ring / kRings;
    profile.push_back({ring == 0 ? 0 : std::sin(angle), -std::cos(angle) - length / 2});
  }
  for (Index ring = length > 0 ? 0 : 1; ring <= kRings; ++ring) {
    const double angle = pi / 2 * ring / kRings;
    profile.push_back({ring == kRings ? 0 : std::cos(angle), std::sin(angle) + length / 2});
  }
  return profile;
}

// How near the facets come to the axis, or beyond the ends of a capsule to the centre of its cap.
double least_reach(const TriangleMesh& mesh, double length) {
  double least = 1;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Point &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Vector normal = (q - p).cross(r - p).normalized();
    const double height = (p.z() + q.z() + r.z()) / 3;
    const Point center(0, 0, std::clamp(height, -length / 2, length / 2));
    least = std::min(least, normal.dot(p - center));
  }
  return least;
}

}  // namespace

PrimitiveMesh primitive_mesh(const Element& element) {
  if (element.shape == Shape::box) return {box(element.size), 0};
  const double radius = element.size.x(), length = element.shape == Shape::sphere ? 0 : element.size.y();
  if (element.shape == Shape::cylinder) {
    const double outer = radius / std::cos(pi / kAround);
    return {turned({{0, -length / 2}, {outer, -length / 2}, {outer, length / 2}, {0, length / 2}}), outer - radius};
  }
  TriangleMesh mesh = turned(capsule_profile(length / radius));
  // Grown about the axis and the ends so that the nearest facet touches.
  const double growth = 1 / least_reach(mesh, length / radius);
  for (Point& vertex : mesh.vertices) {
    const Point center(0, 0, std::clamp(vertex.z(), -length / radius / 2, length / radius / 2));
    vertex = radius * (center + growth * (vertex - center));
  }
  return {std::move(mesh), radius * (growth - 1)};
}

}  // namespace orchard::robot
