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
std::vector<Column> columns_of(const MedialCommand& command);

// The axis's part of a run's numbers, in the order of the columns.
std::vector<double> axis_numbers(const MedialBuild& build, const MedialJudgement& judgement);
// The tree's part, behind it: NaN for levels down to `depth` that it has not.
std::vector<double> tree_numbers(const SphereTreeBuild& built, const Surface& surface, Index depth);

}  // namespace orchard::apps
