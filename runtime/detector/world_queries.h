#pragma once
#include "detector/world.h"

namespace orchard::runtime::detail {

// Rays, nearest points and overlaps among all parts of all bodies at one time: a tree of boxes around the parts'
// spheres, built when the first question is asked after a change.
class WorldQueries {
 public:
  // The world as of the last step. Nothing is built where it is still the one of the last call.
  void update(const World& world);
  std::optional<WorldPoint> cast_ray(const World& world, const Ray& ray, const QueryFilter& filter);
  std::optional<WorldPoint> nearest(const World& world, const Vec3& point, double limit, const QueryFilter& filter);
  std::span<const BodyId> touching_sphere(const World& world, const Vec3& center, double radius,
                                          const QueryFilter& filter);
  std::size_t memory_bytes() const noexcept { return bytes_of(parts_, nodes_, poses_, asked_, answers_, found_); }

 private:
  struct Part {
    Vec3 center{};
    double reach = 0;
    BodyIndex body = kNoIndex;
    std::uint32_t part = 0;
  };
  struct Node {
    Vec3 low{}, high{};
    std::uint32_t begin = 0, end = 0;  // of parts_; a leaf
    std::uint32_t second = 0;          // the node of its other half, its first one being the next node; 0: a leaf
  };
  void find_poses(const World& world);
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);
  Pose pose_of(const World& world, const Part& part) const noexcept;
  // visit(part) for the parts in boxes for which bound(node), a lower bound on what is looked for, is at most most().
  template <typename Bound, typename Most, typename Visit>
  void walk(const Bound& bound, const Most& most, const Visit& visit) const;

  Step at_ = kNotAsked;
  std::uint64_t changes_ = 0;
  std::vector<Part> parts_;
  std::vector<Node> nodes_;
  std::vector<Pose> poses_;  // by body
  std::vector<BodyIndex> asked_;
  std::vector<BodyState> answers_;
  std::vector<BodyId> found_;
};

}  // namespace orchard::runtime::detail
