#pragma once
#include <span>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

// The default algorithm for Voronoi diagrams: incremental insertion that is consistent for every input and certified.
namespace orchard {

// Builds the Voronoi diagram by incremental insertion with the highest-first deletion search under the five constraints
// of Inagaki et al.
// - The diagram is consistent for every input.
// - It is certified: no point lies deeper in the sphere of a vertex, or farther beyond a facet of the hull, than
//   report.certified_intrusion. This value is at most tolerance::kVoronoiIntrusion of the bounding radius for up to 512
//   points, and a 512th of that more for each further point.
// - Points within tolerance::kCoincidentPoints of the bounding radius of an earlier point form no vertex.
// - If there are fewer than four points or all lie in one plane up to rounding, the diagram has no vertices;
//   report.dimension contains the dimension that they span.
// The result is deterministic. From 100,000 points on, several threads compute it, and it is the same on any number of
// them. Throws InputError for coordinates that are not finite or beyond 1e100, or if all points lie within 1e-100 and
// are not one point. Takes about O(n log n) on surface points, and at the peak 66 bytes for each vertex and 32 for each
// point in addition to the caller's points. Source: dissertation 6.2.3.
VoronoiBuild highest_first_voronoi(std::span<const Point> points, const Progress& progress = {});

// Adds points to a diagram that any of the algorithms built. The new points are numbered after the existing ones; old
// vertices may be renumbered. The result agrees with a rebuild up to rounding.
// The report covers the new points, or all points if the diagram had no vertices or was rebuilt. A rebuild, which costs
// as much as the first build, is necessary if the new points contradict the old vertices because these are not exactly
// Voronoi. The certificate covers what is new: an old vertex that was wrong remains wrong.
// Throws InputError as highest_first_voronoi() does; after an exception, the diagram is unchanged. Takes O(n) with a
// small constant, plus about O(k log k) for k new points.
InsertionReport insert_points(VoronoiDiagram& diagram, std::span<const Point> points);

}  // namespace orchard
