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

namespace orchard {

// What a set of spheres promises.
//   cover     it holds the whole surface, and sticks out as little as it can
//   inside    it lies within the solid, and fills as much of it as it can
//   balanced  its union has the volume of the solid, within 1 %, and a boundary as near to the surface as can be
//   particles it lies within the solid, no two of its spheres overlap by more than is allowed, and as one rigid body it
//             has the solid's centre of mass and inertia within stated errors; it fills as much as it can
enum class SphereFit { cover, inside, balanced, particles };

inline constexpr Index kMaxSetSpheres = 2000;
inline constexpr double kBalancedVolume = 0.01;  // how far the union's volume of a balanced set may be off, as a part

struct SphereSetOptions {
  SphereFit fit = SphereFit::cover;
  Index spheres = 20;  // exactly so many, 1..kMaxSetSpheres; where an error is given, at most so many
  // The fewest spheres with this error at most, as a fraction of the diagonal of the bounding box; 0: exactly
  // `spheres`. cover: how far they stick out; inside and particles: how far the surface is from them; balanced: the
  // mean two-sided distance.
  double error = 0;
  // The same for the volume, as a fraction of the solid's: cover: what lies outside; inside and particles: what is left
  // out. balanced: of no use, since the volume is that of the solid anyhow.
  double volume_error = 0;
  bool solid = false;           // cover: the whole solid, not the surface alone
  double padding = 0;           // cover: every point no farther than this from the surface is held, too; mesh units
  double min_radius = 0;        // no sphere is smaller; mesh units
  SetWeights weights{};         // where looseness counts more; of no use to particles
  ParticleOptions particles{};  // of use to that fit alone
  Effort effort = Effort::standard;  // cover: as for trees; otherwise: how many steps
  // Where something that was asked for is missed, look for a number of spheres that would do: up to four more sets are
  // made.
  bool find_enough = true;
  std::uint64_t seed = 1;
  // How closely the result is measured. It does not change what a cover or a set of spheres inside is, nor whether they
  // are kept; the volume of a balanced set is judged by audit.rays.
  SphereAuditOptions audit{};
};

struct SphereSetBuild {
  SphereFit fit = SphereFit::cover;
  std::vector<Sphere> spheres;  // the largest first
  // Whether the promise is proven: cover, of the surface (and of the solid, where that is asked for); inside, of every
  // sphere; balanced, that the volume is within kBalancedVolume, two standard errors included; particles, of every
  // sphere and every pair, and that the moments are within their errors. Also that no sphere is below `min_radius`.
  bool kept = false;
  // Whether an error that was asked for is reached. If not, `spheres` is the best set of as many as are allowed.
  bool error_reached = true;
  // Where one of the two is false: a number of spheres with which a set was made that misses nothing. Nothing: none was
  // found up to kMaxSetSpheres, or `find_enough` is off.
  std::optional<Index> enough;
  SphereAudit audit;                         // of the spheres; without `padding`
  std::optional<ParticleFigures> particles;  // of that fit
  StageTimes seconds;
};

// Throws InputError if an option is out of its range or of no use to the fit.
void require_usable(const SphereSetOptions& options);

// Makes a set of spheres for a solid that keeps the promise of `options.fit`; the result says whether it does.
// cover is the first level of a tightened tree (tightened.h), the best of some searches by how far the union sticks out
// and how much of it lies outside; inside and balanced move all spheres together along the gradient of the union's
// volume or of its two-sided distance; particles are packed, and then made smaller or moved until the moments are
// right. Where fewer spheres are enough for a cover, the others lie within the solid. The same spheres for the same
// surface, options and input whatever the number of threads. Throws InputError if options are unusable or the surface
// is no solid.
SphereSetBuild build_sphere_set(const Surface& surface, const SphereSetOptions& options = {},
                                const Progress& progress = {});

// Whether every point of the solid lies in a ball, given that every point of its surface does: a void of a union of
// balls has a corner where three spheres meet in no other ball, so it is enough to look at those. What rounding cannot
// tell counts as not held. Precondition: the balls cover the surface. O(n k^3) for n balls that meet k others each.
bool covers_solid(const Surface& surface, std::span<const Sphere> balls);

}  // namespace orchard
