#include "insertion/insertion.h"

#include <algorithm>

namespace orchard::detail {
namespace {

constexpr std::size_t kNearby = 64;  // vertices with uncertain signs that are searched before all vertices are

// The most vertices that searches of all vertices may look at together: so many times their number, plus a constant.
// Such a search rarely succeeds; if more are necessary, building the diagram again with exact signs takes less time.
constexpr std::size_t kMaxSearches = 8, kMaxSearched = 1u << 20;

// The most steps of a walk in a region. Vertices that it must not read can lead it astray. The number is a few times
// that of a walk through a million points.
constexpr std::size_t kPatience = 1024;

}  // namespace

// Finds a vertex that is nearer to q than to its forming points, or one that comes as near to that as can be found. It
// walks uphill by power: of two neighbours, the one on q's side of their common facet has the greater power, so the
// walk goes straight to q. Where several vertices share one sphere, their powers are equal, and the side of the facet
// on which q lies decides instead.
Index Inserter::locate(const Point& q) const {
  const Index reached = walk(q);
  return workspace_.sign(reached, q) == Sign::positive ? reached : highest_nearby(reached, q);
}

// Searches breadth-first from where the walk ended, through vertices with uncertain signs. If none of them is certainly
// nearer to q, searches all vertices, as long as that is worth while (is_lost()).
Index Inserter::highest_nearby(Index v, const Point& q) const {
  std::vector<Index> reached{v};
  for (std::size_t i = 0; i < reached.size() && i < kNearby; ++i)
    for (Index u : workspace_.vertices[reached[i]].neighbors) {
      if (std::find(reached.begin(), reached.end(), u) != reached.end()) continue;
      const Sign sign = workspace_.sign(u, q);
      if (sign == Sign::positive) return u;
      if (sign == Sign::uncertain || i == 0) reached.push_back(u);
    }
  return is_lost() ? v : highest_of_all(q);
}

Index Inserter::walk(const Point& q) const {
  Index v = last_;
  if (workspace_.at_infinity(v)) v = workspace_.vertices[v].neighbors[3];
  Index came_from = kNone;
  workspace_.settle(v);
  double here = workspace_.power(v, q);
  const std::size_t patience = territory_.whole() ? workspace_.vertices.size() + 64 : kPatience;
  for (std::size_t steps = 0; steps < patience; ++steps) {
    if (here > workspace_.power_bound(v)) return v;
    Index next = kNone;
    const std::array<Index, 4> neighbors = workspace_.neighbors_now(v);
    for (const Index u : neighbors) workspace_.prefetch(u);
    for (const Index u : neighbors) {
      if (u == came_from || !territory_.may_read(u)) continue;
      double power = workspace_.power(u, q);
      if (power > 0 && !workspace_.settled(u)) {
        workspace_.settle(u);
        power = workspace_.power(u, q);
      }
      // On the way a vertex need not be settled: an approximate power is enough to go uphill.
      const double bound = workspace_.settled(u) ? workspace_.power_bound(u) : 0;
      if (power > bound) return u;
      if (power > here + bound) {
        if (bound == std::numeric_limits<double>::infinity()) continue;
        next = u;
        here = power;
        break;
      }
      if (power != power && workspace_.sign(u, q) == Sign::positive) return u;
    }
    if (next == kNone) {
      next = step_by_orientation(v, q);
      if (next == kNone || workspace_.sign(next, q) == Sign::positive) return next == kNone ? v : next;
      if (workspace_.at_infinity(next)) return v;
      here = workspace_.power(next, q);
    }
    came_from = v;
    v = next;
  }
  return territory_.whole() ? highest_of_all(q) : v;
}

// The neighbour across a facet that certainly separates q from v, or kNone. Whether the walk just came from there need
// not be tested: a facet cannot separate q from the vertices on both of its sides. A neighbour at infinity is chosen
// only if q is certainly nearer to it or there is no other: q may be outside the hull by a rounding, but then another
// facet leads on.
Index Inserter::step_by_orientation(Index v, const Point& q) const {
  const VoronoiVertex& vertex = workspace_.vertices[v];
  const std::array<Index, 4> neighbors = workspace_.neighbors_now(v);
  Index outside = kNone;
  for (unsigned i = 0; i < 4; ++i) {
    const auto& [a, b, c] = Cavity::kOthers[i];
    const auto corner = [&](unsigned k) -> const Point& { return workspace_.points[vertex.forming_points[k]]; };
    if (volume_sign(q, corner(a), corner(b), corner(c)) != Sign::negative) continue;
    const Index next = neighbors[i];
    if (!territory_.may_read(next)) continue;
    if (!workspace_.at_infinity(next) || workspace_.sign(next, q) == Sign::positive) return next;
    outside = next;
  }
  return outside;
}

// Walks to the vertex whose tetrahedron holds q, or to a vertex at infinity if q is outside the hull.
Index Inserter::walk_by_orientation(Index v, const Point& q) const {
  if (workspace_.at_infinity(v) && workspace_.sign(v, q) != Sign::positive) v = workspace_.vertices[v].neighbors[3];
  const std::size_t patience = workspace_.vertices.size() + 64;
  for (std::size_t steps = 0; steps < patience && !workspace_.at_infinity(v); ++steps) {
    const Index next = step_by_orientation(v, q);
    if (next == kNone) return v;
    v = next;
  }
  return v;
}

bool Inserter::is_lost() const {
  return !workspace_.exact() && searched_ > kMaxSearched + kMaxSearches * workspace_.vertices.size();
}

Index Inserter::highest_of_all(const Point& q) const {
  searched_ += workspace_.vertices.size();
  Index best = kNone;
  double best_value = 0;
  Sign best_sign = Sign::negative;
  for (Index v = 0; v < workspace_.vertices.size(); ++v) {
    if (workspace_.is_free(v)) continue;
    const Sign sign = workspace_.sign(v, q);
    if (best != kNone && sign < best_sign) continue;
    const double value = workspace_.value(v, q);
    if (best != kNone && sign == best_sign && !(value > best_value)) continue;
    best = v;
    best_value = value;
    best_sign = sign;
  }
  return best;
}

// Walks to neighbours with a larger value as long as there are such.
Index Inserter::climb(Index v, const Point& q) const {
  double here = workspace_.value(v, q);
  for (Index from = kNone; from != v;) {
    from = v;
    for (Index u : workspace_.vertices[from].neighbors) {
      const double value = workspace_.value(u, q);
      if (!(value > here) || workspace_.sign(u, q) != Sign::positive) continue;
      here = value;
      v = u;
    }
  }
  return v;
}

}  // namespace orchard::detail
