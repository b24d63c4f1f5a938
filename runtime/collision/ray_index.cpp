#include "orchard/runtime/shape_query.h"

#include "collision/kernels/ray_block.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace orchard::runtime {
namespace {

constexpr float kBeyond = std::numeric_limits<float>::infinity();
// Levels below which parts are halved by number: 31 more are enough for every count, and kTriangleTreeDepthLimit is 64.
constexpr std::uint32_t kCostlyDepth = 32;

constexpr double kOutward = 1 + 0x1p-23;  // more than what rounding to float takes away

struct Box {
  std::array<float, 3> low = {kBeyond, kBeyond, kBeyond}, high = {-kBeyond, -kBeyond, -kBeyond};

  void add(const Box& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], other.low[i]), high[i] = std::max(high[i], other.high[i]);
    }
  }
  float diagonal() const {  // not less than it is
    const double x = double{high[0]} - low[0], y = double{high[1]} - low[1], z = double{high[2]} - low[2];
    return static_cast<float>(std::sqrt(x * x + y * y + z * z) * kOutward);
  }
  double half_area() const {
    const double x = double{high[0]} - low[0], y = double{high[1]} - low[1], z = double{high[2]} - low[2];
    return x * y + y * z + z * x;
  }
};

struct Part {
  std::size_t begin, end;
  std::size_t size() const { return end - begin; }
};

// Top down, in two where the boxes of both parts, times what it costs to look into them, are smallest (MacDonald and
// Booth 1990), along each of the axes; the widest parts of a node again until there are eight.
class Builder {
 public:
  Builder(const TreeView& tree, std::vector<BoxBlock>& boxes, std::vector<TriangleBlock>& leaves,
          std::vector<float>& sizes)
      : tree_(tree),
        boxes_(boxes),
        leaves_(leaves),
        sizes_(sizes),
        box_(tree.triangles.size()),
        first_(tree.triangles.size()) {
    const std::size_t count = tree.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
      for (const std::uint32_t corner : tree.triangles[t]) box_[t].add({tree.vertices[corner], tree.vertices[corner]});
    }
    behind_.resize(count), moved_.resize(count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<std::uint32_t>& order = order_[axis];
      order.resize(count);
      for (std::size_t t = 0; t < count; ++t) order[t] = static_cast<std::uint32_t>(t);
      const auto middle = [&](std::uint32_t t) { return double{box_[t].low[axis]} + box_[t].high[axis]; };
      std::sort(order.begin(), order.end(),
                [&](std::uint32_t p, std::uint32_t q) { return std::tuple(middle(p), p) < std::tuple(middle(q), q); });
    }
  }

  void build() {
    if (box_.empty()) return;
    struct Open {
      Part part;
      std::size_t block;
    };
    std::vector<Open> level, next;
    boxes_.emplace_back();
    level.push_back({{0, box_.size()}, 0});
    for (; !level.empty(); ++depth_, level.swap(next)) {
      next.clear();
      for (const Open& node : level) {
        const std::vector<Part> parts = split(node.part);
        for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
          const bool used = lane < parts.size();
          put_box(used ? box_of(parts[lane]) : Box{}, boxes_[node.block], lane);
          if (!used) continue;
          std::uint32_t child = kLeafBit | static_cast<std::uint32_t>(leaves_.size());
          if (parts[lane].size() <= kBlockWidth) {
            add_leaf(parts[lane]);
          } else {
            child = static_cast<std::uint32_t>(boxes_.size());
            next.push_back({parts[lane], boxes_.size()});
            boxes_.emplace_back();
          }
          boxes_[node.block].child[lane] = child;
        }
      }
    }
  }

 private:
  static void put_box(const Box& box, BoxBlock& block, std::uint32_t lane) {
    for (std::size_t i = 0; i < 3; ++i) block.low[i][lane] = box.low[i], block.high[i][lane] = box.high[i];
  }

  void add_leaf(const Part& part) {
    sizes_.push_back(box_of(part).diagonal());
    TriangleBlock& block = leaves_.emplace_back();
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      const bool used = lane < part.size();
      const std::uint32_t t = order_[0][part.begin + (used ? lane : 0)];
      block.triangle[lane] = used ? t : kNoTriangle;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) block.corner[k][i][lane] = tree_.vertices[tree_.triangles[t][k]][i];
      }
    }
  }

  Box box_of(const Part& part) const {
    Box box;
    for (std::size_t i = part.begin; i < part.end; ++i) box.add(box_[order_[0][i]]);
    return box;
  }

  std::vector<Part> split(const Part& whole) {
    std::vector<Part> parts = {whole};
    std::vector<double> areas = {0};  // -1 where a part is a leaf
    while (parts.size() < kBlockWidth) {
      if (parts.size() == 1 && whole.size() <= kBlockWidth) break;
      const auto widest = static_cast<std::size_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
      if (areas[widest] < 0) break;
      const Part part = parts[widest];
      const std::size_t middle = halve(part);
      parts[widest] = {part.begin, middle};
      parts.push_back({middle, part.end});
      areas[widest] = area_of(parts[widest]);
      areas.push_back(area_of(parts.back()));
    }
    return parts;
  }

  double area_of(const Part& part) const { return part.size() <= kBlockWidth ? -1 : box_of(part).half_area(); }

  // What it costs to look at so many triangles, in leaves of eight of which one in four lanes is empty.
  static double cost_of(std::size_t triangles) {
    const std::size_t lanes = (triangles + 3) / 4;
    return static_cast<double>(lanes);
  }

  // Puts the triangles of the first part to the front, in all three orders, and returns where the second one begins.
  std::size_t halve(const Part& part) {
    const std::size_t size = part.size();
    // cost, unevenness, axis, size of the first part
    std::tuple<double, std::size_t, std::size_t, std::size_t> best = {std::numeric_limits<double>::infinity(), 0, 0,
                                                                      size / 2};
    for (std::size_t axis = 0; axis < 3 && depth_ < kCostlyDepth; ++axis) {
      const std::uint32_t* const order = order_[axis].data() + part.begin;
      Box box;
      for (std::size_t i = size; i-- > 1;) {
        box.add(box_[order[i]]);
        behind_[i] = box.half_area() * cost_of(size - i);
      }
      box = {};
      for (std::size_t i = 1; i < size; ++i) {
        box.add(box_[order[i - 1]]);
        const double cost = box.half_area() * cost_of(i) + behind_[i];
        if (cost > std::get<0>(best)) continue;
        best = std::min(best, {cost, i > size / 2 ? i - size / 2 : size / 2 - i, axis, i});
      }
    }
    const std::size_t axis = std::get<2>(best), middle = part.begin + std::get<3>(best);
    for (std::size_t i = part.begin; i < part.end; ++i) first_[order_[axis][i]] = i < middle;
    for (std::size_t other = 0; other < 3; ++other) {
      if (other == axis) continue;
      std::uint32_t* const order = order_[other].data();
      std::size_t front = part.begin, back = 0;
      for (std::size_t i = part.begin; i < part.end; ++i) {
        if (first_[order[i]]) {
          order[front++] = order[i];
        } else {
          moved_[back++] = order[i];
        }
      }
      std::copy_n(moved_.begin(), back, order + front);
    }
    return middle;
  }

  const TreeView& tree_;
  std::vector<BoxBlock>& boxes_;
  std::vector<TriangleBlock>& leaves_;
  std::vector<float>& sizes_;
  std::uint32_t depth_ = 0;
  std::vector<Box> box_;                             // by triangle
  std::array<std::vector<std::uint32_t>, 3> order_;  // triangles along each axis, part by part
  std::vector<char> first_;                          // by triangle: of the first part
  std::vector<double> behind_;
  std::vector<std::uint32_t> moved_;
};

}  // namespace

RayIndex::RayIndex(const TreeView& tree) : origin_(tree.origin), bounding_radius_(tree.bounding_radius) {
  if (tree.triangles.empty()) return;
  const ObbNodeBlock& root = tree.obb_nodes[0];
  middle_ = {double{root.x[0]}, double{root.y[0]}, double{root.z[0]}};
  radius_ = double{root.radius[0]};
  Builder(tree, boxes_, leaves_, sizes_).build();
  boxes_.shrink_to_fit(), leaves_.shrink_to_fit(), sizes_.shrink_to_fit();
}

RayIndex::RayIndex() noexcept = default;
RayIndex::RayIndex(const RayIndex&) = default;
RayIndex::RayIndex(RayIndex&&) noexcept = default;
RayIndex& RayIndex::operator=(const RayIndex&) = default;
RayIndex& RayIndex::operator=(RayIndex&&) noexcept = default;
RayIndex::~RayIndex() = default;

std::size_t RayIndex::bytes() const noexcept {
  return boxes_.capacity() * sizeof(BoxBlock) + leaves_.capacity() * sizeof(TriangleBlock) +
         sizes_.capacity() * sizeof(float);
}

}  // namespace orchard::runtime
