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
#include <set>
#endif

namespace orchard::bench {

#ifdef ORCHARD_HAS_FCL
namespace {

using runtime::test::Scene;
using runtime::test::SceneShape;

template <typename S>
class FclFrames final : public FrameRival {
 public:
  explicit FclFrames(const Scene& scene) : scene_(scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      for (std::size_t k = 0; k < scene.bodies[i].parts.size(); ++k) {
        const std::pair key{scene.bodies[i].parts[k], scene.poses[0][i].scale * scene.local(0, i, k).scale};
        auto& made = shapes_[key];
        if (!made) made = shape_of(scene.shapes[key.first], S(key.second), offsets_[key]);
        Part& part = parts_.emplace_back(Part{i, k, key, std::make_unique<fcl::CollisionObject<S>>(made)});
        part.object->setUserData(reinterpret_cast<void*>(i));
        part.stays = stays(scene.bodies[i]);
      }
      several_ = several_ || scene.bodies[i].parts.size() > 1;
    }
    for (const auto& plane : scene.planes) {
      const fcl::Vector3<S> normal(S(plane.normal[0]), S(plane.normal[1]), S(plane.normal[2]));
      planes_.push_back(
          std::make_unique<fcl::CollisionObject<S>>(std::make_shared<fcl::Halfspace<S>>(normal, S(plane.offset))));
      planes_.back()->setUserData(reinterpret_cast<void*>(scene.bodies.size() + planes_.size() - 1));
    }
  }
  std::string name() const override { return sizeof(S) == sizeof(float) ? "FCL float" : "FCL double"; }

  std::size_t step(int step) override {
    for (Part& part : parts_) {
      if (part.in && part.stays) continue;
      move(part, step);
    }
    if (!set_up_) moving_.setup(), static_.setup(), set_up_ = true;
    moving_.update();
    count_ = 0;
    touching_.clear();
    const auto met = [](fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b, void* data) {
      static_cast<FclFrames*>(data)->test(a, b);
      return false;
    };
    moving_.collide(this, met);
    if (!static_.empty()) moving_.collide(&static_, this, met);
    // A half-space has no box: each body whose box reaches it is asked.
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const auto& plane = scene_.planes[k];
      for (const Part& part : parts_) {
        if (!part.in || scene_.bodies[part.body].is_static) continue;
        const auto& box = part.object->getAABB();
        S lowest = -S(plane.offset);
        for (int d = 0; d < 3; ++d) {
          const S n = S(plane.normal[static_cast<std::size_t>(d)]);
          lowest += n * (n > 0 ? box.min_[d] : box.max_[d]);
        }
        if (lowest <= 0) test(part.object.get(), planes_[k].get());
      }
    }
    return count_;
  }

 private:
  struct Part {
    std::size_t body, part;
    std::pair<std::size_t, double> shape;  // and its scale
    std::unique_ptr<fcl::CollisionObject<S>> object;
    bool in = false, stays = false;
  };

  // What is static has a tree of its own, and stays as it is.
  void move(Part& part, int step) {
    const auto& body = scene_.bodies[part.body];
    auto& manager = body.is_static ? static_ : moving_;
    const bool there = body.birth <= step && step < body.death;
    if (there && !(part.in && body.is_static)) {
      part.object->setTransform(transform_of(part, step));
      part.object->computeAABB();
    }
    if (there && !part.in) manager.registerObject(part.object.get());
    if (!there && part.in) manager.unregisterObject(part.object.get());
    part.in = there;
  }

  // Bodies touch if any of their parts do, so that one pair of parts that does is enough.
  void test(fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b) {
    const auto i = reinterpret_cast<std::size_t>(a->getUserData()), j = reinterpret_cast<std::size_t>(b->getUserData());
    if (several_ && (i == j || touching_.count(std::minmax(i, j)) > 0)) return;
    fcl::CollisionRequest<S> request;
    fcl::CollisionResult<S> result;
    fcl::collide(a, b, request, result);
    if (!result.isCollision()) return;
    ++count_;
    if (several_) touching_.insert(std::minmax(i, j));
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

  fcl::Transform3<S> transform_of(const Part& part, int step) {
    runtime::Pose pose = scene_.poses[static_cast<std::size_t>(step)][part.body];
    if (scene_.joints(part.body) > 0) pose = compose(pose, scene_.local(step, part.body, part.part));
    fcl::Transform3<S> result = fcl::Transform3<S>::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) result.linear()(i, j) = S(pose.rotation[static_cast<std::size_t>(3 * i + j)]);
      result.translation()[i] = S(pose.translation[static_cast<std::size_t>(i)]);
    }
    return result * offsets_[part.shape];
  }

  const Scene& scene_;
  std::map<std::pair<std::size_t, double>, std::shared_ptr<fcl::CollisionGeometry<S>>> shapes_;
  std::map<std::pair<std::size_t, double>, fcl::Transform3<S>> offsets_;
  std::vector<Part> parts_;
  bool several_ = false;  // parts of one body
  std::set<std::pair<std::size_t, std::size_t>> touching_;
  std::vector<std::unique_ptr<fcl::CollisionObject<S>>> planes_;
  fcl::DynamicAABBTreeCollisionManager<S> moving_, static_;
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
