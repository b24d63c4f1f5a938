// One function for each family of point sets, hence more than 300 lines.
#include "voronoi/algorithms/shaken_sets.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "orchard/geometry/random.h"
#include "voronoi/predicates/quadruples.h"

namespace orchard::test {
namespace {

int between(Random& random, int low, int high) {
  return low + static_cast<int>(random.below(static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1));
}

Point on_ring(double radius, int i, int around, double z) {
  const double angle = kTurn * i / around;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// i, j and k from 0 to below the counts, each mapped to a point.
template <class Place>
Points lattice(int nx, int ny, int nz, Place&& place) {
  Points points;
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y)
      for (int z = 0; z < nz; ++z) points.push_back(place(x, y, z));
  return points;
}

Points box_grid(Random& random) {
  const double step = random.below(2) == 0 ? 1 : 0.1;
  return lattice(between(random, 2, 7), between(random, 2, 7), between(random, 2, 6),
                 [&](int x, int y, int z) { return Point(step * x, step * y, step * z); });
}

Points body_centered(Random& random) { return body_centered_points(between(random, 2, 5)); }

Points face_centered(Random& random) {
  Points points = lattice(between(random, 3, 8), between(random, 3, 8), between(random, 3, 8),
                          [](int x, int y, int z) { return Point(x, y, z); });
  std::erase_if(points, [](const Point& p) { return static_cast<int>(p.sum()) % 2 != 0; });
  return points;
}

Points hexagonal(Random& random) {
  const double height = random.below(2) == 0 ? 1 : std::sqrt(2.0 / 3);
  return lattice(between(random, 2, 7), between(random, 2, 7), between(random, 2, 5),
                 [&](int x, int y, int z) { return Point(x + 0.5 * y, y * std::sqrt(0.75), z * height); });
}

Points triangular_prism(Random& random) {
  // Corners, edge thirds and centres of triangles in layers.
  const int parts = between(random, 1, 5), layers = between(random, 2, 5);
  Points points;
  for (int z = 0; z < layers; ++z)
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j)
        points.emplace_back((i + 0.5 * j) / parts, j * std::sqrt(0.75) / parts, static_cast<double>(z) / 3);
  return points;
}

Points polygonal_prism(Random& random) {
  const int around = between(random, 3, 24), layers = between(random, 2, 10);
  const bool centers = random.below(2) == 0;
  Points points;
  for (int z = 0; z < layers; ++z) {
    for (int i = 0; i < around; ++i) points.push_back(on_ring(1, i, around, 0.3 * z));
    if (centers) points.emplace_back(0, 0, 0.3 * z);
  }
  return points;
}

Points cube_lattice(Random& random) { return box_lattice_points(between(random, 2, 6)); }
Points cube_faces(Random& random) { return box_face_points(8 + random.below(290), random.bits()); }
Points relaxed_cube(Random& random) { return relaxed_box_points(30 + random.below(200), random.bits()); }
Points sphere(Random& random) { return sphere_points(8 + random.below(290), random.bits()); }

Points sphere_and_center(Random& random) {
  Points points = sphere_points(8 + random.below(150), random.bits());
  points.emplace_back(0, 0, 0);
  for (Point& p : sphere_points(random.below(100), random.bits())) points.push_back(0.5 * p);
  return points;
}

Points globe(Random& random) {
  const int around = between(random, 4, 24), rings = between(random, 2, 12);
  Points points{{0, 0, 1}, {0, 0, -1}};
  for (int ring = 1; ring < rings; ++ring) {
    const double latitude = kTurn / 2 * ring / rings;
    for (int i = 0; i < around; ++i) points.push_back(on_ring(std::sin(latitude), i, around, std::cos(latitude)));
  }
  return points;
}

Points cone(Random& random) { return cone_ring_points(between(random, 2, 14), between(random, 4, 20)); }

Points cylinder(Random& random) {
  const int around = between(random, 4, 24), rings = between(random, 2, 12);
  const double step = random.uniform(0.02, 0.5);
  return lattice(rings, around, 1, [&](int z, int i, int) { return on_ring(1, i, around, step * z); });
}

Points torus_lattice(Random& random) {
  const int u = between(random, 4, 20), v = between(random, 3, 14);
  return lattice(u, v, 1, [&](int i, int j, int) {
    const double angle = kTurn * j / v;
    return on_ring(1 + 0.35 * std::cos(angle), i, u, 0.35 * std::sin(angle));
  });
}

Points circles(Random& random) {
  // Concentric ones, in one plane or two.
  const int around = between(random, 4, 30), rings = between(random, 1, 5), planes = between(random, 1, 2);
  Points points = lattice(rings, around, planes, [&](int r, int i, int z) { return on_ring(r + 1, i, around, z); });
  points.emplace_back(0.1, 0.2, random.uniform(-1, 2));
  points.emplace_back(0, 0, 0);
  return points;
}

Points lines(Random& random) {
  Points points;
  const int count = between(random, 2, 5), each = between(random, 3, 60);
  const Points starts = sphere_points(static_cast<std::size_t>(count), random.bits()),
               directions = sphere_points(static_cast<std::size_t>(count), random.bits());
  const bool star = random.below(2) == 0;
  for (int line = 0; line < count; ++line)
    for (int i = 0; i < each; ++i) {
      const auto l = static_cast<std::size_t>(line);
      points.push_back((star ? Point(Point::Zero()) : starts[l]) + directions[l] * (i + 1) / each);
    }
  points.push_back(Point(0.3, -0.2, 0.7));
  return points;
}

Points parallel_lines(Random& random) {
  const int around = between(random, 3, 12), each = between(random, 2, 25);
  const double step = random.uniform(0.01, 1);
  return lattice(around, each, 1, [&](int i, int j, int) { return on_ring(0.3, i, around, step * j); });
}

Points near_duplicates(Random& random) {
  Points points = random.below(2) == 0 ? uniform_points(8 + random.below(140), random.bits())
                                       : bumpy_sphere_points(8 + random.below(140), random.bits());
  const std::size_t count = points.size();
  const double apart = std::pow(10.0, random.uniform(-6.5, -3));
  for (std::size_t i = 0; i < count; ++i) {
    const Point p = points[i];
    for (const Point& d : sphere_points(random.below(3), random.bits())) points.push_back(p + apart * d);
  }
  return points;
}

Points plane_and_points(Random& random) {
  const int nx = between(random, 2, 12), ny = between(random, 2, 12);
  Points points = lattice(nx, ny, 1, [](int x, int y, int) { return Point(x, y, 0); });
  for (std::uint64_t more = 1 + random.below(3); more-- > 0;)
    points.emplace_back(random.uniform(0, nx), random.uniform(0, ny), random.uniform(-4, 4));
  return points;
}

Points random_plane_and_points(Random& random) {
  Points points = uniform_points(8 + random.below(200), random.bits());
  for (Point& p : points) p.z() = 0;
  points.emplace_back(0.5, 0.5, random.uniform(0.001, 1));
  return points;
}

Points two_planes(Random& random) {
  Points points = uniform_points(8 + random.below(200), random.bits());
  const double gap = std::pow(10.0, random.uniform(-4, 0));
  for (std::size_t i = 0; i < points.size(); ++i) points[i].z() = i % 2 == 0 ? 0 : gap;
  return points;
}

Points wedge(Random& random) {
  // Two planes that meet in an edge on which there are points, too.
  const double angle = random.uniform(0.01, 2.5);
  Points points;
  for (const Point& p : uniform_points(8 + random.below(120), random.bits())) {
    points.emplace_back(p.x(), p.y(), 0);
    points.emplace_back(p.x() * std::cos(angle), p.z(), p.x() * std::sin(angle));
    points.emplace_back(0, p.z(), 0);
  }
  return points;
}

Points regular_solids(Random& random) {
  const double golden = std::numbers::phi;
  Points points;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-1.0, 1.0}) {
      points.emplace_back(0, s, t * golden);
      points.emplace_back(s, t * golden, 0);
      points.emplace_back(t * golden, 0, s);
    }
  const std::size_t corners = points.size();
  for (std::size_t i = 0; i < corners; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((points[i] - points[j]).norm() < 2.1) points.push_back((points[i] + points[j]) / 2);
  if (random.below(2) == 0) points.emplace_back(0, 0, 0);
  if (random.below(2) == 0)
    for (std::size_t i = 0; i < corners; ++i) points.push_back(points[i] / 2);
  return points;
}

Points moment_curve(Random& random) {
  Points points;
  const int count = between(random, 8, 60);
  for (int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / count;
    points.emplace_back(t, t * t, t * t * t);
  }
  return points;
}

Points nested_cubes(Random& random) {
  Points points;
  const int cubes = between(random, 1, 4), k = between(random, 1, 4);
  for (int cube = 1; cube <= cubes; ++cube)
    for (const Point& p : box_lattice_points(k)) points.push_back((p - Point(0.5, 0.5, 0.5)) * cube);
  return points;
}

Points needle_set(Random& random) {
  Points points = random.below(2) == 0 ? box_lattice_points(between(random, 2, 5))
                                       : cone_ring_points(between(random, 2, 10), between(random, 4, 16));
  const double thin = std::pow(10.0, random.uniform(-5, 0));
  for (Point& p : points) p.y() *= thin, p.z() *= random.below(2) == 0 ? thin : 1;
  return points;
}

Points two_clusters(Random& random) {
  Points points = random.below(2) == 0 ? grid_points(between(random, 2, 5)) : sphere_points(60, random.bits());
  const double apart = std::pow(10.0, random.uniform(0, 3));
  for (std::size_t i = 0; i < points.size() / 2; ++i) points[i] += Vector(apart, 0, 0);
  return points;
}

Points half_random(Random& random) {
  Points points = lattice(between(random, 2, 5), between(random, 2, 5), between(random, 2, 5),
                          [](int x, int y, int z) { return Point(x, y, z); });
  for (const Point& p : uniform_points(random.below(100), random.bits())) points.push_back(3 * p);
  return points;
}

struct Family {
  const char* name;
  Points (*make)(Random&);
};

constexpr Family kFamilies[] = {{"box grid", box_grid},
                                {"body-centred lattice", body_centered},
                                {"face-centred lattice", face_centered},
                                {"hexagonal lattice", hexagonal},
                                {"triangular prism", triangular_prism},
                                {"polygonal prism", polygonal_prism},
                                {"lattice on a cube", cube_lattice},
                                {"random on a cube", cube_faces},
                                {"relaxed on a cube", relaxed_cube},
                                {"sphere", sphere},
                                {"spheres and centre", sphere_and_center},
                                {"globe", globe},
                                {"cone", cone},
                                {"cylinder", cylinder},
                                {"torus lattice", torus_lattice},
                                {"circles", circles},
                                {"lines", lines},
                                {"parallel lines", parallel_lines},
                                {"near-duplicates", near_duplicates},
                                {"plane and points", plane_and_points},
                                {"random plane and a point", random_plane_and_points},
                                {"two planes", two_planes},
                                {"wedge", wedge},
                                {"regular solids", regular_solids},
                                {"moment curve", moment_curve},
                                {"nested cubes", nested_cubes},
                                {"needle", needle_set},
                                {"two clusters", two_clusters},
                                {"half random", half_random}};

void shuffle(Points& points, Random& random) {
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
}

// Every coordinate; or those of some points only; or the heights only.
void shake(Points& points, double off, Random& random) {
  const std::uint64_t how = random.below(4);
  for (Point& p : points) {
    const Vector d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (how == 1 && random.below(2) == 0) continue;
    p += off * (how == 2 ? Vector(0, 0, d.z()) : d);
  }
}

}  // namespace

std::size_t shaken_family_count() { return std::size(kFamilies); }

ShakenSet shaken_set(std::uint64_t seed) {
  Random random(seed, 0x5e7u);
  const Family& family = kFamilies[random.below(std::size(kFamilies))];
  Points points = family.make(random);
  if (random.below(2) == 0) {  // some of them only
    shuffle(points, random);
    points.resize(std::min(points.size(), 8 + random.below(53)));
  }
  if (random.below(2) == 0) points = turned(points, random.bits());
  const double size = bounding_radius(points), exponent = random.uniform(-16, -6);
  shake(points, size * std::pow(10.0, exponent), random);
  if (random.below(4) == 0)
    points =
        moved(points, random.uniform(0.5, 2),
              size * std::pow(10.0, random.uniform(-1, 3)) * Vector(random.uniform(-1, 1), random.uniform(-1, 1), 1));
  if (random.below(4) == 0)  // what an STL file makes of it
    for (Point& p : points) p = p.cast<float>().cast<double>();
  if (random.below(2) == 0) shuffle(points, random);
  return {std::string(family.name) + ", seed " + std::to_string(seed) + ", " + std::to_string(points.size()) +
              " points, shaken by 1e" + std::to_string(exponent),
          std::move(points)};
}

}  // namespace orchard::test
