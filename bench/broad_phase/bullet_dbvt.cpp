#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include "rivals.h"

namespace orchard::bench {
namespace {

class BulletDbvt final : public Rival {
 public:
  BulletDbvt(const std::vector<Vec3>& positions, const std::vector<double>& radii)
      : positions_(positions), radii_(radii) {
    for (BodyIndex i = 0; i < positions.size(); ++i) {
      btVector3 low, high;
      box(i, low, high);
      proxies_.push_back(
          tree_.createProxy(low, high, 0, reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)), 1, 1, nullptr));
    }
  }
  ~BulletDbvt() override {
    for (btBroadphaseProxy* proxy : proxies_) tree_.destroyProxy(proxy, nullptr);
  }

  void find(std::vector<BodyPair>& pairs) override {
    for (BodyIndex i = 0; i < proxies_.size(); ++i) {
      btVector3 low, high;
      box(i, low, high);
      tree_.setAabb(proxies_[i], low, high, nullptr);
    }
    tree_.calculateOverlappingPairs(nullptr);
    btBroadphasePairArray& near = tree_.getOverlappingPairCache()->getOverlappingPairArray();
    for (int k = 0; k < near.size(); ++k) {
      const auto i = static_cast<BodyIndex>(reinterpret_cast<std::uintptr_t>(near[k].m_pProxy0->m_clientObject));
      const auto j = static_cast<BodyIndex>(reinterpret_cast<std::uintptr_t>(near[k].m_pProxy1->m_clientObject));
      const Vec3 apart = runtime::operator-(positions_[j], positions_[i]);
      const double reach = radii_[i] + radii_[j];
      if (runtime::dot(apart, apart) <= reach * reach) pairs.push_back({std::min(i, j), std::max(i, j)});
    }
  }

 private:
  void box(BodyIndex i, btVector3& low, btVector3& high) const {
    const auto at = [&](double side) {
      return btVector3(static_cast<btScalar>(positions_[i][0] + side * radii_[i]),
                       static_cast<btScalar>(positions_[i][1] + side * radii_[i]),
                       static_cast<btScalar>(positions_[i][2] + side * radii_[i]));
    };
    low = at(-1.001), high = at(1.001);  // its floats would lose pairs
  }

  const std::vector<Vec3>& positions_;
  const std::vector<double>& radii_;
  btDbvtBroadphase tree_;
  std::vector<btBroadphaseProxy*> proxies_;
};

}  // namespace

std::unique_ptr<Rival> bullet_dbvt(const std::vector<Vec3>& positions, const std::vector<double>& radii) {
  return std::make_unique<BulletDbvt>(positions, radii);
}

}  // namespace orchard::bench
