#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "medial/medial_advice.h"
#include "medial/medial_table.h"
#include "output/provenance.h"

// Makes advice end: it considers the earlier runs on the same input, which reports store.
namespace orchard::apps {

// One run with --report, as far as advice depends on it.
struct MedialTrial {
  nlohmann::json options;  // that decide the axis, as they were given
  nlohmann::json worst;    // the largest value of each measure of worst places, % of the diagonal
};

// The earlier runs that a report in the folder remembers, itself the last; none if it is of another input, or missing.
std::vector<MedialTrial> earlier_trials(const std::filesystem::path& report, const Provenance& provenance);
// This run.
MedialTrial trial_of(const Provenance& provenance, const std::vector<WorstPlace>& worst);
nlohmann::json to_json(const std::vector<MedialTrial>& trials);

// Returns the advice for a place, unless an earlier run shows that it does not help: one with that very option, or one
// from which the last step of that option gained less than a tenth. Then the sentence says so, with both values.
std::string advice_after(const std::vector<MedialTrial>& earlier, const MedialTrial& now, const Advice& advice,
                         const WorstPlace& place);

}  // namespace orchard::apps
