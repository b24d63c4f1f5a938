#include "insertion.h"

#include <algorithm>
#include <cassert>
#include <string>

#include "orchard/geometry/error.h"

namespace orchard::detail {

bool Inserter::start(const std::array<Index, 4>& points) {
  std::array<Index, 4> corner = points;
  const auto from_first = [&](unsigned i) { return workspace_.points[corner[i]] - workspace_.points[corner[0]]; };
  if (from_first(1).cross(from_first(2)).dot(from_first(3)) < 0) std::swap(corner[2], corner[3]);

  // The boundary of a four-simplex: five vertices, each with all of the five points but one.
  const std::array<Index, 5> five{corner[0], corner[1], corner[2], corner[3], kInfinitePoint};
  workspace_.resize(5);
  for (Index left_out = 0; left_out < 5; ++left_out) {
    std::array<Index, 4> own{0, 1, 2, 3};
    if (left_out < 4) {
      // Infinity in the place of a corner is on the other side of the facet: one swap mends the orientation.
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
    const bool placed = left_out < 4 ? workspace_.place_at_infinity(vertex, error, relative(1), relative(2))
                                     : workspace_.place(vertex, error, origin, relative(1), relative(2), relative(3));
    if (!placed) return false;
    workspace_.store(left_out, vertex, error);
  }
  last_ = 4;
  return true;
}

void Inserter::insert(Index point) {
  const Point q = workspace_.points[point];
  const Index start = locate(q);
  cavity_.begin(point);
  if (search_ == Search::bowyer) return insert_bowyer(start, q);
  if (search_ == Search::highest_first) {
    if (insert_directly(start, q)) return;
    cavity_.begin(point);
    search_highest_first(climb(start, q), q);
  } else {
    search_breadth_first(climb(start, q), q);
  }
  ++counts_.constrained;
  cavity_.note_facets();
  cavity_.place_vertices();
  if (!cavity_.link_vertices()) throw Error("internal: the deleted Voronoi vertices do not form a ball");
  finish();
}

// Without looking at values: right where every sign is certain. A vertex whose sign is in doubt counts as not nearer to
// the new point, as if each new point were an infinitesimal bit farther away than all before it. In exact arithmetic
// that always gives a ball that the new point sees all around; here it is checked.
bool Inserter::insert_directly(Index start, const Point& q) {
  if (workspace_.sign(start, q) != Sign::positive) return false;
  const bool certain = cavity_.delete_nearer(start);
  cavity_.note_facets();
  const bool visible = cavity_.place_vertices();
  if (!visible) return false;
  if (!cavity_.link_vertices()) return false;
  if (!certain && !cavity_.is_ball()) return false;
  ++(certain ? counts_.certified : counts_.settled);
  finish();
  return true;
}

void Inserter::delete_and_queue(Index v, const Point& q) {
  cavity_.delete_legally(v);
  for (Index u : workspace_.vertices[v].neighbors) {
    if (workspace_.mark(u) == Mark::unseen)
      cavity_.add_seen(u, workspace_.sign(u, q) == Sign::positive ? Mark::wanted : Mark::kept);
    if (workspace_.mark(u) != Mark::wanted) continue;
    queue_.push_back({workspace_.value(u, q), u});
    std::push_heap(queue_.begin(), queue_.end());
  }
}

// Dissertation 6.2.3. There all illegal vertices return to the queue after each deletion; here those return that
// neighbour the deleted vertex, as only they can have become legal (see Cavity::legal): the same order at less cost.
void Inserter::search_highest_first(Index start, const Point& q) {
  queue_.clear();
  delete_and_queue(start, q);
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end());
    const Index v = queue_.back().vertex;
    queue_.pop_back();
    if (workspace_.mark(v) != Mark::deleted && cavity_.legal(v)) delete_and_queue(v, q);
  }
  widen_over_flat_facets(q);
}

// Where a facet of the boundary is coplanar with the new point, there is no circumcentre. If the vertex across is in
// doubt, deleting it is as good as leaving it, and leads to a facet farther away.
void Inserter::widen_over_flat_facets(const Point& q) {
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::size_t i = 0; i < cavity_.deleted().size(); ++i) {
      const Index v = cavity_.deleted()[i];
      for (unsigned k = 0; k < 4; ++k) {
        const Index u = workspace_.vertices[v].neighbors[k];
        if (workspace_.mark(u) == Mark::deleted || cavity_.sees_facet(v, k)) continue;
        if (workspace_.sign(u, q) == Sign::negative || !cavity_.legal(u)) continue;
        delete_and_queue(u, q);
        changed = true;
      }
    }
    queue_.clear();
  }
}

void Inserter::search_breadth_first(Index start, const Point& q) {
  cavity_.delete_legally(start);
  for (std::size_t i = 0; i < cavity_.deleted().size(); ++i)
    for (Index u : workspace_.vertices[cavity_.deleted()[i]].neighbors)
      if (workspace_.mark(u) != Mark::deleted && workspace_.value(u, q) > 0 && cavity_.legal(u))
        cavity_.delete_legally(u);
}

void Inserter::insert_bowyer(Index start, const Point& q) {
  cavity_.delete_vertex(start);
  for (std::size_t i = 0; i < cavity_.deleted().size(); ++i) {
    const Index v = cavity_.deleted()[i];
    for (unsigned k = 0; k < 4; ++k) {
      const Index u = workspace_.vertices[v].neighbors[k];
      if (workspace_.mark(u) != Mark::deleted && workspace_.value(u, q) > 0) cavity_.delete_vertex(u);
    }
  }
  cavity_.note_facets();
  const bool placed = cavity_.place_vertices();
  if (!cavity_.link_vertices() || !cavity_.is_ball())
    throw Error("Bowyer's algorithm fails: rounding makes the vertices that a point deletes other than one ball");
  if (!placed) throw Error("Bowyer's algorithm fails: four forming points are coplanar");
  ++counts_.certified;
  finish();
}

void Inserter::finish() {
  counts_.coplanar += cavity_.approximate_unplaced();
  last_ = cavity_.replace();
}

}  // namespace orchard::detail
