#pragma once
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/medial/axis.h"

namespace orchard::detail {

// Fills axis.face_points, axis.faces, axis.topology_face_points and axis.topology_faces. `medial`: the medial vertex of
// each Voronoi vertex, or kNone. `stems`: KeptTopology::stems; a vertex that a stem joins to one neighbour has no
// faces.
void find_medial_faces(const Surface& surface, const SurfaceSampling& sampling, const VoronoiFaces& voronoi,
                       const std::vector<Index>& medial, const std::vector<Index>& stems, MedialAxis& axis);

}  // namespace orchard::detail
