#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "edge_table.h"
#include "workspace.h"

namespace orchard::detail {

// The vertices that one new point deletes, what surrounds them, and the new vertices that replace them. As tetrahedra:
// a cavity, its boundary facets, and the tetrahedra from the new point to these facets.
class Cavity {
 public:
  // A boundary facet and the new vertex that it makes.
  struct Facet {
    VoronoiVertex vertex;        // its forming points are the facet's and, at `slot`, the new one
    std::array<Index, 4> local;  // of its forming points, into the local points; at `slot` unused
    Index outside;               // the undeleted vertex across
    std::uint8_t slot, back;     // outside's neighbour `back` was the deleted vertex
    std::uint8_t error_class;
    bool placed;  // false: nearly coplanar forming points
  };

  explicit Cavity(Workspace& workspace) : workspace_(workspace) {}

  // Starts anew for a new point: nothing deleted, all marks removed.
  void begin(Index new_point);

  const std::vector<Index>& deleted() const { return deleted_; }
  const std::vector<Facet>& facets() const { return facets_; }

  // Marks a vertex as deleted. Its facets are not noted yet.
  void add_deleted(Index v) {
    workspace_.set_mark(v, Mark::deleted);
    deleted_.push_back(v);
  }
  // Marks a vertex as seen but not deleted.
  void add_seen(Index v, Mark mark) {
    if (workspace_.mark(v) == Mark::unseen) seen_.push_back(v);
    workspace_.set_mark(v, mark);
  }
  // Notes the boundary facet between a deleted vertex and its neighbour i.
  void add_facet(Index inside, unsigned i);
  void add_all_facets();

  // The constrained search's view: whether deleting one more vertex keeps Inagaki et al.'s constraints; and deleting
  // it.
  bool legal(Index v) const;
  void delete_legally(Index v);

  // Whether the facet between v and its neighbour i is seen from the new point, so that its new vertex has a position.
  bool sees_facet(Index v, unsigned i) const;

  // Places the new vertices. True if all could be placed: every facet is strictly visible from the new point.
  bool place_vertices();
  // Joins the new vertices with each other; false unless the boundary is closed, with two facets on each edge and the
  // number of facets that a sphere has.
  bool link_vertices();
  // Whether the boundary is one piece and no point lies within. After link_vertices.
  bool is_ball();
  // The position for vertices with coplanar forming points; their number.
  Index approximate_unplaced();
  // Replaces the deleted vertices by the new ones and removes all marks. The last new vertex that has a position.
  Index replace();

 private:
  struct LocalPoint {
    LengthedVector from_new;
    Index point;
  };

  Index local(Index point);
  Index known_local(Index point) const { return local_of_[point == kInfinitePoint ? workspace_.points.size() : point]; }
  void set_local(Index point, Index local) {
    local_of_[point == kInfinitePoint ? workspace_.points.size() : point] = local;
  }
  void note_edges(Index v);

  Workspace& workspace_;
  Index new_point_ = kNone;
  Point position_ = Point::Zero();
  std::vector<Index> deleted_, seen_, slots_, stack_;
  std::vector<Facet> facets_;
  std::vector<LocalPoint> local_points_;  // the points of the boundary, the one at infinity included
  std::vector<Index> local_of_;           // of each point and the infinite one: into local_points_ or kNone
  EdgeTable edges_;
  Index edge_limit_ = 0;  // local points that the edge table was set up for, in the constrained search
};

}  // namespace orchard::detail
