// Decides whether shapes cover a polygon: shapes, their boundaries inside the region, and the parts of these that are
// certainly covered.
#include "orchard/covering/planar_cover.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "circle_intervals.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "plane_edges.h"

// The argument is that of boundary_lemma.cpp. A triangle of the region is covered if one of its points certainly is,
// and if all but finitely many points of every shape's boundary inside it have a neighbourhood that is covered. There
// are two kinds of such points: those in the interior of another shape, and those on an edge whose other side adjoins
// an edge of another polygon, which is decided exactly. The pieces of a boundary that other shapes cover are rounded
// inward, so two of them that end at the same point leave a sliver between them. The sliver is ignored if both ends are
// known to be roundings of one point.
namespace orchard {
namespace {

using detail::Arc;
using detail::CircleIntervals;
using detail::Edge;

constexpr double kRounding = 0x1p-46;  // as for spheres: a few roundings, per length involved
constexpr int kNamedPoints = 64;       // points that are tried to find one that is certainly covered
// Where a circle meets a line, slivers narrower than kSliver radians count as one point if the line's chord is wider
// than kChord radians.
constexpr double kSliver = 1e-6, kChord = 1e-3;

struct Shape {
  PlanarShape shape;
  std::vector<Edge> edges;  // empty: a disk
  Eigen::AlignedBox2d box;
  Index index;
};

Shape prepared(const PlanarShape& shape, Index index) {
  Shape result{shape, {}, {}, index};
  if (!shape.corners.empty()) {
    result.edges = detail::edges_of(detail::convex_corners(shape.corners));
    for (const PlanePoint& corner : shape.corners) result.box.extend(corner);
    return result;
  }
  if (!(shape.radius > 0 && std::isfinite(shape.radius)) || !shape.center.allFinite())
    throw InputError("a disk needs a finite centre and a positive radius");
  const PlanePoint half = PlanePoint::Constant(shape.radius);
  result.box = {shape.center - half, shape.center + half};
  return result;
}

// An end of a part that is removed from a boundary piece: a crossing with an edge, or a corner that lies on the piece.
struct End {
  double at;
  const Edge* crossing;  // nullptr: a corner
  PlanePoint corner = PlanePoint::Zero();
};

// One boundary piece as an interval of a parameter, from which the parts that other shapes cover are removed.
class Piece {
 public:
  explicit Piece(CircleIntervals all) : left_(std::move(all)) {}

  void take(double begin, double end) { left_.subtract(begin, end); }
  void take(const CircleIntervals& covered) { left_.subtract(covered); }
  void note(const End& end) { ends_.push_back(end); }
  bool empty() const { return left_.empty(); }

  // Returns the rest, without slivers whose ends are one point.
  template <class SamePoint>
  std::vector<CircleIntervals::Interval> rest(SamePoint same_point) const {
    std::vector<CircleIntervals::Interval> rest;
    for (const auto& interval : left_.intervals()) {
      bool point = false;
      for (const End& p : ends_)
        for (const End& q : ends_)
          point = point || (p.at == interval.begin && q.at == interval.end && same_point(p, q, interval));
      if (!point) rest.push_back(interval);
    }
    return rest;
  }

 private:
  CircleIntervals left_;
  std::vector<End> ends_;
};

// Returns whether two ends on an edge are certainly one point: they are at one corner, or at crossings with edges that
// lie on one line or share a corner on the edge.
bool one_point(const End& p, const End& q, const Edge& edge) {
  if (p.crossing != nullptr && q.crossing != nullptr) return detail::cross_in_one_point(*p.crossing, *q.crossing, edge);
  if (p.crossing == nullptr && q.crossing == nullptr) return p.corner == q.corner;
  const Edge& crossing = p.crossing != nullptr ? *p.crossing : *q.crossing;
  const PlanePoint& corner = p.crossing != nullptr ? q.corner : p.corner;
  return crossing.side_of(corner) == 0;
}

class Triangle {
 public:
  Triangle(const std::array<PlanePoint, 3>& corners, std::span<const Shape> shapes)
      : corners_(corners), edges_(detail::edges_of(corners)), shapes_(shapes) {
    for (const PlanePoint& corner : corners) box_.extend(corner), extent_ = std::max(extent_, corner.norm());
    for (Index i = 0; i < shapes.size(); ++i) {
      if (!shapes[i].box.intersects(box_)) continue;
      near_.push_back(i);
      extent_ = std::max({extent_, shapes[i].box.min().norm(), shapes[i].box.max().norm(), shapes[i].shape.radius});
    }
  }

  void check(PlanarCover& result) {
    PlanePoint named = (corners_[0] + corners_[1] + corners_[2]) / 3;
    const bool point_covered = some_point_covered(named);
    const std::size_t before = result.gaps.size();
    for (Index i : near_) {
      if (shapes_[i].edges.empty()) check_circle(shapes_[i], result);
      for (const Edge& edge : shapes_[i].edges) check_edge(edge, shapes_[i], result);
    }
    if (point_covered && result.gaps.size() == before) return;
    if (result.covered) result.witness = result.gaps.size() > before ? result.gaps[before].middle : named;
    result.covered = false;
  }

 private:
  double fuzz() const { return kRounding * extent_; }

  // Finds an interior point that is certainly covered. Several points are tried, because a point on an edge between two
  // shapes is not certain.
  bool some_point_covered(PlanePoint& point) const {
    Random random(0, 0);
    for (int i = 0; i < kNamedPoints; ++i) {
      for (Index k : near_)
        if (certainly_inside(point, shapes_[k])) return true;
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      point = corners_[0] + u * (corners_[1] - corners_[0]) + v * (corners_[2] - corners_[0]);
    }
    return false;
  }

  bool certainly_inside(const PlanePoint& p, const Shape& shape) const {
    if (shape.edges.empty()) return (p - shape.shape.center).norm() < shape.shape.radius - fuzz();
    return std::all_of(shape.edges.begin(), shape.edges.end(),
                       [&](const Edge& edge) { return height(edge, p) > fuzz(); });
  }

  // Returns the distance of a point from the line of an edge, positive on the left; the error is at most fuzz().
  static double height(const Edge& edge, const PlanePoint& p) {
    const PlanePoint along = edge.b - edge.a, out = p - edge.a;
    return (along.x() * out.y() - along.y() * out.x()) / along.norm();
  }

  // ---- an edge, by the coordinate along its axis

  void check_edge(const Edge& edge, const Shape& owner, PlanarCover& result) const {
    const int axis = edge.axis();
    const Eigen::AlignedBox2d box(edge.a.cwiseMin(edge.b), edge.a.cwiseMax(edge.b));
    const double low = box.min()[axis], high = box.max()[axis];
    CircleIntervals all;
    all.assign(low, high);
    Piece piece(std::move(all));
    for (const Edge& side : edges_) take_outside(edge, side, piece);
    for (Index i : near_) {
      if (piece.empty()) return;
      if (shapes_[i].index == owner.index || !shapes_[i].box.intersects(box)) continue;
      if (shapes_[i].edges.empty()) {
        take_disk(edge, shapes_[i], piece);
      } else {
        take_polygon(edge, shapes_[i], piece);
      }
    }
    const auto rest = piece.rest([&](const End& p, const End& q, const auto&) { return one_point(p, q, edge); });
    for (const auto& interval : rest) {
      const auto at = [&](double t) {
        return PlanePoint(edge.a + (t - edge.a[axis]) / (edge.b[axis] - edge.a[axis]) * (edge.b - edge.a));
      };
      result.gaps.push_back(
          {owner.index, at(interval.begin), at((interval.begin + interval.end) / 2), at(interval.end)});
    }
  }

  // The place where an edge crosses a line between its ends, and the uncertainty of this place.
  struct Crossing {
    double at, uncertainty;
  };
  Crossing crossing(const Edge& edge, const Edge& line) const {
    const int axis = edge.axis();
    const double from = height(line, edge.a), to = height(line, edge.b), length = edge.b[axis] - edge.a[axis];
    const double fraction = std::clamp(from / (from - to), 0.0, 1.0);
    return {edge.a[axis] + fraction * length, fuzz() + 2 * fuzz() / std::abs(from - to) * std::abs(length)};
  }

  // Removes the part of the edge that is outside the half-plane of a side. An edge on the side itself bounds nothing
  // inside.
  void take_outside(const Edge& edge, const Edge& side, Piece& piece) const {
    const int a = side.side_of(edge.a), b = side.side_of(edge.b), axis = edge.axis();
    const double low = std::min(edge.a[axis], edge.b[axis]), high = std::max(edge.a[axis], edge.b[axis]);
    if (a >= 0 && b >= 0 && (a > 0 || b > 0)) return;
    if (a <= 0 && b <= 0) return piece.take(low, high);
    const Crossing cross = crossing(edge, side);
    const bool low_end_outside = (edge.a[axis] < edge.b[axis] ? a : b) < 0;
    const double end = low_end_outside ? cross.at - cross.uncertainty : cross.at + cross.uncertainty;
    piece.note({end, &side});
    if (low_end_outside) piece.take(low, end);
    if (!low_end_outside) piece.take(end, high);
  }

  // Removes the part of the edge that lies in the interior of a polygon, or along an edge of it on the opposite side.
  void take_polygon(const Edge& edge, const Shape& polygon, Piece& piece) const {
    const int axis = edge.axis();
    double low = std::min(edge.a[axis], edge.b[axis]), high = std::max(edge.a[axis], edge.b[axis]);
    const bool forward = edge.a[axis] < edge.b[axis];
    const Edge *from_low = nullptr, *from_high = nullptr;
    for (const Edge& side : polygon.edges) {
      const int a = side.side_of(edge.a), b = side.side_of(edge.b);
      if (a == 0 && b == 0) return take_facing(edge, side, piece);
      if (a <= 0 && b <= 0) return;
      if (a >= 0 && b >= 0) continue;
      const Crossing cross = crossing(edge, side);
      const bool enters_upwards = (forward ? a : b) < 0;
      if (enters_upwards && cross.at + cross.uncertainty > low) low = cross.at + cross.uncertainty, from_low = &side;
      if (!enters_upwards && cross.at - cross.uncertainty < high)
        high = cross.at - cross.uncertainty, from_high = &side;
    }
    if (low >= high) return;
    if (from_low != nullptr) piece.note({low, from_low});
    if (from_high != nullptr) piece.note({high, from_high});
    piece.take(low, high);
  }

  static void take_facing(const Edge& edge, const Edge& side, Piece& piece) {
    if ((edge.b - edge.a).dot(side.b - side.a) >= 0) return;
    const int axis = edge.axis();
    const double low = std::min(side.a[axis], side.b[axis]), high = std::max(side.a[axis], side.b[axis]);
    for (const PlanePoint& corner : {side.a, side.b}) piece.note({corner[axis], nullptr, corner});
    piece.take(low, high);
  }

  void take_disk(const Edge& edge, const Shape& disk, Piece& piece) const {
    const int axis = edge.axis();
    const PlanePoint along = (edge.b - edge.a).normalized();
    const double radius = disk.shape.radius - fuzz(), off = std::abs(height(edge, disk.shape.center)) + fuzz();
    if (!(radius > off)) return;
    const double half = std::sqrt((radius - off) * (radius + off)) * std::abs(along[axis]) - fuzz();
    const double foot = edge.a[axis] + (disk.shape.center - edge.a).dot(along) * along[axis];
    if (half > fuzz()) piece.take(foot - half, foot + half);
  }

  // ---- a circle, by the angle

  void check_circle(const Shape& disk, PlanarCover& result) const {
    CircleIntervals all;
    all.set_all();
    Piece piece(std::move(all));
    for (const Edge& side : edges_) {
      const Arc outside = beyond(disk, side, fuzz());
      note_ends(outside, side, piece);
      CircleIntervals covered;
      CircleIntervals whole;
      whole.set_all();
      covered.assign_intersection(whole, outside);
      piece.take(covered);
    }
    for (Index i : near_) {
      if (piece.empty()) return;
      if (shapes_[i].index == disk.index || !shapes_[i].box.intersects(disk.box)) continue;
      piece.take(shapes_[i].edges.empty() ? inside_disk(disk, shapes_[i]) : inside_polygon(disk, shapes_[i], piece));
    }
    const auto rest = piece.rest([&](const End& p, const End& q, const CircleIntervals::Interval& sliver) {
      const double off = std::abs(height(*p.crossing, disk.shape.center));
      const double half_chord = off < disk.shape.radius ? std::acos(off / disk.shape.radius) : 0;
      return sliver.end - sliver.begin < kSliver && half_chord > kChord && p.crossing->on_line_of(*q.crossing);
    });
    for (const auto& interval : rest) {
      const auto at = [&](double angle) {
        return PlanePoint(disk.shape.center + disk.shape.radius * PlanePoint(std::cos(angle), std::sin(angle)));
      };
      result.gaps.push_back(
          {disk.index, at(interval.begin), at((interval.begin + interval.end) / 2), at(interval.end)});
    }
  }

  // Returns the arc of the disk's circle that lies on the right of the edge's line, moved to the right by `by`.
  static Arc beyond(const Shape& disk, const Edge& edge, double by) {
    const double r = disk.shape.radius, room = height(edge, disk.shape.center) + by;
    if (room >= r) return Arc::none();
    if (room <= -r) return Arc::all();
    const PlanePoint along = edge.b - edge.a;
    return Arc::around(std::atan2(-along.x(), along.y()), 2 * std::atan2(std::sqrt(r - room), std::sqrt(r + room)));
  }

  static void note_ends(const Arc& arc, const Edge& edge, Piece& piece) {
    if (arc.kind != Arc::Kind::some) return;
    piece.note({arc.begin, &edge});
    piece.note({arc.end > detail::kTwoPi ? arc.end - detail::kTwoPi : arc.end, &edge});
  }

  CircleIntervals inside_polygon(const Shape& disk, const Shape& polygon, Piece& piece) const {
    CircleIntervals inside;
    inside.set_all();
    for (const Edge& edge : polygon.edges) {
      const Arc outside = beyond(disk, edge, -fuzz());
      note_ends(outside, edge, piece);
      inside.subtract(outside);
    }
    return inside;
  }

  CircleIntervals inside_disk(const Shape& disk, const Shape& other) const {
    CircleIntervals inside, whole;
    whole.set_all();
    const PlanePoint apart = other.shape.center - disk.shape.center;
    const double d = apart.norm(), r = disk.shape.radius, s = other.shape.radius - 2 * fuzz();
    const double above = (s - (d - r)) * (s + (d - r)), below = (d + r - s) * (d + r + s);
    if (s <= 0 || above <= 0) return inside;
    if (below <= 0) return whole;
    inside.assign_intersection(
        whole, Arc::around(std::atan2(apart.y(), apart.x()), 2 * std::atan2(std::sqrt(above), std::sqrt(below))));
    return inside;
  }

  const std::array<PlanePoint, 3> corners_;
  std::vector<Edge> edges_;
  std::span<const Shape> shapes_;
  std::vector<Index> near_;  // the shapes whose boxes meet that of the triangle
  Eigen::AlignedBox2d box_;
  double extent_ = 0;
};

}  // namespace

PlanarShape PlanarShape::rectangle(const PlanePoint& lower, const PlanePoint& upper) {
  return polygon({lower, {upper.x(), lower.y()}, upper, {lower.x(), upper.y()}});
}

PlanarCover cover_of_polygon(std::span<const PlanePoint> region, std::span<const PlanarShape> shapes) {
  std::vector<Shape> all;
  for (Index i = 0; i < shapes.size(); ++i) all.push_back(prepared(shapes[i], i));
  PlanarCover result;
  result.covered = true;
  for (const auto& triangle : detail::triangulated(region)) Triangle(triangle, all).check(result);
  return result;
}

}  // namespace orchard
