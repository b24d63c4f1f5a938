#include "known_axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outlines.h"
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

namespace {

// The planar axis of the L: a node for each corner of the outline and each place where lines of the axis meet or bend.
struct PlanarAxis {
  struct Node {
    std::array<double, 2> at;
    double radius;
  };
  std::vector<Node> nodes;
  std::vector<std::array<Index, 2>> lines;
  std::vector<std::vector<Index>>
      regions;  // where one side, or the reentrant corner, is nearest: fans from their first
};

// Mirrors a node at the diagonal y = x.
PlanarAxis::Node across_diagonal(const PlanarAxis::Node& node) { return {{node.at[1], node.at[0]}, node.radius}; }

PlanarAxis planar_l(Index pieces) {
  PlanarAxis axis;
  // One half, below the diagonal. The parabola, equally far from (1, 1) and from y = 0, is y = (1 + (x - 1)^2) / 2; it
  // meets the diagonal at 2 - sqrt 2.
  const double meeting = 2 - std::numbers::sqrt2;
  std::vector<PlanarAxis::Node> half{{{1, 0}, 0}, {{2, 0}, 0}, {{2, 1}, 0}, {{1.5, 0.5}, 0.5}};
  for (Index i = 0; i < pieces; ++i) {
    const double x = 1 - i * (1 - meeting) / pieces, y = (1 + (x - 1) * (x - 1)) / 2;
    half.push_back({{x, y}, y});
  }
  const Index size = static_cast<Index>(half.size());
  axis.nodes = {{{0, 0}, 0}, {{1, 1}, 0}, {{meeting, meeting}, meeting}};
  axis.lines.push_back({0, 2});
  for (const bool mirror : {false, true}) {
    const Index first = static_cast<Index>(axis.nodes.size());
    for (const auto& node : half) axis.nodes.push_back(mirror ? across_diagonal(node) : node);
    const Index side = first, outer = first + 1, inner = first + 2, end = first + 3, bend = first + 4;
    axis.lines.insert(axis.lines.end(), {{end, outer}, {end, inner}, {end, bend}});
    axis.regions.push_back({outer, inner, end});
    axis.regions.push_back({1, bend, end, inner});
    std::vector<Index> below{side, outer, end}, around{1};
    for (Index k = 4; k < size; ++k) {
      const Index next = k + 1 < size ? first + k + 1 : 2;
      axis.lines.push_back({first + k, next});
      below.push_back(first + k);
      around.push_back(first + k);
    }
    below.insert(below.end(), {2, 0});
    around.push_back(2);
    axis.regions.push_back(below);
    axis.regions.push_back(around);
  }
  return axis;
}

}  // namespace

KnownAxis known_l_shape(Index pieces) {
  constexpr double height = 2;
  KnownAxis known{extruded({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, height), {}};
  MedialMesh& axis = known.axis;
  const PlanarAxis planar = planar_l(pieces);
  const Index roof = static_cast<Index>(planar.nodes.size());  // the lower roof's vertices come first
  for (const bool upper : {false, true}) {
    for (const auto& [at, radius] : planar.nodes) add(axis, {at[0], at[1], upper ? height - radius : radius}, radius);
    for (const auto& region : planar.regions) {
      for (std::size_t k = 2; k < region.size(); ++k) {
        const Index shift = upper ? roof : 0;
        axis.triangles.push_back({shift + region[0], shift + region[k - 1], shift + region[k]});
      }
    }
  }
  for (const auto& [a, b] : planar.lines) add_quad(axis, a, b, roof + b, roof + a);
  complete(axis);
  return known;
}

TriangleMesh as_triangles(const MedialMesh& axis) {
  TriangleMesh mesh{axis.centers, axis.triangles};
  for (const auto& [a, b] : axis.edges) mesh.triangles.push_back({a, b, b});
  for (Index i = 0; i < axis.size(); ++i) mesh.triangles.push_back({i, i, i});
  return mesh;
}

std::vector<Point> points_on(const MedialMesh& axis, double step) {
  std::vector<Point> points = axis.centers;
  const auto parts = [&](const Point& a, const Point& b) { return static_cast<int>(std::ceil((a - b).norm() / step)); };
  for (const auto& [a, b] : axis.edges) {
    const int count = parts(axis.centers[a], axis.centers[b]);
    for (int i = 1; i < count; ++i) {
      points.push_back(axis.centers[a] + double(i) / count * (axis.centers[b] - axis.centers[a]));
    }
  }
  for (const auto& [i, j, k] : axis.triangles) {
    const Point &a = axis.centers[i], &b = axis.centers[j], &c = axis.centers[k];
    const int count = std::max({parts(a, b), parts(a, c), parts(b, c)});
    for (int u = 1; u < count; ++u) {
      for (int v = 1; u + v < count; ++v)
        points.push_back(a + double(u) / count * (b - a) + double(v) / count * (c - a));
    }
  }
  return points;
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
