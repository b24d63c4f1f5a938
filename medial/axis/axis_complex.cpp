#include "axis_complex.h"

#include <algorithm>
#include <string>

#include "incidence.h"
#include "orchard/geometry/error.h"

namespace orchard::detail {

AxisComplex::AxisComplex(const MedialAxis& axis) : axis_(axis) {
  std::vector<std::array<Index, 2>> at_vertex, at_edge;
  for (Index i = 0; i < axis.size(); ++i) {
    for (const Index next : axis.neighbors[i]) {
      if (next < i) continue;
      at_vertex.push_back({i, static_cast<Index>(edges_.size())});
      at_vertex.push_back({next, static_cast<Index>(edges_.size())});
      edges_.push_back({i, next});
    }
  }
  for (Index face = 0; face < face_count(); ++face) {
    const auto loop = corners(face);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const auto [low, high] = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
      const auto found = std::lower_bound(edges_.begin(), edges_.end(), std::array<Index, 2>{low, high});
      if (found == edges_.end() || *found != std::array<Index, 2>{low, high})
        throw Error("medial axis: face " + std::to_string(face) + " has a side that is no edge");
      const Index edge = static_cast<Index>(found - edges_.begin());
      sides_.items.push_back(edge);
      at_edge.push_back({edge, face});
    }
    sides_.close_row();
  }
  edges_at_ = rows_of(at_vertex, axis.size());
  faces_at_ = rows_of(at_edge, static_cast<Index>(edges_.size()));
}

}  // namespace orchard::detail
