#pragma once
#include <cstdint>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

// Offsets of surfaces: the places at a given distance.
namespace orchard {

// The side of the surface on which the offset lies.
enum class OffsetSide : std::uint8_t {
  outside,  // The surface of the solid grown by the distance.
  inside,   // The surface of the solid shrunk by the distance.
  both      // The surface of a shell around the surface, twice as thick as the distance. It may be open.
};

// The options of offset_mesh().
struct OffsetOptions {
  double distance = 0;  // In mesh units, above 0.
  OffsetSide side = OffsetSide::outside;
  // The largest difference between the distance of a place of the result and `distance`, in diagonals of the bounding
  // box of the surface; in [kMinOffsetTolerance, 0.5]. Time and size grow with the inverse square.
  double tolerance = 0.005;
};
inline constexpr double kMinOffsetTolerance = 2e-4;

// An offset with proven bounds.
struct OffsetMesh {
  TriangleMesh mesh;     // Closed, manifold, without self-intersections, facing away from the solid or shell.
  double distance = 0;   // The distance from the surface that the mesh was made for, in mesh units.
  double tolerance = 0;  // Of the options, in mesh units. See offset_mesh().
  double cell = 0;       // The edge length of the grid's cells.
  // Proven: every place of the mesh has a distance from the surface between these two. They are tight: some place has
  // a distance within 2 % of the tolerance of each, unless the search was ended by its limit of work.
  double min_distance = 0, max_distance = 0;
  // The places of the mesh that were found nearest to the surface and farthest from it.
  Point nearest = Point::Zero(), farthest = Point::Zero();

  // The largest difference between the distance of a place of the mesh and the distance asked for.
  double error() const;
};

// Returns the offset of a surface by its exact distance field: the mesh of the level set on a grid (as that of
// envelope_mesh()) whose cells are the tolerance over sqrt(3), or, of a shell, half the distance if that is smaller.
// Two things hold:
// 1. No place of the mesh has a distance that differs from the one asked for by more than the tolerance. The result
//    has bounds for all places, found by branch and bound and not by samples.
// 2. Every place whose distance differs by more than the tolerance is on its right side of the mesh. So parts that
//    vanish are nowhere deeper than that.
// An edge of the offset is cut off within the tolerance. Throws InputError unless the options are in range, and
// surface.solid() if the offset has a side, or if nothing is left of the solid at that depth. Deterministic; parallel.
// About four microseconds of one core for each triangle of the result.
OffsetMesh offset_mesh(const Surface& surface, const OffsetOptions& options, const Progress& progress = {});

// A solid with a cavity inside it.
struct HollowMesh {
  TriangleMesh mesh;  // The triangles of the surface, then those of the cavity, which face into it.
  OffsetMesh cavity;  // Facing out of the cavity.
  // Proven: the wall between the cavity and the surface is nowhere thinner.
  double min_wall = 0;
};

// Hollows a solid: the cavity consists of the places deeper than `wall`, in mesh units. No wall is thinner than `wall`,
// and cavity.max_distance is a proven bound on how thick it is at any place of the cavity: above `wall` by 1.6
// tolerances at most, where the cavity has sharp edges, and by a tenth of the tolerance on most flat walls. Parts
// thinner than two walls stay solid. The cavity has no opening. options.distance and options.side do not count. Throws
// as offset_mesh() does; takes twice as long.
HollowMesh hollow_mesh(const Surface& surface, double wall, const OffsetOptions& options,
                       const Progress& progress = {});

}  // namespace orchard
