#include "shape_cost.h"

#include <algorithm>

#include "../triangle_quality.h"

namespace orchard::detail {

ShapeCost::ShapeCost(const ContractibleMesh& mesh) : mesh_(mesh) {
  const std::size_t triangles = mesh.triangles().size();
  share_ = triangles > 0 ? 1.0 / static_cast<double>(triangles) : 0;
}

double ShapeCost::added(Index a, Index b, const Ball4& ball) const {
  const Point center = ball.head<3>();
  double sum = 0;
  for (const auto& [end, other] : {std::pair{a, b}, std::pair{b, a}}) {
    for (const Index t : mesh_.triangles_at(end)) {
      const ContractibleMesh::Triangle& corners = mesh_.triangle(t);
      std::array<Point, 3> before, after;
      bool vanishes = false;
      for (std::size_t i = 0; i < 3; ++i) {
        before[i] = mesh_.ball(corners[i]).head<3>();
        after[i] = corners[i] == end ? center : before[i];
        vanishes = vanishes || corners[i] == other;
      }
      if (vanishes && end == b) continue;  // it is counted together with a
      sum -= 1 - triangle_quality(before[0], before[1], before[2]);
      if (!vanishes) sum += 1 - triangle_quality(after[0], after[1], after[2]);
    }
  }
  if (is_inside_sheet(a, b) && is_on_structure(a) && is_on_structure(b)) sum += kPinch;
  return sum * share_;
}

bool ShapeCost::is_inside_sheet(Index a, Index b) const { return mesh_.count_triangles_at(a, b) == 2; }

bool ShapeCost::is_on_structure(Index vertex) const {
  const std::span<const Index> others = mesh_.neighbors(vertex);
  return std::any_of(others.begin(), others.end(), [&](Index other) { return !is_inside_sheet(vertex, other); });
}

}  // namespace orchard::detail
