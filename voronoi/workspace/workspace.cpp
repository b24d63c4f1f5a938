#include "workspace/workspace.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>

#include "predicates/four_tetrahedra.h"
#include "workspace/large_pages.h"

namespace orchard::detail {
namespace {

constexpr Index kSlice = 1u << 12;  // vertices that a thread looks at at once

void move_infinity_last(VoronoiVertex& vertex) {
  auto& corner = vertex.forming_points;
  vertex.radius = std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(std::find(corner.begin(), corner.end(), kInfinitePoint) - corner.begin());
  if (i == 3) return;
  // Two swaps leave the orientation.
  const std::size_t j = i == 0 ? 1 : 0, k = 3 - i - j;
  for (auto* four : {&corner, &vertex.neighbors}) {
    std::swap((*four)[i], (*four)[3]);
    std::swap((*four)[j], (*four)[k]);
  }
}

}  // namespace

void Workspace::reserve(std::size_t count, std::size_t used) {
  const auto move = [count, used](auto& items) {
    if (count <= items.capacity()) return;
    auto before = std::exchange(items, {});
    items.reserve(count);
    use_large_pages(items.data(), std::min(used, count) * sizeof(before[0]));
    items.assign(before.begin(), before.end());
  };
  move(vertices);
  move(state_);
}

void Workspace::bring_in(std::size_t count) {
  constexpr std::size_t kPage = 4096;
  auto* const room = reinterpret_cast<std::byte*>(vertices.data());
  const std::size_t begin = vertices.size() * sizeof(VoronoiVertex) / kPage + 1,
                    end = std::min(count, vertices.capacity()) * sizeof(VoronoiVertex) / kPage;
  if (begin < end) use_large_pages(room + begin * kPage, (end - begin) * kPage);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(std::min(begin, end), end, kPage / 16), [room](const auto& pages) {
    for (std::size_t page = pages.begin(); page < pages.end(); ++page) room[page * kPage] = std::byte{0};
  });
}

void Workspace::set_scale(const Box& box, double rounding) {
  const int exponent = std::ilogb(box.diagonal().norm());
  noise_ = kInputNoise * rounding;
  good_center_ = std::min(0x1p21 * noise_ / box.diagonal().norm(), 0.125);
  squared_scale_ = std::ldexp(1.0, 2 * exponent);
  per_min_bound_ = std::ldexp(1.0, 100 - 2 * exponent);
  for (unsigned i = 0; i + 1 < bounds_.size(); ++i)
    bounds_[i] = std::ldexp(1.0, 2 * exponent - 100 + 2 * static_cast<int>(i));
  bounds_[kUnknownError] = bounds_[kNotSettled] = std::numeric_limits<double>::infinity();
}

void Workspace::take_scale(const Workspace& other) {
  noise_ = other.noise_;
  good_center_ = other.good_center_;
  squared_scale_ = other.squared_scale_;
  per_min_bound_ = other.per_min_bound_;
  bounds_ = other.bounds_;
}

void Workspace::adopt(std::span<const VoronoiVertex> finished, const Frame& frame, std::size_t more) {
  clear();
  reserve(finished.size() + more, finished.size());
  state_.assign(finished.size(), kNotSettled << 2);
  for (const VoronoiVertex& old : finished) {
    VoronoiVertex& vertex = vertices.emplace_back(old);
    if (vertex.at_infinity()) {
      move_infinity_last(vertex);
      continue;
    }
    vertex.center = frame.inward(old.center);
    const double radius = frame.inward(old.radius);
    vertex.radius = radius * radius;
  }
}

// A vertex from its forming points alone.
Placing Workspace::place_again(Index v, VoronoiVertex& placed, std::uint8_t& error) const {
  const auto& corner = vertices[v].forming_points;
  const Point& origin = points[corner[0]];
  const LengthedVector a(points[corner[1]] - origin), b(points[corner[2]] - origin);
  return at_infinity(v) ? place_at_infinity(placed, error, a, b)
                        : place(placed, error, origin, a, b, LengthedVector(points[corner[3]] - origin));
}

bool Workspace::place_sharply(Index v) {
  const auto corner = [&](unsigned i) -> const Point& { return points[vertices[v].forming_points[i]]; };
  Vector center;
  if (!sharp_circumcenter(corner(0), corner(1), corner(2), corner(3), center)) return false;
  place_sharply(v, center);
  return true;
}

void Workspace::place_sharply(Index v, const Vector& center) {
  VoronoiVertex& vertex = vertices[v];
  const Point& origin = points[vertex.forming_points[0]];
  vertex.center = origin + center;
  vertex.radius = (vertex.center - origin).squaredNorm();
  set_error_class(v, error_class(rounding_of_power(vertex.center, vertex.radius)), false, state_[v] & 3u);
}

std::size_t Workspace::place_thin_vertices() {
  // Of the power, over the squared radius: at least that where the condition is kSharpCondition or worse.
  constexpr double kBound = 4 * RelativeCenter::kCenterError * kSharpCondition;
  std::atomic<std::size_t> approximate = 0;
  tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(vertices.size()), kSlice), [&](const auto& range) {
    for (Index v = range.begin(); v < range.end(); ++v) {
      const bool is_made = !is_free(v) && !at_infinity(v) && settled(v);
      if (is_made && power_bound(v) >= kBound * vertices[v].radius && !place_sharply(v)) ++approximate;
    }
  });
  return approximate;
}

double Workspace::own_power_bound(const Point& center, double squared_radius, double off) {
  return 4 * off * std::sqrt(squared_radius) + rounding_of_power(center, squared_radius);
}

// Of one whose centre is right but for some roundings.
double Workspace::rounding_of_power(const Point& center, double squared_radius) {
  return 64 * kRounding * (squared_radius + std::sqrt(squared_radius) * center.lpNorm<1>());
}

// Whether the centre that it has is that of its forming points, as far as doubles can tell.
bool Workspace::has_own_center(Index v) const {
  const VoronoiVertex& vertex = vertices[v];
  const auto corner = [&](unsigned i) -> const Point& { return points[vertex.forming_points[i]]; };
  Vector center;
  return sharp_circumcenter(corner(0), corner(1), corner(2), corner(3), center) &&
         (corner(0) + center - vertex.center).norm() <= kSameCenter * (center.norm() + scale());
}

void Workspace::find_error_class(Index v) {
  VoronoiVertex& vertex = vertices[v];
  VoronoiVertex placed = vertex;
  std::uint8_t error = kUnknownError;
  const bool found = place_again(v, placed, error) != Placing::failed;
  bool shared = false;
  if (at_infinity(v)) {
    if (found) vertex.center = placed.center;
  } else if (found && (exact_ || !poor(placed, error))) {
    // What it has is kept where it is as good: only what is new changes.
    const double off = (vertex.center - placed.center).norm() * std::sqrt(placed.radius);
    if (4 * off <= bounds_[error])
      vertex.radius = (vertex.center - points[vertex.forming_points[0]]).squaredNorm();
    else
      vertex = placed;
  } else if (!exact_) {
    // It may have a neighbour's sphere.
    vertex.radius = (vertex.center - points[vertex.forming_points[0]]).squaredNorm();
    shared = !has_own_center(v);
    error =
        error_class(residual(vertex) + (shared ? 0 : 8 * kSameCenter * (std::sqrt(vertex.radius) + scale()) * scale()));
  }
  set_error_class(v, error, shared, state_[v] & 3u);
}

// A bound for a vertex whose own centre is poor, but which has a neighbour's: its forming points are on that sphere up
// to this.
double Workspace::residual(const VoronoiVertex& vertex) const {
  double max = 0;
  for (const Index p : vertex.forming_points)
    max = std::max(max, std::abs(vertex.radius - (vertex.center - points[p]).squaredNorm()));
  const double r = std::sqrt(vertex.radius);
  return 4 * max + 16 * noise_ * r + 16 * kRounding * (vertex.radius + r * vertex.center.lpNorm<1>());
}

double Workspace::value(Index v, const Point& q) const {
  const VoronoiVertex& vertex = vertices[v];
  if (at_infinity(v)) return vertex.center.dot(q - points[vertex.forming_points[0]]);
  const double squared_distance = (vertex.center - q).squaredNorm();
  return (vertex.radius - squared_distance) / (std::sqrt(vertex.radius) + std::sqrt(squared_distance));
}

Sign Workspace::doubtful_sign(Index v, const Point& q, double bound) {
  if (!settled(v)) {
    find_error_class(v);
    return sign(v, q);
  }
  if (at_infinity(v)) return sign_at_infinity(v, q);
  // With a centre as good as this, the doubt is in the input.
  if (!exact_ && bound < good_center_ * vertices[v].radius) return Sign::uncertain;
  return sign_from_points(v, q);
}

std::array<Sign, 4> Workspace::doubtful_signs(const std::array<Index, 4>& v, unsigned which, const Point& q) const {
  for (unsigned i = 0; i < 4; ++i)
    if (((which >> i) & 1u) != 0 && (!settled(v[i]) || at_infinity(v[i]))) which &= ~(1u << i);
  std::array<Sign, 4> signs{};
  // One alone is told as soon by itself.
  if (std::popcount(which) < 2 || !can_take_four()) return signs;
  FourTetrahedra tetrahedra;
  const auto some = static_cast<unsigned>(std::countr_zero(which));
  for (unsigned i = 0; i < 4; ++i) {
    const auto& corner = vertices[v[((which >> i) & 1u) != 0 ? i : some]].forming_points;
    for (unsigned k = 0; k < 4; ++k) tetrahedra[k][i] = &points[corner[k]];
  }
  const std::array<Sign, 4> found = four_inside_spheres(q, tetrahedra);
  for (unsigned i = 0; i < 4; ++i)
    if (((which >> i) & 1u) != 0) signs[i] = found[i];
  return signs;
}

bool Workspace::share_sphere(VoronoiVertex& vertex, std::uint8_t& error, Index v, const Point& new_point) const {
  if (!may_share_sphere(v, new_point)) return false;
  if (!settled(v) || poor(vertices[v], error_class_of(v))) return false;
  vertex.center = vertices[v].center;
  vertex.radius = vertices[v].radius;
  error = error_class_of(v);
  return true;
}

Sign Workspace::sign_from_points(Index v, const Point& q) const {
  const auto& corner = vertices[v].forming_points;
  return inside_sphere(q, points[corner[0]], points[corner[1]], points[corner[2]], points[corner[3]]);
}

// On which side of the facet's plane q is. A thin facet's own normal tells nothing; whether the four points are
// coplanar up to the input's noise does.
Sign Workspace::side_of_plane(Index v, const Point& q) const {
  const auto& corner = vertices[v].forming_points;
  const Point &p0 = points[corner[0]], &p1 = points[corner[1]], &p2 = points[corner[2]];
  const Vector a = p0 - q, b = p1 - q, c = p2 - q;
  const double max_face = std::sqrt(std::max({a.cross(b).squaredNorm(), b.cross(c).squaredNorm(),
                                              c.cross(a).squaredNorm(), (b - a).cross(c - a).squaredNorm()}));
  return -volume_sign(q, p0, p1, p2, kFourPoints * noise_ * max_face);
}

// How far the height of a point beyond the facet of a vertex at infinity may be off.
double Workspace::infinity_bound(Index v, const Vector& from_corner) const {
  return from_corner.lpNorm<1>() * (power_bound(v) / squared_scale_) + 2 * noise_;
}

Sign Workspace::sign_at_infinity(Index v, const Point& q) {
  const VoronoiVertex& vertex = vertices[v];
  const Vector a = points[vertex.forming_points[0]] - q;
  const double height = -vertex.center.dot(a);
  const double bound = infinity_bound(v, a);
  if (height > bound) return Sign::positive;
  if (height < -bound) return Sign::negative;
  if (exact_) {
    const auto& corner = vertex.forming_points;
    const Sign below = volume_sign(q, points[corner[0]], points[corner[1]], points[corner[2]]);
    if (below != Sign::uncertain) return -below;
  } else if (bound > kWide * noise_) {
    const Sign side = side_of_plane(v, q);
    if (side != Sign::uncertain) return side;
  }
  // In the facet's plane, as far as the input goes. The spheres that grow towards this end of the unbounded edge all
  // cut the plane in the facet's circle: q is nearer to the vertex at infinity if it lies inside. The sphere at the
  // other end of the edge cuts the plane there too; taking its sign, no facet ends up between a deleted and an
  // undeleted vertex that is coplanar with q.
  return sign(vertex.neighbors[3], q);
}

}  // namespace orchard::detail
