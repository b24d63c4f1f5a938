#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface_distance.h"

namespace orchard::apps {

// The distance between a repaired mesh and the one that was read, as proven bounds in mesh units. A certificate for one
// of them holds for the other up to this distance.
struct RepairDistance {
  // From the repaired mesh to the input, and back; both are 0 if no triangle changed.
  SurfaceDistance to_input, from_input;

  double upper() const;  // of the two-sided Hausdorff distance
};

// Computes the distances. Triangles with the same three corners in both meshes have distance 0, so only the others are
// searched: O(n log n) for these. Precondition: validate(input) passes.
RepairDistance repair_distance(const TriangleMesh& input, const Surface& repaired, const Progress& progress = {});

// Returns "no point of it is farther than .. from the input, no point of the input farther than .. from it".
std::string in_words(const RepairDistance& distance, double bounding_radius);

// Adds the two distances as [lower, upper], and `distance`, the upper bound of both, to the report of the repair.
void add_json(const RepairDistance& distance, double bounding_radius, nlohmann::json& repair);

}  // namespace orchard::apps
