#include "rival.h"

#ifdef ORCHARD_HAS_FCL
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/distance.h>
#endif

namespace orchard::bench {

#ifdef ORCHARD_HAS_FCL
namespace {

// Compiled from FCL's headers: in float that is twice as fast as the packaged library, which is in double.
template <typename S>
class Fcl final : public PairRival {
 public:
  Fcl(const runtime::TreeView& a, const runtime::TreeView& b) : a_(model_of(a)), b_(model_of(b)) {}

  std::string name() const override {
    return sizeof(S) == sizeof(float) ? "FCL, OBBRSS, float" : "FCL, OBBRSS, double";
  }
  void place(const std::vector<Query>& queries) override {
    poses_.clear();
    for (const Query& q : queries) poses_.emplace_back(transform_of(q.a), transform_of(q.b));
  }
  bool collide(std::size_t query) override {
    fcl::CollisionRequest<S> request;
    fcl::CollisionResult<S> result;
    fcl::collide(a_.get(), poses_[query].first, b_.get(), poses_[query].second, request, result);
    return result.isCollision();
  }
  bool measures_distance() const override { return true; }
  double distance(std::size_t query) override {
    fcl::DistanceRequest<S> request;
    fcl::DistanceResult<S> result;
    fcl::distance(a_.get(), poses_[query].first, b_.get(), poses_[query].second, request, result);
    return static_cast<double>(result.min_distance);
  }

  bool finds_contacts() const override { return true; }
  std::size_t contacts(std::size_t query) override {
    fcl::CollisionRequest<S> request(100000, true);
    fcl::CollisionResult<S> result;
    fcl::collide(a_.get(), poses_[query].first, b_.get(), poses_[query].second, request, result);
    return result.numContacts();
  }
  ContactResponse response(std::size_t query) override {
    fcl::CollisionRequest<S> request(100000, true);
    fcl::CollisionResult<S> result;
    fcl::collide(a_.get(), poses_[query].first, b_.get(), poses_[query].second, request, result);
    ResponseSum sum;
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      const auto& contact = result.getContact(i);
      sum.add({double(contact.normal[0]), double(contact.normal[1]), double(contact.normal[2])},
              double(contact.penetration_depth));
    }
    return sum.result();
  }
  bool moves() const override { return sizeof(S) == sizeof(double); }
  double time_of_impact(std::size_t query, const runtime::Pose& to, double tolerance) override {
    if constexpr (sizeof(S) == sizeof(double)) {  // in float its motions do not compile
      fcl::ContinuousCollisionRequest<S> request(1000, S(tolerance), fcl::CCDM_LINEAR, fcl::GST_LIBCCD,
                                                 fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
      fcl::ContinuousCollisionResult<S> result;
      fcl::continuousCollide(a_.get(), poses_[query].first, poses_[query].first, b_.get(), poses_[query].second,
                             transform_of(to), request, result);
      return result.is_collide ? static_cast<double>(result.time_of_contact) : 1;
    }
    return 1;
  }

 private:
  using Model = fcl::BVHModel<fcl::OBBRSS<S>>;

  static std::shared_ptr<Model> model_of(const runtime::TreeView& tree) {
    std::vector<fcl::Vector3<S>> vertices;
    std::vector<fcl::Triangle> triangles;
    for (const auto& v : tree.vertices) {
      vertices.emplace_back(S(v[0] + tree.origin[0]), S(v[1] + tree.origin[1]), S(v[2] + tree.origin[2]));
    }
    for (const auto& t : tree.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    auto model = std::make_shared<Model>();
    model->beginModel();
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
  }

  static fcl::Transform3<S> transform_of(const runtime::Pose& pose) {
    fcl::Transform3<S> result = fcl::Transform3<S>::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) result.linear()(i, j) = S(pose.rotation[static_cast<std::size_t>(3 * i + j)]);
      result.translation()[i] = S(pose.translation[static_cast<std::size_t>(i)]);
    }
    return result;
  }

  std::shared_ptr<Model> a_, b_;
  std::vector<std::pair<fcl::Transform3<S>, fcl::Transform3<S>>> poses_;
};

}  // namespace

std::unique_ptr<PairRival> fcl_float(const runtime::TreeView& a, const runtime::TreeView& b) {
  return std::make_unique<Fcl<float>>(a, b);
}
std::unique_ptr<PairRival> fcl_double(const runtime::TreeView& a, const runtime::TreeView& b) {
  return std::make_unique<Fcl<double>>(a, b);
}
#else
std::unique_ptr<PairRival> fcl_float(const runtime::TreeView&, const runtime::TreeView&) { return nullptr; }
std::unique_ptr<PairRival> fcl_double(const runtime::TreeView&, const runtime::TreeView&) { return nullptr; }
#endif

}  // namespace orchard::bench
