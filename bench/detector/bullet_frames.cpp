#include "frame_rival.h"

#ifdef ORCHARD_HAS_BULLET
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <map>
#include <set>
#endif

namespace orchard::bench {

#ifdef ORCHARD_HAS_BULLET
namespace {

using runtime::test::Scene;
using runtime::test::SceneShape;

class BulletFrames final : public FrameRival {
 public:
  explicit BulletFrames(const Scene& scene)
      : scene_(scene), dispatcher_(&configuration_), world_(&dispatcher_, &broad_phase_, &configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      auto& object = objects_.emplace_back(std::make_unique<btCollisionObject>());
      auto& made = shapes_[{scene.bodies[i].parts[0], scene.poses[0][i].scale}];
      if (!made) made = shape_of(scene.shapes[scene.bodies[i].parts[0]], btScalar(scene.poses[0][i].scale));
      object->setCollisionShape(made.get());
      if (scene.bodies[i].is_static) object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    }
    for (const auto& plane : scene.planes) {
      plane_shapes_.push_back(std::make_unique<btStaticPlaneShape>(
          btVector3(btScalar(plane.normal[0]), btScalar(plane.normal[1]), btScalar(plane.normal[2])),
          btScalar(plane.offset)));
      planes_.push_back(std::make_unique<btCollisionObject>());
      planes_.back()->setCollisionShape(plane_shapes_.back().get());
      planes_.back()->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
      world_.addCollisionObject(planes_.back().get());
    }
    in_.resize(objects_.size());
  }
  std::string name() const override { return "Bullet"; }

  std::size_t step(int step) override {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const auto& body = scene_.bodies[i];
      const bool there = body.birth <= step && step < body.death;
      if (there) objects_[i]->setWorldTransform(transform_of(scene_.poses[static_cast<std::size_t>(step)][i]));
      if (there && !in_[i]) world_.addCollisionObject(objects_[i].get());
      if (!there && in_[i]) world_.removeCollisionObject(objects_[i].get());
      in_[i] = there;
    }
    world_.performDiscreteCollisionDetection();
    std::set<std::pair<const void*, const void*>> touching;  // a pair of meshes may have several manifolds
    for (int k = 0; k < dispatcher_.getNumManifolds(); ++k) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(k);
      for (int p = 0; p < manifold->getNumContacts(); ++p) {
        if (manifold->getContactPoint(p).getDistance() > 0) continue;
        touching.insert(std::minmax<const void*>(manifold->getBody0(), manifold->getBody1()));
      }
    }
    return touching.size();
  }

 private:
  std::unique_ptr<btCollisionShape> shape_of(const SceneShape& shape, btScalar scale) {
    const auto vector = [scale](const runtime::Vec3& v) {
      return btVector3(btScalar(v[0]) * scale, btScalar(v[1]) * scale, btScalar(v[2]) * scale);
    };
    if (shape.kind == SceneShape::Kind::box) return std::make_unique<btBoxShape>(vector(shape.p));
    if (shape.kind == SceneShape::Kind::round) {  // the scenes' capsules lie along x around the origin
      const btScalar length = (vector(shape.q) - vector(shape.p)).length(), radius = btScalar(shape.radius) * scale;
      if (length == 0) return std::make_unique<btSphereShape>(radius);
      return std::make_unique<btCapsuleShapeX>(radius, length);
    }
    auto& mesh = meshes_.emplace_back(std::make_unique<btTriangleMesh>());
    for (const auto& t : shape.tree.triangles) {
      btVector3 corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = shape.tree.vertices[t[k]];
        corner[k] = vector({double{v[0]} + shape.tree.origin[0], double{v[1]} + shape.tree.origin[1],
                            double{v[2]} + shape.tree.origin[2]});
      }
      mesh->addTriangle(corner[0], corner[1], corner[2]);
    }
    auto result = std::make_unique<btGImpactMeshShape>(mesh.get());
    result->setMargin(0);
    result->updateBound();
    return result;
  }

  static btTransform transform_of(const runtime::Pose& pose) {
    const auto r = [&pose](std::size_t i) { return static_cast<btScalar>(pose.rotation[i]); };
    const auto t = [&pose](std::size_t i) { return static_cast<btScalar>(pose.translation[i]); };
    return btTransform(btMatrix3x3(r(0), r(1), r(2), r(3), r(4), r(5), r(6), r(7), r(8)), btVector3(t(0), t(1), t(2)));
  }

  const Scene& scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btCollisionWorld world_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::map<std::pair<std::size_t, double>, std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btStaticPlaneShape>> plane_shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_, planes_;
  std::vector<bool> in_;
};

}  // namespace

std::unique_ptr<FrameRival> bullet_frames(const Scene& scene) { return std::make_unique<BulletFrames>(scene); }
#else
std::unique_ptr<FrameRival> bullet_frames(const runtime::test::Scene&) { return nullptr; }
#endif

}  // namespace orchard::bench
