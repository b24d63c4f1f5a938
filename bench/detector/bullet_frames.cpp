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
    world_.setForceUpdateAllAabbs(false);  // what is static stays as it is
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const std::size_t first = parts_.size();
      for (std::size_t k = 0; k < scene.bodies[i].parts.size(); ++k) {
        Part& part = parts_.emplace_back(Part{i, k, std::make_unique<btCollisionObject>()});
        part.stays = stays(scene.bodies[i]);
        const std::size_t shape = scene.bodies[i].parts[k];
        const double scale = scene.poses[0][i].scale * scene.local(0, i, k).scale;
        auto& made = shapes_[{shape, scale}];
        if (!made) made = shape_of(scene.shapes[shape], btScalar(scale));
        part.object->setCollisionShape(made.get());
        part.object->setUserIndex(static_cast<int>(i));
        for (std::size_t other = first; other + 1 < parts_.size(); ++other) {
          part.object->setIgnoreCollisionCheck(parts_[other].object.get(), true);
          parts_[other].object->setIgnoreCollisionCheck(part.object.get(), true);
        }
        if (!scene.bodies[i].is_static) continue;
        part.object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
        part.object->setActivationState(ISLAND_SLEEPING);
      }
    }
    for (const auto& plane : scene.planes) {
      plane_shapes_.push_back(std::make_unique<btStaticPlaneShape>(
          btVector3(btScalar(plane.normal[0]), btScalar(plane.normal[1]), btScalar(plane.normal[2])),
          btScalar(plane.offset)));
      planes_.push_back(std::make_unique<btCollisionObject>());
      planes_.back()->setCollisionShape(plane_shapes_.back().get());
      planes_.back()->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
      planes_.back()->setUserIndex(static_cast<int>(scene.bodies.size() + planes_.size() - 1));
      add(*planes_.back(), true);
    }
  }
  std::string name() const override { return "Bullet"; }

  std::size_t step(int step) override {
    for (Part& part : parts_) {
      if (part.in && part.stays) continue;
      move(part, step);
    }
    world_.performDiscreteCollisionDetection();
    std::set<std::pair<int, int>> touching;  // a pair of bodies may have several manifolds
    for (int k = 0; k < dispatcher_.getNumManifolds(); ++k) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(k);
      for (int p = 0; p < manifold->getNumContacts(); ++p) {
        if (manifold->getContactPoint(p).getDistance() > 0) continue;
        touching.insert(std::minmax(manifold->getBody0()->getUserIndex(), manifold->getBody1()->getUserIndex()));
      }
    }
    return touching.size();
  }

 private:
  struct Part {
    std::size_t body, part;
    std::unique_ptr<btCollisionObject> object;
    bool in = false, stays = false;
  };

  void add(btCollisionObject& object, bool is_static) {
    using Filter = btBroadphaseProxy;
    if (is_static)
      world_.addCollisionObject(&object, Filter::StaticFilter, Filter::AllFilter ^ Filter::StaticFilter);
    else
      world_.addCollisionObject(&object);
  }

  void move(Part& part, int step) {
    const auto& body = scene_.bodies[part.body];
    const bool there = body.birth <= step && step < body.death;
    if (there && !(part.in && body.is_static)) part.object->setWorldTransform(transform_of(part, step));
    if (there && !part.in) add(*part.object, body.is_static);
    if (!there && part.in) world_.removeCollisionObject(part.object.get());
    part.in = there;
  }

  std::unique_ptr<btCollisionShape> shape_of(const SceneShape& shape, btScalar scale) {
    const auto vector = [scale](const runtime::Vec3& v) {
      return btVector3(btScalar(v[0]) * scale, btScalar(v[1]) * scale, btScalar(v[2]) * scale);
    };
    if (shape.kind == SceneShape::Kind::box) return std::make_unique<btBoxShape>(vector(shape.p));
    if (shape.kind == SceneShape::Kind::round) {  // the scenes' capsules lie along x
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

  btTransform transform_of(const Part& part, int step) const {
    runtime::Pose pose = scene_.poses[static_cast<std::size_t>(step)][part.body];
    if (scene_.joints(part.body) > 0) pose = compose(pose, scene_.local(step, part.body, part.part));
    const SceneShape& shape = scene_.shapes[scene_.bodies[part.body].parts[part.part]];
    if (shape.kind == SceneShape::Kind::round) pose.translation = transform(pose, 0.5 * (shape.p + shape.q));
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
  std::vector<Part> parts_;
  std::vector<std::unique_ptr<btCollisionObject>> planes_;
};

}  // namespace

std::unique_ptr<FrameRival> bullet_frames(const Scene& scene) { return std::make_unique<BulletFrames>(scene); }
#else
std::unique_ptr<FrameRival> bullet_frames(const runtime::test::Scene&) { return nullptr; }
#endif

}  // namespace orchard::bench
