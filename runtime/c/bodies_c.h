#pragma once
#include "orchard/runtime/broad_queries.h"
#include "orchard/runtime/orchard_broad_phase.h"

// Bodies and their filters, which the C interfaces of the broad phase and of the detector share.
namespace orchard::runtime::detail {

inline BodyId id_of(orchard_body body) noexcept { return {body.index, body.generation}; }
inline orchard_body body_of(BodyId id) noexcept { return {id.index, id.generation}; }

// Without a filter: the default one.
inline BodyFilter filter_of(const orchard_body_filter* from) noexcept {
  return from == nullptr ? BodyFilter{}
                         : BodyFilter{from->category, from->mask, from->group, from->ignores_static != 0};
}
inline QueryFilter filter_of(const orchard_query_filter* from) noexcept {
  return from == nullptr ? QueryFilter{} : QueryFilter{from->category, from->mask};
}

}  // namespace orchard::runtime::detail
