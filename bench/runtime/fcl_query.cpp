#include "fcl_query.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <vector>

namespace orchard::bench {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSS<float>>;

std::shared_ptr<Model> model_of(const runtime::PackedSphereTree& tree) {
  std::vector<fcl::Vector3<float>> vertices;
  std::vector<fcl::Triangle> triangles;
  for (const auto& v : tree.vertices) vertices.emplace_back(v[0], v[1], v[2]);
  for (const auto& t : tree.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

fcl::Transform3<float> transform_of(const runtime::Pose& pose) {
  fcl::Transform3<float> result = fcl::Transform3<float>::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.linear()(i, j) = static_cast<float>(pose.rotation[static_cast<std::size_t>(3 * i + j)]);
    }
    result.translation()[i] = static_cast<float>(pose.translation[static_cast<std::size_t>(i)]);
  }
  return result;
}

}  // namespace

struct FclPair::Models {
  std::shared_ptr<Model> a, b;
};

FclPair::FclPair(const runtime::PackedSphereTree& a, const runtime::PackedSphereTree& b)
    : models_(new Models{model_of(a), model_of(b)}) {}
FclPair::~FclPair() = default;

bool FclPair::collide(const runtime::Pose& a, const runtime::Pose& b) const {
  fcl::CollisionRequest<float> request;
  fcl::CollisionResult<float> result;
  fcl::collide(models_->a.get(), transform_of(a), models_->b.get(), transform_of(b), request, result);
  return result.isCollision();
}

}  // namespace orchard::bench
