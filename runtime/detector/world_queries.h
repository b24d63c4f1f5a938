#pragma once
#include "detector/sample_states.h"
#include "detector/sphere_tree.h"

namespace orchard::runtime::detail {

// Answers queries by ray, by nearest point and by overlap about all parts of all bodies and half-spaces, at the last
// step. It uses a tree of the parts' spheres, which is rebuilt at the first query after a change.
class WorldQueries {
 public:
  WorldQueries(const World& world, const StateSampler& sampler) noexcept : world_(world), sampler_(sampler) {}

  std::optional<WorldPoint> cast_ray(const Ray& ray, const QueryFilter& filter);
  std::optional<WorldPoint> nearest(const Vec3& point, double limit, const QueryFilter& filter);
  std::span<const BodyId> touching_sphere(const Vec3& center, double radius, const QueryFilter& filter);
  std::size_t memory_bytes() const noexcept {
    return tree_.memory_bytes() + bytes_of(poses_, asked_, answers_, found_);
  }

 private:
  // A part of a body, or a half-space, whose pose does not matter.
  struct Target {
    const Body& body;
    std::uint32_t part = 0;
    const Shape& shape;
    Pose pose{};
  };
  void find_poses();
  void update();  // rebuilds the tree from the world at the last step, unless it is up to date
  template <typename Bound, typename Most, typename Use>
  void each_target(const QueryFilter& filter, const Bound& bound, const Most& most, const Use& use);
  template <typename Most, typename Use>
  void each_near(const QueryFilter& filter, const Vec3& to, const Most& most, const Use& use);

  const World& world_;
  const StateSampler& sampler_;
  Step at_ = kNotAsked;
  std::uint64_t changes_ = 0;
  SphereTree tree_;
  std::vector<Pose> poses_;  // by body
  std::vector<BodyIndex> asked_;
  std::vector<BodyState> answers_;
  std::vector<BodyId> found_;
};

}  // namespace orchard::runtime::detail
