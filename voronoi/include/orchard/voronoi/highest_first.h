#pragma once
#include <span>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

namespace orchard {

// The Voronoi diagram by incremental insertion with the highest-first deletion search under Inagaki et al.'s five
// constraints (dissertation 6.2.3): consistent for every input, and certified to be right: no point is deeper in a
// sphere, or farther beyond a facet of the hull, than report.certified_intrusion, which is at most
// tolerance::kVoronoiIntrusion of the bounding radius for up to 512 points (a 512th of that for each point more).
// Points within tolerance::kCoincidentPoints of the bounding radius of an earlier point form no vertex. Points that all
// lie in a plane, up to rounding, or are fewer than four have a diagram without vertices; report.dimension tells.
// Deterministic; from 100,000 points on by several threads, with the same result on any number of them. Throws
// InputError for coordinates that are not finite or beyond 1e100, or if all points lie within
// 1e-100 and are not one. About O(n log n) on surface points; at the peak 66 bytes a vertex and 32 a point beside the
// caller's points.
VoronoiBuild highest_first_voronoi(std::span<const Point> points, const Progress& progress = {});

// Adds points to a diagram that any of the algorithms made; new ones are numbered after those there are. A rebuild
// agrees up to rounding. Old vertices may be renumbered. The report speaks of the new points, or of all of them if the
// diagram had no vertices or had to be rebuilt, which costs as much as the first time: where the new points
// contradict the old ones, and these are not exactly Voronoi. Else O(n) with a small constant, plus about O(k log k)
// for k new points. The certificate is of what is new: an old vertex that was wrong stays wrong. Throws InputError as
// above; whatever is thrown, the diagram is as it was.
InsertionReport insert_points(VoronoiDiagram& diagram, std::span<const Point> points);

}  // namespace orchard
