#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/medial/axis.h"

namespace orchard::detail {

// The cells of a medial axis and which of them meet. Faces and topology faces are numbered together, faces first; edges
// are in the order of their vertices.
class AxisComplex {
 public:
  explicit AxisComplex(const MedialAxis& axis);

  Index face_count() const { return axis_.faces.size() + axis_.topology_faces.size(); }
  std::span<const Index> corners(Index face) const {
    return face < axis_.faces.size() ? axis_.faces[face] : axis_.topology_faces[face - axis_.faces.size()];
  }
  const std::array<Index, 2>& points(Index face) const {
    return face < axis_.faces.size() ? axis_.face_points[face] : axis_.topology_face_points[face - axis_.faces.size()];
  }
  const std::vector<std::array<Index, 2>>& edges() const { return edges_; }
  std::span<const Index> sides(Index face) const { return sides_[face]; }            // edges, in order
  std::span<const Index> faces_at(Index edge) const { return faces_at_[edge]; }      // ascending
  std::span<const Index> edges_at(Index vertex) const { return edges_at_[vertex]; }  // ascending

 private:
  const MedialAxis& axis_;
  std::vector<std::array<Index, 2>> edges_;
  Rows sides_, faces_at_, edges_at_;
};

}  // namespace orchard::detail
