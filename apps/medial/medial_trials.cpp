#include "medial/medial_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "command_line/number_text.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr double kGain = 0.1;  // of a value: a step that gains less is not worth another one
constexpr std::size_t kMaxTrials = 50;

// Options that leave the axis as it is.
constexpr const char* kOfTheReport[] = {
    "report", "picture", "beside",      "up",       "no-views",      "export",          "accept",     "vertices",
    "error",  "balls",   "error-curve", "envelope", "envelope-cell", "quality-samples", "importance", "prune-curve"};

std::string text_of(const json& options, const std::string& option) {
  const auto at = options.find(option);
  if (at == options.end()) {
    const auto& flags = tuning_flags();
    const auto flag = std::find_if(flags.begin(), flags.end(), [&](const TuningFlag& f) { return f.name == option; });
    return flag == flags.end() ? "" : flag->standard;
  }
  return at->is_string() ? at->get<std::string>() : at->dump();
}

bool same_without(json a, json b, const std::string& option) {
  a.erase(option);
  b.erase(option);
  return a == b;
}

// Whether the step from an earlier value to this one leads the way that the advice goes on.
bool leads_on(const std::string& earlier, const std::string& now, const std::string& advised) {
  const auto from = finite_number(earlier), at = finite_number(now), to = finite_number(advised);
  return from && at && to && (*at - *from) * (*to - *at) > 0;
}

}  // namespace

std::vector<MedialTrial> earlier_trials(const std::filesystem::path& report, const Provenance& provenance) {
  std::ifstream in(report, std::ios::binary);
  const json read = json::parse(in, nullptr, false);
  std::vector<MedialTrial> trials;
  try {
    if (read.at("provenance").at("inputs").at(0).at("checksum") != provenance.inputs.front().checksum) return {};
    for (const json& trial : read.at("trials")) trials.push_back({trial.at("options"), trial.at("worst")});
  } catch (const json::exception&) {
    return {};  // of another version, or without measures
  }
  if (trials.size() >= kMaxTrials) trials.erase(trials.begin(), trials.end() - (kMaxTrials - 1));
  return trials;
}

MedialTrial trial_of(const Provenance& provenance, const std::vector<WorstPlace>& worst) {
  MedialTrial trial{.options = provenance.run.options, .worst = json::object()};
  for (const char* option : kOfTheReport) trial.options.erase(option);
  for (const WorstPlace& place : worst) {
    const std::string measure = measure_name(place.kind);
    trial.worst[measure] = std::max(trial.worst.value(measure, 0.0), 100 * place.value);
  }
  return trial;
}

json to_json(const std::vector<MedialTrial>& trials) {
  json list = json::array();
  for (const MedialTrial& trial : trials) list.push_back({{"options", trial.options}, {"worst", trial.worst}});
  return list;
}

std::string advice_after(const std::vector<MedialTrial>& earlier, const MedialTrial& now, const Advice& advice,
                         const WorstPlace& place) {
  if (advice.option.empty()) return advice.text;
  const std::string measure = measure_name(place.kind);
  const double value = now.worst.value(measure, 0.0);
  for (const MedialTrial& trial : earlier) {
    if (!same_without(trial.options, now.options, advice.option)) continue;
    const double other = trial.worst.value(measure, 0.0);
    const std::string tried = text_of(trial.options, advice.option), here = text_of(now.options, advice.option);
    if (tried == advice.value)
      return fmt::format("no more: --{} {} was tried and gave {:.4g} where this run has {:.4g}", advice.option, tried,
                         other, value);
    if (leads_on(tried, here, advice.value) && value > (1 - kGain) * other)
      return fmt::format("no more: --{} {} gained less than a tenth over {}, {:.4g} to {:.4g}", advice.option, here,
                         tried, other, value);
  }
  return advice.text;
}

}  // namespace orchard::apps
