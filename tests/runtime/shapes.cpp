#include <algorithm>
#include <cmath>
#include <numbers>

#include "support.h"

namespace orchard::runtime::test {

Vec Draw::direction() {
  for (;;) {
    const Vec v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (length > 0.1 && length <= 1) return {v[0] / length, v[1] / length, v[2] / length};
  }
}

Pose Draw::pose(double distance) {
  const Vec axis = direction();
  const double half = uniform(0, std::numbers::pi);
  const double s = std::sin(half);
  const Vec way = direction();
  return *pose_from_quaternion({std::cos(half), s * axis[0], s * axis[1], s * axis[2]},
                               {distance * way[0], distance * way[1], distance * way[2]});
}

Mesh box(const Vec& lower, const Vec& upper) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back({(i & 1 ? upper : lower)[0], (i & 2 ? upper : lower)[1], (i & 4 ? upper : lower)[2]});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// Cosine and sine of `part` of `whole` equal parts of a turn. Those of quarter turns are exact: libraries differ in the
// sine of what is nearly pi (that of MinGW has 12 digits less).
static std::array<double, 2> turned(int part, int whole) {
  constexpr std::array<double, 4> kCosines = {1, 0, -1, 0};
  if (4 * part % whole == 0) {
    const auto quarter = static_cast<std::size_t>(4 * part / whole);
    return {kCosines[quarter % 4], kCosines[(quarter + 3) % 4]};
  }
  const double angle = 2 * std::numbers::pi * part / whole;
  return {std::cos(angle), std::sin(angle)};
}

Mesh uv_sphere(int around, int across, double radius) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(around);
  mesh.vertices.push_back({0, 0, radius});
  for (int i = 1; i < across; ++i) {
    const auto [up, out] = turned(i, 2 * across);
    for (int j = 0; j < around; ++j) {
      const auto [x, y] = turned(j, around);
      mesh.vertices.push_back({radius * out * x, radius * out * y, radius * up});
    }
  }
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0, -radius});
  for (std::uint32_t j = 0; j < n; ++j) {
    const std::uint32_t k = (j + 1) % n;
    mesh.triangles.push_back({0, 1 + j, 1 + k});
    for (std::uint32_t ring = 1; ring + n < last; ring += n) {
      mesh.triangles.push_back({ring + j, ring + n + j, ring + n + k});
      mesh.triangles.push_back({ring + j, ring + n + k, ring + k});
    }
    mesh.triangles.push_back({last, last - n + k, last - n + j});
  }
  return mesh;
}

Mesh torus(int around, int across, double major_radius, double minor_radius) {
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across;
      const double ring = major_radius + minor_radius * std::cos(v);
      mesh.vertices.push_back({ring * std::cos(u), ring * std::sin(u), minor_radius * std::sin(v)});
    }
  }
  const auto n = static_cast<std::uint32_t>(around), m = static_cast<std::uint32_t>(across);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < m; ++j) {
      const std::uint32_t a = i * m + j, b = i * m + (j + 1) % m;
      const std::uint32_t c = (i + 1) % n * m + j, d = (i + 1) % n * m + (j + 1) % m;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

Mesh l_shape() {
  // The outline counterclockwise, extruded along z; the caps are cut into the same four triangles.
  const std::array<std::array<double, 2>, 6> outline = {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  const std::array<std::array<std::uint32_t, 3>, 4> cap = {{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}};
  Mesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (const auto& p : outline) mesh.vertices.push_back({p[0], p[1], z});
  }
  for (const auto& t : cap) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    mesh.triangles.push_back({i, j, j + 6});
    mesh.triangles.push_back({i, j + 6, i + 6});
  }
  return mesh;
}

Mesh spikes(std::uint64_t seed, int around, int across) {
  Draw draw(seed);
  Mesh mesh = uv_sphere(around, across, 1);
  for (Vec& v : mesh.vertices) {
    const double factor = draw.uniform(0.3, 1);
    for (double& x : v) x *= factor;
  }
  return mesh;
}

Mesh soup(std::uint64_t seed, int triangles) {
  Draw draw(seed);
  Mesh mesh;
  mesh.closed = false;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(triangles); ++i) {
    const Vec c = {draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
    for (int k = 0; k < 3; ++k) {
      const Vec d = draw.direction();
      mesh.vertices.push_back({c[0] + 0.3 * d[0], c[1] + 0.3 * d[1], c[2] + 0.3 * d[2]});
    }
    if (i % 16 == 7)
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 1});  // a segment
    else if (i % 16 == 9)
      mesh.triangles.push_back({3 * i, 3 * i, 3 * i});  // a point
    else
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

Mesh scaled(Mesh mesh, double scale) {
  for (Vec& v : mesh.vertices) {
    for (double& x : v) x *= scale;
  }
  return mesh;
}

}  // namespace orchard::runtime::test
