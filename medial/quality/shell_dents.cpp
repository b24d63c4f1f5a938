#include "shell_dents.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "search_precision.h"
#include "shell_piece.h"

namespace orchard::detail {
namespace {

constexpr double kNormalRounding = 1e-14;  // of a normal, times the squared longest side over the area
constexpr double kFlatSine = 1e-12;  // sine of an angle: an edge that is convex by less may be reflex after rounding
constexpr int kMaxShellLevels = 60;  // number of halvings, after which a piece is as small as its rounding error
constexpr std::size_t kShellBlock = 64;  // triangles or pieces that one task looks at
constexpr double kWide = 0.5;            // cosine to the mean normal: pieces with a wider range of normals are divided
constexpr int kTouches = 6;              // the number of places q that are tried, each nearer than the one before
constexpr double kSameDepth = 1e-3;      // of the depth: a place q that is nearer by less is not tried
constexpr double kShellArrived = 0.01;   // of the accuracy: a path to the boundary ends when it is this near
constexpr int kMaxShellSteps = 20;       // number of steps on a path to the boundary

// What the previous piece has shown. It is a good guess for the next one, because successive pieces are near each
// other.
struct Hint {
  Index cell = 0;  // the cell of the reconstruction that is nearest to the piece
  double gap = 0;  // distance of that cell from the middle of the piece, if no cell contained the piece
};

class ShellSearch {
 public:
  ShellSearch(const Surface& surface, const Reconstruction& reconstruction, double known, double deepest,
              double accuracy, std::size_t max_pieces)
      : surface_(surface),
        reconstruction_(reconstruction),
        accuracy_(accuracy),
        deepest_(deepest),
        max_pieces_(max_pieces) {
    found_.max = known;
    const Box& box = surface.bounding_box();
    rounding_ = search_rounding(box);
  }

  SearchedMax run() {
    std::vector<ShellPiece> open = look_below_all();
    std::size_t looked_at = 0;
    for (int level = 0; level < kMaxShellLevels && !open.empty(); ++level) {
      looked_at += open.size();
      if (looked_at > max_pieces_) break;
      open = look_below_halves(open);
    }
    found_.upper = std::max(found_.max, level());
    for (const ShellPiece& piece : open) found_.upper = std::max(found_.upper, std::min(max_depth(piece), deepest_));
    found_.upper += rounding_;
    return found_;
  }

 private:
  // Places that are no deeper than this are not searched for.
  double level() const { return std::min(deepest_, found_.max + std::max(accuracy_, kShareAbove * found_.max)); }

  struct Result {
    std::vector<ShellPiece> open;
    SearchedMax found;
  };

  struct Depths {
    double from, to, slack;
  };

  template <class LookAt>
  std::vector<ShellPiece> in_blocks(std::size_t count, const LookAt& look_at) {
    std::vector<Result> results((count + kShellBlock - 1) / kShellBlock);
    const double level = this->level();
    tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t block) {
      Hint hint;
      for (std::size_t i = block * kShellBlock; i < std::min(count, (block + 1) * kShellBlock); ++i)
        look_at(i, level, hint, results[block]);
    });
    std::vector<ShellPiece> open;
    for (const Result& result : results) {
      open.insert(open.end(), result.open.begin(), result.open.end());
      if (result.found.max > found_.max) found_ = result.found;
    }
    return open;
  }

  std::vector<ShellPiece> look_below_all() {
    return in_blocks(surface_.mesh().triangles.size(), [&](std::size_t t, double level, Hint& hint, Result& result) {
      const auto triangle = static_cast<Index>(t);
      look_at_whole(face_piece(triangle), level, hint, result);
      for (int i = 0; i < 3; ++i) look_below_edge(triangle, i, level, hint, result);
      for (const Index vertex : surface_.mesh().triangles[triangle]) {
        if (surface_.triangles_around(vertex).front() == triangle) look_below_vertex(vertex, level, hint, result);
      }
    });
  }

  std::vector<ShellPiece> look_below_halves(const std::vector<ShellPiece>& pieces) {
    return in_blocks(pieces.size(), [&](std::size_t i, double level, Hint& hint, Result& result) {
      for (const ShellPiece& half : halves_of(pieces[i])) {
        hint.cell = pieces[i].cell;
        look_at(half, level, hint, result);
      }
    });
  }

  // Returns how far places below a triangle may be off. The cross product of its sides is rounded, which matters on
  // thin triangles.
  double slack_of(Index triangle) const {
    double longest = 0;
    const auto corners = surface_.corners(triangle);
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).squaredNorm());
    return rounding_ + kNormalRounding * deepest_ * longest / surface_.area(triangle);
  }

  ShellPiece face_piece(Index triangle) const {
    ShellPiece piece;
    piece.count = 3;
    piece.slack = slack_of(triangle);
    const auto corners = surface_.corners(triangle);
    for (std::size_t k = 0; k < 3; ++k) piece.columns[k] = {corners[k], -surface_.normal(triangle)};
    return piece;
  }

  // Returns how far the triangle across an edge rises above the plane of this one. The edge is reflex if this is above
  // 0.
  bool is_reflex(Index triangle, int edge) const {
    const Index other = surface_.neighbors(triangle)[static_cast<std::size_t>(edge)];
    if (other == kNone) return true;
    const auto corners = surface_.corners(triangle);
    const Point& from = corners[static_cast<std::size_t>(edge)];
    double rise = 0, far = 0;
    for (const Point& corner : surface_.corners(other)) {
      const double height = surface_.normal(triangle).dot(corner - from);
      if (std::abs(height) > std::abs(rise)) rise = height;
      far = std::max(far, (corner - from).norm());
    }
    return rise > -kFlatSine * far;
  }

  void look_below_edge(Index triangle, int edge, double level, Hint& hint, Result& result) const {
    const auto i = static_cast<std::size_t>(edge);
    const Index other = surface_.neighbors(triangle)[i];
    if (other != kNone && (other < triangle || !is_reflex(triangle, edge))) return;
    const auto corners = surface_.corners(triangle);
    const Point &a = corners[i], &b = corners[(i + 1) % 3], &c = corners[(i + 2) % 3];
    const Vector normal = -surface_.normal(triangle),
                 other_normal = other == kNone ? normal : Vector(-surface_.normal(other));
    const double slack = std::max(slack_of(triangle), slack_of(other == kNone ? triangle : other));
    const auto piece = [&](const Vector& m, const Vector& n) {
      return ShellPiece{.columns = {{{a, m}, {b, m}, {a, n}, {b, n}}}, .count = 4, .slack = slack};
    };
    const ShellPiece whole = piece(normal, other_normal);
    if (mean_normal(whole.in_use()).cosine >= kWide) {
      look_at_whole(whole, level, hint, result);
      return;
    }
    // Both faces are turned back from here, so the direction away from them is the mean of their normals.
    const Vector along = (b - a).normalized();
    Vector middle = -((c - a) - (c - a).dot(along) * along).normalized();
    if ((normal + other_normal).norm() > kWide) middle = (normal + other_normal).normalized();
    look_at_whole(piece(normal, middle), level, hint, result);
    look_at_whole(piece(middle, other_normal), level, hint, result);
  }

  void look_below_vertex(Index vertex, double level, Hint& hint, Result& result) const {
    const auto around = surface_.triangles_around(vertex);
    const Point& foot = surface_.mesh().vertices[vertex];
    bool reflex = false;
    for (const Index triangle : around) {
      for (int i = 0; i < 3 && !reflex; ++i) {
        const auto& corners = surface_.mesh().triangles[triangle];
        const bool meets =
            corners[static_cast<std::size_t>(i)] == vertex || corners[static_cast<std::size_t>((i + 1) % 3)] == vertex;
        reflex = meets && is_reflex(triangle, i);
      }
      if (reflex) break;
    }
    if (!reflex) return;
    std::vector<NormalColumn> columns;
    double slack = 0;
    for (const Index triangle : around) {
      columns.push_back({foot, -surface_.normal(triangle)});
      slack = std::max(slack, slack_of(triangle));
    }
    const MeanNormal axis = mean_normal(columns);
    if (axis.cosine >= kWide) {
      if (is_held(columns, {level, (1 + kFlatSine) * deepest_ / axis.cosine, slack}, hint)) return;
      const std::vector<Vector> hull = hull_of(columns, axis.direction);
      for (std::size_t k = 0; k < hull.size(); ++k) {
        look_at_whole(below(vertex, slack, {axis.direction, hull[k], hull[(k + 1) % hull.size()]}), level, hint,
                      result);
      }
      return;
    }
    for (int octant = 0; octant < 8; ++octant) {
      const auto axis_of_octant = [&](int k) { return Vector((octant >> k & 1 ? -1.0 : 1.0) * Vector::Unit(k)); };
      look_at_whole(below(vertex, slack, {axis_of_octant(0), axis_of_octant(1), axis_of_octant(2)}), level, hint,
                    result);
    }
  }

  ShellPiece below(Index vertex, double slack, const std::array<Vector, 3>& normals) const {
    ShellPiece piece;
    piece.slack = slack;
    piece.count = 3;
    piece.vertex = vertex;
    for (std::size_t k = 0; k < 3; ++k) piece.columns[k] = {surface_.mesh().vertices[vertex], normals[k]};
    return piece;
  }

  // Whether all directions of a piece below a vertex lean towards one of the edges, so that none of them is in the
  // polar cone.
  bool leans(const ShellPiece& piece) const {
    const Point& foot = surface_.mesh().vertices[piece.vertex];
    for (const Index triangle : surface_.triangles_around(piece.vertex)) {
      for (const Point& end : surface_.corners(triangle)) {
        const Vector edge = end - foot;
        const double length = edge.norm();
        if (length > 0 &&
            std::all_of(piece.columns.begin(), piece.columns.begin() + 3,
                        [&](const NormalColumn& column) { return column.inward.dot(edge) > kFlatSine * length; }))
          return true;
      }
    }
    return false;
  }

  // Examines all that lies below a face, an edge or a vertex.
  void look_at_whole(ShellPiece piece, double level, Hint& hint, Result& result) const {
    const MeanNormal axis = mean_normal(piece.in_use());
    piece.from = level;
    piece.to = (1 + kFlatSine) * deepest_ / std::max(axis.cosine, kWide / 2);
    look_at(piece, level, hint, result);
  }

  void look_at(ShellPiece piece, double level, Hint& hint, Result& result) const {
    piece.from = std::max(piece.from, level);
    if (!(piece.from < piece.to) || (piece.vertex != kNone && leans(piece))) return;
    for (std::size_t k = 0; k < piece.count; ++k) piece.columns[k].top = piece.to;
    if (is_held(piece.in_use(), {piece.from, piece.to, piece.slack}, hint)) return;
    const double gap = hint.gap;
    const MeanNormal axis = mean_normal(piece.in_use());
    if (cut_where_nearest(piece, axis) && is_held_below_tops(piece, hint)) return;
    if (is_shallow(piece, level)) return;
    if (!(gap < 0)) look_for_boundary(piece, axis, hint, result.found);
    piece.cell = hint.cell;
    result.open.push_back(piece);
  }

  // Whether one cell contains all places of these columns between the two depths.
  bool is_held(std::span<const NormalColumn> columns, const Depths& depths, Hint& hint) const {
    Point middle = Point::Zero();
    for (const NormalColumn& column : columns) middle += column.foot + depths.from * column.inward;
    middle /= static_cast<double>(columns.size());
    const auto all_in = [&](const auto& holds) {
      return std::all_of(columns.begin(), columns.end(), [&](const NormalColumn& column) {
        return holds(Point(column.foot + depths.from * column.inward)) &&
               holds(Point(column.foot + depths.to * column.inward));
      });
    };
    return holds_all(middle, depths.slack, hint, all_in);
  }

  // Searches for a ball or a cell near `middle` for which all_in(holds) is true.
  template <class AllIn>
  bool holds_all(const Point& middle, double slack, Hint& hint, const AllIn& all_in) const {
    auto near = reconstruction_.nearest_in(hint.cell, middle);
    const auto tried = [&] {
      if (!(near.distance < 0)) return false;
      return all_in([&](const Point& place) { return (place - near.ball.center).norm() < near.ball.radius - slack; }) ||
             all_in([&](const Point& place) { return reconstruction_.distance_to_cell(near.cell, place, 0) < -slack; });
    };
    if (tried()) return true;
    near = reconstruction_.nearest_from(near, middle, -std::numeric_limits<double>::infinity());
    hint.gap = near.distance;
    if (near.cell == hint.cell) return false;
    hint.cell = near.cell;
    return tried();
  }

  // The same for places up to the depth at which another place of the surface is nearer than the foot.
  bool is_held_below_tops(const ShellPiece& piece, Hint& hint) const {
    std::array<Point, kMaxShellCorners> corners;
    const std::size_t count = corners_of(piece, corners.data());
    if (count == 0) return true;
    Point middle = Point::Zero();
    for (std::size_t i = 0; i < count; ++i) middle += corners[i];
    middle /= static_cast<double>(count);
    return holds_all(middle, piece.slack, hint, [&](const auto& holds) {
      return std::all_of(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count), holds);
    });
  }

  // Shrinks a ball at the middle of a piece until it is empty. The last place that stopped it is q, at which the piece
  // is cut.
  bool cut_where_nearest(ShellPiece& piece, const MeanNormal& axis) const {
    NormalColumn middle{Point::Zero(), axis.direction};
    for (const NormalColumn& column : piece.in_use()) middle.foot += column.foot / static_cast<double>(piece.count);
    std::span<NormalColumn, 1> single(&middle, 1);
    middle.top = piece.to;
    bool found = false;
    for (int k = 0; k < kTouches; ++k) {
      const NormalColumn before = middle;
      const ClosestPoint other =
          surface_.closest_within(middle.foot + middle.top * middle.inward, (1 - kSameDepth) * middle.top);
      if (other.triangle == kNone || !cut_at(single, other.position) || !(middle.top < before.top)) break;
      std::array<NormalColumn, 4> columns = piece.columns;
      std::span<NormalColumn> in_use(columns.data(), piece.count);
      if (!cut_at(in_use, other.position)) break;
      piece.columns = columns;
      found = true;
    }
    return found;
  }

  // Whether no place of a piece is deeper than `level`. The depth of its middle shows that, since depth is 1-Lipschitz,
  // or the distance from a triangle, which is a convex function. This is often so along a sharp edge with flat faces
  // around it, and beyond such an edge.
  bool is_shallow(const ShellPiece& piece, double level) const {
    std::array<Point, 8> corners;
    std::size_t count = 0;
    Point middle = Point::Zero();
    // All columns are extended to the depth of the deepest one. Otherwise, the hull of their ends would be too small
    // where some columns go beyond piece.to.
    const double to = max_depth(piece);
    for (const NormalColumn& column : piece.in_use()) {
      for (const double depth : {piece.from, to}) middle += corners[count++] = column.foot + depth * column.inward;
    }
    middle /= static_cast<double>(count);
    double reach = 0;
    for (std::size_t i = 0; i < count; ++i) reach = std::max(reach, (corners[i] - middle).norm());
    ClosestPoint nearest;
    if (reach + piece.slack - surface_.signed_distance(middle, nearest) < level) return true;
    const auto triangle = surface_.corners(nearest.triangle);
    return std::all_of(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count), [&](const Point& corner) {
      return closest_point_of_triangle(corner, triangle[0], triangle[1], triangle[2]).distance + piece.slack < level;
    });
  }

  // Looks for a place of the boundary below the middle of a piece that is deeper than the best one.
  void look_for_boundary(const ShellPiece& piece, const MeanNormal& axis, const Hint& hint, SearchedMax& found) const {
    Point place = Point::Zero();
    for (const NormalColumn& column : piece.in_use()) place += column.foot / static_cast<double>(piece.count);
    place += piece.from * axis.direction;
    // From outside, the nearest place of the reconstruction is on its boundary at every step.
    const double arrived = accuracy_ * kShellArrived;
    for (int step = 1;; ++step) {
      const auto near = reconstruction_.nearest_from(reconstruction_.nearest_in(hint.cell, place), place, 0);
      if (!(near.distance > 0)) return;
      if (near.distance < arrived || step == kMaxShellSteps) {
        take_boundary(place, near, found);
        return;
      }
      place += near.distance * axis.direction;
    }
  }

  void take_boundary(const Point& from, const Reconstruction::Nearest& near, SearchedMax& found) const {
    const Vector way = from - near.ball.center;
    const double length = way.norm();
    if (!(near.distance >= 0 && length > 0)) return;
    const Point place = near.ball.center + near.ball.radius / length * way;
    const double depth = -surface_.signed_distance(place);
    if (depth > std::max(found.max, found_.max)) found = {.max = depth, .upper = 0, .place = place, .ball = near.ball};
  }

  const Surface& surface_;
  const Reconstruction& reconstruction_;
  const double accuracy_, deepest_;
  const std::size_t max_pieces_;  // the maximum number of pieces on all levels together
  double rounding_ = 0;           // the rounding error of coordinates
  SearchedMax found_;
};

}  // namespace

SearchedMax max_shell_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double deepest,
                           double accuracy, Index max_pieces) {
  return ShellSearch(surface, reconstruction, known, deepest, accuracy, max_pieces).run();
}

}  // namespace orchard::detail
