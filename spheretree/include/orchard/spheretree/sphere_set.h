#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/stage_times.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/sphere_audit.h"
#include "orchard/spheretree/tightened.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// What a set of spheres promises.
//   cover     it holds the whole surface, and sticks out as little as it can
//   inside    it lies within the solid, and fills as much of it as it can
//   balanced  its union has the volume of the solid, within 1 %, and a boundary as near to the surface as can be
enum class SphereFit { cover, inside, balanced };

inline constexpr Index kMaxSetSpheres = 2000;
inline constexpr double kBalancedVolume = 0.01;  // how far the union's volume of a balanced set may be off, as a part

struct SphereSetOptions {
  SphereFit fit = SphereFit::cover;
  Index spheres = 20;  // exactly so many, 1..kMaxSetSpheres; where an error is given, at most so many
  // The fewest spheres with this error at most, as a fraction of the diagonal of the bounding box; 0: exactly
  // `spheres`. cover: how far they stick out; inside: how far the surface is from them; balanced: the mean two-sided
  // distance.
  double error = 0;
  // The same for the volume, as a fraction of the solid's: cover: what lies outside; inside: what is left out.
  // balanced: of no use, since the volume is that of the solid anyhow.
  double volume_error = 0;
  bool solid = false;     // cover: the whole solid, not the surface alone
  double padding = 0;     // cover: every point no farther than this from the surface is held, too; mesh units
  double min_radius = 0;  // cover: no sphere is smaller; mesh units
  Effort effort = Effort::standard;  // cover: as for trees; balanced and inside: how many steps
  std::uint64_t seed = 1;
};

struct SphereSetBuild {
  SphereFit fit = SphereFit::cover;
  std::vector<Sphere> spheres;  // the largest first
  // Whether the promise is proven: cover, of the surface (and of the solid, where that is asked for); inside, of every
  // sphere; balanced, that the volume is within kBalancedVolume, two standard errors included.
  bool kept = false;
  // Whether an error that was asked for is reached. If not, `spheres` is the best set of as many as are allowed.
  bool error_reached = true;
  SphereAudit audit;  // of the spheres; without `padding`
  StageTimes seconds;
};

// Throws InputError if an option is out of its range or of no use to the fit.
void require_usable(const SphereSetOptions& options);

// Makes a set of spheres for a solid that keeps the promise of `options.fit`; the result says whether it does.
// cover is the first level of a tightened tree (tightened.h), the best of some searches by how far the union sticks out
// and how much of it lies outside; inside and balanced move all spheres together along the gradient of the union's
// volume or of its two-sided distance. Where fewer spheres are enough for a cover, the others lie within the solid. The
// same spheres for the same surface, options and input whatever the number of threads. Throws InputError if options are
// unusable or the surface is no solid.
SphereSetBuild build_sphere_set(const Surface& surface, const SphereSetOptions& options = {},
                                const Progress& progress = {});

// Whether every point of the solid lies in a ball, given that every point of its surface does: a void of a union of
// balls has a corner where three spheres meet in no other ball, so it is enough to look at those. What rounding cannot
// tell counts as not held. Precondition: the balls cover the surface. O(n k^3) for n balls that meet k others each.
bool covers_solid(const Surface& surface, std::span<const Sphere> balls);

// A tree of two levels: a root that holds all balls and the surface's bounding ball, and the balls as its leaves. The
// root grows about the centre of `bounds`. Precondition: there is a ball.
SphereTree tree_over(std::span<const Sphere> balls, const Sphere& bounds);

}  // namespace orchard
