#pragma once
#include <algorithm>
#include <bit>

#include "orchard/runtime/collide.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/orchard.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/tree_file.h"

// What both C interfaces share.
struct orchard_tree {
  orchard::runtime::MappedTree mapped;
  orchard::runtime::PackedSphereTree loaded;
  orchard::runtime::TreeView view;
  orchard::runtime::PreparedTree prepared;
  orchard::runtime::RayIndex rays;  // empty unless asked for
};

struct orchard_workspace {
  orchard::runtime::Workspace workspace;
};

namespace orchard::runtime::detail {

inline Workspace& workspace_of(orchard_workspace* workspace) noexcept { return workspace->workspace; }

// They are alike in both languages, number by number.
inline Pose pose_of(const orchard_pose& from) noexcept { return std::bit_cast<Pose>(from); }
inline orchard_pose pose_in_c(const Pose& from) noexcept { return std::bit_cast<orchard_pose>(from); }

inline std::chrono::nanoseconds time_of(std::uint64_t nanoseconds) noexcept {
  const auto longest = static_cast<std::uint64_t>(std::chrono::nanoseconds::max().count());
  return nanoseconds < longest ? std::chrono::nanoseconds(nanoseconds) : std::chrono::nanoseconds::max();
}

// Where answers in C have a contact: a verdict's and a touch's fields are alike.
template <typename InC>
void put_contact(const Contact& contact, InC& result) noexcept {
  std::copy_n(contact.center.begin(), 3, result.contact_center);
  std::copy_n(contact.normal.begin(), 3, result.contact_normal);
  result.contact_radius = contact.radius;
  result.triangle_a = contact.triangle_a;
  result.triangle_b = contact.triangle_b;
}

inline orchard_manifold manifold_of(const Manifold& m) noexcept {
  orchard_manifold result{};
  result.answer = static_cast<orchard_answer>(m.answer);
  result.count = m.count;
  for (std::uint32_t i = 0; i < m.count; ++i) {
    std::copy_n(m.points[i].place.begin(), 3, result.points[i]);
    result.triangles[i][0] = m.points[i].triangle_a, result.triangles[i][1] = m.points[i].triangle_b;
    result.depths[i] = m.points[i].depth;
  }
  std::copy_n(m.normal.begin(), 3, result.normal);
  result.depth = m.depth;
  result.error = m.error;
  result.complete = m.complete;
  return result;
}

inline orchard_verdict verdict_of(const Verdict& v) noexcept {
  orchard_verdict result{};
  result.answer = static_cast<orchard_answer>(v.answer);
  result.separation_bound = v.separation_bound;
  result.lower_bound = v.lower_bound;
  put_contact(v.contact, result);
  result.level = v.level;
  result.work = v.work;
  return result;
}

inline orchard_verdict verdict_of(const NarrowPhase& pair) noexcept {
  orchard_verdict result = verdict_of(pair.verdict());
  result.finished = pair.finished();
  result.refused = pair.refused();
  return result;
}

inline orchard_distance distance_of(const Distance& measured) noexcept {
  orchard_distance result{};
  result.lower = measured.lower;
  result.upper = measured.upper;
  std::copy_n(measured.points.on_a.begin(), 3, result.on_a);
  std::copy_n(measured.points.on_b.begin(), 3, result.on_b);
  result.triangle_a = measured.points.triangle_a;
  result.triangle_b = measured.points.triangle_b;
  return result;
}

inline std::array<double, 3> vector_of(const double* v) noexcept { return {v[0], v[1], v[2]}; }

inline Budget budget_of(const orchard_budget& from) noexcept {
  Budget budget;
  budget.work = from.tests;
  budget.time = time_of(from.nanoseconds);
  return budget;
}

// 1, 0, or -1 for "maybe".
inline int in_c(Answer answer) noexcept { return answer == Answer::yes ? 1 : answer == Answer::no ? 0 : -1; }

}  // namespace orchard::runtime::detail
