#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "orchard/medial/build.h"

namespace orchard::apps {

inline constexpr Index kStandardSamples = 5000;

// What a user can tune on the way to a medial axis, in the units of the command line.
struct MedialTuning {
  std::optional<Index> samples;       // kStandardSamples, or what a tree needs, unless it is given
  std::optional<Index> edge_samples;  // a fifth unless it is given
  std::optional<double> cluster_degrees;
  double prune_degrees = 0, segment_degrees = 60;
  bool keep_topology = true;
  bool refine = true;          // trees are built without, but for what is shown beside them
  RefineOptions refinement;    // if so
  MedialBuildOptions options;  // the rest of it
};

// Everything in one value. Throws InputError if edge samples exceed samples.
MedialBuildOptions build_options(const MedialTuning& tuning);

// The step on the way to an axis that a flag acts on; the report only says more or less of the axis.
enum class TuningStep { points, diagram, axis, pruning, refining, open_places, report };

// One flag: --name on the command line, name=a,b,c in a sweep.
struct TuningFlag {
  std::string name, help;  // help: what it trades
  std::string standard;    // its value unless it is given
  std::vector<std::string> choices;
  double low = 0, high = 0;  // where there are no choices
  bool whole = false;        // whole numbers only
  TuningStep step = TuningStep::points;
  std::function<void(MedialTuning&, const std::string&)> set;
  // Which other flag's value leaves this one without effect, as "--gaps none"; empty if none does.
  std::function<std::string(const MedialTuning&)> unused = {};

  // Why a value cannot be, without the flag's name; empty if it can.
  std::string fault(const std::string& value) const;
  std::string range() const;
};

const std::vector<TuningFlag>& tuning_flags();

}  // namespace orchard::apps
