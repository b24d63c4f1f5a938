#include "certificate/mend.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace orchard::detail {
namespace {

// The most vertices that one insertion may delete: a doubt that takes more is not local. In the first rounds, if only
// few doubts are left, more are allowed, because one point alone may form that many.
constexpr std::size_t kMaxDeleted = 256, kMaxDeletedOfFew = 2048, kFewDoubts = 16;
constexpr int kFirstRounds = 8;
constexpr int kPatient = 2;   // rounds before what insertions do not mend is rebuilt
constexpr int kHopeless = 8;  // rounds before nothing is inserted any more, and more around it is rebuilt each time
constexpr int kStricter = 2;  // bits that a round takes off the intrusion that does no harm

// How deep a point lies in a sphere through the origin. `center` and `point` are relative to the origin.
double intrusion_in(const Vector& center, const Vector& point) {
  return point.dot(2 * center - point) / (2 * center.norm());
}

}  // namespace

std::vector<Index> Repairer::mend(std::span<const Doubt> doubts, int round) {
  changed_.clear();
  harmless_ = std::ldexp(workspace_.harmless_intrusion(), -kStricter * round);
  max_deleted_ = doubts.size() <= kFewDoubts && round < kFirstRounds ? kMaxDeletedOfFew : kMaxDeleted;
  workspace_.set_exact(true);
  std::vector<Index> left;
  for (const auto& [v, u] : doubts) {
    if (workspace_.is_free(v) || workspace_.is_free(u) || slot_of(v, u) == 4) continue;  // gone with another doubt
    sharpen(v);
    sharpen(u);
    if (round >= kHopeless || (!insert_again(v, u) && !insert_again(u, v))) left.insert(left.end(), {v, u});
  }
  cavity_.end();
  workspace_.set_exact(false);
  changed_.insert(changed_.end(), left.begin(), left.end());
  if (round >= kPatient) {
    const std::vector<Index> patched = patch(std::move(left), std::max(round - kHopeless, 0));
    changed_.insert(changed_.end(), patched.begin(), patched.end());
  }
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  return changed_;
}

std::vector<Index> Repairer::patch(std::vector<Index> vertices, int layers) {
  std::erase_if(vertices, [this](Index v) { return workspace_.is_free(v); });
  if (vertices.empty() || !may_patch_) return {};
  may_patch_ = patch_.replace(vertices, layers);
  return may_patch_ ? patch_.created() : std::vector<Index>();
}

unsigned Repairer::slot_of(Index v, Index neighbor) const {
  const auto& neighbors = workspace_.vertices[v].neighbors;
  return static_cast<unsigned>(std::find(neighbors.begin(), neighbors.end(), neighbor) - neighbors.begin());
}

bool Repairer::is_formed_by(Index v, Index point) const {
  const auto& corner = workspace_.vertices[v].forming_points;
  return std::find(corner.begin(), corner.end(), point) != corner.end();
}

// Gives a vertex a sphere of its own if it shares a neighbour's, whose signs would not be exact for it.
void Repairer::sharpen(Index v) {
  if (workspace_.at_infinity(v)) return;
  workspace_.settle(v);
  if (!workspace_.shares_sphere(v)) return;
  workspace_.place_sharply(v);
  changed_.push_back(v);
}

// The depth of q in the sphere of a vertex, or its distance beyond the plane of a vertex at infinity.
double Repairer::intrusion(Index v, const Point& q) {
  const VoronoiVertex& vertex = workspace_.vertices[v];
  const Point& origin = workspace_.points[vertex.forming_points[0]];
  if (workspace_.at_infinity(v)) return vertex.center.dot(q - origin);
  sharpen(v);
  return intrusion_in(vertex.center - origin, q - origin);
}

bool Repairer::is_in_sphere(Index v, const Point& q) {
  sharpen(workspace_.at_infinity(v) ? workspace_.vertices[v].neighbors[3] : v);
  return workspace_.sign(v, q) == Sign::positive;
}

// Inserts again the forming point of u that v does not share, if it lies in the sphere of v.
bool Repairer::insert_again(Index v, Index u) {
  const Index point = workspace_.vertices[u].forming_points[slot_of(u, v)];
  if (point == kInfinitePoint) return false;
  const Point q = workspace_.points[point];
  if (!is_in_sphere(v, q)) return false;
  cavity_.begin(point);
  cavity_.delete_vertex(u);
  cavity_.delete_vertex(v);
  if (!grow(point, q) || !cavity_.link_vertices() || !cavity_.is_ball()) return false;
  cavity_.place_flat_vertices();
  cavity_.replace();
  for (const Index fresh : cavity_.created()) {
    changed_.push_back(fresh);
    if (!workspace_.at_infinity(fresh) && workspace_.poor(fresh)) workspace_.place_sharply(fresh);
  }
  return true;
}

// Deletes all vertices that must be deleted together with those that are, and places the new ones. Returns false if a
// vertex would have to be deleted whose sphere the point lies well outside of, or if there are too many.
bool Repairer::grow(Index point, const Point& q) {
  for (std::size_t done = 0; done < cavity_.deleted().size();) {
    for (; done < cavity_.deleted().size(); ++done) {
      if (cavity_.deleted().size() > max_deleted_) return false;
      for (const Index next : workspace_.vertices[cavity_.deleted()[done]].neighbors) {
        if (workspace_.mark(next) != Mark::unseen) continue;
        if (is_formed_by(next, point) || intrusion(next, q) > harmless_)
          cavity_.delete_vertex(next);
        else
          cavity_.add_seen(next, Mark::kept);
      }
    }
    cavity_.note_facets();
    cavity_.place_vertices();
    work_ += cavity_.facets().size();
    for (const Cavity::Facet& facet : cavity_.facets()) {
      if (workspace_.mark(facet.outside) == Mark::deleted || is_facet_good(facet, q)) continue;
      if (intrusion(facet.outside, q) < -workspace_.harmless_intrusion()) return false;
      cavity_.delete_vertex(facet.outside);
    }
  }
  return true;
}

// Whether the new point sees the facet, and the sphere through both does not hold the point beyond the facet.
bool Repairer::is_facet_good(const Cavity::Facet& facet, const Point& q) const {
  if (!facet.visible) return false;
  const auto& corner = workspace_.vertices[facet.inside].forming_points;
  const Index beyond = workspace_.vertices[facet.outside].forming_points[facet.back];
  const auto& [a, b, c] = Cavity::kOthers[facet.slot];
  if (corner[c] == kInfinitePoint) return !would_invert_hull(facet, q);
  if (beyond == kInfinitePoint) return true;
  const auto& points = workspace_.points;
  Vector center;
  return sharp_circumcenter(q, points[corner[a]], points[corner[b]], points[corner[c]], center) &&
         intrusion_in(center, points[beyond] - q) <= harmless_;
}

// At an edge of the convex hull: whether the new point's facet would lie upside down on the facet beyond the edge,
// which is not deleted. That happens only if the point lies nearly in that facet's plane.
bool Repairer::would_invert_hull(const Cavity::Facet& facet, const Point& q) const {
  const VoronoiVertex& outside = workspace_.vertices[facet.outside];
  const auto& corner = workspace_.vertices[facet.inside].forming_points;
  const auto& [a, b, c] = Cavity::kOthers[facet.slot];
  const auto& points = workspace_.points;
  const double height = outside.center.dot(q - points[outside.forming_points[0]]);
  Vector normal;
  return std::abs(height) < workspace_.harmless_intrusion() &&
         sharp_normal(q, points[corner[a]], points[corner[b]], normal) && normal.dot(outside.center) < 0;
}

}  // namespace orchard::detail
