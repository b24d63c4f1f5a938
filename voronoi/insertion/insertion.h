#pragma once
#include <cstdint>
#include <queue>
#include <span>
#include <vector>

#include "insertion/cavity.h"
#include "workspace/workspace.h"

namespace orchard::detail {

class Patch;

// How the vertices that a new point deletes are found.
enum class Search : std::uint8_t {
  bowyer,           // all that are nearer to the new point, and failing where that is not a ball
  inagaki,          // breadth-first and ignoring value, under the five constraints
  highest_first,    // by value, under the five constraints
  always_by_value,  // the same without the short cut for points whose vertices are beyond doubt, to test the search
};

struct InsertionCounts {
  std::uint64_t certified = 0;    // every sign was beyond doubt
  std::uint64_t settled = 0;      // leaving the doubtful vertices alone gave a ball that the new point sees all around
  std::uint64_t exact = 0;        // the same, after exact arithmetic had settled the doubts
  std::uint64_t constrained = 0;  // the constrained search decided
  std::uint64_t coplanar = 0;     // vertices with an approximate position

  std::uint64_t inserted() const { return certified + settled + exact + constrained; }
  InsertionCounts& operator+=(const InsertionCounts& other);
};

// Inserts points one by one into the diagram of a workspace.
class Inserter {
 public:
  // `expected`: about how many points it is to insert. How many of them may be in doubt hangs on that.
  Inserter(Workspace& workspace, Search search, std::size_t expected)
      : workspace_(workspace), search_(search), expected_(expected), cavity_(workspace) {}

  // Makes the diagram of four points; false if they are nearly coplanar.
  bool start(const std::array<Index, 4>& points);
  // Where the signs contradict each other, although the workspace does not ask for exact ones, the point is kept for
  // insert_deferred(): its neighbours on the same plane or sphere may well settle the doubt. False, with the diagram as
  // it was, where too many do: then the input is near to degenerate, but not so near that rounding could be the
  // reason. To be done again with exact signs from the start. Bowyer's search returns false where its premises fail.
  bool insert(Index point);
  // To be called at the end; false, as above, if there are points that do not fit even now, or if it takes too long to
  // find that out. With a patch, points that do not fit by themselves go in by it, for a certificate that looks at all
  // vertices.
  bool insert_deferred(Patch* patch = nullptr);
  // Between enter() and leave(): where vertices may be replaced, by several threads that have an inserter each. The
  // walk to the first point starts from the first of `starts`, and where a walk leads nowhere, it is made again from
  // the one nearest to the point. They must be owned, and live until then.
  void enter(const Region& territory, std::span<const Index> starts);
  // Only without doubts that take more than leaving vertices alone, and only if all that changes is owned; else false,
  // with the diagram as it was.
  bool insert_within(Index point);
  // Removes all marks, lest other inserters meet them.
  void leave();
  // To be called when others have been at work.
  void start_anywhere();
  const InsertionCounts& counts() const { return counts_; }
  bool has_deferred() const { return !deferred_.empty(); }
  void add(const InsertionCounts& counts) { counts_ += counts; }
  const char* failure() const { return failure_; }  // why insert() returned false

 private:
  struct Candidate {
    double value;
    Index vertex;
    bool operator<(const Candidate& other) const {  // the queue releases the greatest
      return value != other.value ? value < other.value : vertex > other.vertex;
    }
  };

  bool insert_now(Index point);
  bool insert_by_value(Index point, Index start, const Point& q, bool may_overrule);
  bool insert_sparsely(Index point, const Point& q);
  void insert_constrained(Index start, const Point& q);
  bool too_doubtful() const;
  bool insert_by_patch(Patch* patch);
  bool insert_anyhow(Index point);
  Index locate(const Point& q) const;
  Index nearest_start(const Point& q) const;
  bool is_blocked(const Point& q) const;
  bool note_blocker(Index v);  // false
  Index walk(const Point& q) const;
  Index highest_nearby(Index v, const Point& q) const;
  Index step_by_orientation(Index v, const Point& q) const;
  Index walk_by_orientation(Index v, const Point& q) const;
  Index highest_of_all(const Point& q) const;
  bool is_lost() const;
  Index climb(Index v, const Point& q) const;
  bool insert_directly(Index start, const Point& q);
  bool insert_with_doubts(Index point, Index start, const Point& q);
  bool insert_exactly(Index point, const Point& q);
  bool respects_certain_signs(const Point& q) const;
  void search_highest_first(Index start, const Point& q);
  void delete_and_queue(Index v, const Point& q);
  void enqueue(Index v, double value);
  bool sees_around(const Candidate& candidate, const Point& q);
  void search_breadth_first(Index start, const Point& q);
  bool insert_bowyer(Index start, const Point& q);
  void finish();

  Workspace& workspace_;
  Search search_;
  std::size_t expected_;
  Region territory_;
  Cavity cavity_;
  InsertionCounts counts_;
  const char* failure_ = "";
  std::span<const Index> starts_;
  // Vertices not owned that kept points from being inserted of late: they are as they were, and often in the way of the
  // next point as well, which saves the walk to it and the search.
  std::array<Index, 4> blockers_{};
  std::size_t next_blocker_ = 0;
  Index last_ = 0;  // where the walk to the next point starts
  std::vector<Candidate> queue_;
  std::vector<Index> deferred_;
  mutable std::size_t searched_ = 0;  // vertices, by highest_of_all()
};

}  // namespace orchard::detail
