#include "insertion/insertion.h"

#include <algorithm>

namespace orchard::detail {
namespace {

constexpr std::size_t kNearby = 64;  // vertices in doubt that are searched before all others are

// How many vertices may be searched, in terms of all that there are and beside that: rarely is one found that way, and
// to rebuild everything with exact signs takes less time then.
constexpr std::size_t kMaxSearches = 8, kMaxSearched = 1u << 20;

// Steps of a walk that may have been led astray by what it must not read: a few times the way through a million points.
constexpr std::size_t kPatience = 1024;

}  // namespace

// A vertex that is nearer to q than to its forming points, or as near to that as can be found. Uphill by power: across
// the facet between two vertices, the side of q has the greater one, so this is a walk straight to q. Where several
// vertices share one sphere, the power has a plateau, and the sides of the facets are looked at instead.
Index Inserter::locate(const Point& q) const {
  const Index reached = walk(q);
  return workspace_.sign(reached, q) == Sign::positive ? reached : highest_nearby(reached, q);
}

// Breadth-first from where the walk ended, through vertices in doubt; all vertices if that finds none that is certainly
// nearer to q, as long as that is worth while.
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
      // On the way, a vertex need not be settled: the walk goes uphill all the same.
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

// The neighbour across a facet that certainly parts q from v, or kNone. Not where the walk just came from is not asked:
// a facet that parts them cannot do so in both directions. Out of the hull only if there is no other way: q may be
// outside by a rounding, but it is above another facet then.
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

// To the vertex whose tetrahedron holds q; at infinity if q is outside.
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

// Uphill by value.
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
