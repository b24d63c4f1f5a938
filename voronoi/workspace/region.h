#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The vertices that one thread may replace while others work elsewhere: those all of whose forming points lie in one
// region of space. What has points in several regions is mixed: no thread replaces it, so that every thread may read
// it, nor marks it. The regions of vertices stay as they are all the while: a vertex that takes the place of owned ones
// is owned, too.
//
// Around a mixed vertex others may be replaced all the same. Across a facet all of whose points lie in one region there
// is a vertex of this region or a mixed one, before and after, and only the thread of the region changes which: no
// other may read it. Across other facets there are mixed vertices, which stay.
struct Region {
  static constexpr std::uint8_t kMixed = 255;

  const std::uint8_t* region_of = nullptr;  // by vertex, free ones included; null where one thread does it all
  std::uint8_t own = 0;
  std::vector<Index>* free_vertices = nullptr;  // for new vertices: there are no others

  bool whole() const { return region_of == nullptr; }
  bool owns(Index v) const { return whole() || region_of[v] == own; }
  // A bit for each.
  unsigned owned(const std::array<Index, 4>& v) const {
    const auto bit = [&](unsigned i) { return unsigned{region_of[v[i]] == own} << i; };
    return bit(0) | bit(1) | bit(2) | bit(3);
  }
  bool may_read(Index v) const { return whole() || region_of[v] == own || region_of[v] == kMixed; }
};

}  // namespace orchard::detail
