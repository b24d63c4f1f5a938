#include "frame_rival.h"

#ifdef ORCHARD_HAS_FCL
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>

#include <map>
#endif

namespace orchard::bench {

#ifdef ORCHARD_HAS_FCL
namespace {

using runtime::test::Scene;
using runtime::test::SceneShape;

template <typename S>
class FclFrames final : public FrameRival {
 public:
  explicit FclFrames(const Scene& scene) : scene_(scene), objects_(scene.bodies.size()) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const std::size_t shape = scene.bodies[i].parts[0];
      auto& made = shapes_[{shape, scene.poses[0][i].scale}];
      if (!made) made = shape_of(scene.shapes[shape], S(scene.poses[0][i].scale), offsets_[shape]);
      objects_[i] = std::make_unique<fcl::CollisionObject<S>>(made);
      objects_[i]->setUserData(reinterpret_cast<void*>(i));
    }
    for (const auto& plane : scene.planes) {
      const fcl::Vector3<S> normal(S(plane.normal[0]), S(plane.normal[1]), S(plane.normal[2]));
      planes_.push_back(
          std::make_unique<fcl::CollisionObject<S>>(std::make_shared<fcl::Halfspace<S>>(normal, S(plane.offset))));
    }
  }
  std::string name() const override { return sizeof(S) == sizeof(float) ? "FCL float" : "FCL double"; }

  std::size_t step(int step) override {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const auto& body = scene_.bodies[i];
      const bool there = body.birth <= step && step < body.death;
      if (!there) {
        if (in_.size() > i && in_[i]) manager_.unregisterObject(objects_[i].get()), in_[i] = false;
        continue;
      }
      objects_[i]->setTransform(transform_of(scene_.poses[static_cast<std::size_t>(step)][i], body.parts[0]));
      objects_[i]->computeAABB();
      if (in_.size() <= i) in_.resize(objects_.size());
      if (!in_[i]) manager_.registerObject(objects_[i].get()), in_[i] = true;
    }
    if (!set_up_) manager_.setup(), set_up_ = true;
    manager_.update();
    count_ = 0;
    manager_.collide(this, [](fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b, void* data) {
      auto& self = *static_cast<FclFrames*>(data);
      const auto i = reinterpret_cast<std::size_t>(a->getUserData()),
                 j = reinterpret_cast<std::size_t>(b->getUserData());
      if (self.scene_.bodies[i].is_static && self.scene_.bodies[j].is_static) return false;
      self.test(a, b);
      return false;
    });
    // A half-space has no box: each body whose box reaches it is asked.
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const auto& plane = scene_.planes[k];
      for (std::size_t i = 0; i < objects_.size(); ++i) {
        if (!in_[i]) continue;
        const auto& box = objects_[i]->getAABB();
        S lowest = -S(plane.offset);
        for (int d = 0; d < 3; ++d) {
          const S n = S(plane.normal[static_cast<std::size_t>(d)]);
          lowest += n * (n > 0 ? box.min_[d] : box.max_[d]);
        }
        if (lowest <= 0) test(objects_[i].get(), planes_[k].get());
      }
    }
    return count_;
  }

 private:
  void test(fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b) {
    fcl::CollisionRequest<S> request;
    fcl::CollisionResult<S> result;
    fcl::collide(a, b, request, result);
    count_ += result.isCollision();
  }

  // FCL's capsules lie along z around the origin.
  static std::shared_ptr<fcl::CollisionGeometry<S>> shape_of(const SceneShape& shape, S scale,
                                                             fcl::Transform3<S>& offset) {
    offset = fcl::Transform3<S>::Identity();
    if (shape.kind == SceneShape::Kind::box) {
      return std::make_shared<fcl::Box<S>>(2 * S(shape.p[0]) * scale, 2 * S(shape.p[1]) * scale,
                                           2 * S(shape.p[2]) * scale);
    }
    if (shape.kind == SceneShape::Kind::round) {
      const fcl::Vector3<S> p(S(shape.p[0]), S(shape.p[1]), S(shape.p[2])),
          q(S(shape.q[0]), S(shape.q[1]), S(shape.q[2]));
      const S length = (q - p).norm();
      if (length == 0) return std::make_shared<fcl::Sphere<S>>(S(shape.radius) * scale);
      offset.linear() = Eigen::Quaternion<S>::FromTwoVectors(fcl::Vector3<S>(0, 0, 1), q - p).toRotationMatrix();
      offset.translation() = scale * (p + q) / 2;
      return std::make_shared<fcl::Capsule<S>>(S(shape.radius) * scale, length * scale);
    }
    std::vector<fcl::Vector3<S>> vertices;
    std::vector<fcl::Triangle> triangles;
    for (const auto& v : shape.tree.vertices) {
      const auto at = [&](std::size_t i) { return scale * S(double{v[i]} + shape.tree.origin[i]); };
      vertices.emplace_back(at(0), at(1), at(2));
    }
    for (const auto& t : shape.tree.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSS<S>>>();
    model->beginModel();
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
  }

  fcl::Transform3<S> transform_of(const runtime::Pose& pose, std::size_t shape) {
    fcl::Transform3<S> result = fcl::Transform3<S>::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) result.linear()(i, j) = S(pose.rotation[static_cast<std::size_t>(3 * i + j)]);
      result.translation()[i] = S(pose.translation[static_cast<std::size_t>(i)]);
    }
    return result * offsets_[shape];
  }

  const Scene& scene_;
  std::map<std::pair<std::size_t, double>, std::shared_ptr<fcl::CollisionGeometry<S>>> shapes_;
  std::map<std::size_t, fcl::Transform3<S>> offsets_;
  std::vector<std::unique_ptr<fcl::CollisionObject<S>>> objects_, planes_;
  std::vector<bool> in_;
  fcl::DynamicAABBTreeCollisionManager<S> manager_;
  bool set_up_ = false;
  std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<FrameRival> fcl_frames_double(const Scene& scene) { return std::make_unique<FclFrames<double>>(scene); }
std::unique_ptr<FrameRival> fcl_frames_float(const Scene& scene) { return std::make_unique<FclFrames<float>>(scene); }
#else
std::unique_ptr<FrameRival> fcl_frames_double(const runtime::test::Scene&) { return nullptr; }
std::unique_ptr<FrameRival> fcl_frames_float(const runtime::test::Scene&) { return nullptr; }
#endif

}  // namespace orchard::bench
