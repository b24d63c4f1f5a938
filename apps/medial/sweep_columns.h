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
// Leaves out measures with the name of a swept option, because the values of that option have the name.
std::vector<Column> columns_of(const MedialCommand& command);

// Returns the numbers of a run that concern the axis, in the order of the columns. `more` is the time of its
// simplification.
std::vector<double> axis_numbers(const MedialBuild& build, const MedialJudgement& judgement, const StageTimes& more);
// Returns the numbers that concern the tree, which follow. They are NaN for levels up to `depth` that it does not have.
std::vector<double> tree_numbers(const SphereTreeBuild& built, const Surface& surface, Index depth);

}  // namespace orchard::apps
