#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lattice.h"

// Scenes of whole numbers at every size that a tree may have, and whether they touch, which no size changes.
namespace orchard::runtime::test {

// 2^-149 is the least float. Coordinates and radii are below 12: at 2^56 within 1e18, and at 2^60 those of 1 are
// beyond.
inline constexpr int kMinPower = -149, kMaxPower = 56, kBeyond = 60;

using LatticeMesh = std::vector<LatticeTriangle>;

inline LatticeMesh lattice_soup(Draw& draw, std::size_t triangles, std::int64_t side) {
  LatticeMesh mesh(triangles);
  for (LatticeTriangle& t : mesh) {
    Lattice corner{};
    for (std::int64_t& x : corner) x = static_cast<std::int64_t>(draw.bits() % static_cast<std::uint64_t>(side));
    for (Lattice& p : t) {
      for (std::size_t i = 0; i < 3; ++i) p[i] = corner[i] + static_cast<std::int64_t>(draw.bits() % 6) - 3;
    }
  }
  return mesh;
}

inline LatticeMesh lattice_box(const Lattice& size) {
  LatticeMesh mesh;
  const Mesh unit = box({0, 0, 0}, {1, 1, 1});
  for (const auto& t : unit.triangles) {
    LatticeTriangle& triangle = mesh.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        triangle[k][i] = static_cast<std::int64_t>(unit.vertices[t[k]][i]) * size[i];
      }
    }
  }
  return mesh;
}

inline PackedSphereTree tree_of(const LatticeMesh& lattice, int power) {
  Mesh mesh;
  mesh.closed = false;
  for (const LatticeTriangle& t : lattice) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Lattice& p : t) {
      Vec v{};
      for (std::size_t i = 0; i < 3; ++i) v[i] = std::ldexp(static_cast<double>(p[i]), power);
      mesh.vertices.push_back(v);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return build_tree(mesh, {.branching = 3, .leaf_triangles = 2, .bounds = false});
}

// One of the 24 rotations that keep the lattice, and a step.
struct LatticePose {
  std::array<std::array<std::int64_t, 3>, 3> rotation{};
  Lattice step{};
};

inline LatticePose lattice_pose(Draw& draw, std::int64_t reach) {
  LatticePose pose;
  const std::size_t first = draw.bits() % 3, second = (first + 1 + draw.bits() % 2) % 3, third = 3 - first - second;
  const std::int64_t s = draw.bits() % 2 == 0 ? 1 : -1, t = draw.bits() % 2 == 0 ? 1 : -1;
  const bool even = second == (first + 1) % 3;
  pose.rotation[0][first] = s, pose.rotation[1][second] = t, pose.rotation[2][third] = even ? s * t : -s * t;
  for (std::int64_t& x : pose.step) {
    x = static_cast<std::int64_t>(draw.bits() % static_cast<std::uint64_t>(2 * reach + 1)) - reach;
  }
  return pose;
}

inline LatticeMesh moved(LatticeMesh mesh, const LatticePose& pose) {
  for (LatticeTriangle& t : mesh) {
    for (Lattice& p : t) {
      Lattice q = pose.step;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) q[i] += pose.rotation[i][j] * p[j];
      }
      p = q;
    }
  }
  return mesh;
}

inline Pose pose_of(const LatticePose& from, int power) {
  Pose pose;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) pose.rotation[3 * i + j] = static_cast<double>(from.rotation[i][j]);
    pose.translation[i] = std::ldexp(static_cast<double>(from.step[i]), power);
  }
  return pose;
}

inline bool meet(const LatticeMesh& a, const LatticeMesh& b) {
  return std::any_of(a.begin(), a.end(), [&b](const LatticeTriangle& t) {
    return std::any_of(b.begin(), b.end(), [&t](const LatticeTriangle& u) { return lattice_triangles_meet(t, u); });
  });
}

struct Scene {
  LatticeMesh a, b;
  LatticePose pose;
  bool touch;
};

// Boxes, which touch by a face, an edge or a corner, and soups.
inline Scene scene(std::uint64_t seed) {
  Draw draw(seed);
  const auto side = [&draw] { return static_cast<std::int64_t>(1 + draw.bits() % 4); };
  Scene s;
  if (seed % 2 == 0) {
    s.a = lattice_box({side(), side(), side()}), s.b = lattice_box({side(), side(), side()});
    s.pose = lattice_pose(draw, 2);
  } else {
    s.a = lattice_soup(draw, 1 + draw.bits() % 20, 8), s.b = lattice_soup(draw, 1 + draw.bits() % 20, 8);
    s.pose = lattice_pose(draw, 3);
  }
  s.touch = meet(s.a, moved(s.b, s.pose));
  return s;
}

}  // namespace orchard::runtime::test
