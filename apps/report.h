#pragma once
#include <nlohmann/json.hpp>

#include "orchard/geometry/surface.h"
#include "pipeline.h"

// What a run says about itself, for people and for programs.
namespace orchard::apps {

nlohmann::json mesh_json(const Surface& surface);
nlohmann::json build_json(const Surface& surface, const BuildOptions& options, const BuildResult& result);
void print_build(const BuildResult& result, double bounding_radius);

}  // namespace orchard::apps
