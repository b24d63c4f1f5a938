#include "support_tree.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <bit>
#include <utility>

namespace orchard::detail {
namespace {

using Float4 = float __attribute__((vector_size(16)));

constexpr float kSupportSlack = 1e-5f;  // a bound has some forty rounding errors of 6e-8 in numbers of about 1
constexpr double kFar = 1e12;           // over the size of the tree: beyond this distance, squares may overflow floats
constexpr float kNoFloat = 1e18f;       // used in place of larger numbers

Float4 broadcast(float x) { return Float4{x, x, x, x}; }
Float4 abs(Float4 x) { return x < broadcast(0) ? -x : x; }
Float4 square_root(Float4 a) { return Float4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }

// Returns a mask whose bit k is set if x[k] is below the limit or is not a number. At the middle of a box there is no
// direction to the query, and so there is no bound.
unsigned below(Float4 x, float limit) {
  const auto is_below = ~(x >= broadcast(limit));
#ifdef __SSE__
  return static_cast<unsigned>(__builtin_ia32_movmskps((Float4)is_below));
#else
  unsigned bits = 0;
  for (int k = 0; k < 4; ++k) bits |= (is_below[k] != 0 ? 1u : 0u) << k;
  return bits;
#endif
}

}  // namespace

// Builds the tree. It halves the items along the longest axis, and each half along its own longest axis, so that a node
// has four children. Up to four items become children of a node themselves.
class SupportTree::Builder {
 public:
  explicit Builder(SupportTree& tree) : tree_(tree), balls_(tree.items_.size()), order_(tree.items_.size()) {
    for (Index i = 0; i < order_.size(); ++i) {
      std::transform(tree.items_[i].begin(), tree.items_[i].end(), balls_[i].begin(), [&](const Sphere& ball) {
        const Point local = tree.scale_ * (ball.center - tree.center_);
        return Eigen::Vector4d(local.x(), local.y(), local.z(), tree.scale_ * ball.radius);
      });
      order_[i].number = i;
    }
  }

  void run() {
    const auto count = static_cast<Index>(order_.size());
    build(0, count, box_of(0, count));
    std::vector<Item> sorted;
    sorted.reserve(count);
    tree_.numbers_.reserve(count);
    for (const Entry& entry : order_) {
      sorted.push_back(tree_.items_[entry.number]);
      tree_.numbers_.push_back(entry.number);
    }
    tree_.items_ = std::move(sorted);
  }

 private:
  using Balls = std::array<Eigen::Vector4d, 3>;
  struct Entry {  // an item while it is sorted; it is small, because sorting moves it
    double along = 0;
    Index number = 0;
  };
  struct Box {  // the columns are the half axes
    Eigen::Vector4d middle;
    Eigen::Matrix4d half_axes;
  };

  // The box of a single item lies in the plane of its three balls, along the longest side. Its other two half axes are
  // zero.
  static Box box_of(Balls balls) {
    const auto squared = [&](std::size_t k) { return (balls[(k + 1) % 3] - balls[k]).squaredNorm(); };
    std::size_t longest = 0;
    for (const std::size_t k : {1u, 2u})
      if (squared(k) > squared(longest)) longest = k;
    std::rotate(balls.begin(), balls.begin() + static_cast<std::ptrdiff_t>(longest), balls.end());
    Box box{balls[0], Eigen::Matrix4d::Zero()};
    const Eigen::Vector4d side = balls[1] - balls[0], other = balls[2] - balls[0];
    const double length = side.squaredNorm();
    if (!(length > 0)) return box;
    const double foot = std::clamp(other.dot(side) / length, 0.0, 1.0);
    const Eigen::Vector4d up = other - foot * side;
    box.half_axes.col(0) = 0.5 * side;
    box.half_axes.col(1) = 0.5 * up;
    box.middle += 0.5 * (side + up);
    return box;
  }

  // Returns the axes of the plane of one item with a normal. They suit few items well, since these lie in nearly one
  // plane.
  Eigen::Matrix4d axes_of_first(Index first) const {
    const Balls& balls = balls_at(first);
    Eigen::Matrix<double, 4, 2> sides;
    sides << balls[1] - balls[0], balls[2] - balls[0];
    return Eigen::HouseholderQR<Eigen::Matrix<double, 4, 2>>(sides).householderQ();
  }

  Eigen::Matrix4d main_axes(Index first, Index count) const {
    const Eigen::Vector4d origin = balls_at(first)[0];
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    Eigen::Matrix4d spread = Eigen::Matrix4d::Zero();
    for (Index i = first; i < first + count; ++i) {
      for (const Eigen::Vector4d& ball : balls_at(i)) {
        const Eigen::Vector4d way = ball - origin;
        sum += way;
        spread.noalias() += way * way.transpose();
      }
    }
    spread -= sum * sum.transpose() / (3.0 * count);
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(spread).eigenvectors();
  }

  Box box_of(Index first, Index count) const {
    if (count == 1) return box_of(balls_at(first));
    const auto visit = [&](const auto& look_at) {
      for (Index i = first; i < first + count; ++i) {
        for (const Eigen::Vector4d& ball : balls_at(i)) look_at(ball);
      }
    };
    const Eigen::Vector4d origin = balls_at(first)[0];
    const Eigen::Matrix4d axes = count <= 4 ? axes_of_first(first) : main_axes(first, count);
    Eigen::Vector4d low = Eigen::Vector4d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    visit([&](const Eigen::Vector4d& ball) {
      const Eigen::Vector4d place = axes.transpose() * (ball - origin);
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    });
    return {origin + axes * (0.5 * (low + high)), axes * (0.5 * (high - low)).asDiagonal()};
  }

  // Returns how many items go into the first half. Nodes of items are filled completely, so that there are as few nodes
  // as possible.
  static Index half_of(Index count) { return std::min(count, (count / 2 + 2) / 4 * 4); }

  // Reorders a range so that the items of its first half come first along the longest of the axes. Returns the size of
  // that half.
  Index halve(Index first, Index count, const Eigen::Matrix4d& axes) {
    const Index half = half_of(count);
    if (half == 0 || half == count) return half;
    Eigen::Vector4d low = Eigen::Vector4d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    const auto place = [&](Index i) -> Eigen::Vector4d {
      const Balls& balls = balls_at(i);
      return balls[0] + balls[1] + balls[2];
    };
    for (Index i = first; i < first + count; ++i) {
      const Eigen::Vector4d along = axes.transpose() * place(i);
      low = low.cwiseMin(along);
      high = high.cwiseMax(along);
    }
    // The extent along an axis also grows with the length of the axis vector.
    int longest = 0;
    (high - low).cwiseQuotient(axes.colwise().norm().transpose().cwiseMax(1e-300)).maxCoeff(&longest);
    const Eigen::Vector4d along = axes.col(longest);
    for (Index i = first; i < first + count; ++i) order_[i].along = along.dot(place(i));
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [](const Entry& a, const Entry& b) {
      return a.along != b.along ? a.along < b.along : a.number < b.number;
    });
    return half;
  }

  Index build(Index first, Index count, const Box& box) {
    const auto at = static_cast<Index>(tree_.nodes_.size());
    tree_.nodes_.emplace_back(Node{});
    std::array<Index, 5> begin{first, first, first, first, first + count};
    if (count <= 4) {
      for (Index k = 0; k < 4; ++k) begin[k] = first + std::min(k, count);
    } else {
      begin[2] = first + halve(first, count, box.half_axes);
      for (const Index k : {0u, 2u}) begin[k + 1] = begin[k] + halve(begin[k], begin[k + 2] - begin[k], box.half_axes);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const Index size = begin[k + 1] - begin[k];
      tree_.nodes_[at].child[k] = kNone;
      if (size == 0) continue;
      const Box child = box_of(begin[k], size);
      const Index number = size == 1 ? kItem + begin[k] : build(begin[k], size, child);
      put(child, number, tree_.nodes_[at], k);
    }
    return at;
  }

  static void put(const Box& box, Index child, Node& node, std::size_t lane) {
    for (int row = 0; row < 4; ++row) {
      node.middle[row][lane] = static_cast<float>(box.middle[row]);
      for (int column = 0; column < 4; ++column)
        node.half_axes[column][row][lane] = static_cast<float>(box.half_axes(row, column));
    }
    node.child[lane] = child;
  }

  const Balls& balls_at(Index i) const { return balls_[order_[i].number]; }

  SupportTree& tree_;
  std::vector<Balls> balls_;  // the balls of each item, in the units of the tree
  std::vector<Entry> order_;
};

SupportTree::SupportTree(std::vector<Item> items) : items_(std::move(items)) {
  if (items_.empty()) return;
  Eigen::AlignedBox3d centers;
  double size = 0;
  for (const Item& item : items_) {
    for (const Sphere& ball : item) {
      centers.extend(ball.center);
      size = std::max(size, std::abs(ball.radius));
    }
  }
  center_ = centers.center();
  size = std::max(size, centers.sizes().maxCoeff());
  if (size > 0) scale_ = std::ldexp(1.0, -std::ilogb(size) - 1);
  Builder builder(*this);
  nodes_.reserve(items_.size() * 5 / 12 + 1);  // the largest possible number of nodes
  builder.run();
}

SupportTree::Query SupportTree::localized(const Point& query) const {
  const Point local = scale_ * (query - center_);
  const double size = local.cwiseAbs().maxCoeff();
  Query result;
  for (int axis = 0; axis < 3; ++axis) result.place[axis] = broadcast(static_cast<float>(local[axis]));
  result.slack = size < kFar ? kSupportSlack * (1 + static_cast<float>(size)) : std::numeric_limits<float>::infinity();
  return result;
}

float SupportTree::limit_of(double value) const {
  const double local = scale_ * value;
  return local < kFar ? static_cast<float>(local) : kNoFloat;
}

// Loads a child into the cache, because it is visited soon after it has been pushed.
void SupportTree::prefetch(Index child) const {
  const bool is_item = child >= kItem;
  const char* at =
      is_item ? reinterpret_cast<const char*>(&items_[child - kItem]) : reinterpret_cast<const char*>(&nodes_[child]);
  for (std::size_t line = 0; line < (is_item ? sizeof(Item) : sizeof(Node)); line += 64) __builtin_prefetch(at + line);
}

// Pushes the children so that the nearest one is popped first.
void SupportTree::push_children(const Node& node, const Query& query, float limit, Entry* stack,
                                std::size_t& size) const {
  const Float4 x = query.place[0] - node.middle[0], y = query.place[1] - node.middle[1],
               z = query.place[2] - node.middle[2];
  const Float4 length = square_root(x * x + y * y + z * z);
  const Float4 inverse = broadcast(1) / length;
  const Float4 u = x * inverse, v = y * inverse, w = z * inverse;
  Float4 added = broadcast(query.slack);
  for (const Float4* half_axis : {node.half_axes[0], node.half_axes[1], node.half_axes[2], node.half_axes[3]})
    added += abs(u * half_axis[0] + v * half_axis[1] + w * half_axis[2] + half_axis[3]);
  const Float4 bounds = length - node.middle[3] - added;
  const std::size_t first = size;
  for (unsigned bits = below(bounds, limit); bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    if (node.child[k] == kNone) continue;
    const float bound = bounds[k] < limit ? bounds[k] : -std::numeric_limits<float>::infinity();
    std::size_t at = size++;
    for (; at > first && stack[at - 1].bound < bound; --at) stack[at] = stack[at - 1];
    stack[at] = {bound, node.child[k]};
    prefetch(node.child[k]);
  }
}

}  // namespace orchard::detail
