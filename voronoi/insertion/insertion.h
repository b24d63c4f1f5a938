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
  bowyer,           // all vertices that are nearer to the new point; fails if these do not form a ball
  inagaki,          // breadth-first and ignoring value, under the five constraints
  highest_first,    // by value, under the five constraints
  always_by_value,  // the same without the shortcut for points whose signs are all certain; it tests the search
};

struct InsertionCounts {
  std::uint64_t certified = 0;    // every sign was certain
  std::uint64_t settled = 0;      // keeping the uncertain vertices gave a ball whose boundary the new point sees
  std::uint64_t exact = 0;        // exact arithmetic decided the uncertain signs
  std::uint64_t constrained = 0;  // the constrained search decided
  std::uint64_t coplanar = 0;     // vertices with an approximate position

  std::uint64_t inserted() const { return certified + settled + exact + constrained; }
  InsertionCounts& operator+=(const InsertionCounts& other);
};

// Inserts points one by one into the diagram of a workspace.
class Inserter {
 public:
  // `expected` is the approximate number of points to insert, on which the allowed number of uncertain points depends.
  Inserter(Workspace& workspace, Search search, std::size_t expected)
      : workspace_(workspace), search_(search), expected_(expected), cavity_(workspace) {}

  // Makes the diagram of four points. Returns false if they are nearly coplanar.
  bool start(const std::array<Index, 4>& points);
  // Inserts a point. If the computed signs contradict each other (the workspace does not use exact signs), the point is
  // kept for insert_deferred(), because its later neighbours on the same plane or sphere often resolve the
  // contradiction. Returns false and leaves the diagram unchanged if too many points are kept: the input is then nearly
  // degenerate, but not by rounding, and has to be inserted from the start with exact signs. Bowyer's search returns
  // false if its premises fail.
  bool insert(Index point);
  // Inserts the points that were kept; call it at the end. Returns false, as above, if points still cannot be inserted
  // or if trying takes too long. With a patch, such points are inserted by it, and a certificate has to check all
  // vertices.
  bool insert_deferred(Patch* patch = nullptr);
  // Limits the inserter to a region until leave(), so that several threads, each with an inserter of its own, can work
  // at the same time. The walk to the first point starts at the first of `starts`. A walk that ends without a result is
  // repeated from the start nearest to the point. The starts must belong to the region and exist until leave().
  void enter(const Region& territory, std::span<const Index> starts);
  // Inserts a point if keeping the uncertain vertices is enough and if all changed vertices belong to the region.
  // Otherwise returns false and leaves the diagram unchanged.
  bool insert_within(Index point);
  // Leaves the region and removes all marks, which other inserters must not find.
  void leave();
  // Call it after other inserters have changed the diagram.
  void start_anywhere();
  const InsertionCounts& counts() const { return counts_; }
  bool has_deferred() const { return !deferred_.empty(); }
  void add(const InsertionCounts& counts) { counts_ += counts; }
  const char* failure() const { return failure_; }  // why insert() returned false

 private:
  struct Candidate {
    double value;
    Index vertex;
    bool operator<(const Candidate& other) const {  // the queue returns the largest one
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
  bool note_blocker(Index v);  // returns false
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
  // Vertices outside the region that recently prevented insertions. They do not change, and often prevent the next
  // insertion as well; testing them first saves the walk and the search.
  std::array<Index, 4> blockers_{};
  std::size_t next_blocker_ = 0;
  Index last_ = 0;  // where the walk to the next point starts
  std::vector<Candidate> queue_;
  std::vector<Index> deferred_;
  mutable std::size_t searched_ = 0;  // the number of vertices that highest_of_all() has examined
};

}  // namespace orchard::detail
