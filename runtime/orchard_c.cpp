#include <algorithm>
#include <new>

#include "orchard/runtime/collide.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/mapped_tree.h"
#include "orchard/runtime/orchard.h"
#include "orchard/runtime/shape_query.h"

namespace rt = orchard::runtime;

struct orchard_tree {
  rt::MappedTree mapped;
  rt::PackedSphereTree loaded;
  rt::TreeView view;
};

struct orchard_pair {
  rt::NarrowPhase narrow;
  rt::DistanceQuery distance;
};

namespace {

rt::Pose pose_of(const orchard_pose& from) noexcept {
  rt::Pose pose;
  std::copy_n(from.rotation, 9, pose.rotation.begin());
  std::copy_n(from.translation, 3, pose.translation.begin());
  pose.scale = from.scale;
  return pose;
}

int given(const std::optional<rt::Pose>& from, orchard_pose* to) noexcept {
  if (!from) return 0;
  std::copy_n(from->rotation.begin(), 9, to->rotation);
  std::copy_n(from->translation.begin(), 3, to->translation);
  to->scale = from->scale;
  return 1;
}

std::array<double, 3> vector_of(const double* v) noexcept { return {v[0], v[1], v[2]}; }

rt::Budget budget_of(const orchard_budget& from) noexcept {
  rt::Budget budget;
  budget.pair_tests = from.tests;
  const auto longest = static_cast<std::uint64_t>(std::chrono::nanoseconds::max().count());
  if (from.nanoseconds < longest) budget.time = std::chrono::nanoseconds(from.nanoseconds);
  return budget;
}

orchard_verdict verdict_of(const rt::NarrowPhase& pair) noexcept {
  const rt::Verdict v = pair.verdict();
  orchard_verdict result{};
  result.answer = static_cast<orchard_answer>(v.answer);
  result.separation_bound = v.separation_bound;
  result.lower_bound = v.lower_bound;
  std::copy_n(v.contact.center.begin(), 3, result.contact_center);
  std::copy_n(v.contact.normal.begin(), 3, result.contact_normal);
  result.contact_radius = v.contact.radius;
  result.triangle_a = v.contact.triangle_a;
  result.triangle_b = v.contact.triangle_b;
  result.level = v.level;
  result.finished = pair.finished();
  result.refused = pair.refused();
  result.work = v.work;
  return result;
}

orchard_tree* opened(orchard_tree* tree, rt::LoadStatus status, const char** error) noexcept {
  if (tree != nullptr && status == rt::LoadStatus::ok) return tree;
  if (error != nullptr) *error = rt::message(tree == nullptr ? rt::LoadStatus::out_of_memory : status);
  delete tree;
  return nullptr;
}

}  // namespace

extern "C" {

orchard_pose orchard_identity(void) { return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, 1}; }

int orchard_is_rigid(const orchard_pose* pose) { return rt::is_rigid(pose_of(*pose)); }

int orchard_make_rigid(orchard_pose* pose) { return given(rt::made_rigid(pose_of(*pose)), pose); }

int orchard_pose_from_matrix(const float rotation[9], const float translation[3], float scale, orchard_pose* pose) {
  std::array<float, 9> r{};
  std::array<float, 3> t{};
  std::copy_n(rotation, 9, r.begin());
  std::copy_n(translation, 3, t.begin());
  return given(rt::pose_from_matrix(r, t, scale), pose);
}

orchard_tree* orchard_tree_read(const char* path, const char** error) {
  auto* const tree = new (std::nothrow) orchard_tree;
  if (tree == nullptr) return opened(nullptr, rt::LoadStatus::out_of_memory, error);
  const rt::LoadStatus status = rt::load_file(path, tree->loaded);
  tree->view = tree->loaded;
  return opened(tree, status, error);
}

orchard_tree* orchard_tree_open(const char* path, const char** error) {
  auto* const tree = new (std::nothrow) orchard_tree;
  if (tree == nullptr) return opened(nullptr, rt::LoadStatus::out_of_memory, error);
  const rt::LoadStatus status = tree->mapped.open(path);
  tree->view = tree->mapped.view();
  return opened(tree, status, error);
}

orchard_tree* orchard_tree_load(const void* bytes, size_t size, const char** error) {
  auto* const tree = new (std::nothrow) orchard_tree;
  if (tree == nullptr) return opened(nullptr, rt::LoadStatus::out_of_memory, error);
  const rt::LoadStatus status = rt::load({static_cast<const std::byte*>(bytes), size}, tree->loaded);
  tree->view = tree->loaded;
  return opened(tree, status, error);
}

void orchard_tree_close(orchard_tree* tree) { delete tree; }
double orchard_tree_bounding_radius(const orchard_tree* tree) { return tree->view.bounding_radius; }
size_t orchard_tree_triangles(const orchard_tree* tree) { return tree->view.triangles.size(); }

orchard_pair* orchard_pair_new(const orchard_tree* a, const orchard_tree* b) {
  return new (std::nothrow) orchard_pair{rt::NarrowPhase(a->view, b->view), rt::DistanceQuery(a->view, b->view)};
}

void orchard_pair_free(orchard_pair* pair) { delete pair; }

orchard_verdict orchard_collide(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b,
                                orchard_budget budget) {
  rt::collide(pair->narrow, pose_of(*a), pose_of(*b), budget_of(budget));
  return verdict_of(pair->narrow);
}

orchard_verdict orchard_start(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b) {
  pair->narrow.start(pose_of(*a), pose_of(*b));
  return verdict_of(pair->narrow);
}

orchard_verdict orchard_refine(orchard_pair* pair, orchard_budget budget) {
  pair->narrow.refine(budget_of(budget));
  return verdict_of(pair->narrow);
}

orchard_distance orchard_measure(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b, double tolerance) {
  pair->distance.start(pose_of(*a), pose_of(*b), {.relative = tolerance});
  pair->distance.refine();
  orchard_distance result{};
  result.lower = pair->distance.lower();
  result.upper = pair->distance.upper();
  const rt::DistanceQuery::Points points = pair->distance.points();
  std::copy_n(points.on_a.begin(), 3, result.on_a);
  std::copy_n(points.on_b.begin(), 3, result.on_b);
  result.triangle_a = points.triangle_a;
  result.triangle_b = points.triangle_b;
  return result;
}

int orchard_capsule_touches(const orchard_tree* tree, const orchard_pose* pose, const double p[3], const double q[3],
                            double radius) {
  const rt::SurfacePoint near =
      rt::nearest_point_to_segment(tree->view, pose_of(*pose), vector_of(p), vector_of(q), radius);
  if (near.triangle != rt::kNoTriangle) return 1;
  return near.distance == 0 ? -1 : 0;
}

int orchard_contains(const orchard_tree* tree, const orchard_pose* pose, const double point[3]) {
  const rt::Pose placed = pose_of(*pose);
  if (!rt::can_ask(tree->view, placed, vector_of(point))) return -1;
  return rt::contains(tree->view, placed, vector_of(point));
}

int orchard_cast_ray(const orchard_tree* tree, const orchard_pose* pose, const double origin[3],
                     const double direction[3], double longest, double* along) {
  const auto hit = rt::cast_ray(tree->view, pose_of(*pose), vector_of(origin), vector_of(direction), longest);
  if (hit && along != nullptr) *along = hit->along;
  if (!hit) return 0;
  return hit->triangle == rt::kNoTriangle ? -1 : 1;
}

}  // extern "C"
