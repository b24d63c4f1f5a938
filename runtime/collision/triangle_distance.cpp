#include "collision/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vector_functions.h"
#include "simd/machine.h"
#include "simd/vector_support.h"

// Corners and edges of a triangle, three of each, side by side: a lane each. Of what is equally near in different lanes
// the first lane's counts, and in a lane what was tried first.
namespace orchard::runtime::detail {
namespace {

// Sines below this count as parallel. At this sine the place on a line is known to 2 % and moves the distance by 2e-9
// of the length; below it, no place on the line is farther than 1e-7 of the length from the best one.
constexpr double kParallelSineSquare = 1e-14;

// Three lanes, and a fourth that repeats the last.
struct FourDoubles {
#ifdef ORCHARD_VECTORS
  using Numbers __attribute__((vector_size(32))) = double;
  using Mask __attribute__((vector_size(32))) = std::int64_t;
  ORCHARD_INLINE static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return mask ? a : b;
  }
#else
  using Numbers = Plain<double, 4>;
  using Mask = Numbers::Mask;
  static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return Numbers::make([&](std::size_t i) { return mask[i] ? a[i] : b[i]; });
  }
#endif
  ORCHARD_INLINE static Numbers all(double x) noexcept { return Numbers{x, x, x, x}; }
  ORCHARD_INLINE static Numbers lanes(double x, double y, double z) noexcept { return Numbers{x, y, z, z}; }
};

struct Near {
  using Kind = FourDoubles;
  using Numbers = Kind::Numbers;
  using Mask = Kind::Mask;
  struct Three {
    Numbers x, y, z;
  };

  ORCHARD_INLINE static Three all(const Vec3& v) noexcept {
    return {Kind::all(v[0]), Kind::all(v[1]), Kind::all(v[2])};
  }
  ORCHARD_INLINE static Three lanes(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    return {Kind::lanes(a[0], b[0], c[0]), Kind::lanes(a[1], b[1], c[1]), Kind::lanes(a[2], b[2], c[2])};
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
    const Numbers zero = Kind::all(0), one = Kind::all(1);
    return Kind::choose(x < zero, zero, Kind::choose(one < x, one, x));
  }
  ORCHARD_INLINE static Numbers unit(const Numbers& part, const Numbers& whole) noexcept {
    return Kind::choose(Kind::all(0) < whole, within_unit(part / whole), Kind::all(0));
  }

  Numbers square = Kind::all(std::numeric_limits<double>::infinity());
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
  // The best s for the line, then the best t for that s, then the best s for that t.
  ORCHARD_INLINE void edges(const Edge& a, const Edge& b) noexcept {
    const Three w = minus(a.from, b.from);
    const Numbers uv = dot(a.way, b.way), uw = dot(a.way, w), vw = dot(b.way, w);
    const Numbers across = a.square * b.square - uv * uv;
    Numbers s = Kind::choose(Kind::all(kParallelSineSquare) * a.square * b.square < across,
                             within_unit((uv * vw - uw * b.square) / across), Kind::all(0));
    const Numbers t = unit(uv * s + vw, b.square);
    s = unit(uv * t - uw, a.square);
    offer(along(a.from, a.way, s), along(b.from, b.way, t));
  }
  ORCHARD_INLINE static Three foot(const Edge& edge, const Three& point) noexcept {
    return along(edge.from, edge.way, unit(dot(minus(point, edge.from), edge.way), edge.square));
  }
  // Where points project into a triangle, which is that of b or of a; beside it an edge is nearer. Feet are made of the
  // corners, so that they are in the triangle even where it is a needle, whose normal is mostly rounding.
  ORCHARD_INLINE void face(const Three& point, const TrianglePoints& t, const TrianglePoints& edge,
                           bool of_b) noexcept {
    const Vec3 n = detail::cross(edge[0], edge[1]);
    const double size = runtime::dot(n, n);
    if (!(size > 0)) return;
    const Three normal = all(n);
    const auto area = [&](std::size_t i)
                          ORCHARD_INLINE_LAMBDA { return dot(cross(all(edge[i]), minus(point, all(t[i]))), normal); };
    const Numbers zero = Kind::all(0), first = area(1), second = area(2), third = area(0);  // opposite of the corners
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

// Of the lanes the first of the nearest.
ORCHARD_INLINE NearestPair first_of(const Near& near) noexcept {
  const auto& square = near.square;
  std::size_t lane = square[1] < square[0] ? 1 : 0;
  lane = square[2] < square[lane] ? 2 : lane;
  return {
      square[lane], {near.p.x[lane], near.p.y[lane], near.p.z[lane]}, {near.q.x[lane], near.q.y[lane], near.q.z[lane]}};
}

ORCHARD_INLINE Near::Three lanes_of(const TrianglePoints& t) noexcept { return Near::lanes(t[0], t[1], t[2]); }

ORCHARD_INLINE NearestPair near_triangle(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  const TrianglePoints ea = edges_of(a), eb = edges_of(b);
  const Near::Edge of_b(lanes_of(b), lanes_of(eb));
  Near best;
  for (std::size_t i = 0; i < 3; ++i) best.edges({Near::all(a[i]), Near::all(ea[i])}, of_b);
  best.face(lanes_of(a), b, eb, true);
  best.face(of_b.from, a, ea, false);
  return first_of(best);
}

ORCHARD_INLINE NearestPair near_point(const Vec3& point, const TrianglePoints& t) noexcept {
  const TrianglePoints edge = edges_of(t);
  const Near::Three p = Near::all(point);
  Near best;
  best.offer(p, Near::foot({lanes_of(t), lanes_of(edge)}, p));
  best.face(p, t, edge, true);
  return first_of(best);
}

ORCHARD_INLINE NearestPair near_segment(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  const TrianglePoints edge = edges_of(t);
  const Near::Edge of_t(lanes_of(t), lanes_of(edge)), segment(Near::all(p), Near::all(minus(q, p)));
  Near best;
  best.edges(segment, of_t);
  // Parallel ones, too, from each corner.
  best.offer(Near::foot(segment, of_t.from), of_t.from);
  for (const Vec3& end : {p, q}) best.offer(Near::all(end), Near::foot(of_t, Near::all(end)));
  best.face(Near::lanes(p, q, q), t, edge, true);
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
  return found_points(PerMachine<near_triangle>::call(a, b));
}
NearestPoints nearest_points(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  return found_points(p == q ? PerMachine<near_point>::call(p, t) : PerMachine<near_segment>::call(p, q, t));
}

}  // namespace orchard::runtime::detail
