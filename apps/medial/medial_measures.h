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

// The measures of an axis. The first three members are measured for any medial mesh. `stability` needs an axis that was
// built here, and `distance` needs another axis to compare with.
struct MedialJudgement {
  MedialQuality quality;
  ShapeMeasures shape = {};
  PaperMeasures paper = {};
  std::optional<MedialStability> stability = {};
  std::optional<AxisDistance> distance = {};  // in diagonals
  StageTimes seconds = {};                    // the seconds that each step of measuring took
};

// Measures any medial mesh: sets `quality`, `shape` and `paper`. The number of samples for `paper` is at most
// options.surface_samples.
MedialJudgement judge_mesh(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options,
                           const Progress& progress = {});

// One number of a judgement. It has the same name and unit in tables, JSON, sweeps and views.
struct MedialMeasure {
  const char* name;
  const char* title;                      // for people, without the unit
  const char* unit;                       // empty: a count
  bool rates;                             // lower values are better; if false, it describes the axis without a rating
  double (*get)(const MedialJudgement&);  // NaN if it is not defined for the axis
};

// Returns all measures.
const std::vector<MedialMeasure>& medial_measures();

}  // namespace orchard::apps
