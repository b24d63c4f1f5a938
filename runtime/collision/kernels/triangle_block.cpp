#include "collision/kernels/triangle_block.h"

#include <bit>
#include <limits>

#include "collision/kernels/eight.h"
#include "collision/kernels/triangle_tests.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

// Finds, for each row, the lanes whose boxes meet the box of the row. The lanes' boxes already contain the margin.
// Returns the rows that have such lanes, as bits.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE std::uint32_t find_near(const Box<Kind>& lane_box, std::uint32_t lanes, const Box<Kind>& row_box,
                                       std::uint32_t rows, std::uint32_t (&near)[kBlockWidth]) noexcept {
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

template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE bool find_candidates(const LeafPair& pair, const Placement& placement, CandidateVisit visit,
                                    const void* context) noexcept {
  Vectors lane[3] = {E::corner(pair.lanes, 0), E::corner(pair.lanes, 1), E::corner(pair.lanes, 2)};
  const Floats reach = E::all(placement.margin);
  const std::uint32_t lanes_left = E::kAll & ~Kind::bits(beyond_box<Kind>(lane, pair.row_box, reach));
  if (lanes_left == 0) return false;
  Vectors row[3] = {E::move(placement, E::corner(pair.rows, 0)), E::move(placement, E::corner(pair.rows, 1)),
                    E::move(placement, E::corner(pair.rows, 2))};
  const std::uint32_t rows_left = E::kAll & ~Kind::bits(beyond_box<Kind>(row, pair.lane_box, reach));
  if (rows_left == 0) return false;
  const Box<Kind> lane_box = box_of<Kind>(lane, reach), row_box = box_of<Kind>(row, E::all(0.0f));
  std::uint32_t near[kBlockWidth];
  const std::uint32_t found =
      find_near<Kind>(lane_box, lanes_left & used_lanes(pair.lanes), row_box, rows_left & used_lanes(pair.rows), near);
  if (found == 0) return false;

  const Floats unit = E::all(placement.unit), margin = reach * unit;
  for (std::size_t k = 0; k < 3; ++k) lane[k] = E::times(lane[k], unit), row[k] = E::times(row[k], unit);
  const Vectors lane_edge[2] = {E::minus(lane[1], lane[0]), E::minus(lane[2], lane[0])};
  const Vectors row_edge[2] = {E::minus(row[1], row[0]), E::minus(row[2], row[0])};
  const Vectors lane_normal = E::cross(lane_edge[0], lane_edge[1]), row_normal = E::cross(row_edge[0], row_edge[1]);
  const Lanes<Kind> planes = {{lane[0], lane[1], lane[2]},
                              {lane_edge[0], E::minus(lane[2], lane[1]), lane_edge[1]},
                              lane_normal,
                              own_height<Kind>(lane_normal, lane_edge, margin)};
  std::array<float, kBlockWidth> row_limit;
  store(own_height<Kind>(row_normal, row_edge, margin), row_limit);
  const OneByOne<Kind> normals(row_normal),
      corners[3] = {OneByOne<Kind>(row[0]), OneByOne<Kind>(row[1]), OneByOne<Kind>(row[2])};
  for (std::uint32_t left = found; left != 0; left &= left - 1) {
    const auto r = static_cast<std::uint32_t>(std::countr_zero(left));
    const Vectors p[3] = {corners[0][r], corners[1][r], corners[2][r]};
    const std::uint32_t open = not_apart<Kind>(near[r], planes, p, normals[r], E::all(row_limit[r]), margin);
    if (open != 0 && visit(context, r, open)) return true;
  }
  return false;
}

// Returns the gap along a direction between all triangles of the lanes and all triangles of the rows.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE typename Eight<Kind>::Floats gap_of_all(const typename Eight<Kind>::Vectors& u,
                                                       const typename Eight<Kind>::Vectors (&lane)[3],
                                                       const typename Eight<Kind>::Vectors (&row)[3]) noexcept {
  const Extent<Kind> lanes = extent_along<Kind>(u, lane), rows = extent_along<Kind>(u, row);
  return E::max(E::all(least_of<Kind>(rows.low)) + E::all(least_of<Kind>(-lanes.high)),
                E::all(least_of<Kind>(lanes.low)) + E::all(least_of<Kind>(-rows.high)));
}

// Axes are normalised in float, so they are longer than 1 by less than 4 u, and a projection of D is off by less than
// 12 u D and the points' own errors. So twice the margin is enough.
template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE void find_triangle_gaps(const TriangleBlock& lanes, const TriangleBlock& rows,
                                       const Placement& placement, const std::array<float, 3>& direction, float reach,
                                       TriangleGaps& result) noexcept {
  const Floats unit = E::all(placement.unit), whole = E::all(placement.whole);
  const auto lane_corner = [&](std::size_t k)
                               ORCHARD_INLINE_LAMBDA -> Vectors { return E::times(E::corner(lanes, k), unit); };
  const auto row_corner = [&](std::size_t k) ORCHARD_INLINE_LAMBDA -> Vectors {
    return E::times(E::move(placement, E::corner(rows, k)), unit);
  };
  const Vectors lane[3] = {lane_corner(0), lane_corner(1), lane_corner(2)};
  const Vectors row[3] = {row_corner(0), row_corner(1), row_corner(2)};
  const Vectors given = E::all_of(direction);
  const Floats margin = E::all(2 * placement.margin * placement.unit), limit = E::all(reach);
  // First, all triangles together are tested along the direction that has separated others.
  const Floats all_beyond = (gap_of_all<Kind>(given, lane, row) - margin) * whole;
  if (Kind::bits(all_beyond <= limit) == 0) {
    for (std::uint32_t r = 0; r < kBlockWidth; ++r) store(all_beyond, result.lower[r]), result.near[r] = 0;
    result.beyond = result.lower[0][0];
    return;
  }
  const OneByOne<Kind> corners[3] = {OneByOne<Kind>(row[0]), OneByOne<Kind>(row[1]), OneByOne<Kind>(row[2])};
  const Floats infinite = E::all(std::numeric_limits<float>::infinity());
  const Box<Kind> lane_box = box_of<Kind>(lane, E::all(0.0f)), row_boxes = box_of<Kind>(row, E::all(0.0f));
  const OneByOne<Kind> lows(row_boxes.low), highs(row_boxes.high);
  Floats beyond = infinite;
  std::uint32_t open = 0;  // rows that boxes leave undecided
  for (std::uint32_t r = 0; r < kBlockWidth; ++r) {
    result.near[r] = 0;
    if (rows.triangle[r] == kNoTriangle) continue;
    const Floats by_boxes = (gap_between<Kind>(lane_box, lows[r], highs[r]) - margin) * whole;
    store(by_boxes, result.lower[r]);
    const bool settled = Kind::bits(by_boxes <= limit) == 0;
    open |= std::uint32_t{!settled} << r;
    beyond = E::min(beyond, settled ? by_boxes : infinite);
  }
  if (open != 0) {
    const Vectors lane_normal = normal_of<Kind>(lane), lane_middle = middle_of<Kind>(lane);
    const OneByOne<Kind> normals(normal_of<Kind>(row));
    const std::uint32_t used = used_lanes(lanes);
    for (; open != 0; open &= open - 1) {
      const auto r = static_cast<std::uint32_t>(std::countr_zero(open));
      const Vectors p[3] = {corners[0][r], corners[1][r], corners[2][r]};
      const Vectors line = normalised<Kind>(E::minus(lane_middle, middle_of<Kind>(p)));
      const Floats gap = E::max(E::max(gap_along<Kind>(normals[r], lane, p), gap_along<Kind>(lane_normal, lane, p)),
                                E::max(gap_along<Kind>(line, lane, p), gap_along<Kind>(given, lane, p)));
      const Floats lower = E::max((gap - margin) * whole, load<Floats>(result.lower[r]));
      store(lower, result.lower[r]);
      const auto near = lower <= limit;
      result.near[r] = used & Kind::bits(near);
      beyond = E::min(beyond, Kind::choose(near, infinite, lower));
    }
  }
  result.beyond = least_of<Kind>(beyond);  // unused lanes repeat the first one
}

}  // namespace

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

void triangle_gaps(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                   const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept {
  PerMachine<find_triangle_gaps<Widest>, find_triangle_gaps<Base>, find_triangle_gaps<PlainFloats>>::call(
      lanes, rows, placement, direction, reach, result);
}

bool visit_candidates(const LeafPair& pair, const Placement& placement, CandidateVisit visit,
                      const void* context) noexcept {
  return PerMachine<find_candidates<Widest>, find_candidates<Base>, find_candidates<PlainFloats>>::call(pair, placement,
                                                                                                        visit, context);
}

}  // namespace orchard::runtime::detail
