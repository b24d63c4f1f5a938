#include <algorithm>
#include <bit>
#include <limits>

#include "certificate/certifier.h"
#include "insertion/cavity.h"
#include "workspace/workspace_four.h"

namespace orchard::detail {

bool Certifier::are_facets_good(Index v) {
  for (unsigned i = 0; i < 4; ++i) {
    const Index u = workspace_.vertices[v].neighbors[i];
    if (u < v && is_new(u) && !looks_at_changed_) continue;  // tested from there
    if (workspace_.at_infinity(v) != workspace_.at_infinity(u))
      continue;  // a facet of the hull: its edges are tested instead
    if (!is_facet_good(v, i, u)) return false;
  }
  return true;
}

bool Certifier::is_facet_good(Index v, unsigned i, Index u) {
  return (workspace_.at_infinity(v) ? is_hull_convex(v, i) : do_spheres_agree(v, i, u)) || doubt(v, u);
}

// Tests the same facets, except those of the hull, of a range of vertices that are all new. Otherwise waiting for
// memory and mispredicted branches would take most of the time, so all facets are listed first, without branches. For
// most facets, doubles show that the sphere of the neighbour does not hold the vertex's own point; then the neighbour's
// own point need not be looked up.
bool Certifier::are_all_facets_good(Index begin, Index end) {
  std::size_t listed = 0, count = 0;
  std::array<Facet, std::size_t{4} * kCertificateBatch + 4> facets;
  for (Index v = begin; v < end; ++v)
    for (unsigned i = 0; i < 4; ++i) {
      const Index u = workspace_.vertices[v].neighbors[i];
      workspace_.prefetch(u);
      facets[listed] = {v, u, i, 0};
      listed += (u > v) & (u != kNone);
    }
  for (std::size_t f = 0; f < listed; ++f) {
    const auto [v, u, i, none] = facets[f];
    facets[count] = {v, u, i, workspace_.vertices[v].forming_points[i]};
    __builtin_prefetch(workspace_.points.data() + facets[count].opposite);
    count += std::size_t{!workspace_.at_infinity(v)} & std::size_t{!workspace_.at_infinity(u)};
  }
  for (std::size_t f = 0; f < count; f += 4) {
    const std::size_t lanes = std::min<std::size_t>(count - f, 4);
    std::fill(facets.begin() + f + lanes, facets.begin() + f + 4, facets[f]);
    unsigned doubtful = can_place_four() ? doubtful_of_four(workspace_, &facets[f]) : 0xf;
    doubtful &= (1u << lanes) - 1;
    std::array<double, 4> added;
    added.fill(std::numeric_limits<double>::infinity());
    if ((doubtful & (doubtful - 1)) != 0 && can_place_four() && !workspace_.exact()) added = added_across(&facets[f]);
    for (; doubtful != 0; doubtful &= doubtful - 1) {
      const auto lane = static_cast<unsigned>(std::countr_zero(doubtful));
      const auto [v, u, i, opposite] = facets[f + lane];
      if (are_own_spheres(v, u) && are_apart(v, i, u, corner(u, slot_of(u, v)))) continue;
      if (added[lane] <= share_ && !is_same_sphere(v, u)) {
        found_.intrusion += added[lane];
        continue;
      }
      if (!is_facet_good(v, i, u)) return false;
    }
  }
  return true;
}

// The intrusions added across four facets.
std::array<double, 4> Certifier::added_across(const Facet* facets) {
  FourSteps steps;
  for (unsigned lane = 0; lane < 4; ++lane) {
    const auto& [v, u, i, opposite] = facets[lane];
    workspace_.settle(v);
    workspace_.settle(u);
    const auto& [a, b, c] = Cavity::kOthers[i];
    steps.from[lane] = &workspace_.vertices[v];
    steps.to[lane] = &workspace_.vertices[u];
    steps.from_corner[lane] = &corner(v, 0);
    steps.to_corner[lane] = &corner(u, 0);
    steps.a[lane] = &corner(v, a);
    steps.b[lane] = &corner(v, b);
    steps.c[lane] = &corner(v, c);
  }
  return added_by_four(steps, diameter_);
}

// Notes an intrusion that is lost only along lines through the facet of v that is opposite to its point i.
void Certifier::note_loss(double intrusion, Index v, unsigned i) {
  if (share_ > small_share_) {
    found_.intrusion += intrusion;
    return;
  }
  found_.lost += intrusion;
  const auto& [a, b, c] = Cavity::kOthers[i];
  const auto& corner = workspace_.vertices[v].forming_points;
  found_.losses.push_back({intrusion, {corner[a], corner[b], corner[c]}});
}

// Tests the facet between v and its neighbour u in slot i.
bool Certifier::do_spheres_agree(Index v, unsigned i, Index u) {
  workspace_.settle(u);
  if (!workspace_.exact() && is_same_sphere(v, u)) return true;  // nothing is lost; on grids most neighbours are such
  const Point& across = corner(u, slot_of(u, v));
  const bool own = are_own_spheres(v, u);
  if (own && are_apart(v, i, u, across)) return true;
  double lost = 2 * diameter_;
  if (!workspace_.exact()) {
    const auto& [a, b, c] = Cavity::kOthers[i];
    Vector away;
    const double blur = normal(corner(v, a), corner(v, b), corner(v, c), away);
    lost = intrusion_added(v, u, corner(v, a), away, blur, Vector::Zero(), 0);
    if (lost <= share_ && add(lost)) return true;
  }
  if (inside_sphere(across, corner(v, 0), corner(v, 1), corner(v, 2), corner(v, 3)) != Sign::positive) {
    // For exact spheres nothing is lost, so only the errors of the spheres count.
    lost = std::min(lost, own ? 0 : from_own_sphere(v) + from_own_sphere(u));
  } else if (!(lost <= kFacet * max_)) {
    return false;
  }
  note_loss(lost, v, i);
  return true;
}

// Whether the sphere of v certainly does not hold the point that only u has, or the other way round.
bool Certifier::are_apart(Index v, unsigned i, Index u, const Point& across) const {
  return workspace_.power(v, across) < -workspace_.power_bound(v) ||
         workspace_.power(u, corner(v, i)) < -workspace_.power_bound(u);
}

// Computes the unit normal of a facet. Returns a bound on the angle of its error.
double Certifier::normal(const Point& a, const Point& b, const Point& c, Vector& result) {
  const Vector ab = b - a, ac = c - a;
  result = ab.cross(ac);
  const double blur = 8 * kRounding * ab.norm() * ac.norm() / result.norm();
  if (!(blur < kBlurred)) return sharp_normal(a, b, c, result) ? 8 * kRounding : 1;
  result.normalize();
  return blur;
}

// The power of q with respect to the sphere around v through its first point. The error is some roundings of (the
// sphere's radius times the distance of points), however large the sphere is.
double Certifier::near_power(Index v, const Point& q) const {
  const Vector from_corner = q - corner(v, 0);
  return from_corner.dot(2 * (workspace_.vertices[v].center - corner(v, 0)) - from_corner);
}

// A bound on the intrusion that may be lost from v to u, for points beyond the plane through `origin`. The normal,
// whose error is at most the angle `blur`, points to these points. If `up` is not zero, it bounds the intrusion for
// points less than `height` above the plane that it is normal to.
double Certifier::intrusion_added(Index v, Index u, const Point& origin, const Vector& normal, double blur,
                                  const Vector& up, double height) const {
  const VoronoiVertex &from = workspace_.vertices[v], &to = workspace_.vertices[u];
  if (is_same_sphere(v, u)) return 0;
  const Vector step = to.center - from.center;
  const double radius = std::sqrt(from.radius), reach = std::min(2 * radius, diameter_);
  const double along = normal.dot(step), above = up.dot(step), length = step.norm();
  const double sideways = (step - along * normal - above * up).norm() + (2 * blur + 8 * kRounding) * length;
  const double lost = near_power(v, origin) - near_power(u, origin) +
                      16 * kRounding * (radius + std::sqrt(to.radius) + diameter_) * diameter_;
  return (std::max(lost, 0.0) + 2 * reach * (std::max(-along, 0.0) + sideways) + 2 * std::abs(above) * height) / radius;
}

// Tests the edge of the hull between the facets of v and of its neighbour i. The neighbour's third point must be below
// the facet of v; because of rounding it may also be slightly above, if it lies on the other side of the edge.
bool Certifier::is_hull_convex(Index v, unsigned i) {
  const Point &b = corner(v, (i + 1) % 3), &c = corner(v, (i + 2) % 3);
  const Index u = workspace_.vertices[v].neighbors[i];
  const Point& p = corner(u, slot_of(u, v));
  const Sign below = volume_sign(p, corner(v, 0), corner(v, 1), corner(v, 2));
  if (below == Sign::positive) return true;
  if (same_side_of_line(b, c, corner(v, i), p) != Sign::negative) return false;
  return below == Sign::uncertain || (!workspace_.exact() && is_reflex_edge_shallow(v, i, p, b, c));
}

// For a point p that is above the facet of v, beyond the edge from b to c, so that the hull is reflex at this edge.
// Other points of the hull may then be above the facet at the same angle. Between the two facets, the spheres below
// them meet in the edge.
bool Certifier::is_reflex_edge_shallow(Index v, unsigned i, const Point& p, const Point& b, const Point& c) {
  Vector normal;
  if (!sharp_normal(corner(v, 0), corner(v, 1), corner(v, 2), normal)) return false;
  const Vector along = (c - b).normalized(), from_edge = (p - b) - along.dot(p - b) * along;
  const double rise = diameter_ * std::abs(normal.dot(from_edge)) / from_edge.norm();
  Vector away = normal.cross(along);
  if (away.dot(corner(v, i) - b) > 0) away = -away;
  const Index u = workspace_.vertices[v].neighbors[i];
  const Index below = workspace_.vertices[v].neighbors[3], next = workspace_.vertices[u].neighbors[3];
  if (!add(rise + intrusion_added(below, next, b, away, 16 * kRounding, normal, rise)))
    found_.suspects.insert(found_.suspects.end(), {v, u, below, next});  // kOfReflexEdge
  return found_.suspects.size() <= kMaxSuspects;
}

}  // namespace orchard::detail
