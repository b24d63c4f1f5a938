#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "support.h"

// Triangles whose corners are small whole numbers, and whether they meet: integers throughout, so nothing is rounded.
namespace orchard::runtime::test {

__extension__ using Wide = __int128;
using Lattice = std::array<std::int64_t, 3>;
using WideVec = std::array<Wide, 3>;
using LatticeTriangle = std::array<Lattice, 3>;

inline WideVec minus(const Lattice& a, const Lattice& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline WideVec cross(const WideVec& a, const WideVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline bool separated(const WideVec& axis, const LatticeTriangle& a, const LatticeTriangle& b) {
  const auto range = [&axis](const LatticeTriangle& t) {
    std::array<Wide, 3> d{};
    for (std::size_t i = 0; i < 3; ++i) d[i] = axis[0] * t[i][0] + axis[1] * t[i][1] + axis[2] * t[i][2];
    return std::pair(*std::min_element(d.begin(), d.end()), *std::max_element(d.begin(), d.end()));
  };
  const auto [a_low, a_high] = range(a);
  const auto [b_low, b_high] = range(b);
  return a_high < b_low || b_high < a_low;
}

// Integer arithmetic throughout. The axes are the facet normals of the triangles' Minkowski difference, whatever its
// dimension: cross products of edges, those again across an edge, and for flat cases the offset of two corners.
inline bool lattice_triangles_meet(const LatticeTriangle& a, const LatticeTriangle& b) {
  std::vector<WideVec> edges = {minus(b[0], a[0])};
  for (std::size_t i = 0; i < 3; ++i) {
    edges.push_back(minus(a[(i + 1) % 3], a[i]));
    edges.push_back(minus(b[(i + 1) % 3], b[i]));
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (separated(edges[i], a, b)) return false;
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const WideVec normal = cross(edges[i], edges[j]);
      if (separated(normal, a, b)) return false;
      for (const WideVec& edge : edges) {
        if (separated(cross(normal, edge), a, b)) return false;
      }
    }
  }
  return true;
}

}  // namespace orchard::runtime::test
