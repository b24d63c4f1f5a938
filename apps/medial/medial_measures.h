#pragma once
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/stage_times.h"
#include "orchard/medial/axis_distance.h"
#include "orchard/medial/paper_measures.h"
#include "orchard/medial/quality.h"
#include "orchard/medial/shape_measures.h"

namespace orchard::apps {

// What is known of how good an axis is: the metrics of any medial mesh; of one that was built here its stability; of
// one that stands beside another how far it is from that.
struct MedialJudgement {
  MedialQuality quality;
  ShapeMeasures shape = {};
  PaperMeasures paper = {};
  std::optional<MedialStability> stability = {};
  std::optional<AxisDistance> distance = {};  // in diagonals
  StageTimes seconds = {};                    // that measuring took
};

// What is known of any medial mesh. The counts of samples go with those of `options`.
MedialJudgement judge_mesh(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options,
                           const Progress& progress = {});

// One number of a judgement, by the one name and in the one unit that it has in tables, JSON, sweeps and views.
struct MedialMeasure {
  const char* name;
  const char* title;                      // for people, without the unit
  const char* unit;                       // empty: a count
  bool rates;                             // less is better; else it says what the axis is, not how good
  double (*get)(const MedialJudgement&);  // NaN where it is not defined for the axis
};

const std::vector<MedialMeasure>& medial_measures();

}  // namespace orchard::apps
