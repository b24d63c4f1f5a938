#include "workspace.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace orchard::detail {
namespace {

constexpr std::size_t kAdoptedAtOnce = 4096;

}  // namespace

void Workspace::set_scale(const Box& box) {
  const int exponent = std::ilogb(box.diagonal().norm());
  noise_ = kInputNoise * std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  good_center_ = std::min(0x1p21 * noise_ / box.diagonal().norm(), 0.125);
  squared_scale_ = std::ldexp(1.0, 2 * exponent);
  per_smallest_bound_ = std::ldexp(1.0, 100 - 2 * exponent);
  for (unsigned i = 0; i + 1 < bounds_.size(); ++i)
    bounds_[i] = std::ldexp(1.0, 2 * exponent - 100 + 2 * static_cast<int>(i));
  bounds_.back() = std::numeric_limits<double>::infinity();
}

void Workspace::adopt(std::vector<VoronoiVertex>&& finished, std::size_t more) {
  vertices = std::move(finished);
  free_vertices.clear();
  reserve(vertices.size() + more);
  state_.resize(vertices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices.size(), kAdoptedAtOnce), [&](const auto& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v)
      state_[v] = static_cast<std::uint8_t>(adopt(vertices[v]) << 2);
  });
}

// Brings the infinite point to the last place, turns the radius into its square and returns the error class.
std::uint8_t Workspace::adopt(VoronoiVertex& vertex) const {
  auto& corner = vertex.forming_points;
  if (vertex.at_infinity() && corner[3] != kInfinitePoint) {
    const auto i = static_cast<std::size_t>(std::find(corner.begin(), corner.end(), kInfinitePoint) - corner.begin());
    // Two swaps leave the orientation.
    const std::size_t j = i == 0 ? 1 : 0, k = 3 - i - j;
    for (auto* four : {&corner, &vertex.neighbors}) {
      std::swap((*four)[i], (*four)[3]);
      std::swap((*four)[j], (*four)[k]);
    }
  }
  const Point& origin = points[corner[0]];
  const LengthedVector a(points[corner[1]] - origin), b(points[corner[2]] - origin);
  VoronoiVertex placed = vertex;
  std::uint8_t error = kUnknownError;
  Placing placing = Placing::failed;
  if (corner[3] == kInfinitePoint) {
    vertex.radius = std::numeric_limits<double>::quiet_NaN();
    placing = place_at_infinity(placed, error, a, b);
  } else {
    vertex.radius = (vertex.center - origin).squaredNorm();
    placing = place(placed, error, origin, a, b, LengthedVector(points[corner[3]] - origin));
  }
  return placing == Placing::failed ? kUnknownError : error;
}

double Workspace::value(Index v, const Point& q) const {
  const VoronoiVertex& vertex = vertices[v];
  if (at_infinity(v)) return vertex.center.dot(q - points[vertex.forming_points[0]]);
  const double squared_distance = (vertex.center - q).squaredNorm();
  return (vertex.radius - squared_distance) / (std::sqrt(vertex.radius) + std::sqrt(squared_distance));
}

Sign Workspace::doubtful_sign(Index v, const Point& q, double bound) const {
  if (at_infinity(v)) return sign_at_infinity(v, q);
  // With a centre as good as this, the doubt is in the input.
  if (!exact_ && bound < good_center_ * vertices[v].radius) return Sign::uncertain;
  return sign_from_points(v, q);
}

Sign Workspace::sign_from_points(Index v, const Point& q) const {
  const auto& corner = vertices[v].forming_points;
  return inside_sphere(q, points[corner[0]], points[corner[1]], points[corner[2]], points[corner[3]]);
}

Sign Workspace::sign_at_infinity(Index v, const Point& q) const {
  const VoronoiVertex& vertex = vertices[v];
  const Vector a = points[vertex.forming_points[0]] - q;
  const double height = -vertex.center.dot(a);
  const double bound = a.lpNorm<1>() * (power_bound(v) / squared_scale_) + 2 * noise_;
  if (height > bound) return Sign::positive;
  if (height < -bound) return Sign::negative;
  if (exact_) {
    const auto& corner = vertex.forming_points;
    const Sign below = volume_sign(q, points[corner[0]], points[corner[1]], points[corner[2]]);
    if (below != Sign::uncertain) return -below;
  }
  // In the facet's plane, as far as the input goes. The spheres that grow towards this end of the unbounded edge all
  // cut the plane in the facet's circle: q is nearer to the vertex at infinity if it lies inside. The sphere at the
  // other end of the edge cuts the plane there too; taking its sign, no facet ends up between a deleted and an
  // undeleted vertex that is coplanar with q.
  return sign(vertex.neighbors[3], q);
}

}  // namespace orchard::detail
