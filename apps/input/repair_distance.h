#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface_distance.h"

namespace orchard::apps {

// The distance between a repaired mesh and the one that was read, as proven bounds in mesh units. A certificate for one
// of them holds for the other up to this distance.
struct RepairDistance {
  SurfaceDistance to_input, from_input;  // repaired to input, input to repaired; both 0 where no triangle changed

  double upper() const;  // of the two-sided Hausdorff distance
};

// Triangles with the same three corners in both meshes have distance 0, so only the others are searched: O(n log n) for
// these. Precondition: validate(input) passes.
RepairDistance repair_distance(const TriangleMesh& input, const Surface& repaired, const Progress& progress = {});

// "no point of it is farther than .. from the input, no point of the input farther than .. from it".
std::string in_words(const RepairDistance& distance, double bounding_radius);

// The two distances as [lower, upper], and `distance`, the upper bound of both.
void add_json(const RepairDistance& distance, double bounding_radius, nlohmann::json& repair);

}  // namespace orchard::apps
