// How points are inserted one after another: the ways to insert a point, and the order in which they are tried. They
// refer to each other throughout, hence more than 300 lines in one file.
#include "insertion/insertion.h"

#include <algorithm>
#include <cassert>

#include "insertion/patch.h"
#include "orchard/geometry/error.h"

namespace orchard::detail {
namespace {

// At most this many insertions (a number plus one in so many of the expected points) may need exact signs, need the
// constrained search or be deferred. If there are more, the diagram is built again with exact signs.
constexpr std::uint64_t kMaxDoubtful = 16, kMaxDoubtfulOneIn = 4;

// If this many points are deferred before the first is inserted, the diagram that was there is exact and has thin
// tetrahedra, as where rounding has moved points off planes. Insertions without exact signs will not fit into it.
constexpr std::size_t kHopeless = 32;

// With more than kManyDeferred deferred points, all of them are tried again only if more than one in kWorthRepeating
// could be inserted: otherwise the time would grow with the square of their number.
constexpr std::size_t kManyDeferred = 32, kWorthRepeating = 8;

}  // namespace

InsertionCounts& InsertionCounts::operator+=(const InsertionCounts& other) {
  certified += other.certified;
  settled += other.settled;
  exact += other.exact;
  constrained += other.constrained;
  coplanar += other.coplanar;
  return *this;
}

bool Inserter::start(const std::array<Index, 4>& points) {
  std::array<Index, 4> corner = points;
  const auto from_first = [&](unsigned i) { return workspace_.points[corner[i]] - workspace_.points[corner[0]]; };
  if (from_first(1).cross(from_first(2)).dot(from_first(3)) < 0) std::swap(corner[2], corner[3]);

  // The first diagram is the boundary of a four-simplex: five vertices, each formed by all but one of five points (the
  // four given ones and infinity).
  const std::array<Index, 5> five{corner[0], corner[1], corner[2], corner[3], kInfinitePoint};
  workspace_.resize(5);
  for (Index left_out = 0; left_out < 5; ++left_out) {
    std::array<Index, 4> own{0, 1, 2, 3};
    if (left_out < 4) {
      // Infinity lies on the other side of the facet than the corner that it replaces: swapping two points restores the
      // orientation.
      own[left_out] = 4;
      if (left_out == 3)
        std::swap(own[0], own[1]);
      else
        std::swap(own[left_out], own[3]);
    }
    VoronoiVertex vertex;
    for (unsigned i = 0; i < 4; ++i) {
      vertex.forming_points[i] = five[own[i]];
      vertex.neighbors[i] = own[i];  // the vertex that leaves out this point
    }
    const Point& origin = workspace_.points[vertex.forming_points[0]];
    const auto relative = [&](unsigned i) {
      return LengthedVector(workspace_.points[vertex.forming_points[i]] - origin);
    };
    std::uint8_t error = 0;
    const Placing placing = left_out < 4
                                ? workspace_.place_at_infinity(vertex, error, relative(1), relative(2))
                                : workspace_.place(vertex, error, origin, relative(1), relative(2), relative(3));
    if (placing == Placing::failed) return false;
    workspace_.store(left_out, vertex, error);
  }
  last_ = 4;
  return true;
}

bool Inserter::insert(Index point) {
  if (insert_now(point)) return true;
  if (search_ == Search::bowyer || too_doubtful()) return false;
  deferred_.push_back(point);
  return true;
}

bool Inserter::insert_deferred(Patch* patch) {
  while (!deferred_.empty()) {
    const std::size_t before = deferred_.size();
    const std::size_t inserted = std::erase_if(deferred_, [this](Index point) { return insert_now(point); });
    if (is_lost()) return insert_by_patch(patch);
    const bool many = before > kManyDeferred;
    if (inserted > (many ? before / kWorthRepeating : 0)) continue;
    if (many && insert_by_patch(patch)) return true;
    // Inserts one point even if that overrules certain signs; others may fit after that. If there are many, each is
    // tried only once more.
    for (std::size_t left = many ? deferred_.size() : 1; left > 0; --left) {
      const Index point = deferred_.back();
      if (!(many && insert_now(point)) && !insert_anyhow(point)) return insert_by_patch(patch);
      deferred_.pop_back();
    }
  }
  return true;
}

// Inserts all deferred points together, by a patch.
bool Inserter::insert_by_patch(Patch* patch) {
  if (patch == nullptr || deferred_.empty()) return deferred_.empty();
  std::vector<Index> starts;
  for (const Index point : deferred_) {
    const Point q = workspace_.points[point];
    starts.push_back(walk_by_orientation(locate(q), q));
  }
  cavity_.end();
  if (!patch->replace(starts, 0, deferred_)) return false;
  counts_.exact += deferred_.size();
  deferred_.clear();
  start_anywhere();
  return true;
}

bool Inserter::insert_anyhow(Index point) {
  const Point q = workspace_.points[point];
  return insert_by_value(point, locate(q), q, true) || insert_sparsely(point, q);
}

bool Inserter::too_doubtful() const {
  if (deferred_.size() >= kHopeless && counts_.inserted() == 0) return true;
  return counts_.exact + counts_.constrained + deferred_.size() >= kMaxDoubtful + expected_ / kMaxDoubtfulOneIn;
}

bool Inserter::insert_now(Index point) {
  const Point q = workspace_.points[point];
  const Index start = locate(q);
  cavity_.begin(point);
  if (search_ == Search::bowyer) return insert_bowyer(start, q);
  if (search_ == Search::highest_first) {
    if (insert_directly(start, q)) return true;
    if (!workspace_.exact()) return insert_with_doubts(point, start, q);
    cavity_.begin(point);
  }
  insert_constrained(start, q);
  return true;
}

// Inserts a point by one of the searches that always delete a ball, even against certain signs. To be called after
// Cavity::begin.
void Inserter::insert_constrained(Index start, const Point& q) {
  if (search_ == Search::inagaki)
    search_breadth_first(climb(start, q), q);
  else
    search_highest_first(start, q);
  ++counts_.constrained;
  cavity_.note_facets();
  cavity_.place_vertices();
  if (!cavity_.link_vertices()) throw Error("internal: the deleted Voronoi vertices do not form a ball");
  finish();
}

// Inserts a point by signs alone, without computing values: correct if every sign is certain. A vertex whose sign is
// uncertain counts as not nearer to the new point, as if each new point were infinitesimally farther away than all
// before it. With exact signs the deleted vertices then always form a ball whose whole boundary the new point sees: the
// union of all cells of the degenerate diagram that are strictly nearer to it. With other signs this is checked.
bool Inserter::insert_directly(Index start, const Point& q) {
  if (workspace_.sign(start, q) != Sign::positive) return false;
  bool certain = cavity_.delete_nearer(start);
  if (cavity_.left_territory()) return false;
  cavity_.note_facets();
  while (!cavity_.place_vertices()) {
    if (!cavity_.widen() || cavity_.left_territory()) return false;
    certain = false;
    cavity_.note_facets();
  }
  // A thin tetrahedron would magnify the effect of a wrong sign behind its facet.
  if (!workspace_.exact() && cavity_.worst_placing() > (certain ? Placing::thin : Placing::shared)) return false;
  if (!cavity_.has_room() || !cavity_.link_vertices()) return false;
  if (!certain && !(cavity_.is_ball() && (workspace_.exact() || cavity_.doubts_are_harmless()))) return false;
  ++(certain ? counts_.certified : counts_.settled);
  finish();
  return true;
}

// For a point that could not be inserted by keeping the uncertain vertices. Tries exact signs, and then the constrained
// search, which must not overrule a certain sign.
bool Inserter::insert_with_doubts(Index point, Index start, const Point& q) {
  if (too_doubtful()) return false;
  return insert_exactly(point, q) || insert_by_value(point, start, q, false);
}

// Inserts a point by the constrained search, if all new vertices are oriented positively. With `may_overrule`, when
// nothing else helps, it may overrule signs that seem certain; the certificate then has to check the result.
bool Inserter::insert_by_value(Index point, Index start, const Point& q, bool may_overrule) {
  cavity_.begin(point);
  search_highest_first(start, q);
  if (!may_overrule && !respects_certain_signs(q)) return false;
  cavity_.note_facets();
  if (!cavity_.place_vertices() || !cavity_.link_vertices()) return false;
  if (!may_overrule && cavity_.worst_placing() > Placing::thin) return false;
  ++counts_.constrained;
  finish();
  return true;
}

// The last resort: deletes only the vertex whose tetrahedron holds q, and those on whose facets q lies, by exact signs.
// The new vertices are oriented positively, but most are not Voronoi vertices: mend() corrects that.
bool Inserter::insert_sparsely(Index point, const Point& q) {
  const Index start = locate(q);
  workspace_.set_exact(true);
  cavity_.begin(point);
  cavity_.delete_vertex(walk_by_orientation(start, q));
  for (std::size_t i = 0; i < cavity_.deleted().size(); ++i)
    for (unsigned slot = 0; slot < 4; ++slot) {
      const Index v = cavity_.deleted()[i], next = workspace_.vertices[v].neighbors[slot];
      if (workspace_.mark(next) != Mark::deleted && cavity_.side_of_facet(v, slot) != Sign::positive)
        cavity_.delete_vertex(next);
    }
  cavity_.note_facets();
  const bool good = cavity_.place_vertices() && cavity_.link_vertices() && cavity_.is_ball();
  workspace_.set_exact(false);
  if (!good) return false;
  ++counts_.constrained;
  finish();
  return true;
}

// Inserts one point with exact signs while the workspace uses signs of doubles otherwise.
bool Inserter::insert_exactly(Index point, const Point& q) {
  workspace_.set_exact(true);
  const Index start = locate(q);
  cavity_.begin(point);
  bool certain = false;
  bool good = workspace_.sign(start, q) == Sign::positive && cavity_.delete_nearer_in_sight(start, certain);
  if (good) cavity_.note_facets();
  good = good && cavity_.place_vertices() && cavity_.worst_placing() <= Placing::thin && cavity_.link_vertices() &&
         (certain || cavity_.is_ball());
  workspace_.set_exact(false);
  if (!good) return false;
  ++counts_.exact;
  finish();
  return true;
}

// Whether the search deleted no vertex that is certainly not nearer to the new point, and kept none that certainly is.
bool Inserter::respects_certain_signs(const Point& q) const {
  for (const Index v : cavity_.deleted()) {
    if (workspace_.sign(v, q) == Sign::negative) return false;
    for (const Index u : workspace_.vertices[v].neighbors)
      if (workspace_.mark(u) == Mark::wanted) return false;
  }
  return true;
}

// The search of dissertation 6.2.3: it deletes vertices in the order of their values, as long as the five constraints
// hold. Here there is one more constraint: the new point must see all of the boundary, so that every new vertex is
// oriented positively and has a position. The search starts from the vertex whose tetrahedron holds q, which certainly
// has to be deleted.
// In the dissertation all illegal vertices return to the queue after each deletion. Here only the neighbours of the
// deleted vertex do, because only these can have become legal (see Cavity::legal). The order of deletions is the same,
// and the cost is lower.
void Inserter::search_highest_first(Index start, const Point& q) {
  queue_.clear();
  delete_and_queue(walk_by_orientation(start, q), q);
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end());
    const Candidate candidate = queue_.back();
    queue_.pop_back();
    if (workspace_.mark(candidate.vertex) != Mark::deleted && cavity_.legal(candidate.vertex) &&
        sees_around(candidate, q))
      delete_and_queue(candidate.vertex, q);
  }
}

void Inserter::enqueue(Index v, double value) {
  queue_.push_back({value, v});
  std::push_heap(queue_.begin(), queue_.end());
}

void Inserter::delete_and_queue(Index v, const Point& q) {
  cavity_.delete_legally(v);
  for (unsigned i = 0; i < 4; ++i) {
    const Index u = workspace_.vertices[v].neighbors[i];
    if (workspace_.mark(u) == Mark::unseen)
      cavity_.add_seen(u, workspace_.sign(u, q) == Sign::positive ? Mark::wanted : Mark::kept);
    if (workspace_.mark(u) == Mark::deleted) continue;
    // If q does not see the facet between v and u, u has to be deleted whatever its value.
    if (cavity_.side_of_facet(v, i) != Sign::positive)
      enqueue(u, std::numeric_limits<double>::infinity());
    else if (workspace_.mark(u) == Mark::wanted)
      enqueue(u, workspace_.value(u, q));
  }
}

// Whether q would see the boundary facets that deleting the candidate creates. A vertex behind a facet that q would not
// see is queued with the candidate's value if its own sign is uncertain.
bool Inserter::sees_around(const Candidate& candidate, const Point& q) {
  bool sees = true;
  for (unsigned i = 0; i < 4; ++i) {
    const Index u = workspace_.vertices[candidate.vertex].neighbors[i];
    if (workspace_.mark(u) == Mark::deleted || cavity_.side_of_facet(candidate.vertex, i) != Sign::negative) continue;
    sees = false;
    if (workspace_.sign(u, q) == Sign::uncertain) enqueue(u, candidate.value);
  }
  return sees;
}

void Inserter::search_breadth_first(Index start, const Point& q) {
  cavity_.delete_legally(start);
  for (std::size_t i = 0; i < cavity_.deleted().size(); ++i)
    for (Index u : workspace_.vertices[cavity_.deleted()[i]].neighbors)
      if (workspace_.mark(u) != Mark::deleted && workspace_.value(u, q) > 0 && cavity_.legal(u))
        cavity_.delete_legally(u);
}

bool Inserter::insert_bowyer(Index start, const Point& q) {
  const auto fail = [this](const char* reason) {
    failure_ = reason;
    return false;
  };
  if (!(workspace_.value(start, q) > 0))
    return fail("no Voronoi vertex is nearer to it than to its forming points, so none can be deleted");
  cavity_.delete_vertex(start);
  for (std::size_t i = 0; i < cavity_.deleted().size(); ++i)
    for (const Index u : workspace_.vertices[cavity_.deleted()[i]].neighbors)
      if (workspace_.mark(u) != Mark::deleted && workspace_.value(u, q) > 0) cavity_.delete_vertex(u);
  cavity_.note_facets();
  const bool placed = cavity_.place_vertices();
  if (!cavity_.link_vertices() || !cavity_.is_ball())
    return fail("after rounding, the vertices to delete do not make one simply connected piece");
  if (!placed) return fail("a new vertex would have coplanar or wrongly oriented forming points");
  ++counts_.certified;
  finish();
  return true;
}

void Inserter::finish() {
  counts_.coplanar += cavity_.place_flat_vertices();
  last_ = cavity_.replace();
}

}  // namespace orchard::detail
