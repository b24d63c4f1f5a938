#include "voronoi/point_sets.h"

#include <cmath>

#include "orchard/geometry/random.h"

namespace orchard::test {
namespace {

Vector direction(Random& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, kTurn), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// A point of the unit cube's surface from a face number and two coordinates.
Point on_cube(std::uint64_t face, double u, double v) {
  const double w = face % 2 == 0 ? 0 : 1;
  if (face / 2 == 0) return {w, u, v};
  if (face / 2 == 1) return {u, w, v};
  return {u, v, w};
}

}  // namespace

Points uniform_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 1);
  Points points(n);
  for (Point& p : points) p = Point(random.uniform(), random.uniform(), random.uniform());
  return points;
}

Points box_face_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 2);
  Points points(n);
  for (Point& p : points) {
    const double u = random.uniform(), v = random.uniform();
    p = on_cube(random.below(6), u, v);
  }
  return points;
}

Points bumpy_sphere_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 3);
  Points points(n);
  for (Point& p : points) {
    const Vector d = direction(random);
    p = d * (1 + 0.1 * std::sin(5 * d.x()) * std::cos(4 * d.y()) + 0.05 * std::sin(7 * d.z()));
  }
  return points;
}

Points torus_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 4);
  Points points(n);
  for (Point& p : points) {
    const double u = random.uniform(0, kTurn), v = random.uniform(0, kTurn), r = 1 + 0.35 * std::cos(v);
    p = Point(r * std::cos(u), r * std::sin(u), 0.35 * std::sin(v));
  }
  return points;
}

Points sphere_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 5);
  Points points(n);
  for (Point& p : points) p = direction(random);
  return points;
}

Points relaxed_box_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 6);
  const auto k = static_cast<std::size_t>(std::max(2.0, std::round(std::sqrt(static_cast<double>(n) / 6))));
  const double h = 1 / static_cast<double>(k);
  Points points;
  for (std::uint64_t face = 0; face < 6; ++face)
    for (std::size_t i = 0; i < k; ++i)
      for (std::size_t j = 0; j < k; ++j) {
        const double u = (static_cast<double>(i) + (j % 2 ? 0.75 : 0.25) + random.uniform(-0.1, 0.1)) * h;
        const double v = (static_cast<double>(j) + 0.5 + random.uniform(-0.1, 0.1)) * h;
        points.push_back(on_cube(face, u, v));
      }
  for (int edge = 0; edge < 12; ++edge)
    for (std::size_t i = 0; i <= k; ++i) {
      const double t = static_cast<double>(i) * h, a = edge % 2, b = (edge / 2) % 2;
      if (edge >= 4 && (i == 0 || i == k)) continue;
      points.push_back(edge < 4 ? Point(t, a, b) : edge < 8 ? Point(a, t, b) : Point(a, b, t));
    }
  return points;
}

Points relaxed_polyhedron_points(std::size_t n, std::uint64_t seed) {
  return turned(relaxed_box_points(n, seed), seed);
}

Points box_lattice_points(int k) {
  Points points;
  for (int x = 0; x <= k; ++x)
    for (int y = 0; y <= k; ++y)
      for (int z = 0; z <= k; ++z)
        if (x % k == 0 || y % k == 0 || z % k == 0) points.push_back(Point(x, y, z) / k);
  return points;
}

Points grid_points(int k) {
  Points points;
  for (int x = 0; x < k; ++x)
    for (int y = 0; y < k; ++y)
      for (int z = 0; z < k; ++z) points.emplace_back(x * 0.1, y * 0.1, z * 0.1);
  return points;
}

Points body_centered_points(int k) {
  Points points;
  for (int x = 0; x < k; ++x)
    for (int y = 0; y < k; ++y)
      for (int z = 0; z < k; ++z) {
        points.emplace_back(x, y, z);
        points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
      }
  return points;
}

Points cone_ring_points(int rings, int around) {
  Points points{Point(0, 0, 1)};
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const double r = static_cast<double>(ring) / rings, angle = kTurn * i / around;
      points.emplace_back(0.5 * r * std::cos(angle), 0.5 * r * std::sin(angle), 1 - r);
    }
  return points;
}

Points turned(const Points& points, std::uint64_t seed) {
  Random random(seed, 7);
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(random.uniform(0, kTurn), direction(random)) * Eigen::Quaterniond::Identity();
  Points result;
  for (const Point& p : points) result.push_back(rotation * p);
  return result;
}

Points moved(Points points, double scale, const Vector& offset) {
  for (Point& p : points) p = scale * p + offset;
  return points;
}

std::vector<std::pair<std::string, Points>> degenerate_point_sets() {
  std::vector<std::pair<std::string, Points>> sets;
  const auto add = [&](const std::string& name, Points points) { sets.emplace_back(name, std::move(points)); };
  add("tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  add("cube", grid_points(2));
  add("octahedron", {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  add("grid", grid_points(8));
  add("turned grid", turned(grid_points(8), 1));
  add("body-centred lattice", body_centered_points(6));
  add("turned body-centred lattice", turned(body_centered_points(6), 2));
  add("lattice on a box", box_lattice_points(12));
  add("turned lattice on a box", turned(box_lattice_points(12), 3));
  add("relaxed points on a box", relaxed_box_points(800, 1));
  add("relaxed points on a turned box", relaxed_polyhedron_points(800, 2));
  add("random points on a box", box_face_points(500, 3));
  add("random points on a turned box", turned(box_face_points(500, 4), 4));
  add("points on a sphere", sphere_points(700, 5));
  Points sphere = sphere_points(300, 6);
  sphere.emplace_back(0, 0, 0);
  add("points on a sphere and its centre", sphere);
  add("cone rings", cone_ring_points(20, 24));
  add("cylinder rings", [] {
    Points points;
    for (int z = 0; z < 16; ++z)
      for (int i = 0; i < 20; ++i) points.emplace_back(std::cos(kTurn * i / 20), std::sin(kTurn * i / 20), 0.2 * z);
    return points;
  }());
  Points plane;
  for (int x = 0; x < 15; ++x)
    for (int y = 0; y < 15; ++y) plane.emplace_back(x, y, 0);
  plane.emplace_back(3.3, 4.4, 5.5);
  add("coplanar grid and one point", plane);
  add("turned coplanar grid and one point", turned(plane, 5));
  Points flat = uniform_points(300, 7);
  for (Point& p : flat) p.z() = 0;
  flat.emplace_back(0.5, 0.5, 0.25);
  add("coplanar random points and one point", flat);
  add("turned coplanar random points and one point", turned(flat, 6));
  Points line;
  for (int i = 0; i < 100; ++i) line.emplace_back(i, 0, 0);
  line.emplace_back(0, 1, 0);
  line.emplace_back(0, 0, 1);
  add("line and two points", line);
  add("turned line and two points", turned(line, 7));
  Points twice = grid_points(5);
  const Points again = twice;
  twice.insert(twice.end(), again.begin(), again.end());
  add("grid twice", twice);
  add("needle", moved(uniform_points(300, 8), 1, Vector::Zero()));
  for (Point& p : sets.back().second) p.y() *= 1e-5, p.z() *= 1e-5;
  add("two distant clusters", uniform_points(200, 9));
  for (std::size_t i = 0; i < 100; ++i) sets.back().second[i] += Vector(1000, 0, 0);
  add("grid far from the origin", moved(grid_points(7), 1, Vector(1e6, -1e6, 1e6)));
  add("tiny grid", moved(grid_points(7), 1e-6, Vector::Zero()));
  add("tiny turned grid", moved(turned(grid_points(7), 8), 1e-6, Vector::Zero()));
  return sets;
}

}  // namespace orchard::test
