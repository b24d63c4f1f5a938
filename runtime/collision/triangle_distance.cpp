#include "collision/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/kernels/eight.h"
#include "math/vector_functions.h"
#include "simd/machine.h"

// Corners and edges of a triangle, three of each, side by side: a lane each. Of what is equally near in different lanes
// the first lane's counts, and in a lane what was tried first, however many lanes there are at a time.
namespace orchard::runtime::detail {
namespace {

// Sines below this count as parallel. At this sine the place on a line is known to 2 % and moves the distance by 2e-9
// of the length; below it, no place on the line is farther than 1e-7 of the length from the best one.
constexpr double kParallelSineSquare = 1e-14;

// One lane at a time, and all at once (with a fourth that repeats the last).
struct OneDouble {
  using Numbers = double;
  using Mask = bool;
  static double all(double x) noexcept { return x; }
  static double lanes(double x, double y, double z, std::size_t lane) noexcept {
    return lane == 0 ? x : lane == 1 ? y : z;
  }
  static double choose(bool mask, double a, double b) noexcept { return mask ? a : b; }
  static bool none_of(bool a, bool b, bool c) noexcept { return !(a || b || c); }
};
#ifdef ORCHARD_VECTORS
struct FourDoubles {
  using Numbers __attribute__((vector_size(32))) = double;
  using Mask __attribute__((vector_size(32))) = std::int64_t;
  ORCHARD_INLINE static Numbers all(double x) noexcept { return Numbers{x, x, x, x}; }
  ORCHARD_INLINE static Numbers lanes(double x, double y, double z, std::size_t) noexcept {
    return Numbers{x, y, z, z};
  }
  ORCHARD_INLINE static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return mask ? a : b;
  }
  ORCHARD_INLINE static Mask none_of(const Mask& a, const Mask& b, const Mask& c) noexcept { return ~(a | b | c); }
};
#endif

template <typename Kind>
struct Near {
  using Numbers = typename Kind::Numbers;
  using Mask = typename Kind::Mask;
  struct Three {
    Numbers x, y, z;
  };

  ORCHARD_INLINE static Three all(const Vec3& v) noexcept {
    return {Kind::all(v[0]), Kind::all(v[1]), Kind::all(v[2])};
  }
  ORCHARD_INLINE static Three lanes(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t lane) noexcept {
    return {Kind::lanes(a[0], b[0], c[0], lane), Kind::lanes(a[1], b[1], c[1], lane),
            Kind::lanes(a[2], b[2], c[2], lane)};
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
  // Where points project into a triangle; beside it an edge is nearer. `put`: the points, their feet, their distances'
  // squares, and whether there is one that is nearer. Feet are made of the corners, so that they are in the triangle
  // even where it is a needle, whose normal is mostly rounding.
  template <typename Put>
  ORCHARD_INLINE void face(const Three& point, const TrianglePoints& t, const TrianglePoints& edge,
                           Put&& put) noexcept {
    const Vec3 n = detail::cross(edge[0], edge[1]);
    const double size = runtime::dot(n, n);
    if (!(size > 0)) return;
    const Three normal = all(n);
    const auto area = [&](std::size_t i)
                          ORCHARD_INLINE_LAMBDA { return dot(cross(all(edge[i]), minus(point, all(t[i]))), normal); };
    const Numbers zero = Kind::all(0), first = area(1), second = area(2), third = area(0);  // opposite of the corners
    const Numbers sum = first + second + third;
    const auto inside = Kind::none_of(first < zero, second < zero, third < zero) & (zero < sum);
    const Three on = along(along(all(t[0]), all(edge[0]), second / sum), all(edge[2]), -(third / sum));
    const Three d = minus(on, point);
    put(on, dot(d, d), inside & (dot(d, d) < square));
  }
  ORCHARD_INLINE void faces_of_b(const Three& point, const TrianglePoints& t, const TrianglePoints& edge) noexcept {
    face(point, t, edge, [&](const Three& on, const Numbers& s, const Mask& better) ORCHARD_INLINE_LAMBDA {
      offer(point, on, s, better);
    });
  }
  ORCHARD_INLINE void faces_of_a(const Three& point, const TrianglePoints& t, const TrianglePoints& edge) noexcept {
    face(point, t, edge, [&](const Three& on, const Numbers& s, const Mask& better) ORCHARD_INLINE_LAMBDA {
      offer(on, point, s, better);
    });
  }
};

TrianglePoints edges_of(const TrianglePoints& t) noexcept {
  return {minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
}

template <typename Kind>
ORCHARD_INLINE Near<Kind> near_triangle(const TrianglePoints& a, const TrianglePoints& b, std::size_t lane) noexcept {
  using N = Near<Kind>;
  const TrianglePoints ea = edges_of(a), eb = edges_of(b);
  const auto lanes = [lane](const TrianglePoints& t) ORCHARD_INLINE_LAMBDA { return N::lanes(t[0], t[1], t[2], lane); };
  const typename N::Edge of_b(lanes(b), lanes(eb));
  N best;
  for (std::size_t i = 0; i < 3; ++i) best.edges({N::all(a[i]), N::all(ea[i])}, of_b);
  best.faces_of_b(lanes(a), b, eb);
  best.faces_of_a(of_b.from, a, ea);
  return best;
}

template <typename Kind>
ORCHARD_INLINE Near<Kind> near_point(const Vec3& point, const TrianglePoints& t, std::size_t lane) noexcept {
  using N = Near<Kind>;
  const TrianglePoints edge = edges_of(t);
  const typename N::Edge of_t(N::lanes(t[0], t[1], t[2], lane), N::lanes(edge[0], edge[1], edge[2], lane));
  const typename N::Three p = N::all(point);
  N best;
  best.offer(p, N::foot(of_t, p));
  best.faces_of_b(p, t, edge);
  return best;
}

template <typename Kind>
ORCHARD_INLINE Near<Kind> near_segment(const Vec3& p, const Vec3& q, const TrianglePoints& t,
                                       std::size_t lane) noexcept {
  using N = Near<Kind>;
  const TrianglePoints edge = edges_of(t);
  const typename N::Edge of_t(N::lanes(t[0], t[1], t[2], lane), N::lanes(edge[0], edge[1], edge[2], lane));
  const typename N::Edge segment(N::all(p), N::all(minus(q, p)));
  N best;
  best.edges(segment, of_t);
  // Parallel ones, too, from each corner.
  best.offer(N::foot(segment, of_t.from), of_t.from);
  for (const Vec3& end : {p, q}) best.offer(N::all(end), N::foot(of_t, N::all(end)));
  best.faces_of_b(N::lanes(p, q, q, lane), t, edge);
  return best;
}

struct NearestPair {
  double square = std::numeric_limits<double>::infinity();
  Vec3 p{}, q{};
};

NearestPoints found_points(const NearestPair& best) noexcept { return {std::sqrt(best.square), best.p, best.q}; }

template <typename Find>
NearestPair one_by_one(Find&& find) noexcept {
  NearestPair best;
  for (std::size_t lane = 0; lane < 3; ++lane) {
    const Near<OneDouble> found = find(lane);
    if (!(found.square < best.square)) continue;
    best = {found.square, {found.p.x, found.p.y, found.p.z}, {found.q.x, found.q.y, found.q.z}};
  }
  return best;
}

NearestPair triangles_one_by_one(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  return one_by_one([&](std::size_t lane) { return near_triangle<OneDouble>(a, b, lane); });
}
NearestPair point_one_by_one(const Vec3& point, const TrianglePoints& t) noexcept {
  return one_by_one([&](std::size_t lane) { return near_point<OneDouble>(point, t, lane); });
}
NearestPair segment_one_by_one(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  return one_by_one([&](std::size_t lane) { return near_segment<OneDouble>(p, q, t, lane); });
}

#ifdef ORCHARD_VECTORS
ORCHARD_INLINE NearestPair first_of(const Near<FourDoubles>& near) noexcept {
  using Lanes = std::array<double, 4>;
  const auto lanes = [](const FourDoubles::Numbers& v) ORCHARD_INLINE_LAMBDA -> Lanes {
    Lanes result;
    store(v, result);
    return result;
  };
  const Lanes square = lanes(near.square);
  std::size_t lane = square[1] < square[0] ? 1 : 0;
  lane = square[2] < square[lane] ? 2 : lane;
  const Lanes px = lanes(near.p.x), py = lanes(near.p.y), pz = lanes(near.p.z);
  const Lanes qx = lanes(near.q.x), qy = lanes(near.q.y), qz = lanes(near.q.z);
  return {square[lane], {px[lane], py[lane], pz[lane]}, {qx[lane], qy[lane], qz[lane]}};
}

ORCHARD_INLINE NearestPair triangles_at_once(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  return first_of(near_triangle<FourDoubles>(a, b, 0));
}
ORCHARD_INLINE NearestPair point_at_once(const Vec3& point, const TrianglePoints& t) noexcept {
  return first_of(near_point<FourDoubles>(point, t, 0));
}
ORCHARD_INLINE NearestPair segment_at_once(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  return first_of(near_segment<FourDoubles>(p, q, t, 0));
}
#endif

}  // namespace

double longest_edge(const TrianglePoints& t) noexcept {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 e = minus(t[(i + 1) % 3], t[i]);
    square = std::max(square, dot(e, e));
  }
  return std::sqrt(square);
}

// Machines without vectors of four doubles are better served by one number at a time.
#ifdef ORCHARD_VECTORS
NearestPoints nearest_points(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  return found_points(PerMachine<triangles_at_once, triangles_one_by_one>::call(a, b));
}
NearestPoints nearest_points(const Vec3& point, const TrianglePoints& t) noexcept {
  return found_points(PerMachine<point_at_once, point_one_by_one>::call(point, t));
}
NearestPoints nearest_points(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  return found_points(PerMachine<segment_at_once, segment_one_by_one>::call(p, q, t));
}
#else
NearestPoints nearest_points(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  return found_points(triangles_one_by_one(a, b));
}
NearestPoints nearest_points(const Vec3& point, const TrianglePoints& t) noexcept {
  return found_points(point_one_by_one(point, t));
}
NearestPoints nearest_points(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  return found_points(segment_one_by_one(p, q, t));
}
#endif

}  // namespace orchard::runtime::detail
