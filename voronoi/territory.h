#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The vertices that one thread may replace while others work elsewhere: those all of whose forming points lie in one
// region of space. What has points in several regions is mixed: nobody replaces it, so that everybody may read it. The
// regions of vertices stay as they are all the while: a vertex that takes the place of owned ones is owned, too.
struct Territory {
  static constexpr std::uint8_t kMixed = 255;

  const std::uint8_t* region_of = nullptr;  // by vertex, free ones included; null where one thread does it all
  std::uint8_t own = 0;
  std::vector<Index>* free_vertices = nullptr;  // for new vertices: there are no others

  bool whole() const { return region_of == nullptr; }
  bool owns(Index v) const { return whole() || region_of[v] == own; }
  bool may_read(Index v) const { return whole() || region_of[v] == own || region_of[v] == kMixed; }
};

}  // namespace orchard::detail
