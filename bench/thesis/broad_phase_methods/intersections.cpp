#include "intersections.h"

#include <algorithm>
#include <cmath>

namespace orchard::broad_phase_methods {

using detail::PairSet;
using detail::Search;

namespace detail {

std::size_t PairSet::slot_of(std::uint64_t key) const noexcept {
  std::size_t slot = (key * 0x9e3779b97f4a7c15u >> 20) & (slots_.size() - 1);
  while (slots_[slot] != 0 && slots_[slot] != key) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

bool PairSet::insert(std::uint32_t a, std::uint32_t b) {
  if (2 * (keys_.size() + 1) > slots_.size()) {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), 0);
    for (const std::uint64_t key : keys_) slots_[slot_of(key)] = key;
  }
  const std::uint64_t key = (std::uint64_t{a} << 32 | b) + 1;
  const std::size_t slot = slot_of(key);
  if (slots_[slot] == key) return false;
  slots_[slot] = key;
  keys_.push_back(key);
  return true;
}

bool PairSet::contains(std::uint32_t a, std::uint32_t b) const noexcept {
  const std::uint64_t key = (std::uint64_t{a} << 32 | b) + 1;
  return !keys_.empty() && slots_[slot_of(key)] == key;
}

void PairSet::clear() noexcept {
  if (!keys_.empty()) std::fill(slots_.begin(), slots_.end(), 0);
  keys_.clear();
}

std::size_t PairSet::memory_bytes() const noexcept {
  return (slots_.capacity() + keys_.capacity()) * sizeof(std::uint64_t);
}

void Search::settle(std::uint32_t i, std::uint32_t j) {
  const auto a = std::min(i, j), b = std::max(i, j);
  const double contact = first_contact(bounds[a], bounds[b], duration, shape);
  if (contact < earliest.time && (!filter || filter(a, b))) earliest = {contact, a, b};
}

void Search::faces_meet(std::uint32_t i, std::uint32_t j, std::size_t axis, double t) {
  const SpaceTimeBound &a = bounds[i], &b = bounds[j];
  const double reach = half(i, t) + half(j, t) + contact_slack(a, b, t);
  for (const std::size_t across : {(axis + 1) % 3, (axis + 2) % 3}) {
    if (std::fabs(b.center[across] - a.center[across] + t * (b.velocity[across] - a.velocity[across])) > reach) return;
  }
  if (settled.contains(std::min(i, j), std::max(i, j))) return;
  settle(i, j);
  if (a.has_plane() || b.has_plane()) settled.insert(std::min(i, j), std::max(i, j));
}

}  // namespace detail

struct IntersectionFinder::Scratch {
  Intersections result;
  PairSet settled;
  detail::Sweep sweep;
  detail::Subdivision subdivision;
  std::vector<detail::Face> faces;
  std::vector<std::uint32_t> order;
  std::vector<double> lower, upper;

  template <typename Visit>
  void sort_and_visit(std::span<const SpaceTimeBound> bounds, double duration, Visit&& visit);
  void find_initial(std::span<const SpaceTimeBound> bounds, double duration, const IntersectionOptions& options,
                    const BoundFilter& filter);
  void search(Search& search, const IntersectionOptions& options);
};

// Visits the pairs whose intervals overlap along the axis on which the bounds' centres are spread the most, of the
// cubes swept from 0 to `duration`.
template <typename Visit>
void IntersectionFinder::Scratch::sort_and_visit(std::span<const SpaceTimeBound> bounds, double duration,
                                                 Visit&& visit) {
  Vec3 low{}, high{};
  low.fill(kNoContact), high.fill(-kNoContact);
  for (const SpaceTimeBound& bound : bounds) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], bound.center[d]);
      high[d] = std::max(high[d], bound.center[d]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t d = 1; d < 3; ++d) axis = high[d] - low[d] > high[axis] - low[axis] ? d : axis;

  const std::size_t n = bounds.size();
  order.resize(n), lower.resize(n), upper.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const SpaceTimeBound& b = bounds[i];
    const double end = b.center[axis] + duration * b.velocity[axis], half = b.trapezoid_half(duration);
    order[i] = i;
    lower[i] = std::min(b.center[axis] - b.size, end - half);
    upper[i] = std::max(b.center[axis] + b.size, end + half);
  }
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return lower[a] != lower[b] ? lower[a] < lower[b] : a < b; });
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t i = order[k];
    for (std::size_t m = k + 1; m < n && lower[order[m]] <= upper[i]; ++m) {
      visit(std::min(i, order[m]), std::max(i, order[m]));
    }
  }
}

// 4.3: all of them, and by the cubes, as a cutting plane only hides that they overlap.
void IntersectionFinder::Scratch::find_initial(std::span<const SpaceTimeBound> bounds, double duration,
                                               const IntersectionOptions& options, const BoundFilter& filter) {
  const auto visit = [&](std::uint32_t i, std::uint32_t j) {
    if (!detail::cubes_meet_at_start(bounds[i], bounds[j])) return;
    if (options.shape == BoundShape::horn) {
      const Vec3 apart = bounds[j].center - bounds[i].center;
      const double reach = bounds[i].size + bounds[j].size;
      if (dot(apart, apart) > reach * reach) return;
    }
    if (filter && !filter(i, j)) return;
    result.initial.push_back({first_contact(bounds[i], bounds[j], duration, options.shape), i, j});
  };
  if (options.method == IntersectionMethod::all_pairs) {
    for (std::uint32_t i = 0; i < bounds.size(); ++i) {
      for (std::uint32_t j = i + 1; j < bounds.size(); ++j) visit(i, j);
    }
  } else {
    sort_and_visit(bounds, 0, visit);
    std::sort(result.initial.begin(), result.initial.end(),
              [](const BoundContact& x, const BoundContact& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  }
  for (const BoundContact& contact : result.initial) {
    settled.insert(contact.a, contact.b);
    if (contact.time < result.earliest.time) result.earliest = contact;
  }
}

void IntersectionFinder::Scratch::search(Search& search, const IntersectionOptions& options) {
  const auto n = static_cast<std::uint32_t>(search.bounds.size());
  const bool linear = options.shape == BoundShape::hypertrapezoid;
  if (options.method == IntersectionMethod::all_pairs) {
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = i + 1; j < n; ++j) search.settle(i, j);
    }
  } else if (options.method == IntersectionMethod::projection && options.shape != BoundShape::horn) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      faces.clear();
      for (std::uint32_t i = 0; i < n; ++i) {
        faces.push_back(detail::face_of(search.bounds[i], i, axis, false, options.shape));
        faces.push_back(detail::face_of(search.bounds[i], i, axis, true, options.shape));
      }
      sweep.run(search, axis, faces, 0, search.limit());
    }
  } else if (linear && options.method != IntersectionMethod::sorted) {
    subdivision.run(search, options.base_case, options.method == IntersectionMethod::hybrid);
  } else {
    sort_and_visit(search.bounds, search.limit(), [&](std::uint32_t i, std::uint32_t j) { search.settle(i, j); });
  }
}

IntersectionFinder::IntersectionFinder() : scratch_(std::make_unique<Scratch>()) {}
IntersectionFinder::IntersectionFinder(IntersectionFinder&&) noexcept = default;
IntersectionFinder& IntersectionFinder::operator=(IntersectionFinder&&) noexcept = default;
IntersectionFinder::~IntersectionFinder() = default;

const Intersections& IntersectionFinder::find(std::span<const SpaceTimeBound> bounds, double duration,
                                              const IntersectionOptions& options, const BoundFilter& filter) {
  Scratch& s = *scratch_;
  s.result.initial.clear();
  s.result.earliest = {kNoContact, 0, 0};
  s.result.counts = {};
  s.settled.clear();
  s.find_initial(bounds, duration, options, filter);
  Search search{bounds, duration, options.shape, s.settled, s.result.earliest, filter, s.result.counts};
  if (s.result.earliest.time > 0) s.search(search, options);
  return s.result;
}

std::size_t IntersectionFinder::memory_bytes() const noexcept {
  const Scratch& s = *scratch_;
  return sizeof(Scratch) + s.result.initial.capacity() * sizeof(BoundContact) + s.settled.memory_bytes() +
         s.sweep.memory_bytes() + s.subdivision.memory_bytes() + s.faces.capacity() * sizeof(detail::Face) +
         s.order.capacity() * sizeof(std::uint32_t) + (s.lower.capacity() + s.upper.capacity()) * sizeof(double);
}

}  // namespace orchard::broad_phase_methods
