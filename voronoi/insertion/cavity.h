#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "predicates/four_vectors.h"
#include "predicates/placed_sphere.h"
#include "predicates/vectors.h"
#include "workspace/edge_table.h"
#include "workspace/region.h"
#include "workspace/workspace.h"

namespace orchard::detail {

#ifdef ORCHARD_FOUR_LANES
// For each subset of four items, the order of bytes that moves the items of the subset to the front.
struct alignas(16) OrderOfBytes : std::array<std::uint8_t, 16> {};
inline constexpr std::array<OrderOfBytes, 16> kFirstOfFour = [] {
  std::array<OrderOfBytes, 16> orders{};
  for (unsigned bits = 0; bits < 16; ++bits)
    for (unsigned item = 0, place = 0; item < 4; ++item)
      if (((bits >> item) & 1u) != 0) {
        for (unsigned byte = 0; byte < 4; ++byte) orders[bits][4 * place + byte] = std::uint8_t(4 * item + byte);
        ++place;
      }
  return orders;
}();
#endif

// The vertices that one new point deletes, the boundary around them, and the new vertices that replace them. In terms
// of tetrahedra: a cavity, its boundary facets, and the tetrahedra between the new point and these facets.
class Cavity {
 public:
  // A list to which items can be added conditionally without a branch: the item is always written after the end, and
  // the end moves if the condition holds.
  class List {
   public:
    std::span<const Index> items() const { return {room_.data(), count_}; }
    std::size_t size() const { return count_; }
    void clear() { count_ = 0; }
    void push(Index item) {
      ensure_room();
      push_if(item, true);
    }
    void ensure_room() {
      if (count_ + 4 > room_.size()) room_.resize(2 * room_.size() + 64);
    }
    // Returns the items, with room for `more` further ones.
    Index* room_for(std::size_t more) {
      if (count_ + more + 4 > room_.size()) room_.resize(2 * (count_ + more) + 64);
      return room_.data();
    }
    void resize(std::size_t count) { count_ = count; }
    // May be called up to four times after ensure_room().
    void push_if(Index item, bool condition) {
      room_[count_] = item;
      count_ += condition;
    }
    // The items and their number as local variables, for loops that only append. resize() then stores the number.
    struct Open {
      Index* items;
      std::size_t count;
#ifdef ORCHARD_FOUR_LANES
      // Appends those of four items whose bit is set. Precondition: there is room for four items.
      ORCHARD_AVX2 void push_four(__m128i four, unsigned bits) {
        const auto* const order = reinterpret_cast<const __m128i*>(kFirstOfFour[bits].data());
        _mm_storeu_si128(reinterpret_cast<__m128i*>(items + count), _mm_shuffle_epi8(four, _mm_load_si128(order)));
        count += static_cast<std::size_t>(std::popcount(bits));
      }
#endif
    };
    // Returns the first `count` items, with room for `room` items in all.
    Open open(std::size_t count, std::size_t room) {
      if (room > room_.size()) room_.resize(room);
      return {room_.data(), count};
    }

   private:
    std::vector<Index> room_;
    std::size_t count_ = 0;
  };

  // A boundary facet. It gives a new vertex, whose forming points are those of the deleted vertex, except that the new
  // point replaces the one at `slot`.
  struct Facet {
    Index inside, outside;       // the deleted vertex, and the kept vertex across the facet
    std::array<Index, 3> local;  // its corners, as indices into the local points, in the order of kOthers[slot]
    std::uint8_t slot, back;     // neighbour `slot` of `inside` is `outside`, and neighbour `back` of that is `inside`
    std::uint8_t error_class;    // of the new vertex
    bool visible;                // whether the new point sees the facet from its inner side
    Placing placing;
  };
  // kOthers[i]: the other corners, so that (i, others) is an even permutation. The infinite corner 3 comes last.
  static constexpr std::array<std::array<std::uint8_t, 3>, 4> kOthers{{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

  explicit Cavity(Workspace& workspace) : workspace_(workspace) {}

  // Sets the region in which vertices may be replaced from now on. Only delete_nearer(), widen() and the functions that
  // follow them respect it. Precondition: no vertex has a mark.
  void enter(const Region& territory) { territory_ = territory; }
  // Whether the search reached a vertex outside the region. The point cannot be inserted in this region then.
  bool left_territory() const { return left_territory_; }
  // The vertex outside the region that would have to be deleted.
  Index blocker() const { return blocker_; }
  // Whether there are enough free vertices for the new ones of replace().
  bool has_room() const {
    return territory_.whole() || facets_.size() <= deleted_.size() + territory_.free_vertices->size();
  }

  // Begins the insertion of a new point: no vertex is deleted, and all marks are removed.
  void begin(Index new_point);
  // Removes all marks.
  void end();

  std::span<const Index> deleted() const { return deleted_.items(); }
  const std::vector<Facet>& facets() const { return facets_; }

  // Deletes all vertices that are connected to `start` and whose sign is certainly positive. Returns whether no sign
  // was uncertain and the search stayed in the region.
  bool delete_nearer(Index start);
  // Does the same without regard to the region. Returns false, and must be followed by end(), if the new point turns
  // out not to see all of the boundary. Sets `certain` to whether no sign was uncertain.
  bool delete_nearer_in_sight(Index start, bool& certain);
  // Deletes a vertex without any check.
  void delete_vertex(Index v) {
    workspace_.set_mark(v, Mark::deleted);
    deleted_.push(v);
    is_boundary_noted_ = undoubted_ = false;
  }
  // Marks a vertex as seen but not deleted.
  void add_seen(Index v, Mark mark) {
    if (workspace_.mark(v) == Mark::unseen) seen_.push(v);
    workspace_.set_mark(v, mark);
  }
  // Deletes the uncertain vertices behind boundary facets that the new point does not see; call it if place_vertices()
  // found such facets. In exact arithmetic these vertices are nearer to the new point, because a point sees the whole
  // boundary of the vertices that are nearer to it. Returns false if no such vertex is uncertain.
  bool widen();
  // Records the boundary facets. Call it after all deletions.
  void note_facets();

  // For the constrained search: return whether deleting one more vertex keeps the constraints of Inagaki et al., and
  // delete it.
  bool legal(Index v) const;
  void delete_legally(Index v);

  // Returns the side of the facet between v and its neighbour i on which the new point lies. It is positive on the side
  // of v; only then can the facet be part of the boundary.
  Sign side_of_facet(Index v, unsigned i) const;

  // Places the new vertices. Returns whether the new point sees every facet, so that all new vertices are oriented
  // positively.
  bool place_vertices();
  // Returns the worst placing of the new vertices.
  Placing worst_placing() const { return worst_; }
  // Makes the new vertices neighbours of each other. Returns false unless the boundary is closed, with two facets at
  // each edge and the number of facets of a sphere.
  bool link_vertices();
  // Returns whether the boundary is connected and no point except the new one lies inside. Call it after
  // place_vertices() and link_vertices().
  bool is_ball();
  // Returns whether keeping uncertain vertices is harmless. If the new point lies in the sphere of a kept vertex, the
  // new vertex beside it is wrong by the depth of the point, magnified where the new point is low above the facet
  // between the two. Call it after place_vertices().
  bool doubts_are_harmless() const;
  // Computes positions for the vertices that were not placed. Returns the number of those with coplanar forming points,
  // whose position is an approximation.
  Index place_flat_vertices();
  // Replaces the deleted vertices by the new ones and removes all marks. Returns the last new vertex with a position.
  Index replace();
  // The new vertices, after replace().
  std::span<const Index> created() const { return slots_; }

 private:
  // An edge of one facet until the other facet with this edge is found; an item of a list of the edges at a corner.
  struct Link {
    Index far, next, facet;  // the other corner of the edge; `facet` is kNone once the other facet is found
    std::uint8_t slot;       // the neighbour, across the edge, of the vertex of the facet
    bool outward;            // whether the edge runs to its other corner in the order of the facet
  };

  // For each directed edge between up to kPoints local points: the facet with this edge, and the round in which it was
  // written. A triangulated sphere with n corners has 2 n - 4 facets.
  template <unsigned kPoints, unsigned kStride>
  struct LinkTable {
    static constexpr unsigned kFacetBits = std::bit_width(2 * kPoints - 1);
    static constexpr unsigned kFacetMask = (1u << kFacetBits) - 1;
    std::vector<std::uint16_t> entries;
    unsigned round = 0;

    // Begins the next round. Returns its number, shifted to its place in an entry.
    unsigned begin() {
      if (entries.empty() || ++round >> (16 - kFacetBits) != 0) {
        entries.assign(std::size_t{kPoints} * kStride, 0);
        round = 1;
      }
      return round << kFacetBits;
    }
  };
  static constexpr unsigned kFewPoints = 64, kManyPoints = 512;

  // Returns the number of a local point, which gets a new number if it has none. It has no branches; call
  // local_points_.ensure_room() before.
  Index local(Index point) {
    Index& known = known_local(point);
    const bool fresh = known == kNone;
    known = fresh ? static_cast<Index>(local_points_.size()) : known;
    local_points_.push_if(point, fresh);
    return known;
  }
  void note_boundary();
  bool are_local_points_on_boundary();
  bool is_one_small_piece() const;
  bool is_one_piece();
  void measure_local_points();
  void note_forming_points(std::size_t f);
  void place_spheres(std::size_t first, std::size_t end, FourQualities& qualities);
  bool place_vertex(std::size_t f, bool has_sphere, const PlacedQuality& placed);
  bool leave_territory(Index blocker);
  bool is_turned_away(Index v, unsigned i) const;
  // Examine the neighbours of the deleted vertices from number `first` to number `end`.
  bool delete_nearer_around(std::size_t first, std::size_t end);
  bool delete_nearer_one_by_one(std::size_t first, std::size_t end);
  bool delete_nearer_by_four(std::size_t first, std::size_t end);
  bool is_nearer_after_all(Index u, bool& certain);
  unsigned nearer_after_all(const std::array<Index, 4>& u, unsigned which, bool& certain);
  // The infinite point has the highest number, so the sum wraps around to the first element.
  Index& known_local(Index point) { return local_of_[static_cast<Index>(point + 1)]; }
  Index known_local(Index point) const { return local_of_[static_cast<Index>(point + 1)]; }
  void fetch_around(Index v) const;
  std::array<Index, 4> neighbors_of_deleted(std::size_t i);
  void choose_slots();
  template <unsigned kPoints, unsigned kStride>
  bool link_by(LinkTable<kPoints, kStride>& links);
  bool link_by_lists();
  void note_edges(Index v);

  Workspace& workspace_;
  Region territory_;
  bool left_territory_ = false;
  Index blocker_ = kNone;
  Index new_point_ = kNone;
  Point position_ = Point::Zero();
  Placing worst_ = Placing::good;
  bool visible_ = false;            // whether the new point sees all facets
  List deleted_, seen_, boundary_;  // boundary: 4 * deleted vertex + the neighbour across
  bool is_boundary_noted_ = false;  // whether delete_nearer() recorded it, and nothing was deleted since
  bool undoubted_ = false;          // also no sign was uncertain, and the new point is on no sphere of a kept vertex
  List local_points_;               // the points of the boundary, the one at infinity included
  std::vector<Index> slots_, queue_;
  std::vector<Facet> facets_;
  std::vector<VoronoiVertex> fresh_;      // the new vertex of each facet; neighbours are facets until replace()
  std::vector<std::uint8_t> reached_;     // by facet or local point
  std::vector<LengthedVector> from_new_;  // from the new point to each local one
  std::vector<Index> local_of_;           // of the infinite point and each other: into local_points_ or kNone
  EdgeTable edges_;
  std::vector<std::uint64_t> ranks_;  // by local point, as is the next one
  std::vector<Index> waiting_;
  std::vector<Link> links_;
  LinkTable<kFewPoints, kFewPoints> few_links_;
  LinkTable<kManyPoints, kManyPoints + 16> many_links_;  // rows of a power of two would compete for a few cache lines
  Index edge_limit_ = 0;  // the number of local points for which the edge table was set up, in the constrained search
};

}  // namespace orchard::detail
