#pragma once
#include <nlohmann/json.hpp>

#include "command_line/commands.h"
#include "orchard/medial/curve_skeleton.h"
#include "output/promises.h"
#include "skeleton/solid_axis.h"

// What `orchard skeleton` says about a skeleton, for people and for programs.
namespace orchard::apps {

struct SkeletonReport {
  const SkeletonCommand& command;
  const SolidAxis& axis;
  const CurveSkeleton& skeleton;
  Topology found;  // of the skeleton
};

// The promise of the solid's topology.
Broken broken(const SkeletonReport& report);
nlohmann::json to_json(const SkeletonReport& report);
void print(const SkeletonReport& report);

}  // namespace orchard::apps
