#include "collision/triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "math/vector_functions.h"
#include "simd/machine.h"
#include "simd/vector_support.h"

// The three corners or edges of a triangle are processed side by side, one in each lane. Of equally near points in
// different lanes, those of the first lane count; in one lane, those that were tried first.
namespace orchard::runtime::detail {
namespace {

// Edges with a smaller square of the sine between them count as parallel. At this sine, the place on a line is known to
// 2 % and moves the distance by 2e-9 of the length; below it, no place on the line is farther than 1e-7 of the length
// from the best one.
constexpr double kParallelSineSquare = 1e-14;

// Three lanes, and a fourth one that repeats the last, in one vector, in several narrower ones, or in single numbers.
template <typename Part>
struct FourDoubles {
  using Numbers = Several<Part, 4 * sizeof(double) / sizeof(Part)>;
  using Mask = decltype(Numbers{} < Numbers{});
  ORCHARD_INLINE static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return Numbers::make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return mask[i] ? a[i] : b[i]; });
  }
  ORCHARD_INLINE static double lane(const Numbers& of, std::size_t i) noexcept {
    std::array<double, 4> all;
    store(of, all);
    return all[i];
  }
};
#ifdef ORCHARD_VECTORS
using TwoNumbers __attribute__((vector_size(16))) = double;
using FourNumbers __attribute__((vector_size(32))) = double;
using Wide = FourDoubles<FourNumbers>;
using Narrow = FourDoubles<TwoNumbers>;
#else
using Wide = FourDoubles<double>;
using Narrow = Wide;
#endif

template <typename Kind>
struct Near {
  using Numbers = typename Kind::Numbers;
  using Mask = typename Kind::Mask;
  struct Three {
    Numbers x, y, z;
  };

  ORCHARD_INLINE static Numbers all(double x) noexcept { return spread<Numbers>(x); }
  ORCHARD_INLINE static Numbers lanes(double x, double y, double z) noexcept {
    return load<Numbers>(std::array<double, 4>{x, y, z, z});
  }
  ORCHARD_INLINE static Three all(const Vec3& v) noexcept { return {all(v[0]), all(v[1]), all(v[2])}; }
  ORCHARD_INLINE static Three lanes(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    return {lanes(a[0], b[0], c[0]), lanes(a[1], b[1], c[1]), lanes(a[2], b[2], c[2])};
  }
  ORCHARD_INLINE static Numbers dot(const Three& a, const Three& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  ORCHARD_INLINE static Three minus(const Three& a, const Three& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  ORCHARD_INLINE static Three cross(const Three& a, const Three& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  ORCHARD_INLINE static Three along(const Three& from, const Three& way, const Numbers& by) noexcept {
    return {from.x + by * way.x, from.y + by * way.y, from.z + by * way.z};
  }
  ORCHARD_INLINE static Numbers within_unit(const Numbers& x) noexcept {
    const Numbers zero = all(0.0), one = all(1);
    return Kind::choose(x < zero, zero, Kind::choose(one < x, one, x));
  }
  ORCHARD_INLINE static Numbers unit(const Numbers& part, const Numbers& whole) noexcept {
    return Kind::choose(all(0.0) < whole, within_unit(part / whole), all(0.0));
  }

  Numbers square = all(std::numeric_limits<double>::infinity());
  Three p{}, q{};

  ORCHARD_INLINE void offer(const Three& on_a, const Three& on_b) noexcept {
    const Three d = minus(on_b, on_a);
    offer(on_a, on_b, dot(d, d), dot(d, d) < square);
  }
  ORCHARD_INLINE void offer(const Three& on_a, const Three& on_b, const Numbers& s, const Mask& better) noexcept {
    const auto put = [&](Three& to, const Three& from) ORCHARD_INLINE_LAMBDA {
      to = {Kind::choose(better, from.x, to.x), Kind::choose(better, from.y, to.y), Kind::choose(better, from.z, to.z)};
    };
    square = Kind::choose(better, s, square);
    put(p, on_a), put(q, on_b);
  }

  struct Edge {
    Three from, way;
    Numbers square;
    ORCHARD_INLINE Edge(const Three& begin, const Three& direction) noexcept
        : from(begin), way(direction), square(dot(direction, direction)) {}
  };
  // Finds the best s for the lines, then the best t for that s, then the best s for that t.
  ORCHARD_INLINE void edges(const Edge& a, const Edge& b) noexcept {
    const Three w = minus(a.from, b.from);
    const Numbers uv = dot(a.way, b.way), uw = dot(a.way, w), vw = dot(b.way, w);
    const Numbers across = a.square * b.square - uv * uv;
    Numbers s = Kind::choose(all(kParallelSineSquare) * a.square * b.square < across,
                             within_unit((uv * vw - uw * b.square) / across), all(0.0));
    const Numbers t = unit(uv * s + vw, b.square);
    s = unit(uv * t - uw, a.square);
    offer(along(a.from, a.way, s), along(b.from, b.way, t));
  }
  ORCHARD_INLINE static Three foot(const Edge& edge, const Three& point) noexcept {
    return along(edge.from, edge.way, unit(dot(minus(point, edge.from), edge.way), edge.square));
  }
  // Offers the projections of points to a triangle that lie inside of it; if a projection does not, an edge is nearer.
  // `of_b` is whether the triangle is b. The feet are computed from the corners, so that they are in the triangle even
  // if it is a needle, whose normal is mostly rounding.
  ORCHARD_INLINE void face(const Three& point, const TrianglePoints& t, const TrianglePoints& edge,
                           bool of_b) noexcept {
    const Vec3 n = detail::cross(edge[0], edge[1]);
    const double size = runtime::dot(n, n);
    if (!(size > 0)) return;
    const Three normal = all(n);
    const auto area = [&](std::size_t i)
                          ORCHARD_INLINE_LAMBDA { return dot(cross(all(edge[i]), minus(point, all(t[i]))), normal); };
    const Numbers zero = all(0.0), first = area(1), second = area(2), third = area(0);  // opposite of the corners
    const Numbers sum = first + second + third;
    const auto inside = (zero <= first) & (zero <= second) & (zero <= third) & (zero < sum);
    const Three on = along(along(all(t[0]), all(edge[0]), second / sum), all(edge[2]), -(third / sum));
    const Three d = minus(on, point);
    offer(of_b ? point : on, of_b ? on : point, dot(d, d), inside & (dot(d, d) < square));
  }
};

TrianglePoints edges_of(const TrianglePoints& t) noexcept {
  return {minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
}

struct NearestPair {
  double square;
  Vec3 p, q;
};

// Returns the nearest points of all lanes, those of the first lane if several are equally near.
template <typename Kind>
ORCHARD_INLINE NearestPair first_of(const Near<Kind>& near) noexcept {
  const auto square = [&](std::size_t i) ORCHARD_INLINE_LAMBDA { return Kind::lane(near.square, i); };
  std::size_t lane = square(1) < square(0) ? 1 : 0;
  lane = square(2) < square(lane) ? 2 : lane;
  const auto point = [&](const auto& three) ORCHARD_INLINE_LAMBDA {
    return Vec3{Kind::lane(three.x, lane), Kind::lane(three.y, lane), Kind::lane(three.z, lane)};
  };
  return {square(lane), point(near.p), point(near.q)};
}

template <typename Kind>
ORCHARD_INLINE typename Near<Kind>::Three lanes_of(const TrianglePoints& t) noexcept {
  return Near<Kind>::lanes(t[0], t[1], t[2]);
}

template <typename Kind>
ORCHARD_INLINE NearestPair near_triangle(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  using N = Near<Kind>;
  const TrianglePoints ea = edges_of(a), eb = edges_of(b);
  const typename N::Edge of_b(lanes_of<Kind>(b), lanes_of<Kind>(eb));
  N best;
  for (std::size_t i = 0; i < 3; ++i) best.edges({N::all(a[i]), N::all(ea[i])}, of_b);
  best.face(lanes_of<Kind>(a), b, eb, true);
  best.face(of_b.from, a, ea, false);
  return first_of(best);
}

template <typename Kind>
ORCHARD_INLINE NearestPair near_point(const Vec3& point, const TrianglePoints& t) noexcept {
  using N = Near<Kind>;
  const TrianglePoints edge = edges_of(t);
  const typename N::Three p = N::all(point);
  N best;
  best.offer(p, N::foot({lanes_of<Kind>(t), lanes_of<Kind>(edge)}, p));
  best.face(p, t, edge, true);
  return first_of(best);
}

template <typename Kind>
ORCHARD_INLINE NearestPair near_segment(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  using N = Near<Kind>;
  const TrianglePoints edge = edges_of(t);
  const typename N::Edge of_t(lanes_of<Kind>(t), lanes_of<Kind>(edge)), segment(N::all(p), N::all(minus(q, p)));
  N best;
  best.edges(segment, of_t);
  // For an edge that is parallel to the segment, the nearest points include a corner or an end, so these are tried,
  // too.
  best.offer(N::foot(segment, of_t.from), of_t.from);
  for (const Vec3& end : {p, q}) best.offer(N::all(end), N::foot(of_t, N::all(end)));
  best.face(N::lanes(p, q, q), t, edge, true);
  return first_of(best);
}

NearestPoints found_points(const NearestPair& best) noexcept { return {std::sqrt(best.square), best.p, best.q}; }

}  // namespace

double longest_edge(const TrianglePoints& t) noexcept {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 e = minus(t[(i + 1) % 3], t[i]);
    square = std::max(square, dot(e, e));
  }
  return std::sqrt(square);
}

NearestPoints nearest_points(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  return found_points(PerMachine<near_triangle<Wide>, near_triangle<Narrow>>::call(a, b));
}
NearestPoints nearest_points(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  return found_points(p == q ? PerMachine<near_point<Wide>, near_point<Narrow>>::call(p, t)
                             : PerMachine<near_segment<Wide>, near_segment<Narrow>>::call(p, q, t));
}

}  // namespace orchard::runtime::detail
