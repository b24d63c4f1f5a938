#include "rival.h"

#ifdef ORCHARD_HAS_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>
#endif

namespace orchard::bench {

#ifdef ORCHARD_HAS_CGAL
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Transform = CGAL::Aff_transformation_3<Kernel>;

// Faces that cannot be joined to the mesh (more than two at an edge) stand on corners of their own.
Mesh mesh_of(const runtime::TreeView& tree) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  const auto add = [&](std::size_t i) {
    const auto& v = tree.vertices[i];
    return mesh.add_vertex(
        {double{v[0]} + tree.origin[0], double{v[1]} + tree.origin[1], double{v[2]} + tree.origin[2]});
  };
  for (std::size_t i = 0; i < tree.vertices.size(); ++i) vertices.push_back(add(i));
  for (const auto& t : tree.triangles) {
    if (mesh.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) != Mesh::null_face()) continue;
    mesh.add_face(add(t[0]), add(t[1]), add(t[2]));
  }
  return mesh;
}

class Cgal final : public PairRival {
 public:
  Cgal(const runtime::TreeView& a, const runtime::TreeView& b) : a_(mesh_of(a)), b_(mesh_of(b)) {
    ids_ = {detection_.add_mesh(a_), detection_.add_mesh(b_)};
  }
  std::string name() const override { return "CGAL, AABB trees"; }
  void place(const std::vector<Query>& queries) override {
    poses_.clear();
    for (const Query& q : queries) poses_.emplace_back(transform_of(q.a), transform_of(q.b));
  }
  bool collide(std::size_t query) override {
    detection_.set_transformation(ids_[0], poses_[query].first);
    detection_.set_transformation(ids_[1], poses_[query].second);
    return !detection_.get_all_intersections(ids_[0]).empty();
  }

 private:
  static Transform transform_of(const runtime::Pose& pose) {
    const auto& r = pose.rotation;
    const auto& t = pose.translation;
    return {r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2]};
  }
  Mesh a_, b_;
  CGAL::Rigid_triangle_mesh_collision_detection<Mesh> detection_;
  std::array<std::size_t, 2> ids_{};
  std::vector<std::pair<Transform, Transform>> poses_;
};

}  // namespace

std::unique_ptr<PairRival> cgal(const runtime::TreeView& a, const runtime::TreeView& b) {
  return std::make_unique<Cgal>(a, b);
}
#else
std::unique_ptr<PairRival> cgal(const runtime::TreeView&, const runtime::TreeView&) { return nullptr; }
#endif

}  // namespace orchard::bench
