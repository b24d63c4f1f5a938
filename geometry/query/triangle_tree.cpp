#include "triangle_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "sort_indices.h"
#include "triangle_tree_builder.h"

namespace orchard::detail {
namespace {

// The number of triangles from which on the tree is larger than the caches, so that disks save more time than they
// cost.
constexpr std::size_t kFine = 32'768;
// Every float result has an error below kDistanceSlack * (distance + size of the mesh). There are at most thirteen
// roundings of 6e-8, of the query, of stored values and of three products each; the constant has a margin of one half.
constexpr float kDistanceSlack = 1.25e-6f;
// A fraction of the coordinates of the mesh: more than the rounding of subtracting and adding the centre.
constexpr double kBoxRoom = 0x1p-48;

// Returns the largest squared float distance of a box or triangle that may be nearer than one at the float distance d,
// given the errors of both.
float squared_limit(float d) {
  const float limit = d * (1 + 2 * kDistanceSlack) + 2 * kDistanceSlack;
  return limit * limit;
}

Float4 clamp_unit(Float4 x) { return min(max(x, broadcast(0)), broadcast(1)); }

// Returns a number whose bit k says whether x[k] is at most the limit.
unsigned at_most(Float4 x, float limit) {
#ifdef __SSE__
  return static_cast<unsigned>(__builtin_ia32_movmskps((Float4)(x <= broadcast(limit))));
#else
  unsigned bits = 0;
  for (int k = 0; k < 4; ++k) bits |= (x[k] <= limit ? 1u : 0u) << k;
  return bits;
#endif
}

bool better(const ClosestPoint& a, const ClosestPoint& b) {
  return a.distance < b.distance || (a.distance == b.distance && a.triangle < b.triangle);
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : mesh_(mesh), is_fine_(mesh.triangles.size() >= kFine) {
  Box box;
  for (const auto& corners : mesh.triangles)
    for (const Index v : corners) box.extend(mesh.vertices[v]);
  center_ = box.min() + 0.5 * (box.max() - box.min());
  const double size = (box.max() - box.min()).maxCoeff();
  if (size > 0) scale_ = std::ldexp(1.0, -std::ilogb(size) - 2);  // the diagonal is below 0.87
  Builder(mesh, center_, scale_, nodes_, leaves_).run();
}

bool TriangleTree::localize(const Point& point, Query& query) const {
  const Point local = scale_ * (point - center_);
  if (!(local.cwiseAbs().maxCoeff() < 1e15)) return false;  // its square would not be a float
  for (int axis = 0; axis < 3; ++axis) query.p[axis] = broadcast(static_cast<float>(local[axis]));
  return true;
}

// Returns lower bounds on the squared distances of the children. For children beyond the squared `limit`, they need not
// be tight.
Float4 TriangleTree::squared_distances(const Query& query, const Node& node, float limit) const {
  Float4 d[3];
  for (int axis = 0; axis < 3; ++axis)
    d[axis] = max(max(node.lower[axis] - query.p[axis], query.p[axis] - node.upper[axis]), broadcast(0));
  const Float4 along = dot(query.p, node.normal);
  const Float4 beyond = max(max(node.low - along, along - node.high), broadcast(0));
  const Float4 squared = max(dot(d, d), beyond * beyond);
  if (!is_fine_ || at_most(squared, limit) == 0) return squared;
  Float4 across[3];
  for (int axis = 0; axis < 3; ++axis) across[axis] = query.p[axis] - middle(node, axis);
  const Float4 above = dot(across, node.normal);
  for (int axis = 0; axis < 3; ++axis) across[axis] -= above * node.normal[axis];
  const Float4 beside = max(square_root(dot(across, across)) - node.radius, broadcast(0));
  return max(squared, beyond * beyond + beside * beside);
}

Float4 TriangleTree::squared_distances(const Query& query, const Leaf& leaf) {
  const Float4 d[3] = {query.p[0] - leaf.origin[0], query.p[1] - leaf.origin[1], query.p[2] - leaf.origin[2]};
  const Float4 x = dot(d, leaf.u), y = dot(d, leaf.v), z = dot(d, leaf.n);
  const Float4 zero = broadcast(0);
  const Float4 beyond = x - leaf.base, back = leaf.foot - leaf.base;

  const Float4 off_base = x - min(max(x, zero), leaf.base);
  Float4 squared = off_base * off_base + y * y;
  const auto to_edge = [&](Float4 px, Float4 ex, Float4 inverse) {
    const Float4 t = clamp_unit((px * ex + y * leaf.height) * inverse);
    const Float4 dx = px - t * ex, dy = y - t * leaf.height;
    return dx * dx + dy * dy;
  };
  squared = min(squared, to_edge(x, leaf.foot, leaf.inverse_left));
  squared = min(squared, to_edge(beyond, back, leaf.inverse_right));
  const auto within = (y > zero) & (leaf.height * x > leaf.foot * y) & (leaf.height * beyond < back * y);
  return (within ? zero : squared) + z * z;
}

// Prefetches a child that is pushed onto the stack, because it is visited soon.
void TriangleTree::prefetch(Index child) const {
  const bool is_leaf = child >= Builder::kLeaf;
  const char* at = is_leaf ? reinterpret_cast<const char*>(&leaves_[child - Builder::kLeaf])
                           : reinterpret_cast<const char*>(&nodes_[child]);
  for (std::size_t line = 0; line < (is_leaf ? sizeof(Leaf) : sizeof(Node)); line += 64) __builtin_prefetch(at + line);
}

// Calls visit(leaf) for every leaf that may contain something within the squared `limit`, roughly the nearest first.
// Leaves below a child for which is_out(node, lane) is true are left out. visit() may lower the limit.
template <class Visit, class IsOut>
void TriangleTree::visit_leaves(const Query& query, const float& limit, Visit visit, IsOut is_out) const {
  struct Entry {
    float squared;
    Index child;
  };
  std::array<Entry, Builder::kStackSize> stack;
  int top = 0;
  stack[static_cast<std::size_t>(top++)] = {0, 0};
  while (top > 0) {
    const Entry entry = stack[static_cast<std::size_t>(--top)];
    if (entry.squared > limit) continue;
    if (entry.child >= Builder::kLeaf) {
      visit(leaves_[entry.child - Builder::kLeaf]);
      continue;
    }
    const Node& node = nodes_[entry.child];
    const Float4 squared = squared_distances(query, node, limit);
    const int first = top;
    for (unsigned bits = at_most(squared, limit); bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      if (is_out(node, k)) continue;
      int at = top++;
      for (; at > first && stack[static_cast<std::size_t>(at - 1)].squared < squared[k]; --at)
        stack[static_cast<std::size_t>(at)] = stack[static_cast<std::size_t>(at - 1)];
      stack[static_cast<std::size_t>(at)] = {squared[k], node.child[k]};
      if (is_fine_) prefetch(node.child[k]);
    }
  }
}

template <class Visit>
void TriangleTree::visit_leaves(const Query& query, const float& limit, Visit visit) const {
  visit_leaves(query, limit, visit, [](const Node&, int) { return false; });
}

std::array<Point, 3> TriangleTree::corners(Index triangle) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
}

ClosestPoint TriangleTree::measure(const Point& query, Index triangle) const {
  const auto [a, b, c] = corners(triangle);
  ClosestPoint result = closest_point_of_triangle(query, a, b, c);
  result.triangle = triangle;
  return result;
}

// Triangles that may be nearest by their float distances. They are measured exactly when the traversal ends, or when
// there is no room for more.
class TriangleTree::Candidates {
 public:
  Candidates(const TriangleTree& tree, const Point& query) : tree_(tree), query_(query) {
    best_.distance = std::numeric_limits<double>::infinity();
  }
  float limit = std::numeric_limits<float>::max();

  void add(float squared, Index triangle) {
    if (squared < nearest_) {
      nearest_ = squared;
      limit = squared_limit(std::sqrt(squared));
    }
    if (count_ == entries_.size()) make_room();
    entries_[count_++] = {squared, triangle};
  }
  void list(NearestTriangles& nearest) const {
    nearest.count = 0;
    nearest.complete = !measured_some_;
    for (std::size_t i = 0; i < count_ && nearest.complete; ++i) {
      if (entries_[i].squared > limit) continue;
      nearest.complete = nearest.count < nearest.triangles.size();
      if (nearest.complete) nearest.triangles[nearest.count++] = entries_[i].triangle;
    }
  }
  const ClosestPoint& best() {
    for (std::size_t i = 0; i < count_; ++i) {
      if (entries_[i].squared > limit) continue;
      const ClosestPoint candidate = tree_.measure(query_, entries_[i].triangle);
      if (better(candidate, best_)) best_ = candidate;
    }
    return best_;
  }

 private:
  struct Entry {
    float squared;
    Index triangle;
  };
  void make_room() {
    const auto end =
        std::remove_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.squared > limit; });
    count_ = static_cast<std::size_t>(end - entries_.begin());
    if (2 * count_ < entries_.size()) return;
    best();
    measured_some_ = true;
    count_ = 0;
  }
  const TriangleTree& tree_;
  const Point& query_;
  ClosestPoint best_;
  float nearest_ = std::numeric_limits<float>::max();
  std::array<Entry, 64> entries_;
  std::size_t count_ = 0;
  bool measured_some_ = false;  // whether some were measured and dropped
};

void TriangleTree::find_candidates(const Point& point, Candidates& candidates) const {
  Query query;
  if (localize(point, query)) {
    visit_leaves(query, candidates.limit, [&](const Leaf& leaf) {
      const Float4 squared = squared_distances(query, leaf);
      for (unsigned bits = at_most(squared, candidates.limit); bits != 0; bits &= bits - 1) {
        const int k = std::countr_zero(bits);
        if (squared[k] <= candidates.limit && leaf.triangle[k] != kNone) candidates.add(squared[k], leaf.triangle[k]);
      }
    });
  } else {
    for (Index t = 0; t < mesh_.triangles.size(); ++t) candidates.add(0, t);
  }
}

ClosestPoint TriangleTree::closest(const Point& point) const {
  Candidates candidates(*this, point);
  find_candidates(point, candidates);
  return candidates.best();
}

ClosestPoint TriangleTree::closest(const Point& point, NearestTriangles& nearest) const {
  Candidates candidates(*this, point);
  find_candidates(point, candidates);
  candidates.list(nearest);
  return candidates.best();
}

ClosestPoint TriangleTree::closest_within(const Point& point, double distance) const {
  ClosestPoint none{.position = Point::Zero(), .distance = std::numeric_limits<double>::infinity()};
  if (!(distance >= 0)) return none;
  Candidates candidates(*this, point);
  const double radius = scale_ * distance;
  if (radius < 1e15) candidates.limit = squared_limit(static_cast<float>(radius));
  find_candidates(point, candidates);
  const ClosestPoint& best = candidates.best();
  return best.distance <= distance ? best : none;
}

void TriangleTree::visit_nearest(const Point& point, const std::function<double(Index)>& visit) const {
  Query query;
  if (!localize(point, query)) {
    for (Index t = 0; t < mesh_.triangles.size(); ++t) visit(t);
    return;
  }
  float limit = std::numeric_limits<float>::max();
  visit_leaves(query, limit, [&](const Leaf& leaf) {
    const Float4 squared = squared_distances(query, leaf);
    for (int k = 0; k < 4; ++k) {
      if (!(squared[k] <= limit) || leaf.triangle[k] == kNone) continue;
      const double radius = scale_ * visit(leaf.triangle[k]);
      if (radius < 1e15) limit = squared_limit(static_cast<float>(radius));
    }
  });
}

// Returns the box of a child in the frame of the mesh, with a margin for the roundings of both conversions.
Box TriangleTree::box_around(const Node& node, int lane) const {
  Point lower, upper;
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = center_[axis] + double{node.lower[axis][lane]} / scale_;
    upper[axis] = center_[axis] + double{node.upper[axis][lane]} / scale_;
  }
  const Vector room = Vector::Constant(kBoxRoom * (center_.cwiseAbs().maxCoeff() + 1 / scale_));
  return {lower - room, upper + room};
}

template <class IsOut>
void TriangleTree::near_where(const Sphere& ball, IsOut is_out, std::vector<Index>& out) const {
  out.clear();
  const auto add_if_near = [&](Index triangle) {
    if (measure(ball.center, triangle).distance <= ball.radius) out.push_back(triangle);
  };
  Query query;
  const double radius = scale_ * ball.radius;
  if (radius < 1e15 && localize(ball.center, query)) {
    const float limit = squared_limit(static_cast<float>(radius));
    const float sure = static_cast<float>(radius) * (1 - 4 * kDistanceSlack) - 4 * kDistanceSlack;
    const float sure_squared = sure > 0 ? sure * sure : -1.0f;
    const auto visit = [&](const Leaf& leaf) {
      const Float4 squared = squared_distances(query, leaf);
      for (int k = 0; k < 4; ++k) {
        if (squared[k] > limit || leaf.triangle[k] == kNone) continue;
        if (squared[k] <= sure_squared)
          out.push_back(leaf.triangle[k]);
        else
          add_if_near(leaf.triangle[k]);
      }
    };
    visit_leaves(query, limit, visit, is_out);
    sort_indices(out);
  } else {
    for (Index t = 0; t < mesh_.triangles.size(); ++t) add_if_near(t);
  }
}

void TriangleTree::near(const Sphere& ball, std::vector<Index>& out) const {
  near_where(
      ball, [](const Node&, int) { return false; }, out);
}

void TriangleTree::near(const Sphere& ball, const std::function<bool(const Box&)>& is_out,
                        std::vector<Index>& out) const {
  near_where(
      ball, [&](const Node& node, int lane) { return is_out(box_around(node, lane)); }, out);
}

}  // namespace orchard::detail
