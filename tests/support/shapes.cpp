#include "support/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace orchard::test {
namespace {

using Triangle = std::array<Index, 3>;

TriangleMesh icosahedron() {
  constexpr double phi = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, phi, 0},  {1, phi, 0},  {-1, -phi, 0}, {1, -phi, 0}, {0, -1, phi},  {0, 1, phi},
                   {0, -1, -phi}, {0, 1, -phi}, {phi, 0, -1},  {phi, 0, 1},  {-phi, 0, -1}, {-phi, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

// Splits every triangle into four at its edges' midpoints.
void subdivide(TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, Index> midpoints;
  const auto midpoint = [&](Index a, Index b) {
    const auto [entry, added] = midpoints.try_emplace(std::minmax(a, b), static_cast<Index>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    return entry->second;
  };
  std::vector<Triangle> triangles;
  triangles.reserve(4 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Index ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    triangles.insert(triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(triangles);
}

}  // namespace

TriangleMesh turned(const std::vector<std::array<double, 2>>& profile, int around) {
  TriangleMesh mesh;
  const auto vertex = [&](const Point& place) {
    mesh.vertices.push_back(place);
    return static_cast<Index>(mesh.vertices.size() - 1);
  };
  std::vector<std::vector<Index>> rings;
  const auto add_ring = [&](double radius, double height) {
    std::vector<Index>& ring = rings.emplace_back();
    for (int k = 0; k < (radius > 0 ? around : 1); ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      ring.push_back(vertex({radius * std::cos(angle), radius * std::sin(angle), height}));
    }
  };
  if (profile.front()[0] > 0) add_ring(0, profile.front()[1]);
  for (const auto& [radius, height] : profile) add_ring(radius, height);
  if (profile.back()[0] > 0) add_ring(0, profile.back()[1]);
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    const std::vector<Index>&low = rings[i], &high = rings[i + 1];
    for (std::size_t k = 0; k < static_cast<std::size_t>(around); ++k) {
      const auto at = [&](const std::vector<Index>& ring, std::size_t j) { return ring[j % ring.size()]; };
      if (low.size() > 1) mesh.triangles.push_back({at(low, k), at(low, k + 1), at(high, k + 1)});
      if (high.size() > 1) mesh.triangles.push_back({at(low, k), at(high, k + 1), at(high, k)});
    }
  }
  return mesh;
}

TriangleMesh prism(const std::vector<std::array<double, 2>>& polygon, const std::vector<Triangle>& caps,
                   double height) {
  const Index n = static_cast<Index>(polygon.size());
  TriangleMesh mesh;
  for (const double z : {0.0, height}) {
    for (const auto& [x, y] : polygon) mesh.vertices.emplace_back(x, y, z);
  }
  for (const auto& [a, b, c] : caps) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + n, b + n, c + n});
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
  }
  return mesh;
}

TriangleMesh joined(std::initializer_list<TriangleMesh> parts) {
  TriangleMesh mesh;
  for (const TriangleMesh& part : parts) {
    const Index first = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  }
  return mesh;
}

TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh bag;
  for (const Triangle& t : mesh.triangles) {
    const Index first = static_cast<Index>(bag.vertices.size());
    for (const Index vertex : t) bag.vertices.push_back(mesh.vertices[vertex]);
    bag.triangles.push_back({first, first + 1, first + 2});
  }
  return bag;
}

TriangleMesh box(const Point& lower, const Point& upper) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {  // bits of i: x, y, z
    mesh.vertices.emplace_back((i & 1 ? upper : lower).x(), (i & 2 ? upper : lower).y(), (i & 4 ? upper : lower).z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh icosphere(int subdivisions, double radius) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) subdivide(mesh);
  for (Point& vertex : mesh.vertices) vertex *= radius / vertex.norm();
  return mesh;
}

TriangleMesh torus(int around, int across, double major_radius, double minor_radius) {
  TriangleMesh mesh;
  const auto vertex = [&](int i, int j) { return static_cast<Index>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across;
      const double distance = major_radius + minor_radius * std::cos(v);
      mesh.vertices.emplace_back(distance * std::cos(u), distance * std::sin(u), minor_radius * std::sin(v));
    }
  }
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const Index a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

TriangleMesh l_shape() {
  return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {{3, 4, 5}, {3, 5, 0}, {3, 0, 1}, {3, 1, 2}});
}

TriangleMesh u_shape(double gap) {
  const double left = 1.5 - gap / 2, right = 1.5 + gap / 2;
  return prism({{0, 0}, {3, 0}, {3, 2}, {right, 2}, {right, 1}, {left, 1}, {left, 2}, {0, 2}},
               {{0, 5, 6}, {0, 6, 7}, {0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}});
}

TriangleMesh two_boxes(double gap) {
  return joined({box(Point(0, 0, 0), Point(1, 1, 1)), box(Point(1 + gap, 0, 0), Point(2 + gap, 1, 1))});
}

TriangleMesh open_box() {
  TriangleMesh mesh = box(Point(0, 0, 0), Point(1, 1, 1));
  std::erase_if(mesh.triangles, [](const Triangle& triangle) {
    return std::ranges::all_of(triangle, [](Index vertex) { return vertex >= 4; });
  });
  return mesh;
}

TriangleMesh transformed(TriangleMesh mesh, double scale, const Vector& offset) {
  for (Point& vertex : mesh.vertices) vertex = scale * vertex + offset;
  return mesh;
}

TriangleMesh mirrored(TriangleMesh mesh) {
  for (Point& vertex : mesh.vertices) vertex.x() = -vertex.x();
  return mesh;
}

}  // namespace orchard::test
