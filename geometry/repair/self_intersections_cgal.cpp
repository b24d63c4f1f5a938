#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include <algorithm>

#include "inexact_kernel.h"
#include "orchard/geometry/self_intersections.h"
#include "query/triangle_tree.h"
#include "same_place.h"
#include "self_intersections_of_tree.h"

namespace orchard {
namespace {

using detail::CgalKernel;

class PairTest {
 public:
  explicit PairTest(const TriangleMesh& mesh) : mesh_(mesh), place_(first_at_place(mesh)) {}

  bool degenerate(Index t) const { return CgalKernel().is_degenerate_3_object()(triangle(t)); }

  bool meet(Index a, Index b) const {
    const auto p = places(a), q = places(b);
    std::array<std::size_t, 3> at_a{}, at_b{};  // of the shared corners
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (p[i] == q[j]) at_a[shared] = i, at_b[shared++] = j;
    if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
    if (shared == 1) return opposite_edge_meets(a, at_a[0], b) || opposite_edge_meets(b, at_b[0], a);
    return shared == 2 && folded(a, 3 - at_a[0] - at_a[1], b, 3 - at_b[0] - at_b[1]);
  }

 private:
  std::array<Index, 3> places(Index t) const {
    const auto& [i, j, k] = mesh_.triangles[t];
    return {place_[i], place_[j], place_[k]};
  }
  CgalKernel::Point_3 corner(Index t, std::size_t i) const {
    const Point& p = mesh_.vertices[mesh_.triangles[t][i % 3]];
    return {p.x(), p.y(), p.z()};
  }
  CgalKernel::Triangle_3 triangle(Index t) const { return {corner(t, 0), corner(t, 1), corner(t, 2)}; }

  // Two triangles with one common corner meet elsewhere if and only if the edge of one of them opposite that corner
  // meets the other one.
  bool opposite_edge_meets(Index t, std::size_t i, Index other) const {
    return CGAL::do_intersect(CgalKernel::Segment_3(corner(t, i + 1), corner(t, i + 2)), triangle(other));
  }
  // Two triangles with a common edge meet elsewhere if and only if they lie in one plane and on the same side of it.
  bool folded(Index a, std::size_t i, Index b, std::size_t j) const {
    const CgalKernel::Point_3 p = corner(a, i), u = corner(a, i + 1), v = corner(a, i + 2), q = corner(b, j);
    return CGAL::coplanar(u, v, p, q) && CGAL::coplanar_orientation(u, v, p, q) == CGAL::POSITIVE;
  }

  const TriangleMesh& mesh_;
  std::vector<Index> place_;
};

}  // namespace

std::vector<std::array<Index, 2>> self_intersections(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  return detail::self_intersections(mesh, detail::TriangleTree(mesh));
}

std::vector<std::array<Index, 2>> detail::self_intersections(const TriangleMesh& mesh, const TriangleTree& tree) {
  const PairTest test(mesh);
  std::vector<char> takes_part(mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) takes_part[t] = !test.degenerate(t);
  std::vector<std::array<Index, 2>> pairs;
  tree.visit_pairs([&](Index a, Index b) {
    if (takes_part[a] && takes_part[b] && test.meet(a, b)) pairs.push_back({std::min(a, b), std::max(a, b)});
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace orchard
