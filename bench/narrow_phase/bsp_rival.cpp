// The dissertation's baseline (7.2): a BSP-tree of one body, into which the other one's triangles are filtered
// (Thibault and Naylor 1987). Built by either of its heuristics: of the candidate faces, the one that most nearly
// balances those before and behind it partitions, or the one that splits the fewest others, where ties go to the better
// balance; it used the second. Beyond it: bounding balls first, of the bodies and of each triangle.
#include <algorithm>
#include <cmath>

#include "math/triangle_pair.h"
#include "rival.h"

namespace orchard::bench {
namespace {

using runtime::Vec3;
using runtime::detail::TrianglePoints;

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Plane {
  Vec3 normal;
  double offset;
  double height(const Vec3& p) const { return dot(normal, p) - offset; }
};

using Polygon = std::vector<Vec3>;

constexpr double kOnPlane = 1e-9;  // times the body's size: nearer corners count as on the plane
constexpr std::size_t kCandidates = 100;

struct Sides {
  bool front = false, back = false;
};

template <typename Points>
Sides sides(const Plane& plane, const Points& points, double tolerance) {
  Sides s;
  for (const Vec3& p : points) {
    const double h = plane.height(p);
    s.front = s.front || h > tolerance;
    s.back = s.back || h < -tolerance;
  }
  return s;
}

Polygon clipped(const Polygon& polygon, const Plane& plane, double sign) {  // the part where sign * height >= 0
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = sign * plane.height(p), hq = sign * plane.height(q);
    if (hp >= 0) result.push_back(p);
    if ((hp < 0) == (hq < 0)) continue;
    const double t = hp / (hp - hq);
    result.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])});
  }
  return result;
}

struct Face {
  Polygon polygon;
  std::uint32_t triangle;
};

struct Node {
  Plane plane;
  std::uint32_t first, count;  // triangles in the plane
  std::int32_t front = -1, back = -1;
};

class BspTree {
 public:
  BspTree(std::vector<TrianglePoints> triangles, double size, BspHeuristic heuristic)
      : triangles_(std::move(triangles)), heuristic_(heuristic), tolerance_(kOnPlane * size) {
    std::vector<Face> faces;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      planes_.push_back(plane_of(triangles_[t]));
      faces.push_back({{triangles_[t][0], triangles_[t][1], triangles_[t][2]}, t});
    }
    root_ = build(std::move(faces));
  }

  std::size_t size() const { return nodes_.size(); }

  bool meets(const TrianglePoints& triangle) const { return filter(root_, triangle, triangle); }

 private:
  static Plane plane_of(const TrianglePoints& t) {
    Vec3 n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    const double length = std::sqrt(dot(n, n));
    for (double& x : n) x = length > 0 ? x / length : 0;
    return {n, dot(n, t[0])};
  }

  std::uint32_t best_partitioner(const std::vector<Face>& faces) const {
    std::uint32_t best = faces[0].triangle;
    std::size_t fewest = faces.size() + 1, imbalance = 0;
    const std::size_t step = std::max<std::size_t>(1, faces.size() / kCandidates);
    for (std::size_t c = 0; c < faces.size(); c += step) {
      std::size_t splits = 0, front = 0, back = 0;
      for (const Face& face : faces) {
        const Sides s = sides(planes_[faces[c].triangle], face.polygon, tolerance_);
        splits += s.front && s.back;
        front += s.front, back += s.back;
        if (heuristic_ == BspHeuristic::fewest_splits && splits > fewest) break;
      }
      const std::size_t uneven = front > back ? front - back : back - front;
      const bool better = heuristic_ == BspHeuristic::fewest_splits
                              ? splits < fewest || (splits == fewest && uneven < imbalance)
                              : uneven < imbalance || (uneven == imbalance && splits < fewest);
      if (c == 0 || better) {
        best = faces[c].triangle, fewest = splits, imbalance = uneven;
      }
    }
    return best;
  }

  std::int32_t build(std::vector<Face> faces) {
    if (faces.empty()) return -1;
    const Plane plane = planes_[best_partitioner(faces)];
    std::vector<Face> front, back;
    Node node{plane, static_cast<std::uint32_t>(in_planes_.size()), 0, -1, -1};
    for (Face& face : faces) {
      const Sides s = sides(plane, face.polygon, tolerance_);
      if (!s.front && !s.back) {
        in_planes_.push_back(face.triangle);
        ++node.count;
      } else if (s.front && s.back) {
        front.push_back({clipped(face.polygon, plane, 1), face.triangle});
        back.push_back({clipped(face.polygon, plane, -1), face.triangle});
      } else {
        (s.front ? front : back).push_back(std::move(face));
      }
    }
    faces.clear();
    const auto index = nodes_.size();
    nodes_.push_back(node);
    const std::int32_t f = build(std::move(front)), b = build(std::move(back));
    nodes_[index].front = f, nodes_[index].back = b;
    return static_cast<std::int32_t>(index);
  }

  // `part` of the whole triangle lies in this node's cell.
  template <typename Points>
  bool filter(std::int32_t index, const Points& part, const TrianglePoints& whole) const {
    while (index >= 0) {
      const Node& node = nodes_[static_cast<std::size_t>(index)];
      const Sides s = sides(node.plane, part, tolerance_);
      if (s.front != s.back) {
        // A corner on the plane may touch a face in it.
        if (touches_plane(node.plane, part) && meets_faces(node, whole)) return true;
        index = s.front ? node.front : node.back;
        continue;
      }
      if (meets_faces(node, whole)) return true;
      if (!s.front) return filter(node.front, part, whole) || filter(node.back, part, whole);
      const Polygon polygon(part.begin(), part.end());
      if (filter(node.front, clipped(polygon, node.plane, 1), whole)) return true;
      return filter(node.back, clipped(polygon, node.plane, -1), whole);
    }
    return false;
  }

  template <typename Points>
  bool touches_plane(const Plane& plane, const Points& part) const {
    return std::any_of(part.begin(), part.end(),
                       [&](const Vec3& p) { return std::fabs(plane.height(p)) <= tolerance_; });
  }

  bool meets_faces(const Node& node, const TrianglePoints& whole) const {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (runtime::detail::triangles_intersect(triangles_[in_planes_[i]], whole, nullptr)) return true;
    }
    return false;
  }

  std::vector<TrianglePoints> triangles_;
  BspHeuristic heuristic_;
  std::vector<Plane> planes_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> in_planes_;
  double tolerance_;
  std::int32_t root_ = -1;
};

class Bsp final : public PairRival {
 public:
  Bsp(const runtime::TreeView& a, const runtime::TreeView& b, BspHeuristic heuristic)
      : b_(triangles_of(b)), heuristic_(heuristic), tree_(triangles_of(a), reach(a), heuristic) {
    ball_a_ = ball_of(a), ball_b_ = ball_of(b);
  }
  std::string name() const override {
    return heuristic_ == BspHeuristic::fewest_splits ? "BSP-tree, fewest splits" : "BSP-tree, balanced";
  }
  void place(const std::vector<Query>& queries) override {
    poses_.clear();
    for (const Query& q : queries) poses_.push_back(runtime::compose(runtime::inverse(q.a), q.b));
  }
  bool collide(std::size_t query) override {
    const runtime::Pose& pose = poses_[query];
    if (!near(runtime::transform(pose, ball_b_.center), ball_b_.radius)) return false;
    for (const TrianglePoints& t : b_) {
      TrianglePoints moved{};
      for (std::size_t k = 0; k < 3; ++k) moved[k] = runtime::transform(pose, t[k]);
      if (outside_ball(moved)) continue;
      if (tree_.meets(moved)) return true;
    }
    return false;
  }

 private:
  struct Ball {
    Vec3 center;
    double radius;
  };
  static Ball ball_of(const runtime::TreeView& tree) {
    const auto& root = tree.blocks[0];
    return {{root.x[0] + tree.origin[0], root.y[0] + tree.origin[1], root.z[0] + tree.origin[2]},
            double{root.radius[0]} * (1 + 1e-9)};
  }
  static double reach(const runtime::TreeView& tree) { return double{tree.blocks[0].radius[0]}; }
  static std::vector<TrianglePoints> triangles_of(const runtime::TreeView& tree) {
    std::vector<TrianglePoints> result;
    for (const auto& t : tree.triangles) {
      TrianglePoints points{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) points[k][i] = double{tree.vertices[t[k]][i]} + tree.origin[i];
      }
      result.push_back(points);
    }
    return result;
  }
  bool near(const Vec3& center, double radius) const {
    const Vec3 d = minus(center, ball_a_.center);
    return dot(d, d) <= (radius + ball_a_.radius) * (radius + ball_a_.radius);
  }
  bool outside_ball(const TrianglePoints& t) const {
    const Vec3 middle = {(t[0][0] + t[1][0] + t[2][0]) / 3, (t[0][1] + t[1][1] + t[2][1]) / 3,
                         (t[0][2] + t[1][2] + t[2][2]) / 3};
    double square = 0;
    for (const Vec3& p : t) square = std::max(square, dot(minus(p, middle), minus(p, middle)));
    return !near(middle, std::sqrt(square) * (1 + 1e-9));
  }

  std::vector<TrianglePoints> b_;
  BspHeuristic heuristic_;
  BspTree tree_;
  Ball ball_a_{}, ball_b_{};
  std::vector<runtime::Pose> poses_;
};

}  // namespace

std::unique_ptr<PairRival> bsp_trees(const runtime::TreeView& a, const runtime::TreeView& b, BspHeuristic heuristic) {
  return std::make_unique<Bsp>(a, b, heuristic);
}

}  // namespace orchard::bench
