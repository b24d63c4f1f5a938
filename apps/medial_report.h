#pragma once
#include <nlohmann/json.hpp>
#include <optional>

#include "orchard/medial/build.h"
#include "orchard/medial/quality.h"
#include "orchard/medial/segments.h"

// What `orchard medial` says about an axis, for people and for programs.
namespace orchard::apps {

// The metrics of a medial mesh, and for one that was built here its stability.
struct MedialJudgement {
  MedialQuality quality;
  std::optional<MedialStability> stability;
};

nlohmann::json to_json(const MedialBuild& build);
nlohmann::json to_json(const Topology& topology);
nlohmann::json to_json(const MedialJudgement& judgement);
nlohmann::json to_json(const MedialSegments& segments, const SkeletonGraph& skeleton);

void print(const MedialBuild& build);
void print(const MedialJudgement& judgement);

}  // namespace orchard::apps
