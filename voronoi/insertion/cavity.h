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
// For each set of four items the bytes of those first that are in it.
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

// The vertices that one new point deletes, what surrounds them, and the new vertices that replace them. As tetrahedra:
// a cavity, its boundary facets, and the tetrahedra from the new point to these facets.
class Cavity {
 public:
  // A list to which items can be added without a branch: write at the end, then move the end or not.
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
    // Where the items are, with room for so many more, and how many there are then.
    Index* room_for(std::size_t more) {
      if (count_ + more + 4 > room_.size()) room_.resize(2 * (count_ + more) + 64);
      return room_.data();
    }
    void resize(std::size_t count) { count_ = count; }
    // Up to four times after ensure_room().
    void push_if(Index item, bool condition) {
      room_[count_] = item;
      count_ += condition;
    }
    // The items outside of the list, until resize() brings their number back: only items are written then.
    struct Open {
      Index* items;
      std::size_t count;
#ifdef ORCHARD_FOUR_LANES
      // Those of four items that have a bit set, where there is room for four.
      ORCHARD_AVX2 void push_four(__m128i four, unsigned bits) {
        const auto* const order = reinterpret_cast<const __m128i*>(kFirstOfFour[bits].data());
        _mm_storeu_si128(reinterpret_cast<__m128i*>(items + count), _mm_shuffle_epi8(four, _mm_load_si128(order)));
        count += static_cast<std::size_t>(std::popcount(bits));
      }
#endif
    };
    // The first so many items that were written, and room for so many.
    Open open(std::size_t count, std::size_t room) {
      if (room > room_.size()) room_.resize(room);
      return {room_.data(), count};
    }

   private:
    std::vector<Index> room_;
    std::size_t count_ = 0;
  };

  // A boundary facet. It makes a new vertex: the deleted one's forming points but for the new one at `slot`.
  struct Facet {
    Index inside, outside;       // the deleted vertex and the undeleted one across
    std::array<Index, 3> local;  // its corners, into the local points, in the order of kOthers[slot]
    std::uint8_t slot, back;     // the inside's neighbour `slot` is the outside, whose neighbour `back` is the inside
    std::uint8_t error_class;    // of the new vertex
    bool visible;                // from the new point
    Placing placing;
  };
  // kOthers[i]: the other corners, so that (i, others) is an even permutation. The infinite corner 3 comes last.
  static constexpr std::array<std::array<std::uint8_t, 3>, 4> kOthers{{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

  explicit Cavity(Workspace& workspace) : workspace_(workspace) {}

  // Where vertices may be replaced from now on. Only delete_nearer(), widen() and what follows them heed it; no marks
  // may be left.
  void enter(const Region& territory) { territory_ = territory; }
  // Whether the search came to a vertex that is not to be touched: the point cannot be inserted from here then.
  bool left_territory() const { return left_territory_; }
  // What it would have deleted then.
  Index blocker() const { return blocker_; }
  // Whether there are free vertices for all that replace() makes.
  bool has_room() const {
    return territory_.whole() || facets_.size() <= deleted_.size() + territory_.free_vertices->size();
  }

  // Starts over for a new point: nothing deleted, all marks removed.
  void begin(Index new_point);
  // Removes all marks.
  void end();

  std::span<const Index> deleted() const { return deleted_.items(); }
  const std::vector<Facet>& facets() const { return facets_; }

  // Deletes all vertices, connected with the first, whose sign is certainly positive. True if no sign was in doubt and
  // the territory was not left.
  bool delete_nearer(Index start);
  // The same whatever the territory, as long as the new point sees all of the boundary: false where it was found on the
  // way that it does not, and nothing but end() is to be called then. `certain`: whether no sign was in doubt.
  bool delete_nearer_in_sight(Index start, bool& certain);
  // Deletes a vertex whatever may come of it.
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
  // Deletes the vertices in doubt behind boundary facets that the new point does not see, after place_vertices found
  // some. In exact arithmetic these are nearer to the new point: the boundary of all that are is seen all around. False
  // if there is none in doubt.
  bool widen();
  // Notes the boundary facets, once all deletions are made.
  void note_facets();

  // The constrained search's view: whether deleting one more vertex keeps Inagaki et al.'s constraints; and deleting
  // it.
  bool legal(Index v) const;
  void delete_legally(Index v);

  // On which side of the facet between v and its neighbour i the new point is: positive on v's, where the facet can be
  // part of the boundary.
  Sign side_of_facet(Index v, unsigned i) const;

  // Places the new vertices. True if every facet is visible from the new point: all new vertices oriented positively.
  bool place_vertices();
  // The worst of their placings.
  Placing worst_placing() const { return worst_; }
  // Joins the new vertices with each other; false unless the boundary is closed, with two facets on each edge and the
  // number of facets that a sphere has.
  bool link_vertices();
  // Whether the boundary is one piece and no point but the new one lies within. After place_vertices and link_vertices.
  bool is_ball();
  // Whether no new vertex is moved, farther than does harm, by the new point's being in the sphere of an undeleted
  // neighbour. That a doubtful vertex was kept is magnified where the new point is low above the facet. After
  // place_vertices.
  bool doubts_are_harmless() const;
  // Positions of the vertices that were not placed. The number of those with coplanar forming points, whose position is
  // an approximation.
  Index place_flat_vertices();
  // Replaces the deleted vertices by the new ones and removes all marks. The last new vertex that has a position.
  Index replace();
  // The new vertices, after replace().
  std::span<const Index> created() const { return slots_; }

 private:
  // An edge of one facet that waits for the other one, in a list of those that wait at the same corner.
  struct Link {
    Index far, next, facet;  // the edge's other corner; the facet is kNone once the other one has come
    std::uint8_t slot;       // of the facet's vertex: the neighbour across the edge
    bool outward;            // whether the facet runs along the edge to its other corner
  };

  // For each directed edge between so many local points the facet that has it, and the round in which that was written:
  // a sphere with that many corners has twice as many facets but for four.
  template <unsigned kPoints, unsigned kStride>
  struct LinkTable {
    static constexpr unsigned kFacetBits = std::bit_width(2 * kPoints - 1);
    static constexpr unsigned kFacetMask = (1u << kFacetBits) - 1;
    std::vector<std::uint16_t> entries;
    unsigned round = 0;

    // The next round, in the place where it is kept.
    unsigned begin() {
      if (entries.empty() || ++round >> (16 - kFacetBits) != 0) {
        entries.assign(std::size_t{kPoints} * kStride, 0);
        round = 1;
      }
      return round << kFacetBits;
    }
  };
  static constexpr unsigned kFewPoints = 64, kManyPoints = 512;

  // The number of a local point, a new one if it has none yet; without branches, after local_points_.ensure_room().
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
  // Around those of the deleted vertices from the first to the end.
  bool delete_nearer_around(std::size_t first, std::size_t end);
  bool delete_nearer_one_by_one(std::size_t first, std::size_t end);
  bool delete_nearer_by_four(std::size_t first, std::size_t end);
  bool is_nearer_after_all(Index u, bool& certain);
  unsigned nearer_after_all(const std::array<Index, 4>& u, unsigned which, bool& certain);
  // The infinite point, being the highest number, wraps around to the first place.
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
  bool visible_ = false;            // all facets
  List deleted_, seen_, boundary_;  // boundary: 4 * deleted vertex + the neighbour across
  bool is_boundary_noted_ = false;  // by delete_nearer(), and nothing was deleted since
  bool undoubted_ = false;          // and no sign was in doubt, nor is the new point on the sphere of what is kept
  List local_points_;               // the points of the boundary, the one at infinity included
  std::vector<Index> slots_, queue_;
  std::vector<Facet> facets_;
  std::vector<VoronoiVertex> fresh_;      // of each facet; neighbours are facets until replace(), itself for outside
  std::vector<std::uint8_t> reached_;     // by facet or local point
  std::vector<LengthedVector> from_new_;  // from the new point to each local one
  std::vector<Index> local_of_;           // of the infinite point and each other: into local_points_ or kNone
  EdgeTable edges_;
  std::vector<std::uint64_t> ranks_;  // by local point, and the next likewise
  std::vector<Index> waiting_;
  std::vector<Link> links_;
  LinkTable<kFewPoints, kFewPoints> few_links_;
  LinkTable<kManyPoints, kManyPoints + 16> many_links_;  // rows of a power of two would share a few lines of the cache
  Index edge_limit_ = 0;  // local points that the edge table was set up for, in the constrained search
};

}  // namespace orchard::detail
