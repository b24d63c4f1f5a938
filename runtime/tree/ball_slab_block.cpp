// One file: its three kernels share what is built of Eight, which has to become part of each of them for every machine
// (machine.h), and which nothing else uses.
#include "ball_slab_block.h"

#include <bit>

#include "ball_slab_pair.h"
#include "eight.h"
#include "machine.h"

// Rounding. Ball slabs: see Placement::margin in narrow_phase.cpp, (5). Triangles: any fixed vector serves as an axis,
// so an axis itself needs no accuracy; only the projections do. Along a coordinate, points placed to within sigma that
// are more than the margin apart are apart. A projection a . (p - q) of points placed to within sigma is computed to
// within |a|_1 (2 sigma + 8 u D), which is below |a|_1 margin, with |a|_1 the sum of |components|.
// Such projections are of the third degree, or of the fourth: coordinates of 1e13 would overflow and those of 1e-13
// underflow. So triangles are first multiplied by a power of two (Placement::unit) that makes every coordinate at most
// 1 and changes no digit. What then underflows, or is dropped by a flush-to-zero mode, is at most 2^-126 an operation:
// below 2^-120 a projection, which kMinRoom covers.
namespace orchard::runtime::detail {
namespace {

constexpr float kMinRoom = 0x1p-110f;  // to add to the room along an axis, in units of Placement::whole

template <typename Kind>
ORCHARD_INLINE void find_gaps(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement,
                              float margin, BallSlabGaps& result) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  const BallSlabPair<Kind> pair(single, lanes, placement, result);
  const Floats gap = E::larger(E::larger(pair.by_n, pair.by_m), pair.by_line) - E::all(margin);
  store(gap, result.gap);
  result.meeting = result.used & Kind::bits(gap <= E::all(0.0f));
}

template <typename Kind>
struct Extent {
  typename Kind::Floats low, high;
};

template <typename Kind>
ORCHARD_INLINE Extent<Kind> extent(const typename Kind::Floats& a, const typename Kind::Floats& b,
                                   const typename Kind::Floats& c) noexcept {
  using E = Eight<Kind>;
  return {E::smaller(E::smaller(a, b), c), E::larger(E::larger(a, b), c)};
}

template <typename Kind>
struct Box {
  typename Eight<Kind>::Vectors low, high;
};

// Around eight triangles each, grown by `margin`.
template <typename Kind>
ORCHARD_INLINE Box<Kind> box_of(const typename Eight<Kind>::Vectors (&corner)[3],
                                const typename Kind::Floats& margin) noexcept {
  const Extent<Kind> x = extent<Kind>(corner[0].x, corner[1].x, corner[2].x),
                     y = extent<Kind>(corner[0].y, corner[1].y, corner[2].y),
                     z = extent<Kind>(corner[0].z, corner[1].z, corner[2].z);
  return {{x.low - margin, y.low - margin, z.low - margin}, {x.high + margin, y.high + margin, z.high + margin}};
}

// Of eight triangles in their boxes, grown by the margin, those that may reach into a ball slab: between its planes,
// and into the cube around its ball.
template <typename Kind>
ORCHARD_INLINE std::uint32_t reaching(const typename Eight<Kind>::Vectors (&corner)[3], const Box<Kind>& box,
                                      const BallSlab& slab, const typename Kind::Floats& margin) noexcept {
  using E = Eight<Kind>;
  using Vectors = typename E::Vectors;
  const Vectors n = {E::all(slab.nx), E::all(slab.ny), E::all(slab.nz)};
  const Vectors center = {E::all(slab.x), E::all(slab.y), E::all(slab.z)};
  const auto height = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return E::dot(n, E::minus(corner[k], center)); };
  const Extent<Kind> e = extent<Kind>(height(0), height(1), height(2));
  const auto limit = E::all(slab.height) + margin, radius = E::all(slab.radius) + margin;
  const auto beside = [&](const auto& low, const auto& high, const auto& at)
                          ORCHARD_INLINE_LAMBDA { return (at + radius < low) | (high < at - radius); };
  return 0xffu & ~Kind::bits((limit < e.low) | (e.high < -limit) | beside(box.low.x, box.high.x, center.x) |
                             beside(box.low.y, box.high.y, center.y) | beside(box.low.z, box.high.z, center.z));
}

// Vectors that were made eight at a time, to be taken one by one.
template <typename Kind>
struct OneByOne {
  using E = Eight<Kind>;
  std::array<float, kBlockWidth> x, y, z;

  ORCHARD_INLINE explicit OneByOne(const typename E::Vectors& v) noexcept {
    store(v.x, x), store(v.y, y), store(v.z, z);
  }
  ORCHARD_INLINE typename E::Vectors operator[](std::size_t i) const noexcept {
    return {E::all(x[i]), E::all(y[i]), E::all(z[i])};
  }
};

// For each row the lanes whose boxes, grown by the margin, meet its own; all of them together.
template <typename Kind>
ORCHARD_INLINE std::uint32_t find_near(const Box<Kind>& lane_box, std::uint32_t lanes, const Box<Kind>& row_box,
                                       std::uint32_t rows, std::uint32_t (&near)[kBlockWidth]) noexcept {
  using E = Eight<Kind>;
  const OneByOne<Kind> lows(row_box.low), highs(row_box.high);
  std::uint32_t found = 0;
  for (; rows != 0; rows &= rows - 1) {
    const auto r = static_cast<std::uint32_t>(std::countr_zero(rows));
    const typename E::Vectors low = lows[r], high = highs[r];
    near[r] = lanes & ~Kind::bits((lane_box.high.x < low.x) | (high.x < lane_box.low.x) |  //
                                  (lane_box.high.y < low.y) | (high.y < lane_box.low.y) |  //
                                  (lane_box.high.z < low.z) | (high.z < lane_box.low.z));
    found |= std::uint32_t{near[r] != 0} << r;
  }
  return found;
}

ORCHARD_INLINE std::uint32_t used_lanes(const TriangleBlock& block) noexcept {
  std::uint32_t used = 0;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) used |= std::uint32_t{block.triangle[i] != kNoTriangle} << i;
  return used;
}

// The eight lanes' triangles, and their planes.
template <typename Kind>
struct Lanes {
  using Vectors = typename Eight<Kind>::Vectors;
  Vectors corner[3], edge[3], normal;
  typename Kind::Floats limit;  // own corners' heights over the plane
};

// Those of the lanes in `left` that neither the plane of the triangle p, with its own corners' heights `limit`, nor
// their own keeps apart from it, nor any product of two edges.
template <typename Kind>
ORCHARD_INLINE std::uint32_t not_apart(std::uint32_t left, const Lanes<Kind>& lanes,
                                       const typename Eight<Kind>::Vectors (&p)[3],
                                       const typename Eight<Kind>::Vectors& normal, const typename Kind::Floats& limit,
                                       const typename Kind::Floats& margin) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  const Vectors from[3] = {E::minus(lanes.corner[0], p[0]), E::minus(lanes.corner[1], p[0]),
                           E::minus(lanes.corner[2], p[0])};
  const Extent<Kind> over_row = extent<Kind>(E::dot(normal, from[0]), E::dot(normal, from[1]), E::dot(normal, from[2]));
  left &= ~Kind::bits((limit < over_row.low) | (over_row.high < -limit));
  if (left == 0) return 0;
  const Extent<Kind> over_lane =
      extent<Kind>(-E::dot(lanes.normal, from[0]), E::dot(lanes.normal, E::minus(p[1], lanes.corner[0])),
                   E::dot(lanes.normal, E::minus(p[2], lanes.corner[0])));
  left &= ~Kind::bits((lanes.limit < over_lane.low) | (over_lane.high < -lanes.limit));
  if (left == 0) return 0;
  const Vectors edges[3] = {E::minus(p[1], p[0]), E::minus(p[2], p[1]), E::minus(p[0], p[2])};
  const Floats zero = E::all(0.0f), least = E::all(kMinRoom);
  for (std::size_t i = 0; i < 3 && left != 0; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vectors axis = E::cross(edges[i], lanes.edge[j]);
      const auto project = [&](const Vectors& v) ORCHARD_INLINE_LAMBDA { return E::dot(axis, E::minus(v, p[0])); };
      const Extent<Kind> of_row = extent<Kind>(zero, project(p[1]), project(p[2]));
      const Extent<Kind> of_lane = extent<Kind>(E::dot(axis, from[0]), E::dot(axis, from[1]), E::dot(axis, from[2]));
      const Floats room = E::one_norm(axis) * margin + least;
      left &= ~Kind::bits((of_row.high + room < of_lane.low) | (of_lane.high + room < of_row.low));
    }
  }
  return left;
}

template <typename Kind>
ORCHARD_INLINE std::uint64_t find_candidates(const LeafPair& pair, const Placement& placement) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  Vectors lane[3] = {E::corner(pair.lanes, 0), E::corner(pair.lanes, 1), E::corner(pair.lanes, 2)};
  const Floats reach = E::all(placement.margin);
  const Box<Kind> lane_box = box_of<Kind>(lane, reach);
  const std::uint32_t lanes_left = reaching<Kind>(lane, lane_box, pair.row_slab, reach);
  if (lanes_left == 0) return 0;
  Vectors row[3] = {E::move(placement, E::corner(pair.rows, 0)), E::move(placement, E::corner(pair.rows, 1)),
                    E::move(placement, E::corner(pair.rows, 2))};
  const Box<Kind> row_box = box_of<Kind>(row, E::all(0.0f));
  const std::uint32_t rows_left = reaching<Kind>(row, row_box, pair.lane_slab, reach);
  if (rows_left == 0) return 0;
  std::uint32_t near[kBlockWidth];
  const std::uint32_t found =
      find_near<Kind>(lane_box, lanes_left & used_lanes(pair.lanes), row_box, rows_left & used_lanes(pair.rows), near);
  if (found == 0) return 0;

  const Floats unit = E::all(placement.unit), margin = reach * unit;
  for (std::size_t k = 0; k < 3; ++k) lane[k] = E::times(lane[k], unit), row[k] = E::times(row[k], unit);
  const Vectors lane_edge[2] = {E::minus(lane[1], lane[0]), E::minus(lane[2], lane[0])};
  const Vectors row_edge[2] = {E::minus(row[1], row[0]), E::minus(row[2], row[0])};
  const Vectors lane_normal = E::cross(lane_edge[0], lane_edge[1]), row_normal = E::cross(row_edge[0], row_edge[1]);
  // Own corners' heights over the plane through the first one: 0 but for rounding.
  const auto own_height = [&](const Vectors& normal, const Vectors(&edge)[2]) ORCHARD_INLINE_LAMBDA -> Floats {
    return E::larger(E::size(E::dot(normal, edge[0])), E::size(E::dot(normal, edge[1]))) +
           (E::one_norm(normal) * margin + E::all(kMinRoom));
  };
  const Lanes<Kind> planes = {{lane[0], lane[1], lane[2]},
                              {lane_edge[0], E::minus(lane[2], lane[1]), lane_edge[1]},
                              lane_normal,
                              own_height(lane_normal, lane_edge)};
  std::array<float, kBlockWidth> row_limit;
  store(own_height(row_normal, row_edge), row_limit);
  const OneByOne<Kind> normals(row_normal),
      corners[3] = {OneByOne<Kind>(row[0]), OneByOne<Kind>(row[1]), OneByOne<Kind>(row[2])};
  std::uint64_t result = 0;
  for (std::uint32_t left_rows = found; left_rows != 0; left_rows &= left_rows - 1) {
    const auto r = static_cast<std::uint32_t>(std::countr_zero(left_rows));
    const Vectors p[3] = {corners[0][r], corners[1][r], corners[2][r]};
    const std::uint32_t left = not_apart<Kind>(near[r], planes, p, normals[r], E::all(row_limit[r]), margin);
    result |= std::uint64_t{left} << (8 * r);
  }
  return result;
}

// Axes are normalised in float, so they are longer than 1 by less than 4 u, and a projection of D is off by less than
// 12 u D and the points' own errors: twice the margin is plenty.
template <typename Kind>
ORCHARD_INLINE void find_triangle_gaps(const TriangleBlock& lanes, const TriangleBlock& rows,
                                       const Placement& placement, const std::array<float, 3>& direction, float reach,
                                       TriangleGaps& result) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  const Floats unit = E::all(placement.unit), whole = E::all(placement.whole);
  const auto lane_corner = [&](std::size_t k)
                               ORCHARD_INLINE_LAMBDA -> Vectors { return E::times(E::corner(lanes, k), unit); };
  const auto row_corner = [&](std::size_t k) ORCHARD_INLINE_LAMBDA -> Vectors {
    return E::times(E::move(placement, E::corner(rows, k)), unit);
  };
  const Vectors lane[3] = {lane_corner(0), lane_corner(1), lane_corner(2)};
  const Vectors row[3] = {row_corner(0), row_corner(1), row_corner(2)};
  const auto normalised = [](const Vectors& v) ORCHARD_INLINE_LAMBDA -> Vectors {
    const Floats size = Kind::root(E::dot(v, v)) + E::all(kMinDistance);
    return {v.x / size, v.y / size, v.z / size};
  };
  const auto normal_of = [&](const Vectors(&t)[3]) ORCHARD_INLINE_LAMBDA -> Vectors {
    return normalised(E::cross(E::minus(t[1], t[0]), E::minus(t[2], t[0])));
  };
  const auto gap_along = [&](const Vectors& axis, const Vectors(&p)[3]) ORCHARD_INLINE_LAMBDA -> Floats {
    const auto project = [&](const Vectors& v) ORCHARD_INLINE_LAMBDA { return E::dot(axis, E::minus(v, p[0])); };
    const Extent<Kind> l = extent<Kind>(project(lane[0]), project(lane[1]), project(lane[2]));
    const Extent<Kind> r = extent<Kind>(E::all(0.0f), project(p[1]), project(p[2]));
    return E::larger(l.low - r.high, r.low - l.high);
  };
  const Vectors lane_normal = normal_of(lane), row_normal = normal_of(row);
  const Vectors given = {E::all(direction[0]), E::all(direction[1]), E::all(direction[2])};
  const OneByOne<Kind> normals(row_normal),
      corners[3] = {OneByOne<Kind>(row[0]), OneByOne<Kind>(row[1]), OneByOne<Kind>(row[2])};
  const Floats third = E::all(1.0f / 3), margin = E::all(2 * placement.margin * placement.unit);
  const Box<Kind> lane_box = box_of<Kind>(lane, E::all(0.0f)), row_boxes = box_of<Kind>(row, E::all(0.0f));
  const OneByOne<Kind> lows(row_boxes.low), highs(row_boxes.high);
  for (std::uint32_t r = 0; r < kBlockWidth; ++r) {
    if (rows.triangle[r] == kNoTriangle) break;
    const Vectors low = lows[r], high = highs[r];
    const Floats apart = E::larger(E::larger(E::larger(lane_box.low.x - high.x, low.x - lane_box.high.x),
                                             E::larger(lane_box.low.y - high.y, low.y - lane_box.high.y)),
                                   E::larger(lane_box.low.z - high.z, low.z - lane_box.high.z));
    const Floats by_boxes = (apart - margin) * whole;
    if (Kind::bits(by_boxes <= E::all(reach)) == 0) {
      store(by_boxes, result.lower[r]);
      continue;
    }
    const Vectors p[3] = {corners[0][r], corners[1][r], corners[2][r]};
    const auto middle = [&](const Floats& a, const Floats& b, const Floats& c)
                            ORCHARD_INLINE_LAMBDA -> Floats { return (a + b + c) * third; };
    const Vectors line = normalised(
        E::minus({middle(lane[0].x, lane[1].x, lane[2].x), middle(lane[0].y, lane[1].y, lane[2].y),
                  middle(lane[0].z, lane[1].z, lane[2].z)},
                 {middle(p[0].x, p[1].x, p[2].x), middle(p[0].y, p[1].y, p[2].y), middle(p[0].z, p[1].z, p[2].z)}));
    const Floats gap = E::larger(E::larger(gap_along(normals[r], p), gap_along(lane_normal, p)),
                                 E::larger(gap_along(line, p), gap_along(given, p)));
    store(E::larger((gap - margin) * whole, by_boxes), result.lower[r]);
  }
}

}  // namespace

BallSlab moved(const BallSlab& slab, const Placement& p) noexcept {
  const auto turn = [](const std::array<float, 9>& r, float x, float y, float z) -> std::array<float, 3> {
    return {r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z};
  };
  const auto c = turn(p.rotation, slab.x, slab.y, slab.z), n = turn(p.turn, slab.nx, slab.ny, slab.nz);
  return {c[0] + p.translation[0], c[1] + p.translation[1], c[2] + p.translation[2], n[0], n[1], n[2],
          slab.radius * p.scale,   slab.height * p.scale};
}

TrianglePoints points_of(const TriangleBlock& block, std::uint32_t lane) noexcept {
  TrianglePoints result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) result[k][i] = double{block.corner[k][i][lane]};
  }
  return result;
}

TrianglePoints moved_points_of(const TriangleBlock& block, std::uint32_t lane, const Pose& pose) noexcept {
  TrianglePoints result = points_of(block, lane);
  for (Vec3& point : result) point = transform(pose, point);
  return result;
}

void ball_slab_gaps_scalar(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement, float margin,
                           BallSlabGaps& result) noexcept {
  find_gaps<PlainFloats>(single, lanes, placement, margin, result);
}

void triangle_gaps_scalar(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                          const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept {
  find_triangle_gaps<PlainFloats>(lanes, rows, placement, direction, reach, result);
}

std::uint64_t triangle_candidates_scalar(const LeafPair& pair, const Placement& placement) noexcept {
  return find_candidates<PlainFloats>(pair, placement);
}

void ball_slab_gaps(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement, float margin,
                    BallSlabGaps& result) noexcept {
  PerMachine<find_gaps<Widest>, find_gaps<Base>>::call(single, lanes, placement, margin, result);
}

void triangle_gaps(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                   const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept {
  PerMachine<find_triangle_gaps<Widest>, find_triangle_gaps<Base>>::call(lanes, rows, placement, direction, reach,
                                                                         result);
}

std::uint64_t triangle_candidates(const LeafPair& pair, const Placement& placement) noexcept {
  return PerMachine<find_candidates<Widest>, find_candidates<Base>>::call(pair, placement);
}

}  // namespace orchard::runtime::detail
