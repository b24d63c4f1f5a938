#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "insertion/insertion.h"
#include "workspace/workspace.h"

namespace orchard::detail {

// Rebuilds a part of a diagram (the patch) where no insertion fits. It makes the diagram of the points of this part
// alone, with exact signs. A facet that is Delaunay among all points is so among some of them, so the facets around the
// patch should be in the exact diagram, too. If one is not, the vertex across from it, and some vertices around that,
// join the patch, until all facets around it are in the exact diagram. The vertices that the exact diagram has within
// these facets then replace the patch. Since the surroundings were not made with exact signs, the certificate has to
// check the result.
class Patch {
 public:
  explicit Patch(Workspace& workspace) : workspace_(workspace) {}

  // Rebuilds these vertices, `layers` layers of vertices around them, and others that have to be replaced with them,
  // such that the additional points form vertices, too. If that takes too many vertices, returns false and leaves the
  // diagram as it was.
  bool replace(std::span<const Index> vertices, int layers, std::span<const Index> additional = {});
  // The new vertices, after replace().
  const std::vector<Index>& created() const { return created_; }

 private:
  // A facet around the patch: its corners among the exact diagram's points, the least first, running as seen from
  // within; the vertex in the patch, and the slot of its neighbour across. Then the same facet of the exact diagram.
  struct Facet {
    std::array<Index, 3> corners;
    Index inside;
    unsigned slot;
    Index exact_inside = kNone;
    unsigned exact_slot = 0;
  };

  void begin();
  void add(Index v);
  bool add_enclosed();
  bool is_enclosed(Index first);
  void grow(std::size_t from, int layers);
  bool insert_points(std::span<const Index> additional);
  std::array<Index, 3> corners_of(const VoronoiVertex& vertex, unsigned slot) const;
  void note_boundary();
  bool find_boundary();
  bool fill();
  bool has_all_points() const;
  bool has_single_facets() const;
  void choose_slots();
  void splice();

  Workspace& workspace_;
  std::vector<Index> patch_;
  std::vector<std::uint8_t> side_;  // by vertex: in the patch, or known to be far outside
  std::vector<Index> reached_;
  std::vector<Facet> boundary_;
  Workspace exact_;
  std::optional<Inserter> inserter_;  // of the exact diagram
  std::vector<Index> points_;         // of the exact diagram, by their numbers in the other one
  std::vector<Index> exact_of_;       // the other way around
  std::size_t noted_ = 0;             // vertices of the patch whose points are in the exact diagram
  std::vector<Index> filling_;        // vertices of the exact diagram
  std::vector<Index> slots_;          // by vertex of the exact diagram: where it goes
  std::vector<Index> created_;
};

}  // namespace orchard::detail
