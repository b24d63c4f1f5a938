#include "rival.h"

#ifdef ORCHARD_HAS_BULLET
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#endif

namespace orchard::bench {

#ifdef ORCHARD_HAS_BULLET
namespace {

class Body {
 public:
  explicit Body(const runtime::TreeView& tree) {
    for (const auto& t : tree.triangles) {
      btVector3 corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = tree.vertices[t[k]];
        const auto at = [&](std::size_t i) { return static_cast<btScalar>(double{v[i]} + tree.origin[i]); };
        corner[k] = btVector3(at(0), at(1), at(2));
      }
      mesh_.addTriangle(corner[0], corner[1], corner[2]);
    }
    shape_ = std::make_unique<btGImpactMeshShape>(&mesh_);
    shape_->setMargin(0);
    shape_->updateBound();
    object.setCollisionShape(shape_.get());
  }
  btCollisionObject object;
  const btBvhTriangleMeshShape& bvh() {
    if (!bvh_) bvh_ = std::make_unique<btBvhTriangleMeshShape>(&mesh_, true);
    return *bvh_;
  }

 private:
  std::unique_ptr<btBvhTriangleMeshShape> bvh_;
  btTriangleMesh mesh_;
  std::unique_ptr<btGImpactMeshShape> shape_;
};

struct AnyContact final : btCollisionWorld::ContactResultCallback {
  bool found = false;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    found = found || point.getDistance() <= 0;
    return 0;
  }
};

struct AllContacts final : btCollisionWorld::ContactResultCallback {
  ResponseSum sum;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    const btVector3& n = point.m_normalWorldOnB;
    sum.add({double{n.x()}, double{n.y()}, double{n.z()}}, -double{point.getDistance()});
    return 0;
  }
};

class Bullet final : public PairRival {
 public:
  Bullet(const runtime::TreeView& a, const runtime::TreeView& b)
      : dispatcher_(&configuration_), world_(&dispatcher_, &broad_phase_, &configuration_), a_(a), b_(b) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    // contactPairTest() looks among the algorithms for closest points, where GImpact does not register itself.
    dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE, GIMPACT_SHAPE_PROXYTYPE, &create_);
  }
  std::string name() const override { return "Bullet, GImpact"; }
  void place(const std::vector<Query>& queries) override {
    poses_.clear();
    for (const Query& q : queries) poses_.emplace_back(transform_of(q.a), transform_of(q.b));
  }
  bool collide(std::size_t query) override {
    a_.object.setWorldTransform(poses_[query].first);
    b_.object.setWorldTransform(poses_[query].second);
    AnyContact contact;
    world_.contactPairTest(&a_.object, &b_.object, contact);
    return contact.found;
  }

  bool finds_contacts() const override { return true; }
  std::size_t contacts(std::size_t query) override { return response(query).count; }
  ContactResponse response(std::size_t query) override {
    a_.object.setWorldTransform(poses_[query].first);
    b_.object.setWorldTransform(poses_[query].second);
    AllContacts contacts;
    world_.contactPairTest(&a_.object, &b_.object, contacts);
    return contacts.sum.result();
  }
  bool casts_rays() const override { return true; }
  double cast_ray(const std::array<double, 3>& from, const std::array<double, 3>& to) override {
    const auto vector = [](const std::array<double, 3>& v) {
      return btVector3(static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2]));
    };
    const btVector3 p = vector(from), q = vector(to);
    btCollisionWorld::ClosestRayResultCallback result(p, q);
    btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), p),
                                    btTransform(btQuaternion::getIdentity(), q), &still_, &a_.bvh(),
                                    btTransform::getIdentity(), result);
    return result.hasHit() ? static_cast<double>(result.m_closestHitFraction) : 1;
  }

 private:
  btCollisionObject still_;
  static btTransform transform_of(const runtime::Pose& pose) {
    const auto r = [&pose](std::size_t i) { return static_cast<btScalar>(pose.rotation[i]); };
    const auto t = [&pose](std::size_t i) { return static_cast<btScalar>(pose.translation[i]); };
    return btTransform(btMatrix3x3(r(0), r(1), r(2), r(3), r(4), r(5), r(6), r(7), r(8)), btVector3(t(0), t(1), t(2)));
  }
  btGImpactCollisionAlgorithm::CreateFunc create_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btCollisionWorld world_;
  Body a_, b_;
  std::vector<std::pair<btTransform, btTransform>> poses_;
};

}  // namespace

std::unique_ptr<PairRival> bullet(const runtime::TreeView& a, const runtime::TreeView& b) {
  return std::make_unique<Bullet>(a, b);
}
#else
std::unique_ptr<PairRival> bullet(const runtime::TreeView&, const runtime::TreeView&) { return nullptr; }
#endif

}  // namespace orchard::bench
