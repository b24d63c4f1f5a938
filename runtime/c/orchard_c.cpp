#include <algorithm>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "c/orchard_c.h"

namespace rt = orchard::runtime;

struct orchard_pair {
  orchard_pair(const orchard_tree* a, const orchard_tree* b) noexcept : pair(a->prepared, b->prepared), workspace(0) {
    bind();
    workspace.distance.bind(a->prepared, b->prepared);
  }
  void bind() noexcept { workspace.narrow.bind(pair.a(), pair.b()); }
  rt::TreePair pair;
  rt::Workspace workspace;
};

namespace {

using namespace rt::detail;

int given(const std::optional<rt::Pose>& from, orchard_pose* to) noexcept {
  if (from) *to = converted<orchard_pose>(*from);
  return int{from.has_value()};
}

// Returns a tree that load(tree) has filled. If there is none, returns null and sets `error` to the reason.
template <typename Load>
orchard_tree* opened(const char** error, const Load& load) noexcept {
  std::unique_ptr<orchard_tree> tree;
  const rt::LoadStatus status = made_or(rt::LoadStatus::out_of_memory, [&] {
    tree = std::make_unique<orchard_tree>();
    return load(*tree);
  });
  if (status != rt::LoadStatus::ok) {
    if (error != nullptr) *error = rt::message(status);
    return nullptr;
  }
  const rt::TreeView mapped = tree->mapped.view();
  tree->prepared = rt::PreparedTree(mapped.blocks.empty() ? rt::TreeView(tree->loaded) : mapped);
  return tree.release();
}

// Returns the tree that make() returns, or null if it returns no valid one or there is no memory for it.
template <typename Make>
orchard_tree* made(const Make& make) noexcept {
  return opened(nullptr, [&](orchard_tree& tree) {
    std::optional<rt::PackedSphereTree> shape = make();
    if (!shape || rt::structure_fault(*shape) != nullptr) return rt::LoadStatus::invalid_structure;
    tree.loaded = std::move(*shape);
    return rt::LoadStatus::ok;
  });
}

// Stores a nearest point, where the arguments are not null. Returns 1 if there is one, 0 if not, -1 if nothing is
// known.
int given(const rt::SurfacePoint& from, double* distance, double* point, uint32_t* triangle) noexcept {
  if (distance != nullptr) *distance = from.distance;
  if (point != nullptr) std::copy_n(from.point.begin(), 3, point);
  if (triangle != nullptr) *triangle = from.triangle;
  return from.triangle != rt::kNoTriangle ? 1 : from.distance == 0 ? -1 : 0;
}

}  // namespace

extern "C" {

const char* orchard_version(void) { return ORCHARD_VERSION_STRING; }

orchard_pose orchard_identity(void) { return converted<orchard_pose>(rt::Pose{}); }

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
  return opened(error, [path](orchard_tree& tree) { return rt::load_file(path, tree.loaded); });
}

orchard_tree* orchard_tree_open(const char* path, const char** error) {
  return opened(error, [path](orchard_tree& tree) { return tree.mapped.open(path); });
}

orchard_tree* orchard_tree_load(const void* bytes, size_t size, const char** error) {
  const std::span file(static_cast<const std::byte*>(bytes), size);
  return opened(error, [file](orchard_tree& tree) { return rt::load(file, tree.loaded); });
}

void orchard_tree_close(orchard_tree* tree) { delete tree; }
double orchard_tree_bounding_radius(const orchard_tree* tree) { return tree->view().bounding_radius; }
size_t orchard_tree_triangles(const orchard_tree* tree) { return tree->view().triangles.size(); }

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
  auto result = converted<orchard_verdict>(verdict);
  result.finished = true;
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
  return converted<orchard_distance>(
      rt::distance(pair->workspace, pair->pair, pose_of(*a), pose_of(*b), {.relative = tolerance, .absolute = 0}));
}

int orchard_capsule_touches(const orchard_tree* tree, const orchard_pose* pose, const double p[3], const double q[3],
                            double radius) {
  return in_c(rt::touches_capsule(tree->view(), pose_of(*pose), vector_of(p), vector_of(q), radius));
}

int orchard_contains(const orchard_tree* tree, const orchard_pose* pose, const double point[3]) {
  const rt::Pose placed = pose_of(*pose);
  if (!rt::can_ask(tree->view(), placed, vector_of(point))) return -1;
  return rt::contains(tree->view(), placed, vector_of(point));
}

int orchard_cast_ray(const orchard_tree* tree, const orchard_pose* pose, const double origin[3],
                     const double direction[3], double longest, double* along) {
  const rt::Pose placed = pose_of(*pose);
  const auto from = vector_of(origin), way = vector_of(direction);
  const auto hit = tree->rays.empty() ? rt::cast_ray(tree->view(), placed, from, way, longest)
                                      : rt::cast_ray(tree->rays, placed, from, way, longest);
  if (hit && along != nullptr) *along = hit->along;
  if (!hit) return 0;
  return hit->triangle == rt::kNoTriangle ? -1 : 1;
}

int orchard_index_rays(orchard_tree* tree) {
  return made_or(0, [tree] {
    tree->rays = rt::RayIndex(tree->view());
    return 1;
  });
}

int orchard_nearest_point(const orchard_tree* tree, const orchard_pose* pose, const double center[3], double limit,
                          double* distance, double point[3], uint32_t* triangle) {
  return given(rt::nearest_point(tree->view(), pose_of(*pose), vector_of(center), limit), distance, point, triangle);
}

int orchard_signed_nearest_point(const orchard_tree* tree, const orchard_pose* pose, const double center[3],
                                 double limit, double* distance, double point[3], double normal[3],
                                 uint32_t* triangle) {
  const rt::SignedPoint found = rt::signed_nearest_point(tree->view(), pose_of(*pose), vector_of(center), limit);
  if (normal != nullptr) std::copy_n(found.normal.begin(), 3, normal);
  return given(found.surface, distance, point, triangle);
}

int orchard_box_touches(const orchard_tree* tree, const orchard_pose* pose, const double half[3],
                        const orchard_pose* box) {
  return in_c(rt::touches_box(tree->view(), pose_of(*pose), vector_of(half), pose_of(*box)).answer);
}

int orchard_hull_touches(const orchard_tree* tree, const orchard_pose* pose, const double* corners, size_t corner_count,
                         const uint32_t* facets, size_t facet_count, const orchard_pose* hull) {
  if (corner_count > rt::kMaxCorners || facet_count > rt::kMaxFacets) return -1;
  std::array<std::array<double, 3>, rt::kMaxCorners> points;
  std::array<std::array<std::uint32_t, 3>, rt::kMaxFacets> triangles;
  for (size_t i = 0; i < corner_count; ++i) points[i] = vector_of(corners + 3 * i);
  for (size_t i = 0; i < facet_count; ++i) std::copy_n(facets + 3 * i, 3, triangles[i].begin());
  const rt::ConvexShape shape{std::span(points).first(corner_count), std::span(triangles).first(facet_count)};
  return in_c(rt::touches_convex(tree->view(), pose_of(*pose), shape, pose_of(*hull)).answer);
}

double orchard_plane_distance(const orchard_tree* tree, const orchard_pose* pose, const double normal[3],
                              double offset) {
  return rt::deepest_point(tree->view(), pose_of(*pose), vector_of(normal), offset).distance;
}

orchard_tree* orchard_point_tree(const double point[3]) {
  return made([&] { return rt::point_tree(vector_of(point)); });
}
orchard_tree* orchard_segment_tree(const double p[3], const double q[3]) {
  return made([&] { return rt::segment_tree(vector_of(p), vector_of(q)); });
}
orchard_tree* orchard_box_tree(const double half[3]) {
  return made([&] { return rt::box_tree(vector_of(half)); });
}
orchard_tree* orchard_hull_tree(const double* points, size_t count) {
  return made([&] {
    std::vector<std::array<double, 3>> copy;
    for (size_t i = 0; i < count; ++i) copy.push_back(vector_of(points + 3 * i));
    return rt::hull_tree(copy);
  });
}

}  // extern "C"
