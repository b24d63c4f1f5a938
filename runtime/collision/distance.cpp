#include "orchard/runtime/distance.h"

#include <new>
#include <utility>

#include "collision/distance_search.h"

namespace orchard::runtime {

DistanceSearch& DistanceQuery::search() noexcept {
  return *std::launder(reinterpret_cast<DistanceSearch*>(storage_.data()));
}
const DistanceSearch& DistanceQuery::search() const noexcept {
  return *std::launder(reinterpret_cast<const DistanceSearch*>(storage_.data()));
}
DistanceSearch& search_of(DistanceQuery& query) noexcept { return query.search(); }

DistanceQuery::DistanceQuery() noexcept {
  static_assert(sizeof(DistanceSearch) <= kSize && alignof(DistanceSearch) <= kAlignment);
  ::new (storage_.data()) DistanceSearch();
}
DistanceQuery::DistanceQuery(DistanceQuery&& other) noexcept {
  ::new (storage_.data()) DistanceSearch(std::move(other.search()));
}
DistanceQuery& DistanceQuery::operator=(DistanceQuery&& other) noexcept {
  search() = std::move(other.search());
  return *this;
}
DistanceQuery::~DistanceQuery() { search().~DistanceSearch(); }

bool DistanceQuery::bind(const PreparedTree& a, const PreparedTree& b) noexcept { return search().bind(a, b); }
void DistanceQuery::start(const Pose& a, const Pose& b, const Tolerance& tolerance) noexcept {
  search().start(a, b, tolerance);
}
void DistanceQuery::start_within(const Pose& a, const Pose& b, double limit) noexcept {
  search().start_within(a, b, limit);
}
void DistanceQuery::refine(const Budget& budget) noexcept { search().refine(budget); }

bool DistanceQuery::finished() const noexcept { return search().finished(); }
double DistanceQuery::lower() const noexcept { return search().lower(); }
double DistanceQuery::upper() const noexcept { return search().upper(); }
std::uint64_t DistanceQuery::work() const noexcept { return search().work(); }
DistanceQuery::Points DistanceQuery::points() const noexcept { return search().points(); }

}  // namespace orchard::runtime
