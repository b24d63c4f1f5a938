#include "triangle_tree_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace orchard::detail {
namespace {

constexpr int kBins = 16;
constexpr Index kLeafSize = 4;
// Below this depth, ranges are halved by number, which bounds the depth of the tree.
constexpr int kDepthOfHalving = 20;

float half_area(const Eigen::AlignedBox3f& box) {
  const Eigen::Vector3f s = box.sizes();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}
Index groups(Index count) { return (count + kLeafSize - 1) / kLeafSize; }

// An orthonormal frame whose first axis is along the longest edge and whose second axis points from it to the apex, and
// the corners in this frame. It works for needles and points, too.
struct Flattened {
  Point origin;
  Vector u = Vector::UnitX(), v = Vector::UnitY();
  double base = 0, foot = 0, height = 0;

  explicit Flattened(std::array<Point, 3> corners) {
    const auto length = [&](std::size_t i) { return (corners[(i + 1) % 3] - corners[i]).squaredNorm(); };
    std::size_t longest = 0;
    for (const std::size_t i : {1u, 2u})
      if (length(i) > length(longest)) longest = i;
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(longest), corners.end());
    origin = corners[0];
    const Vector edge = corners[1] - origin, side = corners[2] - origin;
    base = edge.norm();
    if (base > 0) u = edge / base;
    foot = side.dot(u);
    Vector up = side - foot * u;
    up -= up.dot(u) * u;
    height = up.norm();
    const Vector other = std::abs(u.x()) < 0.5 ? Vector::UnitX() : Vector::UnitY();
    v = height > 1e-14 * base ? Vector(up / height) : u.cross(other).normalized();
  }
};

}  // namespace

TriangleTree::Builder::Builder(const TriangleMesh& mesh, const Point& center, double scale, std::vector<Node>& nodes,
                               std::vector<Leaf>& leaves)
    : mesh_(mesh), center_(center), scale_(scale), nodes_(nodes), leaves_(leaves) {}

void TriangleTree::Builder::run() {
  const std::size_t count = mesh_.triangles.size();
  order_.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    Item& item = order_[t];
    item.triangle = static_cast<Index>(t);
    for (const Index vertex : mesh_.triangles[t]) {
      const Point p = scale_ * (mesh_.vertices[vertex] - center_);
      item.box.extend(p.unaryExpr([](double x) { return rounded_down(x); }).cast<float>());
      item.box.extend(p.unaryExpr([](double x) { return rounded_up(x); }).cast<float>());
    }
    item.center = item.box.center();
  }
  leaves_.reserve(count / 2 + 1);
  add_node({0, static_cast<Index>(count)}, 0);
}

TriangleTree::Builder::Box3f TriangleTree::Builder::bounds(Range range) const {
  Box3f box;
  for (Index i = range.begin; i < range.end; ++i) box.extend(order_[i].box);
  return box;
}

Index TriangleTree::Builder::add_node(Range range, int depth) {
  std::array<Range, 4> parts{range};
  std::array<Box3f, 4> boxes{bounds(range)};
  std::size_t count = 1;
  while (count < 4) {
    std::size_t widest = 4;
    float widest_area = -1;
    for (std::size_t i = 0; i < count; ++i) {
      const float area = parts[i].size() > kLeafSize ? half_area(boxes[i]) : -1;
      if (area > widest_area) widest = i, widest_area = area;
    }
    if (widest == 4) break;
    const Index middle = split(parts[widest], depth);
    parts[count] = {middle, parts[widest].end};
    parts[widest].end = middle;
    for (const std::size_t changed : {widest, count}) boxes[changed] = bounds(parts[changed]);
    ++count;
  }

  const auto node = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  for (int axis = 0; axis < 3; ++axis) {
    nodes_[node].lower[axis] = broadcast(kFloatInfinity);
    nodes_[node].upper[axis] = -nodes_[node].lower[axis];
  }
  for (int k = 0; k < 4; ++k) nodes_[node].child[k] = kNone;
  for (Float4* zero : {&nodes_[node].normal[0], &nodes_[node].normal[1], &nodes_[node].normal[2], &nodes_[node].low,
                       &nodes_[node].high, &nodes_[node].radius})
    *zero = Float4{};
  for (std::size_t i = 0; i < count; ++i) {
    const Box3f& box = boxes[i];
    const Index child = parts[i].size() > kLeafSize ? add_node(parts[i], depth + 1) : add_leaf(parts[i]);
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[node].lower[axis][i] = box.min()[axis];
      nodes_[node].upper[axis][i] = box.max()[axis];
    }
    nodes_[node].child[i] = child;
    add_slab(parts[i], nodes_[node], i);
  }
  return node;
}

// Adds a slab across the mean normal, weighted by area, and a disk. Any direction makes a valid slab; if there is none,
// the slab excludes nothing.
void TriangleTree::Builder::add_slab(Range range, Node& node, std::size_t lane) const {
  Vector sum = Vector::Zero();
  for (Index i = range.begin; i < range.end; ++i) {
    const auto& [a, b, c] = mesh_.triangles[order_[i].triangle];
    const Point& p = mesh_.vertices[a];
    sum += (scale_ * (mesh_.vertices[b] - p)).cross(scale_ * (mesh_.vertices[c] - p));
  }
  const double length = sum.norm();
  const Eigen::Vector3f normal =
      length > 0 ? Eigen::Vector3f((sum / length).cast<float>()) : Eigen::Vector3f(Eigen::Vector3f::Zero());
  const Vector across = normal.cast<double>();
  Point middle;
  for (int axis = 0; axis < 3; ++axis) middle[axis] = TriangleTree::middle(node, axis)[lane];
  double low = std::numeric_limits<double>::infinity(), high = -low, squared = 0;
  for (Index i = range.begin; i < range.end; ++i) {
    for (const Index vertex : mesh_.triangles[order_[i].triangle]) {
      const Point place = scale_ * (mesh_.vertices[vertex] - center_);
      const double along = across.dot(place);
      low = std::min(low, along), high = std::max(high, along);
      const Vector offset = place - middle;
      squared = std::max(squared, (offset - across.dot(offset) * across).squaredNorm());
    }
  }
  for (int axis = 0; axis < 3; ++axis) node.normal[axis][lane] = normal[axis];
  node.low[lane] = rounded_down(low);
  node.high[lane] = rounded_up(high);
  node.radius[lane] = rounded_up(std::sqrt(squared));
}

int TriangleTree::Builder::bin_of(const Item& item, int axis, const Box3f& centers) {
  const float low = centers.min()[axis], width = centers.max()[axis] - low;
  return std::min(kBins - 1, static_cast<int>(kBins * ((item.center[axis] - low) / width)));
}

TriangleTree::Builder::Split TriangleTree::Builder::best_split(Range range, const Box3f& centers) const {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(centers.sizes()[axis] > 0)) continue;
    std::array<Box3f, kBins> boxes;
    std::array<Index, kBins> counts{};
    for (Index i = range.begin; i < range.end; ++i) {
      const auto bin = static_cast<std::size_t>(bin_of(order_[i], axis, centers));
      boxes[bin].extend(order_[i].box);
      ++counts[bin];
    }
    std::array<float, kBins> above{};
    Box3f box;
    Index count = 0;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
      box.extend(boxes[bin]);
      count += counts[bin];
      above[bin] = count > 0 ? half_area(box) * static_cast<float>(groups(count)) : -1;
    }
    box.setEmpty();
    count = 0;
    for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
      box.extend(boxes[bin]);
      count += counts[bin];
      if (count == 0 || above[bin + 1] < 0) continue;
      const float cost = half_area(box) * static_cast<float>(groups(count)) + above[bin + 1];
      if (best.axis < 0 || cost < best.cost) best = {axis, static_cast<int>(bin), cost};
    }
  }
  return best;
}

// Reorders the range so that its halves are [begin, result) and [result, end), both not empty.
Index TriangleTree::Builder::split(Range range, int depth) {
  Box3f centers;
  for (Index i = range.begin; i < range.end; ++i) centers.extend(order_[i].center);
  const auto begin = order_.begin() + range.begin, end = order_.begin() + range.end;
  const Split best = depth < kDepthOfHalving ? best_split(range, centers) : Split{};
  if (best.axis >= 0) {
    const auto middle =
        std::partition(begin, end, [&](const Item& item) { return bin_of(item, best.axis, centers) <= best.bin; });
    return static_cast<Index>(middle - order_.begin());
  }
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const Index middle = range.begin + range.size() / 2;
  std::nth_element(begin, order_.begin() + middle, end,
                   [&](const Item& a, const Item& b) { return a.center[axis] < b.center[axis]; });
  return middle;
}

Index TriangleTree::Builder::add_leaf(Range range) {
  Leaf leaf{};
  for (int k = 0; k < 4; ++k) leaf.triangle[k] = kNone;
  for (Index i = range.begin; i < range.end; ++i) flatten(order_[i].triangle, leaf, static_cast<int>(i - range.begin));
  leaves_.push_back(leaf);
  return kLeaf + static_cast<Index>(leaves_.size() - 1);
}

void TriangleTree::Builder::flatten(Index triangle, Leaf& leaf, int lane) const {
  const auto& corners = mesh_.triangles[triangle];
  const auto local = [&](Index vertex) { return Point(scale_ * (mesh_.vertices[vertex] - center_)); };
  const Flattened flat({local(corners[0]), local(corners[1]), local(corners[2])});
  const Vector n = flat.u.cross(flat.v);
  for (int axis = 0; axis < 3; ++axis) {
    leaf.origin[axis][lane] = static_cast<float>(flat.origin[axis]);
    leaf.u[axis][lane] = static_cast<float>(flat.u[axis]);
    leaf.v[axis][lane] = static_cast<float>(flat.v[axis]);
    leaf.n[axis][lane] = static_cast<float>(n[axis]);
  }
  const double left = flat.foot * flat.foot + flat.height * flat.height;
  const double right = (flat.foot - flat.base) * (flat.foot - flat.base) + flat.height * flat.height;
  const auto inverse = [](double x) { return x > 1e-30 ? static_cast<float>(1 / x) : 0.0f; };
  leaf.base[lane] = static_cast<float>(flat.base);
  leaf.foot[lane] = static_cast<float>(flat.foot);
  leaf.height[lane] = static_cast<float>(flat.height);
  leaf.inverse_left[lane] = inverse(left);
  leaf.inverse_right[lane] = inverse(right);
  leaf.triangle[lane] = triangle;
}

}  // namespace orchard::detail
