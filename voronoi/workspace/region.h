#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The vertices that one thread may replace while other threads work elsewhere: those whose forming points all lie in
// one region of space. The region owns them. A vertex with points in several regions is mixed: no thread replaces or
// marks it, so every thread may read it. The region of a vertex does not change while the threads work: a new vertex
// that replaces owned ones is owned, too.
//
// Neighbours of a mixed vertex may be replaced. If all points of a facet of the mixed vertex lie in one region, the
// neighbour across it is always a vertex of this region or a mixed one, and only the thread of this region may change
// or read which. The neighbours across its other facets are mixed and do not change.
struct Region {
  static constexpr std::uint8_t kMixed = 255;

  const std::uint8_t* region_of = nullptr;  // by vertex, free ones included; null where one thread does it all
  std::uint8_t own = 0;
  std::vector<Index>* free_vertices = nullptr;  // for new vertices: there are no others

  bool whole() const { return region_of == nullptr; }
  bool owns(Index v) const { return whole() || region_of[v] == own; }
  // Bit i tells whether the region owns v[i].
  unsigned owned(const std::array<Index, 4>& v) const {
    const auto bit = [&](unsigned i) { return unsigned{region_of[v[i]] == own} << i; };
    return bit(0) | bit(1) | bit(2) | bit(3);
  }
  bool may_read(Index v) const { return whole() || region_of[v] == own || region_of[v] == kMixed; }
};

}  // namespace orchard::detail
