#pragma once
#include <algorithm>
#include <array>
#include <span>

#include "predicates/four_tetrahedra.h"
#include "workspace/workspace.h"

// What the certificate looks at four at a time, with the same bits as one by one. Only where the machine has AVX2.
namespace orchard::detail {

// Vertices that are looked at together, while the points of the next ones are fetched into the cache.
inline constexpr Index kCertificateBatch = 64;

// The angle by which the normal of a facet may be off before it is found with more digits.
inline constexpr double kBlurred = 0x1p-44;

// The facet between a vertex and its neighbour `slot`, and the point that the vertex has instead of a shared one.
struct Facet {
  Index v, u;
  unsigned slot;
  Index opposite;
};

// Four times the spheres on both sides of a facet, a corner of each, and the facet's own.
struct FourSteps {
  std::array<const VoronoiVertex*, 4> from, to;
  std::array<const Point*, 4> from_corner, to_corner, a, b, c;
};

// A bit for each of four facets across which doubles do not show that nothing is lost.
unsigned doubtful_of_four(const Workspace& workspace, const Facet* facets);

// As Certifier::normal() and intrusion_added(), in the same order of operations, by the corners of four facets;
// infinite where a normal calls for more digits.
std::array<double, 4> added_by_four(const FourSteps& steps, double diameter);

// Vertices of a batch, listed without branches.
class BatchList {
 public:
  std::span<const Index> items() const { return {items_.data(), count_}; }
  void push_if(Index v, bool condition) {
    items_[count_] = v;
    count_ += condition;
  }
  // With the place of the first. The last one again for those that the last four lack.
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

// The same of the vertices of such a list, and their radii.
struct BatchLooks {
  std::array<double, kCertificateBatch + 4> negative, negative_bound, radius, apart;
};

// What is seen of four spheres: how far they are from those of their forming points, at most, and what that bounds the
// error of a power by. And the same of the spheres a step nearer to these.
struct FourSeen {
  std::array<double, 4> apart, power_bound;
};
struct FourMoved : FourSeen {
  std::array<double, 4> x, y, z, squared_radius;
};

// As Certifier::from_told_sphere(), with their radii; `far` is what is told of those that share a sphere.
void told_of_four(const Workspace& workspace, const std::array<Index, 4>& v, double far, double* radius, double* apart);

// As Certifier::apart_by() and Workspace::own_power_bound(), by how far the centres are off.
FourSeen apart_of_four(const Workspace& workspace, const std::array<Index, 4>& v, const FourOffCenters& off,
                       double diameter);
// As Certifier::from_moved_sphere().
FourMoved moved_four(const Workspace& workspace, const std::array<Index, 4>& v, const FourOffCenters& off,
                     double diameter);

}  // namespace orchard::detail
