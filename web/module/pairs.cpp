#include <vector>

#include "module.h"

using namespace orchard::web;

namespace {

orchard_workspace* workspace() {
  static orchard_workspace* const only = orchard_workspace_new();
  return only;
}

void say(double* out, const orchard_manifold& manifold) { put(out, manifold); }

}  // namespace

// `poses`, here and below: that of a, then that of b, a row each.
ORCHARD_EXPORT(pair_new) orchard_pair* web_pair_new(const orchard_tree* a, const orchard_tree* b) {
  return orchard_pair_new(a, b);
}
ORCHARD_EXPORT(pair_free) void web_pair_free(orchard_pair* pair) { orchard_pair_free(pair); }
ORCHARD_EXPORT(pair_collide)
void web_pair_collide(orchard_pair* pair, const double* poses, double tests, double microseconds, double* out) {
  put(out, orchard_collide(pair, &pose_at(poses, 0), &pose_at(poses, 1), budget_of(tests, microseconds)));
}
ORCHARD_EXPORT(pair_collide_again) void web_pair_collide_again(orchard_pair* pair, const double* poses, double* out) {
  put(out, orchard_collide_again(pair, &pose_at(poses, 0), &pose_at(poses, 1)));
}
ORCHARD_EXPORT(pair_start) void web_pair_start(orchard_pair* pair, const double* poses, double* out) {
  put(out, orchard_start(pair, &pose_at(poses, 0), &pose_at(poses, 1)));
}
ORCHARD_EXPORT(pair_refine) void web_pair_refine(orchard_pair* pair, double tests, double microseconds, double* out) {
  put(out, orchard_refine(pair, budget_of(tests, microseconds)));
}
ORCHARD_EXPORT(pair_distance)
void web_pair_distance(orchard_pair* pair, const double* poses, double tolerance, double* out) {
  put(out, orchard_measure(pair, &pose_at(poses, 0), &pose_at(poses, 1), tolerance));
}

ORCHARD_EXPORT(closer_than)
int web_closer_than(const orchard_tree* a, const orchard_tree* b, const double* poses, double margin) {
  return orchard_closer_than(workspace(), a, &pose_at(poses, 0), b, &pose_at(poses, 1), margin, nullptr);
}
ORCHARD_EXPORT(contacts)
void web_contacts(const orchard_tree* a, const orchard_tree* b, const double* poses, double margin, double* out) {
  say(out, orchard_contacts(workspace(), a, &pose_at(poses, 0), b, &pose_at(poses, 1), margin));
}
// Lower, upper, a point on each, the direction in which b leaves a.
ORCHARD_EXPORT(signed_distance)
void web_signed_distance(const orchard_tree* a, const orchard_tree* b, const double* poses, double tolerance,
                         double* out) {
  const orchard_signed_distance d =
      orchard_measure_signed(workspace(), a, &pose_at(poses, 0), b, &pose_at(poses, 1), tolerance);
  *out++ = d.lower;
  *out++ = d.upper;
  out = put(out, d.on_a, 3);
  out = put(out, d.on_b, 3);
  put(out, d.normal, 3);
}

// Against one tree: `row` is the pose, then the numbers of the question. 1, 0, or -1 where nothing can be said.
ORCHARD_EXPORT(contains) int web_contains(const orchard_tree* tree, const double* row) {
  return orchard_contains(tree, &pose_at(row), row + kPoseRow);
}
ORCHARD_EXPORT(capsule_touches) int web_capsule_touches(const orchard_tree* tree, const double* row) {
  const double* const capsule = row + kPoseRow;
  return orchard_capsule_touches(tree, &pose_at(row), capsule, capsule + 3, capsule[6]);
}
// Half the edges' lengths, then the box's pose.
ORCHARD_EXPORT(box_touches) int web_box_touches(const orchard_tree* tree, const double* row) {
  return orchard_box_touches(tree, &pose_at(row), row + kPoseRow, &pose_at(row + kPoseRow + 3));
}
// Origin, direction, longest; the factor of the direction.
ORCHARD_EXPORT(cast_ray) int web_cast_ray(const orchard_tree* tree, const double* row, double* out) {
  const double* const ray = row + kPoseRow;
  return orchard_cast_ray(tree, &pose_at(row), ray, ray + 3, ray[6], out);
}
ORCHARD_EXPORT(index_rays) int web_index_rays(orchard_tree* tree) { return orchard_index_rays(tree); }
// The point, the limit; the distance, the nearest point, the direction in which the distance grows, the triangle.
ORCHARD_EXPORT(nearest_point) int web_nearest_point(const orchard_tree* tree, const double* row, double* out) {
  const double* const asked = row + kPoseRow;
  std::uint32_t triangle = ORCHARD_NO_TRIANGLE;
  const int found =
      orchard_signed_nearest_point(tree, &pose_at(row), asked, asked[3], out, out + 1, out + 4, &triangle);
  out[7] = triangle;
  return found;
}

// Many pairs: handles of trees, a row of pose for each body, a row of answer for each pair. In pieces, as the answers
// in C need memory of their own.
namespace {

constexpr std::size_t kPiece = 256;

template <typename Answer, typename Ask>
void in_pieces(std::size_t count, double* out, const Ask& ask) {
  static std::vector<Answer> answers(kPiece);
  for (std::size_t begin = 0; begin < count; begin += kPiece) {
    const std::size_t size = std::min(kPiece, count - begin);
    ask(begin, size, answers.data());
    for (std::size_t i = 0; i < size; ++i) out = put(out, answers[i]);
  }
}

}  // namespace

ORCHARD_EXPORT(collide_all)
void web_collide_all(const orchard_tree* const* a, const double* poses_a, const orchard_tree* const* b,
                     const double* poses_b, std::size_t count, double* out) {
  orchard_workspace* const only = workspace();
  in_pieces<orchard_verdict>(count, out, [&](std::size_t i, std::size_t size, orchard_verdict* verdicts) {
    const orchard_batch batch{a + i, &pose_at(poses_a, i), b + i, &pose_at(poses_b, i), size, &only, 1, nullptr};
    orchard_collide_all(&batch, verdicts);
  });
}
ORCHARD_EXPORT(distance_all)
void web_distance_all(const orchard_tree* const* a, const double* poses_a, const orchard_tree* const* b,
                      const double* poses_b, std::size_t count, double tolerance, double* out) {
  orchard_workspace* const only = workspace();
  in_pieces<orchard_distance>(count, out, [&](std::size_t i, std::size_t size, orchard_distance* distances) {
    const orchard_batch batch{a + i, &pose_at(poses_a, i), b + i, &pose_at(poses_b, i), size, &only, 1, nullptr};
    orchard_measure_all(&batch, tolerance, distances);
  });
}
ORCHARD_EXPORT(closer_than_all)
void web_closer_than_all(const orchard_tree* const* a, const double* poses_a, const orchard_tree* const* b,
                         const double* poses_b, std::size_t count, double margin, std::int32_t* out) {
  orchard_workspace* const only = workspace();
  static_assert(sizeof(int) == sizeof(std::int32_t));
  const orchard_batch batch{a, &pose_at(poses_a), b, &pose_at(poses_b), count, &only, 1, nullptr};
  orchard_closer_than_all(&batch, margin, out);
}
