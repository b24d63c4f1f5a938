#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/spheretree/sphere_set.h"
#include "robot/link_shape.h"

namespace orchard::robot {

struct FitOptions {
  Index spheres = 60;                   // of all links together; at least one each
  SphereFit fit = SphereFit::cover;     // cover, inside or balanced
  std::map<Index, Index> spheres_of{};  // links that are to have exactly so many
  std::map<Index, SphereFit> fit_of{};  // links with another fit
  Effort effort = Effort::standard;
  double padding = 0;  // of covers, in metres
  std::uint64_t seed = 1;
};

// A link's spheres, in its frame.
struct LinkFit {
  SphereFit fit = SphereFit::cover;
  std::vector<Sphere> spheres;  // as files have them: rounded(), the largest first
  // Proven of the spheres as readers hold them, in double or in float: cover, that every point of the link's triangles
  // lies in a sphere, of those that were read and of those that were repaired; for shapes that were wrapped and for
  // curved primitives the whole solid instead, within which they lie. Otherwise what SphereSetBuild::kept says, of the
  // spheres before they were rounded: towards their centres for `inside`.
  bool kept = false;
  double grown = 0;   // what all radii had to grow by for that, beyond rounding; metres
  SphereAudit audit;  // of the spheres as files have them, without padding, beside LinkShape::surface
};

// A sphere whose coordinates and radius have seven digits after the point, so that files are short and readers in float
// and in double hold nearly the same. `outward`: both hold a ball that contains the sphere; otherwise both hold one
// that lies in it, or, where the radius is too small for that, radius 0.
Sphere rounded(const Sphere& sphere, bool outward);

// How sets are measured while they are made: nothing but how far they protrude is asked for.
inline constexpr SphereAuditOptions kQuickAudit{
    .max_cells = 2000, .rays = 400, .surface_samples = 200, .sphere_samples = 400};

// How many spheres each shape gets: the next one goes to the shape whose spheres stick out farthest (of `inside`: leave
// most open), by covers of low effort of as many spheres as a first estimate says, and between these by a law of
// powers. Throws InputError if there are fewer spheres than shapes, or the links that are to have a number of their own
// leave too few.
std::vector<Index> share_spheres(const Robot& robot, const std::vector<LinkShape>& shapes, const FitOptions& options,
                                 const Progress& progress = {});

// Spheres for each shape, in their order: those of build_sphere_set(), rounded, proven and measured. The same for the
// same input on any number of threads. Throws InputError as share_spheres() does, and for a shape that is no solid.
std::vector<LinkFit> fit_links(const Robot& robot, const std::vector<LinkShape>& shapes, const FitOptions& options = {},
                               const Progress& progress = {});

}  // namespace orchard::robot
