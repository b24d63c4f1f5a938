#pragma once
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "medial/medial_measures.h"
#include "orchard/medial/build.h"
#include "orchard/spheretree/build.h"

namespace orchard::apps {

// What a sweep measures of every run: the axis and its quality, and of a tree its levels.
struct Column {
  std::string name, title;
  bool rates = false;  // less is better
};
std::vector<Column> all_columns(const MedialCommand& command);
// Without measures of the name of an option that is swept: its values have the name.
std::vector<Column> columns_of(const MedialCommand& command);

// The axis's part of a run's numbers, in the order of all columns. `more`: what its simplification took.
std::vector<double> axis_numbers(const MedialBuild& build, const MedialJudgement& judgement, const StageTimes& more);
// The tree's part, behind it: NaN for levels down to `depth` that it has not.
std::vector<double> tree_numbers(const SphereTreeBuild& built, const Surface& surface, Index depth);

}  // namespace orchard::apps
