#include "orchard/runtime/narrow_phase.h"

#include <new>
#include <utility>

#include "collision/pair_query.h"

namespace orchard::runtime {

PairQuery& NarrowPhase::query() noexcept { return *std::launder(reinterpret_cast<PairQuery*>(storage_.data())); }
const PairQuery& NarrowPhase::query() const noexcept {
  return *std::launder(reinterpret_cast<const PairQuery*>(storage_.data()));
}
PairQuery& query_of(NarrowPhase& pair) noexcept { return pair.query(); }

NarrowPhase::NarrowPhase(std::size_t room) noexcept {
  static_assert(sizeof(PairQuery) <= kSize && alignof(PairQuery) <= kAlignment);
  ::new (storage_.data()) PairQuery(room);
}
NarrowPhase::NarrowPhase(NarrowPhase&& other) noexcept { ::new (storage_.data()) PairQuery(std::move(other.query())); }
NarrowPhase& NarrowPhase::operator=(NarrowPhase&& other) noexcept {
  query() = std::move(other.query());
  return *this;
}
NarrowPhase::~NarrowPhase() { query().~PairQuery(); }

bool NarrowPhase::bind(const PreparedTree& a, const PreparedTree& b) noexcept { return query().bind(a, b); }
bool NarrowPhase::reserve(std::size_t pairs) noexcept { return query().reserve(pairs); }

Answer NarrowPhase::start(const Pose& a, const Pose& b) noexcept { return query().start(a, b); }
Answer NarrowPhase::refine(const Budget& budget) noexcept { return query().refine(budget); }
Answer NarrowPhase::refine_exactly(const Budget& budget) noexcept { return query().refine_exactly(budget); }

Verdict NarrowPhase::verdict() const noexcept { return query().verdict(); }
Answer NarrowPhase::answer() const noexcept { return query().known().answer; }
bool NarrowPhase::finished() const noexcept { return query().finished(); }
bool NarrowPhase::refused() const noexcept { return query().known().refused; }
NarrowPhase::Progress NarrowPhase::progress() const noexcept { return query().progress(); }
double NarrowPhase::separation_bound() const noexcept { return query().known().separation_bound; }
double NarrowPhase::lower_bound() const noexcept { return query().known().lower_bound; }
Contact NarrowPhase::contact() const noexcept { return query().contact(); }

}  // namespace orchard::runtime
