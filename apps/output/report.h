#pragma once
#include <nlohmann/json.hpp>

#include "orchard/geometry/surface.h"
#include "trees/tree_request.h"

// What a run says about itself, for people and for programs.
namespace orchard::apps {

nlohmann::json mesh_json(const Surface& surface);
// wrap_distance: how far the surface may be from the mesh that it wraps, in mesh units; 0: no wrap. It is added to the
// inaccuracies where their name says so.
nlohmann::json build_json(const Surface& surface, const TreeRequest& tree, const SphereTreeOptions& options,
                          const SphereTreeBuild& result, double wrap_distance);
void print_build(const SphereTreeBuild& result, double bounding_radius, double wrap_distance);

}  // namespace orchard::apps
