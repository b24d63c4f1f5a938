#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/stage_times.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/particles.h"
#include "orchard/spheretree/set_weights.h"
#include "orchard/spheretree/sphere_audit.h"
#include "orchard/spheretree/tightened.h"

// Builds a set of spheres for a solid that covers it, lies inside it, balances its volume or stands for it as
// particles.
namespace orchard {

// What a set of spheres guarantees, and what it optimises.
//   cover     The set contains the whole surface and protrudes as little as possible.
//   inside    The set lies within the solid and fills as much of it as possible.
//   balanced  The union has the volume of the solid within 1 %, and its boundary is as near to the surface as possible.
//   particles The set lies within the solid, no two spheres overlap by more than is allowed, and as one rigid body it
//             has the solid's centre of mass and inertia within stated errors. It fills as much of the solid as
//             possible.
enum class SphereFit { cover, inside, balanced, particles };

// The largest number of spheres in a set.
inline constexpr Index kMaxSetSpheres = 2000;
// The largest error of the volume of a balanced set, as a fraction of the solid's volume.
inline constexpr double kBalancedVolume = 0.01;

// The options of build_sphere_set(). The description of an option names the fits that use it; require_usable() checks
// this.
struct SphereSetOptions {
  SphereFit fit = SphereFit::cover;
  // The number of spheres, 1..kMaxSetSpheres. The set has exactly this number, or at most this number if `error` or
  // `volume_error` is given.
  Index spheres = 20;
  // The error to reach with as few spheres as possible, as a fraction of the diagonal of the bounding box; 0 asks for
  // exactly `spheres` spheres. The error of a cover is how far it protrudes. The error of inside and particles is the
  // largest distance of the surface from the set. The error of balanced is the mean two-sided distance.
  double error = 0;
  // The same for the error of the volume, as a fraction of the solid's volume. The error of a cover is the volume
  // outside the solid; the error of inside and particles is the volume left out. balanced does not use it, since its
  // volume is always that of the solid.
  double volume_error = 0;
  bool solid = false;  // cover: whether the set contains the whole solid, not the surface alone.
  // cover: the set contains every point that is at most this far from the surface; in mesh units.
  double padding = 0;
  double min_radius = 0;        // The smallest radius that a sphere may have, in mesh units.
  SetWeights weights{};         // Regions where looseness counts more; particles do not use them.
  ParticleOptions particles{};  // Options of the fit `particles`; other fits do not use them.
  // cover: the effort of the search, as for trees. Other fits: the number of steps. Higher effort gives better sets and
  // takes longer.
  Effort effort = Effort::standard;
  // Whether the build searches for a number of spheres that is sufficient if a guarantee or an error is missed. The
  // search builds up to four more sets.
  bool find_enough = true;
  std::uint64_t seed = 1;
  // How precisely the result is measured. These options change neither the spheres of a cover or of a set inside nor
  // whether their guarantee counts as kept. For a balanced set, audit.rays determines how precisely the volume is
  // known, and so whether the guarantee counts as kept.
  SphereAuditOptions audit{};
};

// The result of build_sphere_set().
struct SphereSetBuild {
  SphereFit fit = SphereFit::cover;
  std::vector<Sphere> spheres;  // The spheres, the largest first.
  // Whether the guarantee is proven: for a cover, that it contains the surface, and the solid if that was asked for;
  // for inside, that every sphere lies in the solid; for balanced, that the volume is within kBalancedVolume with two
  // standard errors included; for particles, that every sphere and every pair satisfies it and the moments are within
  // their errors. For all fits, also that no radius is below `min_radius`.
  bool kept = false;
  // Whether the requested error is reached. If it is not, `spheres` is the best set of as many spheres as are allowed.
  bool error_reached = true;
  // If `kept` or `error_reached` is false: a number of spheres with which a set was built for which both are true.
  // There is no value if no such set was found up to kMaxSetSpheres or if `find_enough` is off.
  std::optional<Index> enough;
  SphereAudit audit;                         // Measures of the spheres, without `padding`.
  std::optional<ParticleFigures> particles;  // Measures of the fit `particles`.
  StageTimes seconds;
};

// Throws InputError if an option is out of its range or if options.fit cannot use it.
void require_usable(const SphereSetOptions& options);

// Builds a set of spheres for a solid. The result states whether the guarantee of `options.fit` is kept.
// - cover uses the first level of a tightened tree (tightened.h). It takes the best of several searches, by how far the
//   union protrudes and by the volume of its part outside. If fewer spheres are enough, the others lie within the
//   solid.
// - inside and balanced move all spheres together along the gradient of the union's volume or of its two-sided
//   distance.
// - particles packs spheres, and then shrinks or moves them until the moments are right.
// The result is the same for the same surface, options and input on any number of threads. Throws InputError if an
// option is unusable or the surface is not solid.
SphereSetBuild build_sphere_set(const Surface& surface, const SphereSetOptions& options = {},
                                const Progress& progress = {});

// Returns whether every point of the solid lies in a ball. Precondition: the balls cover the surface.
// A void in a union of balls has a corner where three spheres meet outside all other balls, so the function tests these
// corners only. A corner that rounding leaves undecided counts as uncovered. O(n k^3) for n balls of which each meets k
// others.
bool covers_solid(const Surface& surface, std::span<const Sphere> balls);

}  // namespace orchard
