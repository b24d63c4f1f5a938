#include "certificate/covers_once.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "orchard/geometry/random.h"
#include "predicates/predicates.h"

namespace orchard::detail {
namespace {

// The number of rays that are tried. A ray that meets an edge of the hull decides nothing, but with random digits that
// hardly happens.
constexpr std::uint64_t kRays = 4, kRayStream = 0x5ca1u;
constexpr double kAside = 0x1p-10;

std::array<Point, 3> facet_of(const Workspace& workspace, Index v) {
  const auto& corner = workspace.vertices[v].forming_points;
  return {workspace.points[corner[0]], workspace.points[corner[1]], workspace.points[corner[2]]};
}

std::array<Point, 4> corners_of(const Workspace& workspace, Index v) {
  const auto& corner = workspace.vertices[v].forming_points;
  return {workspace.points[corner[0]], workspace.points[corner[1]], workspace.points[corner[2]],
          workspace.points[corner[3]]};
}

// is_below(a, b, c) tells on which side of a triangle a point at or next to `about` is. The rays run nearly along an
// axis, so that their boxes exclude most facets, and to points with random digits, so that they meet no edge.
template <class IsBelow>
bool is_encircled_once(const Workspace& workspace, std::span<const Index> hull, const Point& about, const Box& box,
                       const IsBelow& is_below) {
  const auto is_below_facet = [&](Index v) {
    const auto [a, b, c] = facet_of(workspace, v);
    return is_below(a, b, c);
  };
  if (!std::all_of(hull.begin(), hull.end(), is_below_facet)) return false;
  const double diameter = box.diagonal().norm();
  const Vector next_to =
      Vector::Constant(8 * kRounding * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff());
  for (std::uint64_t ray = 0; ray < kRays; ++ray) {
    Random random(0, kRayStream, ray);
    const auto aside = [&random] { return kAside * (random.uniform() - 0.5); };
    const Point end = about + 2 * diameter * Vector(1, aside(), aside());
    const Box reached = Box(about - next_to, about + next_to).merged(Box(end.cwiseMin(about), end.cwiseMax(about)));
    const auto is_met = [&](Index v) {
      const auto [a, b, c] = facet_of(workspace, v);
      const Box facet(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c));
      return facet.intersects(reached) && !is_below(end, c, b) && !is_below(end, a, c) && !is_below(end, b, a);
    };
    if (std::count_if(hull.begin(), hull.end(), is_met) == 1) return true;
  }
  return false;
}

}  // namespace

bool covers_once(const Workspace& workspace, std::span<const Index> hull, Index tetrahedron, const Box& box) {
  const std::array<Point, 4> inner = corners_of(workspace, tetrahedron);
  const Point rounded = (inner[0] + inner[1] + inner[2] + inner[3]) / 4;
  const auto is_below = [&](const Point& a, const Point& b, const Point& c) {
    return volume_sign(rounded, a, b, c) == Sign::positive;
  };
  // If all tetrahedra are needles, the fattest one may be so thin that its rounded middle is not inside it.
  const auto is_middle_below = [&](const Point& a, const Point& b, const Point& c) {
    return volume_sign_of_middle(inner, a, b, c) == Sign::positive;
  };
  return is_encircled_once(workspace, hull, rounded, box, is_below) ||
         is_encircled_once(workspace, hull, rounded, box, is_middle_below);
}

std::vector<Index> facets_above(const Workspace& workspace, std::span<const Index> hull, Index tetrahedron) {
  const std::array<Point, 4> inner = corners_of(workspace, tetrahedron);
  std::vector<Index> above;
  for (const Index v : hull) {
    const auto [a, b, c] = facet_of(workspace, v);
    if (volume_sign_of_middle(inner, a, b, c) != Sign::positive) above.push_back(v);
  }
  return above;
}

}  // namespace orchard::detail
