// The C interface, function after function as orchard.h has them: hence more than 300 lines.
#include <algorithm>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "c/orchard_c.h"
#include "execution/guarded.h"
#include "execution/share_among.h"
#include "orchard/runtime/batch.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/shape_trees.h"
#include "orchard/runtime/time_of_impact.h"

namespace rt = orchard::runtime;

struct orchard_pair {
  orchard_pair(const orchard_tree* a, const orchard_tree* b) noexcept : pair(a->prepared, b->prepared), workspace(0) {
    bind();
    workspace.distance.bind(a->prepared, b->prepared);
    pair.use(&front);
  }
  void bind() noexcept { workspace.narrow.bind(pair.a(), pair.b()); }
  rt::TreePair pair;
  rt::Workspace workspace;
  rt::PairFront front;
};

namespace {

using rt::detail::pose_of;

orchard_distance distance_of(const rt::Distance& measured) noexcept {
  orchard_distance result{};
  result.lower = measured.lower;
  result.upper = measured.upper;
  std::copy_n(measured.points.on_a.begin(), 3, result.on_a);
  std::copy_n(measured.points.on_b.begin(), 3, result.on_b);
  result.triangle_a = measured.points.triangle_a;
  result.triangle_b = measured.points.triangle_b;
  return result;
}

// Question i in the workspace of the job that it falls to: ask(workspace, pair, pose of a, pose of b, i).
struct CBatch {
  orchard_workspace* const* workspaces;
  size_t workspace_count;
  const orchard_executor* executor;
  const orchard_tree* const* a;
  const orchard_pose* poses_a;
  const orchard_tree* const* b;
  const orchard_pose* poses_b;

  template <typename Ask>
  void run(size_t count, Ask&& ask) const noexcept {
    const rt::Executor on{executor->run, executor->context, executor->concurrency};
    rt::share_among(on, workspace_count, count, [&](size_t job, size_t i) {
      ask(workspaces[job]->workspace, rt::TreePair(a[i]->prepared, b[i]->prepared), pose_of(poses_a[i]),
          pose_of(poses_b[i]), i);
    });
  }
};

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
  budget.work = from.tests;
  budget.time = rt::detail::time_of(from.nanoseconds);
  return budget;
}

// 1, 0, or -1 for "maybe".
int in_c(rt::Answer answer) noexcept { return answer == rt::Answer::yes ? 1 : answer == rt::Answer::no ? 0 : -1; }

orchard_verdict verdict_of(const rt::NarrowPhase& pair) noexcept {
  orchard_verdict result = rt::detail::verdict_of(pair.verdict());
  result.finished = pair.finished();
  result.refused = pair.refused();
  return result;
}

// A tree made here, or null where `make` gives none or there is no memory for it.
template <typename Make>
orchard_tree* made(Make&& make) noexcept {
  const auto work = [&]() -> orchard_tree* {
    std::optional<rt::PackedSphereTree> tree = make();
    if (!tree || rt::structure_fault(*tree) != nullptr) return nullptr;
    auto result = std::make_unique<orchard_tree>();
    result->loaded = std::move(*tree);
    result->view = result->loaded;
    result->prepared = rt::PreparedTree(result->view);
    return result.release();
  };
  return rt::detail::guarded(work, []() -> orchard_tree* { return nullptr; });
}

// A motion that a C function gives, as one that a C++ function gives.
struct CTravel {
  explicit CTravel(const orchard_travel& from) noexcept : travel_in_c(from) {
    travel.start = pose_of(from.start);
    travel.velocity = vector_of(from.velocity), travel.spin = vector_of(from.spin);
    travel.center = vector_of(from.center);
    travel.speed = from.speed, travel.turning = from.turning;
    if (from.pose_at == nullptr) return;
    travel.context = &travel_in_c;
    travel.pose_at = [](const void* context, double time) {
      const auto& own = *static_cast<const orchard_travel*>(context);
      orchard_pose pose{};  // of zeros, which no query answers for
      if (own.pose_at(own.context, time, &pose) == 0) pose = {};
      return pose_of(pose);
    };
  }
  const orchard_travel& travel_in_c;
  rt::Travel travel;
};

orchard_tree* opened(orchard_tree* tree, rt::LoadStatus status, const char** error) noexcept {
  if (tree != nullptr && status == rt::LoadStatus::ok) {
    tree->prepared = rt::PreparedTree(tree->view);
    return tree;
  }
  if (error != nullptr) *error = rt::message(tree == nullptr ? rt::LoadStatus::out_of_memory : status);
  delete tree;
  return nullptr;
}

}  // namespace

extern "C" {

const char* orchard_version(void) { return ORCHARD_VERSION_STRING; }

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

int orchard_pose_from_quaternion(const double wxyz[4], const double translation[3], orchard_pose* pose) {
  return given(rt::pose_from_quaternion({wxyz[0], wxyz[1], wxyz[2], wxyz[3]}, vector_of(translation)), pose);
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
  return new (std::nothrow) orchard_pair(a, b);
}

void orchard_pair_free(orchard_pair* pair) { delete pair; }

orchard_verdict orchard_collide(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b,
                                orchard_budget budget) {
  rt::collide(pair->workspace, pair->pair, pose_of(*a), pose_of(*b), budget_of(budget));
  return verdict_of(pair->workspace.narrow);
}

orchard_verdict orchard_collide_again(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b) {
  pair->bind();  // the verdict's flags are of a query of this pair, even if none is needed
  const rt::Verdict verdict = rt::collide_coherently(pair->workspace, pair->pair, pose_of(*a), pose_of(*b));
  orchard_verdict result = rt::detail::verdict_of(verdict);
  result.finished = 1;
  result.refused = verdict.answer == rt::Answer::maybe && pair->workspace.narrow.refused();
  return result;
}

orchard_verdict orchard_start(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b) {
  pair->workspace.narrow.reserve(rt::NarrowPhase::kDefaultRoom);
  pair->workspace.narrow.start(pose_of(*a), pose_of(*b));
  return verdict_of(pair->workspace.narrow);
}

orchard_verdict orchard_refine(orchard_pair* pair, orchard_budget budget) {
  pair->workspace.narrow.refine(budget_of(budget));
  return verdict_of(pair->workspace.narrow);
}

orchard_distance orchard_measure(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b, double tolerance) {
  return distance_of(
      rt::distance(pair->workspace, pair->pair, pose_of(*a), pose_of(*b), {.relative = tolerance, .absolute = 0}));
}

int orchard_capsule_touches(const orchard_tree* tree, const orchard_pose* pose, const double p[3], const double q[3],
                            double radius) {
  return in_c(rt::touches_capsule(tree->view, pose_of(*pose), vector_of(p), vector_of(q), radius));
}

int orchard_contains(const orchard_tree* tree, const orchard_pose* pose, const double point[3]) {
  const rt::Pose placed = pose_of(*pose);
  if (!rt::can_ask(tree->view, placed, vector_of(point))) return -1;
  return rt::contains(tree->view, placed, vector_of(point));
}

int orchard_cast_ray(const orchard_tree* tree, const orchard_pose* pose, const double origin[3],
                     const double direction[3], double longest, double* along) {
  const rt::Pose placed = pose_of(*pose);
  const auto from = vector_of(origin), way = vector_of(direction);
  const auto hit = tree->rays.empty() ? rt::cast_ray(tree->view, placed, from, way, longest)
                                      : rt::cast_ray(tree->rays, placed, from, way, longest);
  if (hit && along != nullptr) *along = hit->along;
  if (!hit) return 0;
  return hit->triangle == rt::kNoTriangle ? -1 : 1;
}

int orchard_index_rays(orchard_tree* tree) {
  const auto work = [tree] {
    tree->rays = rt::RayIndex(tree->view);
    return 1;
  };
  return rt::detail::guarded(work, [] { return 0; });
}

int orchard_nearest_point(const orchard_tree* tree, const orchard_pose* pose, const double center[3], double limit,
                          double* distance, double point[3], uint32_t* triangle) {
  const rt::SurfacePoint near = rt::nearest_point(tree->view, pose_of(*pose), vector_of(center), limit);
  if (distance != nullptr) *distance = near.distance;
  if (point != nullptr) std::copy_n(near.point.begin(), 3, point);
  if (triangle != nullptr) *triangle = near.triangle;
  if (near.triangle != rt::kNoTriangle) return 1;
  return near.distance == 0 ? -1 : 0;
}

int orchard_box_touches(const orchard_tree* tree, const orchard_pose* pose, const double half[3],
                        const orchard_pose* box) {
  return in_c(rt::touches_box(tree->view, pose_of(*pose), vector_of(half), pose_of(*box)).answer);
}

int orchard_hull_touches(const orchard_tree* tree, const orchard_pose* pose, const double* corners, size_t corner_count,
                         const uint32_t* facets, size_t facet_count, const orchard_pose* hull) {
  if (corner_count > rt::kMaxCorners || facet_count > rt::kMaxFacets) return -1;
  std::array<std::array<double, 3>, rt::kMaxCorners> points;
  std::array<std::array<std::uint32_t, 3>, rt::kMaxFacets> triangles;
  for (size_t i = 0; i < corner_count; ++i) points[i] = vector_of(corners + 3 * i);
  for (size_t i = 0; i < facet_count; ++i) std::copy_n(facets + 3 * i, 3, triangles[i].begin());
  const rt::ConvexShape shape{std::span(points).first(corner_count), std::span(triangles).first(facet_count)};
  return in_c(rt::touches_convex(tree->view, pose_of(*pose), shape, pose_of(*hull)).answer);
}

double orchard_plane_distance(const orchard_tree* tree, const orchard_pose* pose, const double normal[3],
                              double offset) {
  return rt::deepest_point(tree->view, pose_of(*pose), vector_of(normal), offset).distance;
}

orchard_tree* orchard_point_tree(const double point[3]) {
  return made([&] { return std::optional(rt::point_tree(vector_of(point))); });
}
orchard_tree* orchard_segment_tree(const double p[3], const double q[3]) {
  return made([&] { return std::optional(rt::segment_tree(vector_of(p), vector_of(q))); });
}
orchard_tree* orchard_box_tree(const double half[3]) {
  return made([&] { return std::optional(rt::box_tree(vector_of(half))); });
}
orchard_tree* orchard_hull_tree(const double* points, size_t count) {
  return made([&] {
    std::vector<std::array<double, 3>> copy;
    for (size_t i = 0; i < count; ++i) copy.push_back(vector_of(points + 3 * i));
    return rt::hull_tree(copy);
  });
}

orchard_workspace* orchard_workspace_new(void) { return new (std::nothrow) orchard_workspace; }
void orchard_workspace_free(orchard_workspace* workspace) { delete workspace; }

int orchard_closer_than(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                        const orchard_tree* b, const orchard_pose* pose_b, double margin) {
  const rt::TreePair pair(a->prepared, b->prepared);
  return in_c(rt::closer_than(workspace->workspace, pair, pose_of(*pose_a), pose_of(*pose_b), margin));
}

orchard_manifold orchard_contacts(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                                  const orchard_tree* b, const orchard_pose* pose_b) {
  return rt::detail::manifold_of(
      rt::contacts(workspace->workspace, rt::TreePair(a->prepared, b->prepared), pose_of(*pose_a), pose_of(*pose_b)));
}

orchard_signed_distance orchard_measure_signed(orchard_workspace* workspace, const orchard_tree* a,
                                               const orchard_pose* pose_a, const orchard_tree* b,
                                               const orchard_pose* pose_b, double tolerance) {
  const rt::SignedDistance measured = rt::signed_distance(workspace->workspace, rt::TreePair(a->prepared, b->prepared),
                                                          pose_of(*pose_a), pose_of(*pose_b), tolerance);
  orchard_signed_distance result{};
  result.lower = measured.lower;
  result.upper = measured.upper;
  std::copy_n(measured.on_a.begin(), 3, result.on_a);
  std::copy_n(measured.on_b.begin(), 3, result.on_b);
  std::copy_n(measured.normal.begin(), 3, result.normal);
  return result;
}

orchard_travel orchard_travel_between(const orchard_pose* from, const orchard_pose* to, const double center[3]) {
  const rt::Travel travel = rt::travel_between(pose_of(*from), pose_of(*to), vector_of(center));
  orchard_travel result{};
  result.start = *from;
  std::copy_n(travel.velocity.begin(), 3, result.velocity);
  std::copy_n(travel.spin.begin(), 3, result.spin);
  std::copy_n(travel.center.begin(), 3, result.center);
  return result;
}

orchard_impact orchard_time_of_impact(orchard_workspace* workspace, const orchard_tree* a,
                                      const orchard_travel* travel_a, const orchard_tree* b,
                                      const orchard_travel* travel_b, double begin, double end, double tolerance,
                                      double margin, orchard_budget budget) {
  const CTravel of_a(*travel_a), of_b(*travel_b);
  const rt::Impact impact = rt::time_of_impact(
      workspace->workspace, rt::TreePair(a->prepared, b->prepared), of_a.travel, of_b.travel,
      {.begin = begin, .end = end, .tolerance = tolerance, .margin = margin, .budget = budget_of(budget)});
  orchard_impact result{};
  result.answer = static_cast<orchard_answer>(impact.answer);
  result.t0 = impact.t0, result.t1 = impact.t1;
  result.distance = impact.distance;
  std::copy_n(impact.on_a.begin(), 3, result.on_a);
  std::copy_n(impact.on_b.begin(), 3, result.on_b);
  result.triangle_a = impact.triangle_a, result.triangle_b = impact.triangle_b;
  result.finished = impact.finished, result.refused = impact.refused;
  result.work = impact.work;
  return result;
}

void orchard_cast_rays(const orchard_tree* tree, const orchard_pose* pose, const double* origins,
                       const double* directions, double longest, size_t count, int* hit, double* along) {
  constexpr size_t kPortion = 64;
  std::array<rt::Ray, kPortion> rays;
  std::array<std::optional<rt::RayHit>, kPortion> hits;
  const rt::Pose placed = pose_of(*pose);
  for (size_t begin = 0; begin < count; begin += kPortion) {
    const size_t some = std::min(kPortion, count - begin);
    for (size_t i = 0; i < some; ++i) {
      rays[i] = {vector_of(origins + 3 * (begin + i)), vector_of(directions + 3 * (begin + i)), longest};
    }
    const auto portion = std::span(rays).first(some);
    if (tree->rays.empty()) {
      rt::cast_rays(tree->view, placed, portion, hits);
    } else {
      rt::cast_rays(tree->rays, placed, portion, hits);
    }
    for (size_t i = 0; i < some; ++i) {
      hit[begin + i] = !hits[i] ? 0 : hits[i]->triangle == rt::kNoTriangle ? -1 : 1;
      along[begin + i] = hits[i] ? hits[i]->along : 0;
    }
  }
}

void orchard_collide_all(orchard_workspace* const* workspaces, size_t workspace_count, const orchard_executor* executor,
                         const orchard_tree* const* a, const orchard_pose* poses_a, const orchard_tree* const* b,
                         const orchard_pose* poses_b, size_t count, orchard_verdict* verdicts) {
  const CBatch batch{workspaces, workspace_count, executor, a, poses_a, b, poses_b};
  batch.run(count, [&](rt::Workspace& workspace, const rt::TreePair& pair, const rt::Pose& pose_a,
                       const rt::Pose& pose_b, size_t i) {
    rt::collide(workspace, pair, pose_a, pose_b);
    verdicts[i] = verdict_of(workspace.narrow);
  });
}

void orchard_measure_all(orchard_workspace* const* workspaces, size_t workspace_count, const orchard_executor* executor,
                         const orchard_tree* const* a, const orchard_pose* poses_a, const orchard_tree* const* b,
                         const orchard_pose* poses_b, size_t count, double tolerance, orchard_distance* distances) {
  const CBatch batch{workspaces, workspace_count, executor, a, poses_a, b, poses_b};
  batch.run(count, [&](rt::Workspace& workspace, const rt::TreePair& pair, const rt::Pose& pose_a,
                       const rt::Pose& pose_b, size_t i) {
    distances[i] = distance_of(rt::distance(workspace, pair, pose_a, pose_b, {.relative = tolerance, .absolute = 0}));
  });
}

void orchard_closer_than_all(orchard_workspace* const* workspaces, size_t workspace_count,
                             const orchard_executor* executor, const orchard_tree* const* a,
                             const orchard_pose* poses_a, const orchard_tree* const* b, const orchard_pose* poses_b,
                             size_t count, double margin, int* closer) {
  const CBatch batch{workspaces, workspace_count, executor, a, poses_a, b, poses_b};
  batch.run(count,
            [&](rt::Workspace& workspace, const rt::TreePair& pair, const rt::Pose& pose_a, const rt::Pose& pose_b,
                size_t i) { closer[i] = in_c(rt::closer_than(workspace, pair, pose_a, pose_b, margin)); });
}

}  // extern "C"
