#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include "rivals.h"

namespace orchard::bench {
namespace {

class FclTree final : public Rival {
 public:
  FclTree(const std::vector<Vec3>& positions, const std::vector<double>& radii) : positions_(positions), radii_(radii) {
    for (BodyIndex i = 0; i < positions.size(); ++i) {
      objects_.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Sphered>(radii[i])));
      objects_.back()->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
    }
    move();
    std::vector<fcl::CollisionObjectd*> all;
    for (const auto& object : objects_) all.push_back(object.get());
    manager_.registerObjects(all);
    manager_.setup();
  }

  void find(std::vector<BodyPair>& pairs) override {
    move();
    manager_.update();
    Found found{this, &pairs};
    manager_.collide(&found, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
      const Found& f = *static_cast<Found*>(data);
      const auto i = static_cast<BodyIndex>(reinterpret_cast<std::uintptr_t>(a->getUserData()));
      const auto j = static_cast<BodyIndex>(reinterpret_cast<std::uintptr_t>(b->getUserData()));
      const Vec3 apart = runtime::operator-(f.tree->positions_[j], f.tree->positions_[i]);
      const double reach = f.tree->radii_[i] + f.tree->radii_[j];
      if (runtime::dot(apart, apart) <= reach * reach) f.pairs->push_back({std::min(i, j), std::max(i, j)});
      return false;
    });
  }

 private:
  struct Found {
    FclTree* tree;
    std::vector<BodyPair>* pairs;
  };
  void move() {
    for (BodyIndex i = 0; i < positions_.size(); ++i) {
      const Vec3& p = positions_[i];
      objects_[i]->setTranslation({p[0], p[1], p[2]});
      objects_[i]->computeAABB();
    }
  }

  const std::vector<Vec3>& positions_;
  const std::vector<double>& radii_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

}  // namespace

std::unique_ptr<Rival> fcl_tree(const std::vector<Vec3>& positions, const std::vector<double>& radii) {
  return std::make_unique<FclTree>(positions, radii);
}

}  // namespace orchard::bench
