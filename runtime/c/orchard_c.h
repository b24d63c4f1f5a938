#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "execution/guarded.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/orchard.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/tree_file.h"

// Types that all C interfaces share.
struct orchard_tree {
  orchard::runtime::MappedTree mapped;
  orchard::runtime::PackedSphereTree loaded;
  orchard::runtime::PreparedTree prepared;
  orchard::runtime::RayIndex rays;  // empty unless asked for
  const orchard::runtime::TreeView& view() const noexcept { return prepared.tree; }
};

struct orchard_workspace {
  orchard::runtime::Workspace workspace;
};

namespace orchard::runtime::detail {

// Converts a struct of C to that of C++, or back. Both have the same members in the same order. The longer one may have
// further members behind them, which are 0 in a result.
template <typename To, typename From>
To converted(const From& from) noexcept {
  static_assert(std::is_standard_layout_v<To> && std::is_standard_layout_v<From>);
  static_assert(std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
  To result{};
  std::memcpy(static_cast<void*>(&result), &from, sizeof result < sizeof from ? sizeof result : sizeof from);
  return result;
}

static_assert(offsetof(orchard_pose, scale) == offsetof(Pose, scale));
static_assert(offsetof(orchard_verdict, work) == offsetof(Verdict, work));
static_assert(offsetof(orchard_verdict, finished) == sizeof(Verdict));
static_assert(offsetof(orchard_distance, triangle_b) ==
              offsetof(Distance, points) + offsetof(DistanceQuery::Points, triangle_b));
static_assert(offsetof(orchard_manifold, complete) == offsetof(Manifold, complete));
static_assert(sizeof(orchard_contact_point) == sizeof(ContactPoint));
static_assert(offsetof(orchard_signed_distance, normal) == offsetof(SignedDistance, normal));

inline Pose pose_of(const orchard_pose& from) noexcept { return converted<Pose>(from); }

inline orchard_verdict verdict_of(const NarrowPhase& pair) noexcept {
  auto result = converted<orchard_verdict>(pair.verdict());
  result.finished = pair.finished();
  result.refused = pair.refused();
  return result;
}

inline std::array<double, 3> vector_of(const double* v) noexcept { return {v[0], v[1], v[2]}; }

inline Budget budget_of(const orchard_budget& from) noexcept {
  constexpr std::chrono::nanoseconds longest = Budget{}.time;
  const bool limited = from.nanoseconds < static_cast<std::uint64_t>(longest.count());
  return {from.tests, limited ? std::chrono::nanoseconds(from.nanoseconds) : longest};
}

// Returns the executor of the C++ interface. If there is none, jobs run one after the other.
inline Executor executor_of(const orchard_executor* from) noexcept {
  return from == nullptr ? Executor{} : converted<Executor>(*from);
}

// Returns 1 for "yes", 0 for "no", and -1 for "maybe".
inline int in_c(Answer answer) noexcept { return answer == Answer::yes ? 1 : answer == Answer::no ? 0 : -1; }

}  // namespace orchard::runtime::detail
