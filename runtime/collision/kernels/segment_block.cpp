#include "collision/kernels/segment_block.h"

#include "collision/kernels/triangle_tests.h"
#include "simd/machine.h"

// The distance of two convex sets is the largest gap between them along any vector. For a triangle and a segment, this
// vector is the triangle's normal, if an end of the segment is nearest to the triangle's inside, or else the way
// between the nearest points of the segment and an edge. Any vector gives a lower bound, so if rounding finds other
// points than the nearest ones, the bound is only lower. The rounding of projections to a vector is analysed in
// triangle_tests.h.
namespace orchard::runtime::detail {
namespace {

constexpr float kMinSquare = 1e-37f;          // keeps quotients finite
constexpr float kParallelSineSquare = 1e-5f;  // below it, floats cannot determine where lines are nearest

// The way from the nearest point of the segment from the origin to `w` to the nearest point of an edge, and the square
// of its length.
template <typename Kind>
struct EdgeWay {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  Vectors way;
  Floats square;

  // Ericson 2005, 5.1.9: finds the best place on the line of the segment, then the best one on the edge for that, then
  // the best one on the segment again.
  ORCHARD_INLINE EdgeWay(bool moves, const Vectors& w, const Floats& ww, const Vectors& from,
                         const Vectors& edge) noexcept {
    const Floats zero = E::all(0.0f), one = E::all(1.0f), least = E::all(kMinSquare);
    const auto clamped = [&](const Floats& x) ORCHARD_INLINE_LAMBDA -> Floats { return E::min(E::max(x, zero), one); };
    const Floats ee = E::dot(edge, edge), ef = E::dot(edge, from);
    Floats s = zero, t = clamped(-ef / (ee + least));
    if (moves) {
      const Floats we = E::dot(w, edge), wf = E::dot(w, from), across = ww * ee - we * we;
      const Floats on_line = clamped((wf * ee - we * ef) / (across + least));
      s = Kind::choose(E::all(kParallelSineSquare) * ww * ee < across, on_line, zero);
      t = clamped((we * s - ef) / (ee + least));
      s = clamped((we * t + wf) / (ww + least));
    }
    way = {from.x + t * edge.x - s * w.x, from.y + t * edge.y - s * w.y, from.z + t * edge.z - s * w.z};
    square = E::dot(way, way);
  }
};

template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE void find_segment_gaps(const std::array<float, 3>& p, const std::array<float, 3>& q,
                                      const TriangleBlock& block, const Placement& placement,
                                      SegmentGaps& lower) noexcept {
  const Floats unit = E::all(placement.unit), zero = E::all(0.0f);
  const Vectors begin = E::all_of(p), w = E::times(E::minus(E::all_of(q), begin), unit);
  const auto corner = [&](std::size_t k) ORCHARD_INLINE_LAMBDA -> Vectors {
    return E::times(E::minus(E::corner(block, k), begin), unit);
  };
  const Vectors t[3] = {corner(0), corner(1), corner(2)};
  const Vectors edge[3] = {E::minus(t[1], t[0]), E::minus(t[2], t[1]), E::minus(t[0], t[2])};
  const Floats ww = E::dot(w, w);
  const bool moves = p != q;  // otherwise, the segment is a point
  EdgeWay<Kind> best(moves, w, ww, t[0], edge[0]);
  for (std::size_t i = 1; i < 3; ++i) {
    const EdgeWay<Kind> other(moves, w, ww, t[i], edge[i]);
    const auto nearer = other.square < best.square;
    best.square = Kind::choose(nearer, other.square, best.square);
    best.way = {Kind::choose(nearer, other.way.x, best.way.x), Kind::choose(nearer, other.way.y, best.way.y),
                Kind::choose(nearer, other.way.z, best.way.z)};
  }
  const auto gap = [&](const Vectors& axis) ORCHARD_INLINE_LAMBDA -> Floats {
    const Extent<Kind> of_triangle = extent_along<Kind>(axis, t);
    const Floats end = E::dot(axis, w);
    return E::max(of_triangle.low - E::max(end, zero), E::min(end, zero) - of_triangle.high);
  };
  const Floats by_edge = gap(normalised<Kind>(best.way)), by_face = gap(normalised<Kind>(E::cross(edge[0], edge[1])));
  const Floats margin = E::all(2 * placement.margin * placement.unit);
  store((E::max(by_edge, by_face) - margin) * E::all(placement.whole), lower);
}

}  // namespace

void segment_gaps(const std::array<float, 3>& p, const std::array<float, 3>& q, const TriangleBlock& block,
                  const Placement& placement, SegmentGaps& lower) noexcept {
  PerMachine<find_segment_gaps<Widest>, find_segment_gaps<Base>, find_segment_gaps<PlainFloats>>::call(
      p, q, block, placement, lower);
}

}  // namespace orchard::runtime::detail
