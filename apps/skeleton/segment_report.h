#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "command_line/commands.h"
#include "orchard/medial/surface_parts.h"
#include "skeleton/solid_axis.h"

// What `orchard segment` says about the parts of a surface, for people and for programs.
namespace orchard::apps {

struct SegmentReport {
  const SegmentCommand& command;
  const SolidAxis& axis;
  const SurfaceParts& parts;
};

nlohmann::json to_json(const SegmentReport& report);
void print(const SegmentReport& report);

// A line "part,area,area_percent,triangles,patches,max_radius,sheet,region" and a line for each part; -1 for none.
std::string to_csv(const SurfaceParts& parts);

}  // namespace orchard::apps
