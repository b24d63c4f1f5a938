#include <algorithm>
#include <cmath>
#include <limits>

#include "insertion/cavity.h"
#include "predicates/vectors.h"
#include "workspace/workspace_four.h"

namespace orchard::detail {
namespace {

// How many deleted vertices ahead of the current one memory is fetched into the cache. If there are at most so many
// points or vertices as given here, they are in the cache already.
constexpr std::size_t kFetchAhead = 3, kPointsInCache = 1u << 13, kVerticesInCache = 1u << 16;

// The number of deleted vertices after which delete_nearer_in_sight() examines the boundary for the first time. It does
// so again after twice as many, and so on.
constexpr std::size_t kFirstLook = 16;

// a limit that is never reached
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

}  // namespace

bool Cavity::delete_nearer(Index start) {
  if (!territory_.owns(start)) return leave_territory(start);
  delete_vertex(start);
  undoubted_ = true;
  const bool certain = delete_nearer_around(0, kAll);
  is_boundary_noted_ = true;
  undoubted_ = undoubted_ && certain;
  return certain;
}

// The search never deletes a vertex that it has kept. So a facet of the boundary that is not visible now will not
// become visible. Facets that are seen almost from the side are left to place_vertices().
bool Cavity::delete_nearer_in_sight(Index start, bool& certain) {
  delete_vertex(start);
  undoubted_ = certain = true;
  std::size_t looked_around = 0, looked_at = 0;
  for (std::size_t step = kFirstLook; looked_around < deleted_.size(); step *= 2) {
    const std::size_t end = looked_around + step;
    certain &= delete_nearer_around(looked_around, end);
    looked_around = std::min(end, deleted_.size());
    if (looked_around == deleted_.size()) break;
    for (; looked_at < boundary_.size(); ++looked_at) {
      const Index facet = boundary_.items()[looked_at];
      if (is_turned_away(facet / 4, facet % 4)) return false;
    }
  }
  is_boundary_noted_ = true;
  undoubted_ = undoubted_ && certain;
  return true;
}

// Returns true where side_of_facet() is certainly negative by the error bound of doubles.
bool Cavity::is_turned_away(Index v, unsigned i) const {
  const auto& [a, b, c] = kOthers[i];
  const auto& corner = workspace_.vertices[v].forming_points;
  const auto from_new = [&](unsigned k) -> Vector { return workspace_.points[corner[k]] - position_; };
  return corner[c] != kInfinitePoint && volume(from_new(a), from_new(b), from_new(c)).sign() == Sign::negative;
}

bool Cavity::delete_nearer_around(std::size_t first, std::size_t end) {
  return can_place_four() ? delete_nearer_by_four(first, end) : delete_nearer_one_by_one(first, end);
}

bool Cavity::leave_territory(Index blocker) {
  left_territory_ = true;
  blocker_ = blocker;
  return false;
}

// Inlining is forced because a compiler may regard a function that only fetches as one without effect, and omit it. It
// fetches what the search needs when it examines this vertex: the neighbours now, and the forming points in
// note_facets().
[[gnu::always_inline]] inline void Cavity::fetch_around(Index v) const {
  const VoronoiVertex& vertex = workspace_.vertices[v];
  for (const Index u : vertex.neighbors) workspace_.prefetch(u);
  if (local_of_.size() <= kPointsInCache) return;
  for (const Index p : vertex.forming_points) {
    __builtin_prefetch(workspace_.points.data() + p);
    __builtin_prefetch(local_of_.data() + static_cast<Index>(p + 1));
  }
}

// Returns the neighbours of a deleted vertex, and reserves memory for the entries that they may need.
inline std::array<Index, 4> Cavity::neighbors_of_deleted(std::size_t i) {
  deleted_.ensure_room();
  seen_.ensure_room();
  boundary_.ensure_room();
  if (workspace_.vertices.size() > kVerticesInCache)
    fetch_around(deleted_.items()[std::min(i + kFetchAhead, deleted_.size() - 1)]);
  return workspace_.vertices[deleted_.items()[i]].neighbors;
}

// For vertices where the stored centre does not decide, and the doubt is not due to the input.
bool Cavity::is_nearer_after_all(Index u, bool& certain) {
  const Sign sign = workspace_.doubtful_sign(u, position_, workspace_.power_bound(u));
  const bool nearer = sign == Sign::positive;
  certain = certain && sign != Sign::uncertain;
  undoubted_ = undoubted_ && (nearer || workspace_.at_infinity(u) || !workspace_.may_share_sphere(u, position_));
  return nearer;
}

unsigned Cavity::nearer_after_all(const std::array<Index, 4>& u, unsigned which, bool& certain) {
  std::array<Sign, 4> signs{};
  if ((which & (which - 1)) != 0) signs = workspace_.doubtful_signs(u, which, position_);
  unsigned nearer = 0;
  for (; which != 0; which &= which - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(which));
    bool is_nearer = signs[i] == Sign::positive;
    if (signs[i] == Sign::uncertain)
      is_nearer = is_nearer_after_all(u[i], certain);
    else
      undoubted_ = undoubted_ && (is_nearer || !workspace_.may_share_sphere(u[i], position_));
    nearer |= (is_nearer ? 1u : 0u) << i;
  }
  return nearer;
}

bool Cavity::delete_nearer_one_by_one(std::size_t first, std::size_t end) {
  const Point q = position_;
  const double doubtful_input = workspace_.doubtful_input();
  bool certain = true;
  for (std::size_t i = first; i < std::min(deleted_.size(), end); ++i) {
    const Index v = deleted_.items()[i];
    const std::array<Index, 4> neighbors = neighbors_of_deleted(i);
    for (unsigned slot = 0; slot < 4; ++slot) {
      const Index u = neighbors[slot];
      const Mark mark = workspace_.mark(u);
      const bool unseen = mark == Mark::unseen, owned = territory_.owns(u);
      const double power = workspace_.power(u, q), bound = workspace_.power_bound(u);
      bool nearer = power > bound;
      if (unseen && !(std::abs(power) > bound)) {
        if (bound < doubtful_input * workspace_.vertices[u].radius)
          certain = false;
        else
          nearer = is_nearer_after_all(u, certain);
      }
      if (!owned && nearer) return leave_territory(u);
      workspace_.add_mark(u, unseen & owned, nearer ? Mark::deleted : Mark::kept);
      deleted_.push_if(u, unseen & nearer);
      seen_.push_if(u, unseen & !nearer & owned);
      boundary_.push_if(4 * v + slot, (mark == Mark::kept) | (unseen & !nearer));
    }
  }
  return certain;
}

// Mispredicted branches would take most of the time here, because it cannot be predicted whether a neighbour has been
// seen, and which sign it has. So every neighbour is tested, and the results of those that have been seen are masked
// out. The ends of the lists are kept in local variables, because values in memory would have to be loaded again after
// each store.
#ifdef ORCHARD_FOUR_LANES
[[gnu::target("avx2")]] bool Cavity::delete_nearer_by_four(std::size_t first, std::size_t end) {
  const FourVectors q{all_four(position_.x()), all_four(position_.y()), all_four(position_.z())};
  const double doubtful_input = workspace_.doubtful_input();
  const bool whole = territory_.whole(), fetches = workspace_.vertices.size() > kVerticesInCache;
  bool certain = true;
  Index blocker = kNone;
  std::size_t room = 2 * (deleted_.size() + seen_.size() + boundary_.size()) + 64;
  List::Open deleted = deleted_.open(deleted_.size(), room), seen = seen_.open(seen_.size(), room),
             boundary = boundary_.open(boundary_.size(), room);
  for (std::size_t i = first; i < std::min(deleted.count, end); ++i) {
    if (const std::size_t listed = deleted.count + seen.count + boundary.count; listed + 4 > room) {
      room = 2 * listed;
      deleted = deleted_.open(deleted.count, room);
      seen = seen_.open(seen.count, room);
      boundary = boundary_.open(boundary.count, room);
    }
    const Index v = deleted.items[i];
    if (fetches) fetch_around(deleted.items[std::min(i + kFetchAhead, deleted.count - 1)]);
    const std::array<Index, 4> neighbors = workspace_.vertices[v].neighbors;
    const unsigned owned = whole ? 0xf : territory_.owned(neighbors);
    const auto [marks, far, near, input] = workspace_.test_four(neighbors, q, doubtful_input);
    const unsigned unseen = marks.unseen, doubtful = unseen & ~(far | near);
    unsigned nearer = unseen & near;
    certain &= (doubtful & input) == 0;
    if (const unsigned after_all = doubtful & ~input; after_all != 0) [[unlikely]] {
      nearer |= nearer_after_all(neighbors, after_all, certain);
      // Only these are marked if they are kept. Testing the others again is faster than marking them.
      const unsigned seen_now = after_all & ~nearer & owned;
      workspace_.add_marks(neighbors, 0, seen_now);
      seen.push_four(_mm_loadu_si128(reinterpret_cast<const __m128i*>(neighbors.data())), seen_now);
    }
    if (const unsigned beyond = nearer & ~owned; beyond != 0) {
      blocker = neighbors[static_cast<std::size_t>(std::countr_zero(beyond))];
      break;
    }
    const unsigned kept = unseen & ~nearer;
    workspace_.add_marks(neighbors, nearer, 0);
    const __m128i items = _mm_loadu_si128(reinterpret_cast<const __m128i*>(neighbors.data()));
    deleted.push_four(items, nearer);
    // What is kept now will not be deleted by this search.
    boundary.push_four(_mm_add_epi32(_mm_set1_epi32(static_cast<int>(4 * v)), _mm_set_epi32(3, 2, 1, 0)),
                       marks.kept | kept);
  }
  deleted_.resize(deleted.count);
  seen_.resize(seen.count);
  boundary_.resize(boundary.count);
  return blocker == kNone ? certain : leave_territory(blocker);
}
#else
bool Cavity::delete_nearer_by_four(std::size_t first, std::size_t end) { return delete_nearer_one_by_one(first, end); }
#endif

bool Cavity::widen() {
  const std::size_t before = deleted_.size();
  for (const Facet& facet : facets_) {
    if (facet.visible || workspace_.mark(facet.outside) == Mark::deleted ||
        workspace_.sign(facet.outside, position_) != Sign::uncertain)
      continue;
    if (!territory_.owns(facet.outside)) return leave_territory(facet.outside);
    delete_vertex(facet.outside);
  }
  delete_nearer_around(before, kAll);
  return deleted_.size() > before;
}

}  // namespace orchard::detail
