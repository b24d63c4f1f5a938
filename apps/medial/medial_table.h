#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "medial/medial_measures.h"

// The judgements of one axis and of others beside it, for people and for programs.
namespace orchard::apps {

struct JudgedAxis {
  std::string name;  // "this axis", or a file
  MedialJudgement judgement;
};

// Every measure by its name; null where it is not defined.
nlohmann::json to_json(const MedialJudgement& judgement);

// A row for each measure, a column for each axis. Where an axis does not define a measure, the table says so; rows that
// no axis defines are left out, but for those in `promised`, by their names.
void print_table(const std::vector<JudgedAxis>& axes, const std::vector<std::string>& promised);

// "protrusion", "coverage" or "dent".
const char* measure_name(WorstKind kind);

// A place where the axis is worst, as the report numbers it from 1 on.
struct ReportedPlace {
  WorstPlace place;
  std::string advice;  // what to do
};
nlohmann::json to_json(const std::vector<ReportedPlace>& places);
void print(const std::vector<ReportedPlace>& places);

}  // namespace orchard::apps
