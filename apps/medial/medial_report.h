#pragma once
#include <nlohmann/json.hpp>

#include "orchard/medial/build.h"
#include "orchard/medial/segments.h"
#include "orchard/medial/structure.h"
#include "orchard/medial/topology.h"

// What `orchard medial` says about an axis, for people and for programs.
namespace orchard::apps {

nlohmann::json to_json(const MedialBuild& build);
nlohmann::json to_json(const Topology& topology);
nlohmann::json to_json(const MedialSegments& segments, const StructureGraph& graph, const MedialStructure& structure);

void print(const MedialBuild& build);
void print(const MedialStructure& structure);

}  // namespace orchard::apps
