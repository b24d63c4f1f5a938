#include <algorithm>
#include <new>

#include "c/orchard_c.h"
#include "orchard/runtime/time_of_impact.h"

// The C interface of queries about pairs of trees in a workspace, and about many pairs at once.
namespace rt = orchard::runtime;

namespace {

using namespace rt::detail;

// Calls ask(workspace, pair, pose of a, pose of b, i) for each pair i of a batch, with the workspace of the job that
// gets it.
template <typename Ask>
void ask_all(const orchard_batch& of, const Ask& ask) noexcept {
  rt::share_among(executor_of(of.executor), of.workspace_count, of.count, [&](size_t job, size_t i) {
    ask(of.workspaces[job]->workspace, rt::TreePair(of.a[i]->prepared, of.b[i]->prepared), pose_of(of.poses_a[i]),
        pose_of(of.poses_b[i]), i);
  });
}

// A Travel that is converted from C. If a function in C returns its poses, it calls this function.
struct CTravel {
  explicit CTravel(const orchard_travel& from) noexcept : travel_in_c(from), travel(converted<rt::Travel>(from)) {
    static_assert(sizeof(orchard_travel) == sizeof(rt::Travel));
    if (from.pose_at == nullptr) return;
    travel.context = &travel_in_c;
    travel.pose_at = [](const void* context, double time) {
      const auto& own = *static_cast<const orchard_travel*>(context);
      orchard_pose pose{};  // all zeros, which every query refuses
      if (own.pose_at(own.context, time, &pose) == 0) pose = {};
      return pose_of(pose);
    };
  }
  const orchard_travel& travel_in_c;
  rt::Travel travel;
};

}  // namespace

extern "C" {

orchard_workspace* orchard_workspace_new(void) { return new (std::nothrow) orchard_workspace; }
void orchard_workspace_free(orchard_workspace* workspace) { delete workspace; }

int orchard_closer_than(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                        const orchard_tree* b, const orchard_pose* pose_b, double margin, orchard_distance* points) {
  const rt::TreePair pair(a->prepared, b->prepared);
  const rt::Pose at_a = pose_of(*pose_a), at_b = pose_of(*pose_b);
  if (points == nullptr) return in_c(rt::closer_than(workspace->workspace, pair, at_a, at_b, margin));
  const rt::Closeness found = rt::closer_with_points(workspace->workspace, pair, at_a, at_b, margin);
  *points = converted<orchard_distance>(found.distance);
  return in_c(found.answer);
}

orchard_manifold orchard_contacts(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                                  const orchard_tree* b, const orchard_pose* pose_b, double margin) {
  return converted<orchard_manifold>(rt::contacts(workspace->workspace, {a->prepared, b->prepared}, pose_of(*pose_a),
                                                  pose_of(*pose_b), {.margin = margin}));
}

orchard_signed_distance orchard_measure_signed(orchard_workspace* workspace, const orchard_tree* a,
                                               const orchard_pose* pose_a, const orchard_tree* b,
                                               const orchard_pose* pose_b, double tolerance) {
  return converted<orchard_signed_distance>(rt::signed_distance(workspace->workspace, {a->prepared, b->prepared},
                                                                pose_of(*pose_a), pose_of(*pose_b), tolerance));
}

orchard_travel orchard_travel_between(const orchard_pose* from, const orchard_pose* to, const double center[3]) {
  return converted<orchard_travel>(rt::travel_between(pose_of(*from), pose_of(*to), vector_of(center)));
}

orchard_impact orchard_time_of_impact(orchard_workspace* workspace, const orchard_tree* a,
                                      const orchard_travel* travel_a, const orchard_tree* b,
                                      const orchard_travel* travel_b, double begin, double end, double tolerance,
                                      double margin, orchard_budget budget) {
  const CTravel of_a(*travel_a), of_b(*travel_b);
  static_assert(offsetof(orchard_impact, work) == offsetof(rt::Impact, work));
  return converted<orchard_impact>(rt::time_of_impact(
      workspace->workspace, {a->prepared, b->prepared}, of_a.travel, of_b.travel,
      {.begin = begin, .end = end, .tolerance = tolerance, .margin = margin, .budget = budget_of(budget)}));
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
      rt::cast_rays(tree->view(), placed, portion, hits);
    } else {
      rt::cast_rays(tree->rays, placed, portion, hits);
    }
    for (size_t i = 0; i < some; ++i) {
      hit[begin + i] = !hits[i] ? 0 : hits[i]->triangle == rt::kNoTriangle ? -1 : 1;
      along[begin + i] = hits[i] ? hits[i]->along : 0;
    }
  }
}

void orchard_collide_all(const orchard_batch* batch, orchard_verdict* verdicts) {
  ask_all(*batch,
          [&](rt::Workspace& workspace, const rt::TreePair& pair, const rt::Pose& a, const rt::Pose& b, size_t i) {
            rt::collide(workspace, pair, a, b);
            verdicts[i] = verdict_of(workspace.narrow);
          });
}

void orchard_measure_all(const orchard_batch* batch, double tolerance, orchard_distance* distances) {
  ask_all(
      *batch, [&](rt::Workspace& workspace, const rt::TreePair& pair, const rt::Pose& a, const rt::Pose& b, size_t i) {
        distances[i] =
            converted<orchard_distance>(rt::distance(workspace, pair, a, b, {.relative = tolerance, .absolute = 0}));
      });
}

void orchard_closer_than_all(const orchard_batch* batch, double margin, int* closer) {
  ask_all(*batch, [&](rt::Workspace& workspace, const rt::TreePair& pair, const rt::Pose& a, const rt::Pose& b,
                      size_t i) { closer[i] = in_c(rt::closer_than(workspace, pair, a, b, margin)); });
}

}  // extern "C"
