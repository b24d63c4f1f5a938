#pragma once
#include <optional>

#include "orchard/runtime/shape_query.h"

namespace orchard::runtime::test {

// Whether two answers to a ray are the same to the bit.
inline bool same_hit(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->along == b->along && a->triangle == b->triangle && a->point == b->point));
}

}  // namespace orchard::runtime::test
