// The rival that 7.2 left out: an octree of the space that two bodies share, built again at each call, with the
// triangles of either body that lie in each cell (Moore and Wilhelms 1988; Shaffer and Herb 1992 do so for many bodies:
// bench/broad_phase/moving_octree.h). Cells are isothetic in the first body's frame, which spares transforming half of
// the triangles, and are divided only while both bodies have triangles in them. Beyond it: bounding balls first.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "math/triangle_pair.h"
#include "rival.h"

namespace orchard::bench {
namespace {

using runtime::Vec3;
using runtime::detail::TrianglePoints;

constexpr std::size_t kFewPairs = 64;  // that are compared without dividing further
constexpr int kDeepest = 10;
constexpr double kRounding = 1e-9;  // of the lengths involved: triangles that nearly meet a cell count as in it

struct Box {
  Vec3 lower, upper;

  static Box nothing() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  }
  void extend(const Vec3& p) {
    for (std::size_t d = 0; d < 3; ++d) lower[d] = std::min(lower[d], p[d]), upper[d] = std::max(upper[d], p[d]);
  }
  bool meets(const Box& other) const {
    bool meet = true;
    for (std::size_t d = 0; d < 3; ++d) meet = meet && lower[d] <= other.upper[d] && other.lower[d] <= upper[d];
    return meet;
  }
};

struct Triangle {
  TrianglePoints points;
  Box box;
  Vec3 normal;  // of any length
  double offset;

  // Whether its box and its plane meet the box, but for roundings.
  bool meets(const Box& other) const {
    if (!box.meets(other)) return false;
    double height = -offset, reach = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      height += normal[d] * 0.5 * (other.lower[d] + other.upper[d]);
      reach += std::fabs(normal[d]) * 0.5 * (other.upper[d] - other.lower[d]);
    }
    return std::fabs(height) <= reach + kRounding * (std::fabs(offset) + reach);
  }
};

Triangle prepared(const TrianglePoints& points) {
  Triangle triangle{points, Box::nothing(), {}, 0};
  for (const Vec3& p : points) triangle.box.extend(p);
  const Vec3 u = points[1] - points[0], v = points[2] - points[0];
  triangle.normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  triangle.offset = dot(triangle.normal, points[0]);
  return triangle;
}

std::vector<TrianglePoints> triangles_of(const runtime::TreeView& tree) {
  std::vector<TrianglePoints> result;
  for (const auto& t : tree.triangles) {
    TrianglePoints points{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) points[k][i] = double{tree.vertices[t[k]][i]} + tree.origin[i];
    result.push_back(points);
  }
  return result;
}

class OctreePair final : public PairRival {
 public:
  OctreePair(const runtime::TreeView& a, const runtime::TreeView& b) : body_b_(triangles_of(b)) {
    for (const TrianglePoints& t : triangles_of(a)) {
      a_.push_back(prepared(t));
      for (const Vec3& p : t) box_a_.extend(p);
    }
    b_.resize(body_b_.size());
    center_a_ = center(a), radius_a_ = radius(a), center_b_ = center(b), radius_b_ = radius(b);
  }
  std::string name() const override { return "octree, rebuilt"; }
  void place(const std::vector<Query>& queries) override {
    poses_.clear();
    for (const Query& q : queries) poses_.push_back(runtime::compose(runtime::inverse(q.a), q.b));
  }
  bool collide(std::size_t query) override {
    const runtime::Pose& pose = poses_[query];
    const Vec3 apart = runtime::transform(pose, center_b_) - center_a_;
    if (dot(apart, apart) > (radius_a_ + radius_b_) * (radius_a_ + radius_b_)) return false;
    Box shared = Box::nothing();
    for (std::size_t i = 0; i < body_b_.size(); ++i) {
      TrianglePoints moved{};
      for (std::size_t k = 0; k < 3; ++k) moved[k] = runtime::transform(pose, body_b_[i][k]);
      b_[i] = prepared(moved);
      for (const Vec3& p : moved) shared.extend(p);
    }
    if (!shared.meets(box_a_)) return false;
    for (std::size_t d = 0; d < 3; ++d) {
      shared.lower[d] = std::max(shared.lower[d], box_a_.lower[d]);
      shared.upper[d] = std::min(shared.upper[d], box_a_.upper[d]);
    }
    in_cells_.clear();
    for (std::uint32_t i = 0; i < a_.size(); ++i)
      if (a_[i].box.meets(shared)) in_cells_.push_back(i);
    const std::size_t middle = in_cells_.size();
    for (std::uint32_t i = 0; i < b_.size(); ++i)
      if (b_[i].box.meets(shared)) in_cells_.push_back(i);
    return meet_in({shared, 0, middle, in_cells_.size()}, 0);
  }

 private:
  struct Cell {
    Box box;
    std::size_t begin, middle, end;  // in in_cells_: triangles of the first body, then of the second
  };
  static Vec3 center(const runtime::TreeView& tree) {
    const auto& root = tree.blocks[0];
    return {root.x[0] + tree.origin[0], root.y[0] + tree.origin[1], root.z[0] + tree.origin[2]};
  }
  static double radius(const runtime::TreeView& tree) { return double{tree.blocks[0].radius[0]} * (1 + 1e-9); }

  bool meet_in(const Cell& cell, int depth) {
    const std::size_t of_a = cell.middle - cell.begin, of_b = cell.end - cell.middle;
    if (of_a == 0 || of_b == 0) return false;
    if (of_a * of_b <= kFewPairs || depth == kDeepest) return compare(cell);
    const Vec3 middle = 0.5 * (cell.box.lower + cell.box.upper);
    std::array<Cell, 8> parts{};
    std::size_t pairs = 0;
    const std::size_t begin = in_cells_.size();
    for (unsigned part = 0; part < 8; ++part) {
      Box box = cell.box;
      for (unsigned d = 0; d < 3; ++d) (part >> d & 1 ? box.lower : box.upper)[d] = middle[d];
      parts[part] = filtered(cell, box);
      pairs += (parts[part].middle - parts[part].begin) * (parts[part].end - parts[part].middle);
    }
    // Where most triangles are in most parts, dividing costs more than it saves.
    bool meet = false;
    if (pairs >= of_a * of_b) {
      meet = compare(cell);
    } else {
      for (const Cell& part : parts) meet = meet || meet_in(part, depth + 1);
    }
    in_cells_.resize(begin);
    return meet;
  }

  // Cells are closed, so that no contact falls between two.
  Cell filtered(const Cell& cell, const Box& box) {
    Cell child{box, in_cells_.size(), 0, 0};
    for (std::size_t k = cell.begin; k < cell.middle; ++k)
      if (a_[in_cells_[k]].meets(box)) in_cells_.push_back(in_cells_[k]);
    child.middle = in_cells_.size();
    if (child.middle == child.begin) return {box, child.begin, child.begin, child.begin};
    for (std::size_t k = cell.middle; k < cell.end; ++k)
      if (b_[in_cells_[k]].meets(box)) in_cells_.push_back(in_cells_[k]);
    child.end = in_cells_.size();
    return child;
  }

  // Pairs that share several cells are compared in each.
  bool compare(const Cell& cell) const {
    for (std::size_t i = cell.begin; i < cell.middle; ++i) {
      const Triangle& one = a_[in_cells_[i]];
      for (std::size_t k = cell.middle; k < cell.end; ++k) {
        const Triangle& other = b_[in_cells_[k]];
        if (!one.box.meets(other.box)) continue;
        if (runtime::detail::triangles_intersect(one.points, other.points, nullptr)) return true;
      }
    }
    return false;
  }

  std::vector<TrianglePoints> body_b_;
  std::vector<Triangle> a_, b_;  // the second body's as of the call, in the first one's frame
  Box box_a_ = Box::nothing();
  Vec3 center_a_{}, center_b_{};
  double radius_a_ = 0, radius_b_ = 0;
  std::vector<runtime::Pose> poses_;
  std::vector<std::uint32_t> in_cells_;  // of the cells from the root to the present one
};

}  // namespace

std::unique_ptr<PairRival> octree(const runtime::TreeView& a, const runtime::TreeView& b) {
  return std::make_unique<OctreePair>(a, b);
}

}  // namespace orchard::bench
