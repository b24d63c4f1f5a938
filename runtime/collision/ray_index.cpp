#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/kernels/ray_block.h"
#include "collision/ray_walk.h"
#include "orchard/runtime/shape_query.h"

// The boxes of a ray index are computed from the leaves up: the box of a node contains all triangles below it.
namespace orchard::runtime {
namespace {

constexpr double kOutward = 1 + 0x1p-23;  // a factor above the rounding to float

struct Box {
  std::array<float, 3> low, high;

  double diagonal() const noexcept { return length(Vec3(high[0], high[1], high[2]) - Vec3(low[0], low[1], low[2])); }
};

float least(const BoxBlock::Lanes& lanes) noexcept { return *std::min_element(lanes.begin(), lanes.end()); }
float most(const BoxBlock::Lanes& lanes) noexcept { return *std::max_element(lanes.begin(), lanes.end()); }

Box box_of(const TriangleBlock& leaf) noexcept {  // lanes without a triangle repeat the first one
  Box box{};
  for (std::size_t i = 0; i < 3; ++i) {
    box.low[i] = std::min({least(leaf.corner[0][i]), least(leaf.corner[1][i]), least(leaf.corner[2][i])});
    box.high[i] = std::max({most(leaf.corner[0][i]), most(leaf.corner[1][i]), most(leaf.corner[2][i])});
  }
  return box;
}

Box box_of(const BoxBlock& block) noexcept {
  Box box{};
  for (std::size_t i = 0; i < 3; ++i) box.low[i] = least(block.low[i]), box.high[i] = most(block.high[i]);
  return box;
}

}  // namespace

RayIndex::RayIndex(const TreeView& tree) : origin_(tree.origin), bounding_radius_(tree.bounding_radius) {
  if (tree.triangles.empty()) return;
  const detail::Ball ball = detail::ball_around(tree);
  middle_ = ball.middle, radius_ = ball.radius;
  PackedSphereTree aligned;
  aligned.vertices.assign(tree.vertices.begin(), tree.vertices.end());
  aligned.triangles.assign(tree.triangles.begin(), tree.triangles.end());
  detail::index_for_rays(aligned);
  leaves_ = std::move(aligned.triangle_blocks);
  leaves_.shrink_to_fit();
  for (const TriangleBlock& leaf : leaves_) sizes_.push_back(static_cast<float>(box_of(leaf).diagonal() * kOutward));
  constexpr float kBeyond = std::numeric_limits<float>::infinity();
  boxes_.resize(aligned.obb_nodes.size());
  for (std::size_t b = boxes_.size(); b-- > 0;) {  // children come after their parents
    BoxBlock& block = boxes_[b];
    block.child = aligned.obb_nodes[b].child;
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      const std::uint32_t child = block.child[lane];
      Box box{{kBeyond, kBeyond, kBeyond}, {-kBeyond, -kBeyond, -kBeyond}};
      if (aligned.obb_nodes[b].radius[lane] >= 0) {
        box = child & kLeafBit ? box_of(leaves_[child & ~kLeafBit]) : box_of(boxes_[child]);
      }
      for (std::size_t i = 0; i < 3; ++i) block.low[i][lane] = box.low[i], block.high[i][lane] = box.high[i];
    }
  }
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
