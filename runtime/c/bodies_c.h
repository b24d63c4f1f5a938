#pragma once
#include "execution/guarded.h"
#include "orchard/runtime/broad_queries.h"
#include "orchard/runtime/orchard_broad_phase.h"

// Bodies and their filters, which the C interfaces of the broad phase and of the detector share.
namespace orchard::runtime::detail {

inline BodyId id_of(orchard_body body) noexcept { return {body.index, body.generation}; }
inline orchard_body body_of(BodyId id) noexcept { return {id.index, id.generation}; }
inline constexpr orchard_body kNobody = {ORCHARD_NO_BODY, 0};

// Without a filter: the default one.
inline BodyFilter filter_of(const orchard_body_filter* from) noexcept {
  return from == nullptr ? BodyFilter{}
                         : BodyFilter{from->category, from->mask, from->group, from->ignores_static != 0};
}
inline QueryFilter filter_of(const orchard_query_filter* from) noexcept {
  return from == nullptr ? QueryFilter{} : QueryFilter{from->category, from->mask};
}

inline PairFilter filter_of(orchard_pair_filter filter, void* context) {
  if (filter == nullptr) return {};
  return [filter, context](BodyId a, BodyId b) { return filter(context, body_of(a), body_of(b)) != 0; };
}

// What `make` gives, or `otherwise` if there is no memory for it.
template <typename Result, typename Make>
Result made_or(Result otherwise, Make&& make) noexcept {
  return guarded([&]() -> Result { return make(); }, [&]() -> Result { return otherwise; });
}

// 1 if a change has been made, else 0.
template <typename Change>
int changed(Change&& change) noexcept {
  return made_or(0, [&] { return change() ? 1 : 0; });
}

}  // namespace orchard::runtime::detail
