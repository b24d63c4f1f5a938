#pragma once
#include <algorithm>
#include <span>

#include "c/orchard_c.h"
#include "orchard/runtime/broad_queries.h"
#include "orchard/runtime/orchard_broad_phase.h"

// Bodies, their filters and callbacks, which the C interfaces of the broad phase and of the detector share.
namespace orchard::runtime::detail {

inline BodyId id_of(orchard_body body) noexcept { return {body.index, body.generation}; }
inline orchard_body body_of(BodyId id) noexcept { return {id.index, id.generation}; }
inline constexpr orchard_body kNoHandle = {ORCHARD_NO_BODY, 0};

// These return the filter of the C++ interface, or the default one if `from` is null.
inline BodyFilter filter_of(const orchard_body_filter* from) noexcept {
  return from == nullptr ? BodyFilter{} : converted<BodyFilter>(*from);
}
inline QueryFilter filter_of(const orchard_query_filter* from) noexcept {
  return from == nullptr ? QueryFilter{} : converted<QueryFilter>(*from);
}

inline PairFilter filter_of(orchard_pair_filter filter, void* context) {
  if (filter == nullptr) return {};
  return [filter, context](BodyId a, BodyId b) { return filter(context, body_of(a), body_of(b)) != 0; };
}

// Fills `results` with the answers of a source in C, a few at a time. convert(answer) makes a result of an answer.
template <typename InC, typename Source, typename Result, typename Convert>
void ask_in_c(Source source, void* context, double time, std::span<const BodyIndex> bodies, std::span<Result> results,
              const Convert& convert) {
  std::array<InC, 64> answers;
  for (std::size_t done = 0; done < bodies.size(); done += answers.size()) {
    const std::size_t count = std::min(answers.size(), bodies.size() - done);
    source(context, time, bodies.data() + done, count, answers.data());
    std::transform(answers.begin(), answers.begin() + count, results.data() + done, convert);
  }
}

// Returns 1 if a change has been made, otherwise 0, also if there is no memory for it.
template <typename Change>
int changed(Change&& change) noexcept {
  return made_or(0, [&] { return change() ? 1 : 0; });
}

}  // namespace orchard::runtime::detail
