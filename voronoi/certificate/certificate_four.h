#pragma once
#include <algorithm>
#include <array>
#include <span>

#include "predicates/four_tetrahedra.h"
#include "workspace/workspace.h"

// The certificate's tests of four facets or vertices at a time, for machines with AVX2. Results have the same bits as
// those of the tests one by one.
namespace orchard::detail {

// The number of vertices that are tested together, while the points of the next ones are fetched into the cache.
inline constexpr Index kCertificateBatch = 64;

// If the error of a facet's normal may exceed this angle, the normal is computed with more digits.
inline constexpr double kBlurred = 0x1p-44;

// The facet between a vertex and its neighbour `slot`, and the vertex's forming point that is not on the facet.
struct Facet {
  Index v, u;
  unsigned slot;
  Index opposite;
};

// For four facets: the spheres on both sides, a corner of each sphere, and the corners of the facet.
struct FourSteps {
  std::array<const VoronoiVertex*, 4> from, to;
  std::array<const Point*, 4> from_corner, to_corner, a, b, c;
};

// Tests four facets in doubles. A bit is set for each facet that this does not show to be good.
unsigned doubtful_of_four(const Workspace& workspace, const Facet* facets);

// The same as Certifier::normal() and intrusion_added(), in the same order of operations, for the corners of four
// facets. Infinite where a normal needs more digits.
std::array<double, 4> added_by_four(const FourSteps& steps, double diameter);

// A list of the vertices of a batch to which vertices are added without branches.
class BatchList {
 public:
  std::span<const Index> items() const { return {items_.data(), count_}; }
  void push_if(Index v, bool condition) {
    items_[count_] = v;
    count_ += condition;
  }
  // Calls take(i, vertices) for each four vertices of the list, where i is the position of the first. If fewer than
  // four are left, the last vertex is repeated.
  template <class Take>
  void for_each_four(const Take& take) const {
    for (std::size_t first = 0; first < count_; first += 4) {
      std::array<Index, 4> four;
      for (std::size_t lane = 0; lane < 4; ++lane) four[lane] = items_[std::min(first + lane, count_ - 1)];
      take(first, four);
    }
  }

 private:
  std::array<Index, kCertificateBatch + 1> items_;
  std::size_t count_ = 0;
};

// The results of the tests for the vertices of a list, in its order, and their radii.
struct BatchLooks {
  std::array<double, kCertificateBatch + 4> negative, negative_bound, radius, apart;
};

// Bounds for the spheres of four vertices: on their distances from the spheres of their forming points, and on the
// error of a power that follows from these. FourMoved has the same bounds after a step towards the spheres of the
// forming points, and the centres and radii after that step.
struct FourSeen {
  std::array<double, 4> apart, power_bound;
};
struct FourMoved : FourSeen {
  std::array<double, 4> x, y, z, squared_radius;
};

// The same as Certifier::from_told_sphere(), for four vertices, and their radii. `far` is the result for vertices that
// share a sphere.
void told_of_four(const Workspace& workspace, const std::array<Index, 4>& v, double far, double* radius, double* apart);

// The same as Certifier::apart_by() and Workspace::own_power_bound(), from bounds on the errors of four centres.
FourSeen apart_of_four(const Workspace& workspace, const std::array<Index, 4>& v, const FourOffCenters& off,
                       double diameter);
// The same as Certifier::from_moved_sphere(), for four vertices.
FourMoved moved_four(const Workspace& workspace, const std::array<Index, 4>& v, const FourOffCenters& off,
                     double diameter);

}  // namespace orchard::detail
